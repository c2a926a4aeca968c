"""The timeline of a project: transport and lanes, tied to what is shown and selected."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFrame, QScrollArea

from app.window.controls import Panel
from app.window.frames import FrameLoader
from app.window.lanes_of import CHARACTER_LEGEND, VIDEO_LEGEND
from app.window.project import Project
from app.window.timeline import Lane, LaneView, TimelineHit, Transport
from app.window.timeline.lanes import total_height


class TimelinePanel(Panel):
    """Seeks, selects points by their rows, and shows where we are."""

    def __init__(self) -> None:
        super().__init__()
        self.project: Project | None = None
        self.transport = Transport()
        self.lanes = LaneView()
        self.transport.legend.show_entries(VIDEO_LEGEND)
        area = QScrollArea()
        area.setWidgetResizable(True)
        area.setFrameShape(QFrame.Shape.NoFrame)
        area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        area.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        area.setWidget(self.lanes)
        self.column.addWidget(self.transport)
        self.column.addWidget(area, 1)
        self.setMinimumHeight(140)
        self.lanes.sought.connect(self._seek)
        self.lanes.clicked.connect(self._clicked)

    def show_project(self, project: Project, loader: FrameLoader | None) -> None:
        """Take another project."""
        self.project = project
        self.lanes.thumbnail = loader.thumbnail if loader is not None else None
        if loader is not None:
            loader.thumbnail_ready.connect(lambda _: self.lanes.refresh())
        self.lanes.refresh()

    def wanted_height(self) -> int:
        """Pixels that transport and lanes need."""
        return self.transport.height() + total_height(self.lanes.placed) + 4

    def show_lanes(self, lanes: list[Lane], workspace: str) -> None:
        """Show the lanes of a workspace."""
        if self.project is None:
            return
        self.transport.legend.show_entries(VIDEO_LEGEND if workspace == "video" else CHARACTER_LEGEND)
        self.lanes.show_lanes(lanes, self.project.frame_count)
        range_ = self.project.document.range
        self.lanes.show_range((range_.first, range_.last) if range_ else None)
        if self.project.track_id:
            self.lanes.show_row("tracks", self.project.track_id)

    def show_frame(self, frame: int) -> None:
        """Move the playhead and the numbers."""
        if self.project is None:
            return
        self.lanes.show_frame(frame)
        project = self.project
        self.transport.show_frame(frame, project.frame_count, project.fps, frame / max(project.fps, 1e-9))

    def _seek(self, frame: int) -> None:
        if self.project is not None:
            self.project.show_frame(frame)

    def _clicked(self, found: TimelineHit) -> None:
        if self.project is not None and found.lane in ("tracks", "contacts") and found.row:
            self.project.select_track(found.row)
