"""The selected vertex: what it follows, where it is, and what can be done with its moves."""

from __future__ import annotations

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QGridLayout, QHBoxLayout, QVBoxLayout, QWidget

from app.model.character import Character, Move
from app.model.edits import characters, poses
from app.window.character.handles_of import control_vertices, vertex_title
from app.window.character.place_section import LENGTH
from app.window.controls import Chip, Chooser, NumberField, Row, button, label
from app.window.project import Project

Place3 = tuple[float, float, float]
KINDS = ("3D position", "2D, its image point")


class VertexSection(QWidget):
    """``placed`` gives a vertex, a typed place and whether only its image point counts; the others name a vertex."""

    placed = Signal(int, object, bool)
    unmove = Signal(int)
    mute = Signal(int, bool)
    forget = Signal(int)

    def __init__(self) -> None:
        super().__init__()
        self.project: Project | None = None
        self.character: Character | None = None
        self._names: tuple[tuple[str, str], ...] = ()
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(8)
        head = QHBoxLayout()
        self.name = label("", "title")
        self.chip = Chip()
        head.addWidget(self.name, 1)
        head.addWidget(self.chip)
        column.addLayout(head)
        self.follows = Chooser(name="Follows point")
        self.follows.activated.connect(self._follow)
        column.addWidget(Row("Follows point", self.follows))
        self.like = Chooser(name="Moves like")
        self.like.setToolTip("A free control vertex takes over a point's motion between the edits without lying on it")
        self.like.activated.connect(self._move_like)
        column.addWidget(Row("Moves like", self.like))
        self.kind = Chooser(KINDS, "What holds it in this frame")
        self.kind.activated.connect(lambda _: self._typed(0.0))
        column.addWidget(Row("Constraint", self.kind))
        self.place = [NumberField(LENGTH) for _ in range(3)]
        for field in self.place:
            field.changed.connect(self._typed)
        column.addWidget(Row("Position", *self.place))
        grid = QGridLayout()
        grid.setSpacing(8)
        self.mute_button = button("Mute here", self._mute)
        self.unmove_button = button("Delete move", self._unmove)
        self.forget_button = button("Delete control vertex", self._forget, name="delete")
        grid.addWidget(self.mute_button, 0, 0)
        grid.addWidget(self.unmove_button, 0, 1)
        grid.addWidget(self.forget_button, 1, 0, 1, 2)
        column.addLayout(grid)

    def show_vertex(self, project: Project, character: Character, place: Place3 | None) -> None:
        """Show the selected vertex and its place in the frame shown."""
        self.project, self.character = project, character
        vertex = project.vertex
        self.setEnabled(vertex >= 0)
        edit = character.edits.get(project.frame)
        move = edit.moves.get(vertex) if edit else None
        paired = next((track for track, at in character.pairs.items() if at == vertex), None)
        if vertex < 0:
            self.name.setText("No vertex selected")
            self.chip.show_state("")
        else:
            self.name.setText(vertex_title(project, character, vertex))
            states = [("muted here", "neutral")] if move and move.muted else [("edited here", "edit")] if move else []
            states += [("paired", "accent")] if paired else [("free", "neutral")]
            self.chip.show_state(*states[0])
        self._show_followed(project, paired or "", character.following.get(vertex, ""))
        self.like.setEnabled(paired is None and vertex in control_vertices(character))
        self.kind.setEnabled(move is not None)
        self.kind.setCurrentIndex(1 if move is not None and move.on_ray else 0)
        for field, value in zip(self.place, place or (0.0, 0.0, 0.0), strict=True):
            field.setEnabled(place is not None)
            field.set_value(value)
        self._show_buttons(move, vertex in control_vertices(character))

    def _show_buttons(self, move: Move | None, control: bool) -> None:
        self.mute_button.setEnabled(move is not None)
        self.mute_button.setText("Let it count" if move and move.muted else "Mute here")
        self.unmove_button.setEnabled(move is not None)
        self.forget_button.setEnabled(control)

    def _show_followed(self, project: Project, followed: str, like: str) -> None:
        names = (("none", ""), *((track.name, track.id) for track in project.document.tracks))
        if names != self._names:
            self._names = names
            for box in (self.follows, self.like):
                box.clear()
                for name, track_id in names:
                    box.addItem(name, track_id)
        self.follows.setCurrentIndex(max(self.follows.findData(followed), 0))
        self.like.setCurrentIndex(max(self.like.findData(like), 0))

    def _move_like(self, index: int) -> None:
        project, character = self.project, self.character
        if project is not None and character is not None and project.vertex >= 0:
            project.edit(poses.follow_track, character.id, project.vertex, self.like.itemData(index) or None)

    def _follow(self, index: int) -> None:
        project, character = self.project, self.character
        if project is None or character is None or project.vertex < 0:
            return
        track = self.follows.itemData(index)
        paired = next((each for each, at in character.pairs.items() if at == project.vertex), None)
        if paired is not None and track != paired:
            project.edit(characters.remove_pair, character.id, paired, gesture="pair")
        if track and track != paired:
            project.edit(characters.set_pair, character.id, track, project.vertex, gesture="pair")
        project.close_gesture()

    def _typed(self, _: float) -> None:
        if self.project is not None and self.project.vertex >= 0:
            place = tuple(field.value for field in self.place)
            self.placed.emit(self.project.vertex, place, self.kind.isEnabled() and self.kind.currentIndex() == 1)

    def _mute(self) -> None:
        if self.project is not None and self.character is not None:
            edit = self.character.edits[self.project.frame]
            self.mute.emit(self.project.vertex, not edit.moves[self.project.vertex].muted)

    def _unmove(self) -> None:
        if self.project is not None:
            self.unmove.emit(self.project.vertex)

    def _forget(self) -> None:
        if self.project is not None:
            self.forget.emit(self.project.vertex)
