"""What stands right of the picture: the selected point or the scene, and the steps of the project."""

from __future__ import annotations

from PySide6.QtWidgets import QHBoxLayout, QPushButton, QSizePolicy

from app.window.controls import Panel, button
from app.window.fold_away import FoldAway
from app.window.moment import Moment
from app.window.project import Project
from app.window.video import ground_edits
from app.window.video.inspector import TrackInspector
from app.window.video.scene_panel import ScenePanel
from app.window.video.steps import StepList, steps

WIDTH = 304


class RightColumn(FoldAway):
    """Point, or ground and scale while that tool is in use; below what the project needs."""

    def __init__(self) -> None:
        super().__init__("video", "Point, and what this project needs", WIDTH)
        self._needs: tuple[object, ...] = ()
        self.track_panel = Panel("Point")
        self.inspector = TrackInspector()
        self.track_panel.column.addWidget(self.inspector, 1)
        offers = QHBoxLayout()
        offers.setContentsMargins(0, 0, 0, 0)
        offers.setSpacing(6)
        self.propose_button: QPushButton = button("Propose contacts", lambda: None, name="contact")
        self.accept_button: QPushButton = button("Accept all", lambda: None)
        offers.addWidget(self.propose_button)
        offers.addWidget(self.accept_button)
        self.inspector.rows.insertLayout(self.inspector.rows.count() - 1, offers)
        self.scene_panel = Panel("Ground and scale")
        self.scene = ScenePanel()
        self.scene_panel.column.addWidget(self.scene, 1)
        self.steps_panel = Panel("What this project needs")
        self.steps = StepList()
        self.steps_panel.column.addWidget(self.steps)
        self.steps_panel.column.setContentsMargins(1, 1, 1, 1)
        self.steps.layout().setContentsMargins(12, 0, 12, 12)
        self.steps_panel.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Maximum)
        self.column.addWidget(self.track_panel, 1)
        self.column.addWidget(self.scene_panel, 1)
        self.column.addWidget(self.steps_panel)

    def show_scene(self, scene: bool) -> None:
        """Show ground and scale instead of the point, or the point again."""
        if scene:
            self.unfold()
        self.scene_panel.setVisible(scene)
        self.track_panel.setVisible(not scene)

    def show_needs(self, project: Project, *, moved: bool) -> None:
        """Show what the project needs; where one has only ``moved`` to another frame, only if something has changed."""
        now = (Moment.of(project.session), project.character_id, project.track_id, tuple(project.progress.values()))
        if not moved or now != self._needs:
            self._needs = now
            self.steps.show_steps(steps(project), brief=bool(project.track_id))
            self.steps.show_fallbacks(ground_edits.lead(project), ground_edits.fallbacks(project))

    def show_proposals(self, count: int) -> None:
        """Show how many contacts are proposed."""
        self.accept_button.setText(f"Accept all {count}" if count > 1 else "Accept it" if count else "Accept all")
        self.accept_button.setEnabled(count > 0)
