"""The window: bar, workspaces, timeline, status line. It hands on what is asked for and holds no logic of its own."""

from __future__ import annotations

from PySide6.QtCore import QTimer
from PySide6.QtGui import QCloseEvent, QDragEnterEvent, QDragLeaveEvent, QDropEvent, QImage, QPaintEvent, QResizeEvent
from PySide6.QtWidgets import QMainWindow

from app.actions.session import Session
from app.model.document import Document
from app.window import icons, settings, theme
from app.window.background_call import BackgroundCalls
from app.window.care import Care
from app.window.dispatch import Dispatch
from app.window.drops import Drops
from app.window.file_commands import FileCommands
from app.window.navigation import Navigator
from app.window.opening import Opened
from app.window.pages import NamedPages, Pages
from app.window.panels import SidePanel
from app.window.project import Project
from app.window.split import Split
from app.window.stacking import above, beside
from app.window.statusline import StatusLine
from app.window.ties import once, tie
from app.window.timeline_panel import TimelinePanel
from app.window.topbar import TopBar
from app.window.viewport.hosts import Choice
from app.window.welcome import Welcome
from app.window.workspaces import Workspace, first_workspace

LOW = 800
"""Pixels of height below which the lanes are one line each."""


class Shell(QMainWindow, NamedPages):
    """One window on one project."""

    def __init__(self, session: Session, *, viewport: Choice = "auto") -> None:
        super().__init__()
        self.opened: Opened | None = None
        self.seen = False
        self.setWindowTitle("Motionwright")
        self.setWindowIcon(icons.application_icon())
        self.setMinimumSize(1000, 640)
        self.resize(1440, 900)
        self.setAcceptDrops(True)
        self.calls = BackgroundCalls(self)
        self.files = FileCommands(self)
        with theme.bare():
            self._build(viewport)
            self.navigator = Navigator(lambda: self.project, self)
            self._connect()
            self.pages.begin(first_workspace(session.document))
        self.dispatch = Dispatch(self)
        self.drops = Drops(self)
        self._lanes, self._refresh = once(self, 60, self.show_lanes), once(self, 0, self.refresh)
        self.shown: tuple[int, QImage] | None = None
        self.open_session(session)

    def _build(self, viewport: Choice) -> None:
        self.bar, self.status, self.timeline = TopBar(), StatusLine(), TimelinePanel()
        self.welcome = Welcome()
        self.pages = Pages(self.welcome, viewport)
        self.side = SidePanel()
        self.care = Care(self)
        self.split = Split(self.pages, self.timeline)
        self.split.chosen.connect(self._fit_lanes)
        body = beside(self.split, self.side, margin=8)
        body.setObjectName("body")
        self.setCentralWidget(above(self.bar, self.care.notices, body, self.status))

    def _connect(self) -> None:
        for source in (self.bar, self.welcome, self.timeline.transport):
            source.wanted.connect(self.do)
        self.pages.made.connect(lambda page: tie(self, page))
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
        if "character" in self.pages.workspaces:
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
        self.pages.attach(project, opened.loader)
        self._attach()
        self.bar.show_document(project)
        self.bar.show_work(project)
        self.side.attach(project)
        self.show_workspace(first_workspace(project.document))
        self.setFocus()
        self.care.attach(project)
        self._take_up()

    def _attach(self) -> None:
        """Tie everything that shows frames to the clip."""
        opened = self.opened
        assert opened is not None
        if opened.loader is not None:
            opened.loader.loaded.connect(self._loaded)
            opened.loader.failed.connect(self.tell)
        self.pages.attach_clip(opened.project, opened.loader)
        self.timeline.show_project(opened.project, opened.loader)
        self._show_frame(opened.project.frame)

    def _close_project(self) -> None:
        self.navigator.playback.stop()
        self.care.detach()
        self.pages.detach()
        opened, self.opened, self.shown = self.opened, None, None
        if opened is not None:
            opened.close()
            opened.deleteLater()

    # showing -----------------------------------------------------------------------------------------------------

    def show_workspace(self, name: str) -> None:
        """Show a workspace, or the welcome where there is no clip yet."""
        self.bar.show_workspace(name)
        self.split.workspace = name
        self.pages.turn_to(name)
        self._show_page()

    def _show_page(self) -> None:
        if self.seen and self.pages.prepare(self._show_page):
            return
        self.pages.choose(self.project.document if self.project is not None else None)
        if self.pages.welcoming:
            self.status.show_hint(self.welcome.HINT)
        self.timeline.setVisible(not self.pages.welcoming and not self.in_sight().own_timeline)
        if self.shown is not None:
            self.in_sight().show_picture(*self.shown)
        self._refresh.start()

    def _changed(self, before: Document, after: Document) -> None:
        if self.pages.welcoming != self.in_sight().is_empty(after):
            self.show_workspace(self.workspace)
        self.pages.document_changed(before, after)
        self._refresh.start()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Results are read, and work is taken up, once the window is on the screen."""
        super().paintEvent(event)
        if not self.seen:
            QTimer.singleShot(0, self, self._wake)

    def _wake(self) -> None:
        self.seen = True
        self.pages.wake()
        self._take_up()

    def _take_up(self) -> None:
        if self.seen and self.opened is not None:
            self.opened.keeper.keep_up()
            self.refresh_soon()

    @property
    def at_rest(self) -> bool:
        """Whether all is shown that was to be shown until now."""
        return self.seen and not self._refresh.isActive() and not self._lanes.isActive()

    def lanes_soon(self) -> None:
        """Show the lanes anew in a moment, however often it is asked for."""
        if not self._lanes.isActive():
            self._lanes.start()

    def refresh_soon(self) -> None:
        """Show the state once whatever is under way is done."""
        self._refresh.start()

    def refresh(self) -> None:
        """Show the state of the project: workspace in sight, lanes, counts."""
        project = self.project
        if project is None or not self.seen:
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
        self.timeline.show_room(self.split.room)
        self.split.fit(self.timeline.wanted_height())

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Fit the lanes to the new height, and the columns that fold to the new width."""
        super().resizeEvent(event)
        self._fit_lanes()
        self.pages.fit(self.width())

    def _show_frame(self, frame: int) -> None:
        self.timeline.show_frame(frame)
        loader = self.opened.loader if self.opened is not None else None
        picture = loader.request(frame) if loader is not None else QImage()
        if picture is not None:
            self._loaded(frame, picture)

    def _loaded(self, frame: int, picture: QImage) -> None:
        self.shown = (frame, picture)
        self.in_sight().show_picture(frame, picture)

    @property
    def picture(self) -> QImage | None:
        """The frame in sight."""
        return self.shown[1] if self.shown is not None else None

    @property
    def workspace(self) -> str:
        """Name of the workspace chosen."""
        return self.pages.name

    def in_sight(self) -> Workspace:
        """The workspace chosen."""
        return self.pages.in_sight

    def show_hint(self, sentence: str) -> None:
        """Say what the mouse does in the workspace in sight, when it is that which asks."""
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

    def propagate_on_release(self, on: bool) -> None:
        """Spread an edit when the mouse lets go, or not."""
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
        self.pages.close_views()
        event.accept()
