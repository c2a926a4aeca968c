"""What is known of the character and of the selected vertex, and what can be done with them."""

from __future__ import annotations

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QCheckBox, QComboBox, QHBoxLayout, QListWidget, QListWidgetItem, QVBoxLayout, QWidget

from app.model.character import Alignment, Character
from app.model.edits import characters, poses
from app.window.character.handles_of import vertex_title
from app.window.controls import Chip, NumberField, NumberRange, Row, ScrollColumn, button, label, separator
from app.window.project import Project

SCALE = NumberRange(0.01, 100.0, 0.005, 3, "×", 1.0)
ANGLE = NumberRange(-360.0, 360.0, 0.5, 1, "°", 0.0)
LENGTH = NumberRange(-1000.0, 1000.0, 0.002, 3, "", 0.0)


class CharacterInspector(ScrollColumn):
    """Shows one character; every change is an edit of the document."""

    go = Signal(int)
    propagate = Signal()
    on_release = Signal(bool)
    placed = Signal(int, object)
    unmove = Signal(int)
    mute = Signal(int, bool)

    def __init__(self) -> None:
        super().__init__()
        self.project: Project | None = None
        self.character: Character | None = None
        self.chooser = QComboBox()
        self.chooser.setAccessibleName("Character")
        self.chooser.activated.connect(self._choose)
        self.rows.addWidget(Row("Character", self.chooser))
        self.rows.addWidget(self._vertex())
        self.rows.addWidget(separator())
        self.rows.addWidget(label("Propagation", "title"))
        self.automatic = QCheckBox("Propagate on release")
        self.automatic.setChecked(True)
        self.automatic.toggled.connect(self.on_release)
        self.run = button("Propagate", self.propagate.emit, primary=True, name="propagate")
        self.forget = button("Reset this frame", self._reset)
        line = QHBoxLayout()
        line.setSpacing(8)
        line.addWidget(self.run, 1)
        line.addWidget(self.forget, 1)
        self.rows.addWidget(self.automatic)
        self.rows.addLayout(line)
        self.frames = QListWidget()
        self.frames.setAccessibleName("Edited frames")
        self.frames.itemActivated.connect(self._jump)
        self.frames.itemClicked.connect(self._jump)
        self.frames_title = label("Edited frames", "label")
        self.rows.addWidget(self.frames_title)
        self.rows.addWidget(self.frames)
        self.rows.addWidget(separator())
        self.rows.addWidget(self._alignment())
        self.rows.addStretch(1)

    def _vertex(self) -> QWidget:
        self.vertex_body = QWidget()
        column = QVBoxLayout(self.vertex_body)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(8)
        head = QHBoxLayout()
        self.vertex_name = label("", "title")
        self.vertex_chip = Chip()
        head.addWidget(self.vertex_name, 1)
        head.addWidget(self.vertex_chip)
        column.addLayout(head)
        self.follows = QComboBox()
        self.follows.setAccessibleName("Follows point")
        self.follows.activated.connect(self._follow)
        column.addWidget(Row("Follows point", self.follows))
        self.place = [NumberField(LENGTH) for _ in range(3)]
        for field in self.place:
            field.changed.connect(self._typed)
        column.addWidget(Row("Position", *self.place))
        line = QHBoxLayout()
        line.setSpacing(8)
        self.mute_button = button("Mute here", self._mute)
        self.unmove_button = button("Delete move", self._unmove)
        line.addWidget(self.mute_button, 1)
        line.addWidget(self.unmove_button, 1)
        column.addLayout(line)
        return self.vertex_body

    def _alignment(self) -> QWidget:
        self.alignment_body = QWidget()
        column = QVBoxLayout(self.alignment_body)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(8)
        column.addWidget(label("Place in the first frame", "title"))
        self.scale = NumberField(SCALE, 1.0)
        self.scale.changed.connect(lambda value: self._align(scale=value))
        self.turn = [NumberField(ANGLE) for _ in range(3)]
        self.shift = [NumberField(LENGTH) for _ in range(3)]
        for field in self.turn:
            field.changed.connect(lambda _: self._align(rotation=tuple(each.value for each in self.turn)))
        for field in self.shift:
            field.changed.connect(lambda _: self._align(translation=tuple(each.value for each in self.shift)))
        column.addWidget(Row("Scale", self.scale))
        column.addWidget(Row("Rotation", *self.turn))
        column.addWidget(Row("Shift", *self.shift))
        self.up = QComboBox()
        self.up.addItems(["X up", "Y up", "Z up"])
        self.up.activated.connect(lambda index: self._align(up="xyz"[index]))
        column.addWidget(Row("Mesh file", self.up))
        return self.alignment_body

    # showing -----------------------------------------------------------------------------------------------------

    def show_character(self, project: Project, place: tuple[float, float, float] | None) -> None:
        """Show the selected character, and the place of its selected vertex in the frame shown."""
        self.project = project
        document = project.document
        names = [each.name for each in document.characters]
        if names != [self.chooser.itemText(number) for number in range(self.chooser.count())]:
            self.chooser.clear()
            self.chooser.addItems(names)
        ids = [each.id for each in document.characters]
        self.character = None
        if project.character_id in ids:
            self.chooser.setCurrentIndex(ids.index(project.character_id))
            self.character = document.characters[ids.index(project.character_id)]
        self.setEnabled(self.character is not None)
        if self.character is None:
            return
        self._show_vertex(place)
        self._show_frames()
        self._show_alignment(self.character.alignment)

    def _show_vertex(self, place: tuple[float, float, float] | None) -> None:
        project, character = self.project, self.character
        assert project is not None
        assert character is not None
        vertex = project.vertex
        self.vertex_body.setEnabled(vertex >= 0)
        edit = character.edits.get(project.frame)
        move = edit.moves.get(vertex) if edit else None
        paired = next((track for track, at in character.pairs.items() if at == vertex), None)
        if vertex < 0:
            self.vertex_name.setText("No vertex selected")
            self.vertex_chip.show_state("")
        else:
            self.vertex_name.setText(vertex_title(project, character, vertex))
            states = [("muted here", "neutral")] if move and move.muted else [("edited here", "edit")] if move else []
            states += [("paired", "accent")] if paired else [("free", "neutral")]
            self.vertex_chip.show_state(*states[0])
        self.follows.blockSignals(True)
        self.follows.clear()
        self.follows.addItem("none", "")
        for track in project.document.tracks:
            self.follows.addItem(track.name, track.id)
        followed = paired or character.following.get(vertex, "")
        self.follows.setCurrentIndex(max(self.follows.findData(followed), 0))
        self.follows.blockSignals(False)
        for field, value in zip(self.place, place or (0.0, 0.0, 0.0), strict=True):
            field.setEnabled(place is not None)
            field.set_value(value)
        self.mute_button.setEnabled(move is not None)
        self.mute_button.setText("Let it count" if move and move.muted else "Mute here")
        self.unmove_button.setEnabled(move is not None)

    def _show_frames(self) -> None:
        project, character = self.project, self.character
        assert project is not None
        assert character is not None
        edits = list(character.edits.items())
        self.forget.setEnabled(project.frame in character.edits)
        self.frames_title.setText(f"Edited frames ({len(edits)})" if edits else "No edited frames yet")
        self.frames.setVisible(bool(edits))
        self.frames.setFixedHeight(min(len(edits), 5) * 26 + 2)
        rows = []
        for frame, edit in edits:
            names = [vertex_title(project, character, vertex) for vertex in edit.moves]
            more = f" and {len(names) - 2} more" if len(names) > 2 else ""
            rows.append((frame, f"{frame}   {', '.join(names[:2])}{more}"))
        if rows != [(self._data(number), self.frames.item(number).text()) for number in range(self.frames.count())]:
            self.frames.clear()
            for frame, text in rows:
                item = QListWidgetItem(text)
                item.setData(32, frame)
                self.frames.addItem(item)
        here = next((number for number, (frame, _) in enumerate(rows) if frame == project.frame), -1)
        self.frames.setCurrentRow(here)

    def _data(self, number: int) -> int:
        return int(self.frames.item(number).data(32))

    def _show_alignment(self, alignment: Alignment) -> None:
        self.scale.set_value(alignment.scale)
        for fields, values in ((self.turn, alignment.rotation), (self.shift, alignment.translation)):
            for field, value in zip(fields, values, strict=True):
                field.set_value(value)
        self.up.setCurrentIndex("xyz".index(alignment.up))

    # doing -------------------------------------------------------------------------------------------------------

    def _choose(self, index: int) -> None:
        if self.project is not None:
            self.project.select_character(self.project.document.characters[index].id)

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
            self.placed.emit(self.project.vertex, tuple(field.value for field in self.place))

    def _mute(self) -> None:
        if self.project is not None and self.character is not None:
            edit = self.character.edits[self.project.frame]
            self.mute.emit(self.project.vertex, not edit.moves[self.project.vertex].muted)

    def _unmove(self) -> None:
        if self.project is not None:
            self.unmove.emit(self.project.vertex)

    def _reset(self) -> None:
        if self.project is not None and self.character is not None:
            self.project.edit(poses.delete_edit, self.character.id, self.project.frame)

    def _align(self, **changes: object) -> None:
        if self.project is not None and self.character is not None:
            self.project.edit(characters.set_alignment, self.character.id, **changes)

    def _jump(self, item: QListWidgetItem) -> None:
        self.go.emit(int(item.data(32)))
