"""The character's place in the first frame: what the gizmo does, and the numbers beside it."""

from __future__ import annotations

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QHBoxLayout

from app.model.character import Alignment, Character
from app.model.edits import characters
from app.window.controls import Chooser, Fold, NumberField, NumberRange, Row, button, toggle
from app.window.project import Project

SCALE = NumberRange(0.01, 100.0, 0.005, 3, "×", 1.0)
ANGLE = NumberRange(-360.0, 360.0, 0.5, 1, "°", 0.0)
LENGTH = NumberRange(-1000.0, 1000.0, 0.002, 3, "", 0.0)
MODES = (("move", "Move"), ("rotate", "Turn"), ("scale", "Scale"))


class PlaceSection(Fold):
    """``mode_wanted`` names what the gizmo shall do, empty to put it away; ``changing`` that a number is being dragged.

    ``hand_wanted`` asks for placing by hand (True) or by the pairs; ``reset_wanted`` for the default.
    """

    mode_wanted = Signal(str)
    changing = Signal(object)
    hand_wanted = Signal(bool)
    reset_wanted = Signal()

    def __init__(self) -> None:
        super().__init__("Place in the first frame")
        self.project: Project | None = None
        self.character: Character | None = None
        self.modes = {}
        line = QHBoxLayout()
        line.setSpacing(4)
        for name, text in MODES:
            each = toggle(f"gizmo_{name}", text, lambda on, name=name: self._mode(name, on), key=f"gizmo_{name}")
            self.modes[name] = each
            line.addWidget(each, 1)
        self.column.addLayout(line)
        self.scale = NumberField(SCALE, 1.0)
        self.turn = [NumberField(ANGLE) for _ in range(3)]
        self.shift = [NumberField(LENGTH) for _ in range(3)]
        for fields, name in (([self.scale], "scale"), (self.turn, "rotation"), (self.shift, "translation")):
            for field in fields:
                field.changed.connect(lambda _, name=name: self._align(**{name: self._value(name)}))
                field.changing.connect(lambda _: self.changing.emit(self.values()))
        self.column.addWidget(Row("Scale", self.scale))
        self.column.addWidget(Row("Rotation", *self.turn))
        self.column.addWidget(Row("Shift", *self.shift))
        self.up = Chooser(("X up", "Y up", "Z up"), "Axis of the mesh file that points up")
        self.up.activated.connect(lambda index: self._align(up="xyz"[index]))
        self.column.addWidget(Row("Mesh file", self.up))
        self.by = Chooser(("where its pairs fit", "where I put it"), "Where the character stands")
        self.by.activated.connect(lambda index: self.hand_wanted.emit(index == 1))
        self.column.addWidget(Row("Stands", self.by))
        self.reset = button("Reset the place", self.reset_wanted.emit, name="reset")
        self.column.addWidget(self.reset)

    def values(self) -> Alignment:
        """The alignment that the fields show."""
        assert self.character is not None
        now = self.character.alignment
        scale, rotation, translation = (self._value(name) for name in ("scale", "rotation", "translation"))
        return Alignment(now.fitted, scale, rotation, translation, now.up)

    def _value(self, name: str) -> object:
        if name == "scale":
            return self.scale.value
        return tuple(field.value for field in (self.turn if name == "rotation" else self.shift))

    def show_place(self, project: Project, character: Character, mode: str) -> None:
        """Show the alignment of a character, and what the gizmo does."""
        self.project, self.character = project, character
        alignment = character.alignment
        self.scale.set_value(alignment.scale)
        for fields, values in ((self.turn, alignment.rotation), (self.shift, alignment.translation)):
            for field, value in zip(fields, values, strict=True):
                field.set_value(value)
        self.up.setCurrentIndex("xyz".index(alignment.up))
        self.by.setCurrentIndex(0 if alignment.fitted else 1)
        plain = (alignment.scale, alignment.rotation, alignment.translation) == (1.0, (0.0,) * 3, (0.0,) * 3)
        self.reset.setEnabled(not plain)
        self.show_mode(mode)

    def show_mode(self, mode: str) -> None:
        """Show what the gizmo does."""
        for name, each in self.modes.items():
            each.blockSignals(True)
            each.setChecked(name == mode)
            each.blockSignals(False)
        self.caption.setText("on the picture" if mode else "")

    def _mode(self, name: str, on: bool) -> None:
        self.mode_wanted.emit(name if on else "")

    def _align(self, **changes: object) -> None:
        if self.project is not None and self.character is not None:
            self.project.edit(characters.set_alignment, self.character.id, **changes)
