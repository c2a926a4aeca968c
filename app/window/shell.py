"""The window: bar, workspaces, timeline, status line. It hands on what is asked for and holds no logic of its own."""

from __future__ import annotations

from PySide6.QtCore import QTimer
from PySide6.QtGui import QCloseEvent, QDragEnterEvent, QDragLeaveEvent, QDropEvent, QImage, QResizeEvent
from PySide6.QtWidgets import QHBoxLayout, QMainWindow, QVBoxLayout, QWidget

from app.actions.session import Session
from app.model.document import Document
from app.window import icons, settings, theme
from app.window.background_call import BackgroundCalls
from app.window.care import Care
from app.window.character import CharacterWorkspace
from app.window.dispatch import Dispatch
from app.window.drops import Drops
from app.window.file_commands import FileCommands
from app.window.navigation import Navigator
from app.window.opening import Opened
from app.window.panels import SidePanel
from app.window.performance import PerformanceWorkspace
from app.window.project import Project
from app.window.split import Split
from app.window.statusline import StatusLine
from app.window.timeline_panel import TimelinePanel
from app.window.topbar import TopBar
from app.window.video import VideoWorkspace
from app.window.viewport.hosts import Choice
from app.window.welcome import Welcome
from app.window.workspaces import Pages, Workspace, first_workspace

LOW = 800
"""Pixels of height below which the lanes are one line each."""


class Shell(QMainWindow):
    """One window on one project."""

    def __init__(self, session: Session, *, viewport: Choice = "auto") -> None:
        super().__init__()
        self.opened: Opened | None = None
        self.setWindowTitle("Motionwright")
        self.setWindowIcon(icons.application_icon())
        self.setMinimumSize(1180, 720)
        self.resize(1440, 900)
        self.setAcceptDrops(True)
        self.calls = BackgroundCalls(self)
        self.files = FileCommands(self)
        with theme.bare():
            self._build(viewport)
        self.navigator = Navigator(lambda: self.project, self)
        self._connect()
        self.dispatch = Dispatch(self)
        self.drops = Drops(self)
        self._lanes = QTimer(self)
        self._lanes.setSingleShot(True)
        self._lanes.setInterval(60)
        self._lanes.timeout.connect(self.show_lanes)
        self._refresh = QTimer(self)
        self._refresh.setSingleShot(True)
        self._refresh.setInterval(0)
        self._refresh.timeout.connect(self.refresh)
        self._picture: tuple[int, QImage] | None = None
        self.open_session(session)

    def _build(self, viewport: Choice) -> None:
        self.bar, self.status, self.timeline = TopBar(), StatusLine(), TimelinePanel()
        self.video, self.character, self.welcome = VideoWorkspace(), CharacterWorkspace(viewport), Welcome()
        self.performance = PerformanceWorkspace(viewport)
        pages = {"video": self.video, "character": self.character, "performance": self.performance}
        self.pages = Pages(pages, self.welcome)
        self.side = SidePanel()
        self.care = Care(self)
        self.split = Split(self.pages, self.timeline)
        self.split.chosen.connect(self._fit_lanes)
        body = QWidget()
        body.setObjectName("body")
        inner = QHBoxLayout(body)
        inner.setContentsMargins(8, 8, 8, 8)
        inner.setSpacing(8)
        inner.addWidget(self.split, 1)
        inner.addWidget(self.side)
        central = QWidget()
        column = QVBoxLayout(central)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        column.addWidget(self.bar)
        column.addWidget(self.care.notices)
        column.addWidget(body, 1)
        column.addWidget(self.status)
        self.setCentralWidget(central)

    def _connect(self) -> None:
        for source in (self.bar, self.welcome, self.timeline.transport):
            source.wanted.connect(self.do)
        for workspace in self.pages.workspaces.values():
            workspace.hint.connect(self._hint)
            workspace.wanted.connect(self.do)
            workspace.run_wanted.connect(lambda: self.do("propagate"))
            workspace.lanes_changed.connect(lambda: self._lanes.isActive() or self._lanes.start())
        self.character.inspector.go.connect(self.navigator.go)
        self.character.inspector.on_release.connect(self._propagate_on_release)
        self.navigator.playback.playing_changed.connect(self.timeline.transport.show_playing)

    # the project -------------------------------------------------------------------------------------------------

    @property
    def project(self) -> Project | None:
        """The open project."""
        return self.opened.project if self.opened is not None else None

    def open_session(self, session: Session) -> None:
        """Show another project; the one before is closed."""
        self._close_project()
        opened = self.opened = Opened(session, self)
        project = opened.project
        opened.keeper.propagate_on_release = self.character.inspector.automatic.isChecked()
        opened.clip_opened.connect(self._attach)
        project.document_changed.connect(self._changed)
        project.frame_changed.connect(self._show_frame)
        project.failed.connect(self.tell)
        project.saved_changed.connect(lambda: self.bar.show_document(project))
        project.shown_at.connect(self._shown_at)
        for signal in (project.work_changed, project.work_progressed):
            signal.connect(lambda: self.bar.show_work(project))
        for signal in (project.selection_changed, project.stage_finished, project.work_changed):
            signal.connect(lambda *_: self._refresh.start())
        for workspace in self.pages.workspaces.values():
            workspace.attach(project, opened.loader)
        self._attach()
        self.bar.show_document(project)
        self.bar.show_work(project)
        self.side.attach(project)
        self.show_workspace(first_workspace(project.document))
        self.setFocus()
        opened.keeper.keep_up()
        self.care.attach(project)

    def _attach(self) -> None:
        """Tie everything that shows frames to the clip."""
        opened = self.opened
        assert opened is not None
        if opened.loader is not None:
            opened.loader.loaded.connect(self._loaded)
            opened.loader.failed.connect(self.tell)
        for workspace in self.pages.workspaces.values():
            workspace.attach_clip(opened.project, opened.loader)
        self.timeline.show_project(opened.project, opened.loader)
        self._show_frame(opened.project.frame)

    def _close_project(self) -> None:
        self.navigator.playback.stop()
        self.care.detach()
        for workspace in self.pages.workspaces.values():
            workspace.detach()
        opened, self.opened = self.opened, None
        if opened is not None:
            opened.close()
            opened.deleteLater()

    # showing -----------------------------------------------------------------------------------------------------

    def show_workspace(self, name: str) -> None:
        """Show a workspace, or the welcome where there is no clip yet."""
        self.bar.show_workspace(name)
        self.split.workspace = name
        self.pages.choose(name, self.project.document if self.project is not None else None)
        if self.pages.welcoming:
            self.status.show_hint(self.welcome.HINT)
        self.timeline.setVisible(not self.pages.welcoming and not self.in_sight().own_timeline)
        if self._picture is not None:
            self.in_sight().show_picture(*self._picture)
        self._refresh.start()

    def _changed(self, before: Document, after: Document) -> None:
        if self.pages.welcoming != self.in_sight().is_empty(after):
            self.show_workspace(self.workspace)
        for workspace in self.pages.workspaces.values():
            workspace.document_changed(before, after)
        self._refresh.start()

    def refresh_soon(self) -> None:
        """Show the state once whatever is under way is done."""
        self._refresh.start()

    def refresh(self) -> None:
        """Show the state of the project: workspace in sight, lanes, counts."""
        project = self.project
        if project is None:
            return
        self.in_sight().refresh()
        self.show_lanes()
        self.status.show_counts(self.in_sight().counts(project.document))
        self.status.device.setText(self.pages.device())

    def show_lanes(self) -> None:
        """Show the lanes of the workspace in sight."""
        project = self.project
        if project is None:
            return
        self.timeline.show_lanes(self.in_sight().lanes(), self.in_sight().legend())
        self._fit_lanes()

    def _fit_lanes(self) -> None:
        """Give the lanes their room; in a low window one line each, unless the user has given them more."""
        self.timeline.lanes.show_compact(self.height() < LOW and self.split.by_hand is None)
        self.split.fit(self.timeline.wanted_height())

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Fit the lanes to the new height."""
        super().resizeEvent(event)
        self._fit_lanes()

    def _show_frame(self, frame: int) -> None:
        self.timeline.show_frame(frame)
        loader = self.opened.loader if self.opened is not None else None
        picture = loader.request(frame) if loader is not None else QImage()
        if picture is not None:
            self._loaded(frame, picture)

    def _loaded(self, frame: int, picture: QImage) -> None:
        self._picture = (frame, picture)
        self.in_sight().show_picture(frame, picture)

    @property
    def picture(self) -> QImage | None:
        """The frame in sight."""
        return self._picture[1] if self._picture is not None else None

    @property
    def workspace(self) -> str:
        """Name of the workspace chosen."""
        return self.pages.name

    def in_sight(self) -> Workspace:
        """The workspace chosen."""
        return self.pages.in_sight

    def _hint(self, sentence: str) -> None:
        if self.sender() is self.in_sight() and not self.pages.welcoming:
            self.status.show_hint(sentence)

    def _shown_at(self, frame: int, sentence: str) -> None:
        project = self.project
        if project is not None:
            where = f", shown at frame {frame}" if frame != project.frame else ""
            self.in_sight().say(sentence + where)

    def tell(self, sentence: str, details: str = "") -> None:
        """Say what went wrong in the panel that is seen, and keep it among the messages."""
        self.side.log.add(sentence, details)
        self.pages.errors.tell(sentence, details)

    def tell_note(self, sentence: str) -> None:
        """Say what went well, or is worth knowing; kept among the messages."""
        self.side.log.add(sentence, level="note")
        self.pages.errors.tell(sentence, level="note")

    def _propagate_on_release(self, on: bool) -> None:
        if self.opened is not None:
            self.opened.keeper.propagate_on_release = on
            self.opened.keeper.keep_up()

    def do(self, name: str) -> None:
        """Do a command."""
        self.dispatch.do(name)

    # dropping and closing ----------------------------------------------------------------------------------------

    def dragEnterEvent(self, event: QDragEnterEvent) -> None:
        """Say what a drop would do."""
        self.drops.enter(event)

    def dragLeaveEvent(self, event: QDragLeaveEvent) -> None:
        """Say it no longer."""
        self.drops.leave()

    def dropEvent(self, event: QDropEvent) -> None:
        """Open a project, or bring files in."""
        self.drops.drop(event)

    def closeEvent(self, event: QCloseEvent) -> None:
        """Ask about unsaved changes, then end every thread and close the render window."""
        if not self.files.may_leave():
            event.ignore()
            return
        self._refresh.stop()
        self._lanes.stop()
        settings.settings().setValue("geometry", self.saveGeometry())
        self._close_project()
        self.calls.close()
        for workspace in self.pages.workspaces.values():
            workspace.close_view()
        event.accept()
