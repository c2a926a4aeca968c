"""Ground and scale from chosen points of the recovered scene, and what to assume where there is no parallax."""

from __future__ import annotations

from typing import Any

from PySide6.QtCore import Signal
from PySide6.QtGui import QIcon
from PySide6.QtWidgets import QLabel, QPushButton

from app.actions import marks
from app.model.edits import scene
from app.model.world import KnownLength
from app.window import icons
from app.window.controls import NumberField, NumberRange, Row, ScrollColumn, button, label, separator
from app.window.project import Project
from app.window.video import ground_edits
from app.window.video.assumptions import Assumptions
from imitation.errors import InputError

METRES = NumberRange(0.001, 10_000.0, 0.01, 3, "m", 1.0)


class ScenePanel(ScrollColumn):
    """Shows what is chosen in the scene and what can be said of it."""

    cleared = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.project: Project | None = None
        self.points: tuple[int, ...] = ()
        self.tracks: tuple[str, ...] = ()
        self.frame = 0
        self.chosen = _words("")
        self.rows.addWidget(self.chosen)
        self.lay = button("Lay the ground through them", self.lay_ground, name="ground")
        self.rows.addWidget(self.lay)
        self.drop = button("Forget the points of the ground", self.drop_ground)
        self.rows.addWidget(self.drop)
        self.metres = NumberField(METRES, 1.0)
        self.metres.setAccessibleName("Distance between the two, metres")
        self.rows.addWidget(Row("They are apart", self.metres))
        self.scale = button("Set this length", self.set_length, name="length")
        self.rows.addWidget(self.scale)
        self.clear = button("Choose nothing", self.cleared.emit)
        self.rows.addWidget(self.clear)
        self.rows.addWidget(separator())
        self.verdict = _words("")
        self.rows.addWidget(self.verdict)
        self.grounds: dict[str, QPushButton] = {}
        for kind, text, words in (
            ("local", "Fit the ground at each contact", "Stairs and slopes: the points near each foot count."),
            (
                "background",
                "The measured background",
                "Each contact lies where its point meets the measured depth; it is measured first where it is missing.",
            ),
            ("plane", "One ground plane", "One level ground for all contacts."),
            ("depth", "Constant depth", "No ground: the subject stays equally far from the camera."),
        ):
            each = button(text, lambda kind=kind: self.choose(kind))
            each.setToolTip(words)
            each.setCheckable(True)
            self.grounds[kind] = each
            self.rows.addWidget(each)
        self.above = button("Filmed from above", self.toggle_above)
        self.above.setCheckable(True)
        self.rows.addWidget(self.above)
        self.forget = button("Forget the known length", self.forget_length)
        self.rows.addWidget(self.forget)
        self.rows.addWidget(separator())
        self.assumed = Assumptions()
        self.rows.addWidget(self.assumed)
        self.rows.addStretch(1)

    def show_scene(self, project: Project, points: tuple[int, ...], tracks: tuple[str, ...], frame: int) -> None:
        """Show the choice of a project in a frame."""
        self.project, self.points, self.tracks, self.frame = project, points, tracks, frame
        names = [project.document.track(track).name for track in tracks]
        if points or names:
            parts = [f"{len(points)} points of the scene"] if points else []
            self.chosen.setText("Chosen: " + ", ".join(parts + names) + ".")
        else:
            self.chosen.setText(
                "Click points of the scene, or draw round them. Two of them, or two tracks, give a scale."
            )
        self.lay.setEnabled(len(points) >= 3)
        self.scale.setEnabled((len(points), len(tracks)) in ((2, 0), (0, 2)))
        self.clear.setEnabled(bool(points or tracks))
        choice = project.document.world
        self.drop.setEnabled(choice.ground == "plane" and bool(choice.plane_points))
        self.assumed.show_world(project, tracks)
        for kind, each in self.grounds.items():
            each.setChecked(kind == choice.ground)
            each.setIcon(icons.icon("solution", "accent") if kind == choice.ground else QIcon())
        self.above.setChecked(choice.from_above)
        self.above.setIcon(icons.icon("solution", "accent") if choice.from_above else QIcon())
        self.forget.setEnabled(choice.length is not None or choice.seen is not None)
        world = project.result(project.session.stages.world)
        path = self._path()
        if world is not None:
            note = f"{world.note[:1].upper()}{world.note[1:].rstrip('.')}."
        elif path is None:
            note = "The cameras have not been solved yet: run what is missing."
        else:
            note = "The ground has not been laid yet: run what is missing."
        flat = path is not None and path.verdict in ground_edits.FLAT
        lead = "No parallax: assume a ground plane or a constant depth, or skip this. " if flat else ""
        self.verdict.setText(lead + note)

    def _path(self) -> Any:
        return self.project.result(self.project.session.stages.cameras) if self.project is not None else None

    def choose(self, kind: str) -> None:
        """Choose where contacts lie; points chosen before for a plane stay."""
        if self.project is not None:
            ground_edits.choose(self.project, kind)

    def drop_ground(self) -> None:
        """Forget the points that the ground was laid through."""
        if self.project is not None:
            ground_edits.drop_points(self.project)

    def forget_length(self) -> None:
        """Nothing is known of the scale any more."""
        if self.project is not None:
            ground_edits.change(self.project, scene.set_length, None)

    def toggle_above(self) -> None:
        """Say whether the camera looks down on the subject."""
        if self.project is not None:
            ground_edits.change(self.project, scene.set_from_above, not self.project.document.world.from_above)

    def _places(self) -> list[tuple[float, float, float]]:
        path = self._path()
        known = self.points if path is not None else ()
        return [tuple(float(value) for value in path.points[index]) for index in known]  # type: ignore[misc]

    def lay_ground(self) -> None:
        """The ground is the plane through the chosen points."""
        if self.project is not None:
            ground_edits.change(self.project, scene.set_ground, "plane", plane_points=self._places())

    def set_length(self) -> None:
        """The two chosen points, or tracks, are so many metres apart."""
        project, metres = self.project, self.metres.value
        if project is None:
            return
        if len(self.points) == 2:
            first, second = self._places()
            ground_edits.change(project, scene.set_length, KnownLength(first, second, metres))
            return
        try:
            marks.length_between(project.session, *self.tracks, self.frame, metres)
        except (InputError, ValueError) as error:
            project.failed.emit(str(error), "")
            return
        ground_edits.lay_anew(project)


def _words(text: str) -> QLabel:
    made = label(text, "label")
    made.setWordWrap(True)
    return made
