"""The timeline of a project: transport and lanes, tied to what is shown and selected."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from PySide6.QtCore import QPoint, Qt
from PySide6.QtWidgets import QFrame, QMenu, QScrollArea

from app.model.edits import contacts, masks, poses, scene, tracks
from app.window.controls import Panel
from app.window.frames import FrameLoader
from app.window.lanes_of import VIDEO_LEGEND, worst_near
from app.window.project import Project
from app.window.timeline import Bar, Lane, LaneEdit, LaneView, TimelineHit, Transport
from app.window.timeline.lanes import total_height
from app.window.timeline.transport import Entry

MARGIN = 4
"""Pixels of the panel that are neither transport nor lanes."""
NEARBY = 12.0
"""Pixels round a click in the curve of errors within which the worst frame is looked for."""


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
        self.setMinimumHeight(120)
        self.lanes.sought.connect(self._seek)
        self.lanes.clicked.connect(self._clicked)
        self.lanes.edited.connect(self._edited)
        self.lanes.chosen_twice.connect(self._accept)
        self.lanes.menu_wanted.connect(self._menu)

    def show_project(self, project: Project, loader: FrameLoader | None) -> None:
        """Take another project."""
        self.project = project
        self.lanes.thumbnail = loader.thumbnail if loader is not None else None
        if loader is not None:
            loader.thumbnail_ready.connect(lambda _: self.lanes.refresh())
        self.lanes.refresh()

    def wanted_height(self) -> int:
        """Pixels that transport and lanes need."""
        return self.transport.height() + total_height(self.lanes.placed) + MARGIN

    def show_room(self, height: int) -> None:
        """Fit the lanes into a panel of so many pixels, as far as they can be."""
        self.lanes.show_room(height - self.transport.height() - MARGIN)

    def show_lanes(self, lanes: list[Lane], legend: Sequence[Entry]) -> None:
        """Show the lanes of a workspace, and their legend."""
        if self.project is None:
            return
        self.transport.legend.show_entries(legend)
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
        project = self.project
        if project is None:
            return
        if found.lane in ("tracks", "contacts") and found.row:
            project.select_track(found.row)
        elif found.lane == "video" and found.kind == "diamond":
            project.select_track("")
        elif found.lane == "reprojection" and found.kind != "label":
            path = project.result(project.session.stages.cameras)
            if path is not None:
                reach = max(round(NEARBY / self.lanes.axis.pixels), 1)
                project.show_frame(worst_near(path.residuals, found.frame, reach))

    def _edited(self, edit: LaneEdit) -> None:
        """Do what a drag in the lanes means: one entry of the history."""
        project = self.project
        if project is None:
            return
        if edit.kind == "range":
            whole = (edit.first, edit.last) == (0, project.frame_count - 1)
            project.edit(scene.set_range, *((None, None) if whole else (edit.first, edit.last)))
        elif edit.kind == "retime" and edit.lane == "video":
            project.edit(masks.retime_mask, edit.at, edit.last)
        elif edit.kind == "paint":
            project.edit(contacts.add_contact, edit.row, edit.first, edit.last)
        elif edit.kind == "trim":
            project.edit(contacts.trim_contact, edit.row, edit.at, edit.first, edit.last)

    def _proposal(self, found: TimelineHit) -> Bar | None:
        """The proposed contact that was hit."""
        lane = next((each for each in self.lanes.lanes if each.id == found.lane == "contacts"), None)
        row = next((each for each in lane.rows if each.id == found.row), None) if lane is not None else None
        bars = row.bars if row is not None else ()
        return next((bar for bar in bars if bar.style == "hatch" and bar.first <= found.frame <= bar.last), None)

    def _accept(self, found: TimelineHit) -> None:
        """Accept a proposed contact."""
        bar = self._proposal(found)
        if bar is not None and self.project is not None:
            self.project.edit(contacts.add_contact, found.row, bar.first, bar.last, accepted=True)

    def menu_for(self, found: TimelineHit) -> QMenu:
        """What can be done with something in the lanes."""
        menu = QMenu(self)
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        project = self.project
        if project is None:
            return menu
        track = next((each for each in project.document.tracks if each.id == found.row), None)
        if self._proposal(found) is not None:
            menu.addAction("Accept this contact", lambda: self._accept(found))
        elif track is not None and found.lane == "contacts":
            if any(found.frame in contact.span for contact in track.contacts):
                menu.addAction("Remove contact", lambda: project.edit(contacts.remove_contact, track.id, found.frame))
            else:
                menu.addAction(
                    "Contact in this frame", lambda: project.edit(contacts.toggle_contact, track.id, found.frame)
                )
        elif track is not None and found.kind == "diamond" and len(track.clicks) > 1:
            menu.addAction("Remove this click", lambda: project.edit(tracks.remove_click, track.id, found.frame))
        elif found.lane == "video" and found.kind == "diamond":
            menu.addAction("Remove this mask", lambda: project.edit(scene.remove_mask, found.frame))
        elif found.lane == "poses":
            self._pose_entries(menu, project, found.frame)
        elif found.lane == "solution":
            menu.addAction("Solve what is missing", lambda: self.transport.wanted.emit("propagate"))
        menu.addAction("Begin the range here", lambda: self._range(found.frame, None))
        menu.addAction("End the range here", lambda: self._range(None, found.frame))
        if project.document.range is not None:
            menu.addAction("Use the whole clip", lambda: project.edit(scene.set_range, None, None))
        return menu

    def _pose_entries(self, menu: QMenu, project: Project, frame: int) -> None:
        """What can be done with a pose edit: copy and paste are the workspace's, which then shows the frame."""

        def ask(name: str) -> None:
            project.show_frame(frame)
            self.transport.wanted.emit(name)

        character = next((each for each in project.document.characters if each.id == project.character_id), None)
        if character is not None and frame in character.edits:
            menu.addAction("Copy this pose edit", lambda: ask("copy_pose"))
            menu.addAction("Delete this pose edit", lambda: project.edit(poses.delete_edit, character.id, frame))
        menu.addAction("Paste a pose edit here", lambda: ask("paste_pose"))

    def _menu(self, found: TimelineHit, place: QPoint) -> None:
        self.menu_for(found).popup(place)

    def _range(self, first: int | None, last: int | None) -> None:
        """Set one end of the range; an end on the wrong side of the other opens the range there."""
        project = self.project
        if project is None or not project.frame_count:
            return
        begin, end = project.range
        if first is not None:
            begin, end = first, end if end >= first else project.frame_count - 1
        if last is not None:
            begin, end = begin if begin <= last else 0, last
        project.edit(scene.set_range, begin, end)

    def command(self, name: str) -> bool:
        """Do a command of the timeline; says whether it was one."""
        project = self.project
        if project is None:
            return False
        handlers: dict[str, Callable[[], object]] = {
            "fit_time": self.lanes.show_all,
            "zoom_time_in": lambda: self.lanes.zoom(1.5),
            "zoom_time_out": lambda: self.lanes.zoom(1 / 1.5),
            "range_in": lambda: self._range(project.frame, None),
            "range_out": lambda: self._range(None, project.frame),
            "range_all": lambda: project.edit(scene.set_range, None, None),
        }
        if name in handlers:
            handlers[name]()
        return name in handlers
