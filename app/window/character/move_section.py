"""Spreading of pose edits, and what was moved, frame by frame: go there, mute, delete, copy."""

from __future__ import annotations

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QCheckBox, QHBoxLayout

from app.model.character import Character
from app.model.edits import characters, poses
from app.window.character.handles_of import vertex_title
from app.window.character.row_list import Act, Entry, RowList
from app.window.controls import Fold, button, icon_button, label
from app.window.project import Project

DELETE_FRAME = Act("delete", "delete", "Delete this pose edit")
DELETE = Act("delete", "delete", "Delete this move")
MUTE, UNMUTE = Act("mute", "seen", "Mute this move"), Act("mute", "hidden", "Let this move count again")


class MoveList(RowList):
    """Edited frames, and under each the vertices that were moved there."""

    def count(self) -> int:
        """How many frames are edited."""
        return sum(entry.head for entry in self.entries)


class MoveSection(Fold):
    """``go`` asks for a frame; ``unmove`` and ``mute`` name a frame and a vertex; ``wanted`` a command."""

    go = Signal(int)
    on_release = Signal(bool)
    propagate = Signal()
    unmove = Signal(int, int)
    mute = Signal(int, int, bool)
    wanted = Signal(str)

    def __init__(self) -> None:
        super().__init__("Pose edits")
        self.project: Project | None = None
        self.character: Character | None = None
        self.automatic = QCheckBox("Propagate on release")
        self.automatic.setChecked(True)
        self.automatic.setToolTip("Without it several vertices can be moved first; Ctrl+Return spreads them")
        self.automatic.toggled.connect(self.on_release)
        self.run = button("Propagate", self.propagate.emit, primary=True, name="propagate")
        self.forget = button("Reset this frame", self._reset)
        line = QHBoxLayout()
        line.setSpacing(8)
        line.addWidget(self.run, 1)
        line.addWidget(self.forget, 1)
        self.column.addWidget(self.automatic)
        self.column.addLayout(line)
        self.lift = QCheckBox("Lift feet onto the ground")
        self.lift.setToolTip("Where the motion puts a foot below the ground of its contacts, it is lifted, softly")
        self.lift.clicked.connect(self._lift)
        self.column.addWidget(self.lift)
        bar = QHBoxLayout()
        bar.setSpacing(2)
        self.title = label("No frame is edited yet", "label")
        self.copy_button = icon_button("copy", "Copy the pose edit of this frame", self._ask("copy_pose"), "copy_pose")
        self.paste_button = icon_button("paste", "Paste it into this frame", self._ask("paste_pose"), "paste_pose")
        bar.addWidget(self.title, 1)
        bar.addWidget(self.copy_button)
        bar.addWidget(self.paste_button)
        self.column.addLayout(bar)
        self.list = MoveList("Pose edits")
        self.column.addWidget(self.list)
        self.list.chosen.connect(self._choose)
        self.list.acted.connect(self._act)

    def _ask(self, name: str) -> object:
        return lambda: self.wanted.emit(name)

    def show_moves(self, project: Project, character: Character, *, copied: bool) -> None:
        """Show the edited frames of a character and what was moved in each."""
        self.project, self.character = project, character
        edits = character.edits
        rows = []
        for frame, edit in edits.items():
            here = frame == project.frame
            moved = f"{len(edit.moves)} moved" if len(edit.moves) > 1 else ""
            rows.append(Entry(f"{frame}", f"Frame {frame}", moved, "edit", (DELETE_FRAME,), head=True, lit=here))
            for vertex, move in edit.moves.items():
                kind = "muted" if move.muted else "2D" if move.on_ray else "3D"
                acts = (UNMUTE if move.muted else MUTE, DELETE)
                title, lit = vertex_title(project, character, vertex), here and vertex == project.vertex
                rows.append(Entry(f"{frame}/{vertex}", title, kind, "", acts, faint=move.muted, lit=lit))
        self.list.show_entries(tuple(rows))
        count = len(edits)
        self.title.setText(f"{count} edited frame{'s' if count != 1 else ''}" if count else "No frame is edited yet")
        self.caption.setText("")
        self.forget.setEnabled(project.frame in edits)
        self.lift.setChecked(character.solve.lift_feet)
        self.copy_button.setEnabled(project.frame in edits)
        self.paste_button.setEnabled(copied)

    def _choose(self, row: str) -> None:
        frame, vertex = _parts(row)
        self.go.emit(frame)
        if self.project is not None and vertex >= 0:
            self.project.select_vertex(vertex)

    def _act(self, row: str, act: str) -> None:
        frame, vertex = _parts(row)
        if self.project is None or self.character is None:
            return
        if vertex < 0:
            self.project.edit(poses.delete_edit, self.character.id, frame)
        elif act == "delete":
            self.unmove.emit(frame, vertex)
        else:
            self.mute.emit(frame, vertex, not self.character.edits[frame].moves[vertex].muted)

    def _lift(self, on: bool) -> None:
        if self.project is not None and self.character is not None:
            self.project.edit(characters.set_solve, self.character.id, lift_feet=on)

    def _reset(self) -> None:
        if self.project is not None and self.character is not None:
            self.project.edit(poses.delete_edit, self.character.id, self.project.frame)


def _parts(row: str) -> tuple[int, int]:
    """Frame and vertex of a row, -1 for the frame itself."""
    frame, _, vertex = row.partition("/")
    return int(frame), int(vertex) if vertex else -1
