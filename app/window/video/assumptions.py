"""Numbers that the pictures do not tell: how the camera is held, how high, and what stays equally far away."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtWidgets import QToolButton, QVBoxLayout, QWidget

from app.model.edits import scene
from app.window.controls import NumberField, NumberRange, Row, button, icon_button, label, separator
from app.window.project import Project
from app.window.video import ground_edits

ANGLE = NumberRange(-89.0, 89.0, 0.25, 1, "°", 0.0)
HEIGHT = NumberRange(0.01, 1000.0, 0.01, 2, "m", 1.6)
DEPTH = NumberRange(0.01, 10_000.0, 0.02, 2, "", 5.0)


class Assumptions(QWidget):
    """Fields with a way back to what is assumed; every change is an edit, after which the ground is laid anew."""

    def __init__(self) -> None:
        super().__init__()
        self.project: Project | None = None
        self.chosen: tuple[str, ...] = ()
        self.column = QVBoxLayout(self)
        self.column.setContentsMargins(0, 0, 0, 0)
        self.column.setSpacing(8)
        self.pitch, self.pitch_reset = self._field(
            "Tilted down", ANGLE, self._pitch, "How far the camera looks down from the horizon in the first frame."
        )
        self.roll, self.roll_reset = self._field(
            "Turned", ANGLE, self._roll, "How far the camera is turned clockwise in the first frame."
        )
        self.height, self.height_reset = self._field(
            "Camera height", HEIGHT, self._height, "Of the first camera above the ground; it replaces a known length."
        )
        self.column.addWidget(separator())
        self.depth, self.depth_reset = self._field(
            "Depth", DEPTH, self._depth, "How far away the points are that stay at a constant depth."
        )
        self.held = label("", "label")
        self.held.setWordWrap(True)
        self.column.addWidget(self.held)
        self.hold = button("Hold the chosen points there", lambda: self._hold(self.chosen))
        self.release = button("Hold none", lambda: self._hold(()))
        for each in (self.hold, self.release):
            self.column.addWidget(each)

    def _field(
        self, text: str, limits: NumberRange, change: Callable[[float | None], object], words: str
    ) -> tuple[NumberField, QToolButton]:
        field = NumberField(limits, limits.default or 0.0)
        field.setAccessibleName(f"{text}, {limits.unit}" if limits.unit else text)
        field.changed.connect(change)
        reset = icon_button("reset", f"{text}: take the usual again", lambda: change(None))
        field.setToolTip(f"{words} Drag sideways or click and type.")
        row = Row(text, field)
        row.layout().addWidget(reset)
        self.column.addWidget(row)
        return field, reset

    def show_world(self, project: Project, chosen: tuple[str, ...]) -> None:
        """Show what is said of the world; ``chosen`` are the tracks chosen in the picture."""
        self.project, self.chosen = project, chosen
        choice = project.document.world
        for field, reset, value in (
            (self.pitch, self.pitch_reset, choice.pitch),
            (self.roll, self.roll_reset, choice.roll or None),
            (self.height, self.height_reset, choice.height),
            (self.depth, self.depth_reset, choice.depth),
        ):
            field.set_value(value if value is not None else field.limits.default or 0.0, assumed=value is None)
            reset.setEnabled(value is not None)
        names = [project.document.track(track).name for track in choice.depth_tracks]
        held = choice.ground == "depth" and bool(names)
        self.held.setText(f"Held at this depth: {', '.join(names)}." if held else "No point is held at this depth.")
        self.hold.setEnabled(bool(chosen))
        self.release.setEnabled(held)

    def _pitch(self, value: float | None) -> None:
        if self.project is not None:
            ground_edits.change(self.project, scene.set_horizon, value, self.project.document.world.roll)

    def _roll(self, value: float | None) -> None:
        if self.project is not None:
            ground_edits.change(self.project, scene.set_horizon, self.project.document.world.pitch, value or 0.0)

    def _height(self, value: float | None) -> None:
        if self.project is not None:
            ground_edits.change(self.project, scene.set_camera_height, value)

    def _depth(self, value: float | None) -> None:
        if self.project is not None:
            ground_edits.set_depth(self.project, value)

    def _hold(self, tracks: tuple[str, ...]) -> None:
        if self.project is not None:
            ground_edits.hold(self.project, tracks)
