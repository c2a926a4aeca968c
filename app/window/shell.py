"""The window: bar, workspaces, timeline, status line. It hands on what is asked for and holds no logic of its own."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import Qt, QTimer
from PySide6.QtGui import QCloseEvent, QDragEnterEvent, QDropEvent, QImage
from PySide6.QtWidgets import QHBoxLayout, QMainWindow, QSplitter, QStackedWidget, QVBoxLayout, QWidget

from app.actions.session import Session
from app.model.document import Document
from app.window import files, icons, settings
from app.window.background_call import BackgroundCalls
from app.window.character import CharacterWorkspace
from app.window.controls import ErrorBar
from app.window.dispatch import Dispatch
from app.window.file_commands import FileCommands
from app.window.lanes_of import character_lanes, video_lanes
from app.window.navigation import Navigator
from app.window.opening import Opened
from app.window.panels import SidePanel
from app.window.project import Project
from app.window.statusline import StatusLine
from app.window.timeline_panel import TimelinePanel
from app.window.topbar import TopBar
from app.window.video import VideoWorkspace
from app.window.viewport.hosts import Choice
from app.window.welcome import Welcome

AUTOSAVE = 60_000


class Shell(QMainWindow):
    """One window on one project."""

    def __init__(self, session: Session, *, viewport: Choice = "auto") -> None:
        super().__init__()
        self.opened: Opened | None = None
        self.workspace = "video"
        self.setWindowTitle("Motionwright")
        self.setWindowIcon(icons.application_icon())
        self.setMinimumSize(1180, 720)
        self.resize(1440, 900)
        self.setAcceptDrops(True)
        self.bar, self.status, self.timeline = TopBar(), StatusLine(), TimelinePanel()
        self.video, self.character, self.welcome = VideoWorkspace(), CharacterWorkspace(viewport), Welcome()
        self.side = SidePanel()
        self.calls = BackgroundCalls(self)
        self.files = FileCommands(self)
        self.navigator = Navigator(lambda: self.project, self)
        self._build()
        self._connect()
        self.dispatch = Dispatch(self)
        self._autosave = QTimer(self)
        self._autosave.setInterval(AUTOSAVE)
        self._autosave.timeout.connect(self.files.autosave)
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

    def _build(self) -> None:
        self.stack = QStackedWidget()
        for widget in (self.video, self.character, self.welcome):
            self.stack.addWidget(widget)
        self.split = QSplitter(Qt.Orientation.Vertical)
        self.split.setHandleWidth(8)
        self.split.setChildrenCollapsible(False)
        self.split.addWidget(self.stack)
        self.split.addWidget(self.timeline)
        self.split.setStretchFactor(0, 1)
        self.split.setStretchFactor(1, 0)
        self._sized = False
        self.split.splitterMoved.connect(self._resized_by_hand)
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
        column.addWidget(body, 1)
        column.addWidget(self.status)
        self.setCentralWidget(central)

    def _connect(self) -> None:
        for source in (self.bar, self.welcome, self.timeline.transport):
            source.wanted.connect(self.do)
        for workspace in (self.video, self.character):
            workspace.hint.connect(self._hint)
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
        self.character.attach(project, opened.loader)
        self._attach()
        self.bar.show_document(project)
        self.bar.show_work(project)
        self.side.attach(project)
        self.show_workspace("video")
        self._autosave.start()
        self.setFocus()
        opened.keeper.keep_up()

    def _attach(self) -> None:
        """Tie everything that shows frames to the clip."""
        opened = self.opened
        assert opened is not None
        if opened.loader is not None:
            opened.loader.loaded.connect(self._loaded)
            opened.loader.failed.connect(self.tell)
        self.video.attach(opened.project, opened.loader)
        self.character.tracks.attach(opened.project, opened.loader)
        self.timeline.show_project(opened.project, opened.loader)
        self._show_frame(opened.project.frame)

    def _close_project(self) -> None:
        self.navigator.playback.stop()
        self._autosave.stop()
        self.character.detach()
        opened, self.opened = self.opened, None
        if opened is not None:
            opened.close()
            opened.deleteLater()

    # showing -----------------------------------------------------------------------------------------------------

    def show_workspace(self, name: str) -> None:
        """Show a workspace, or the welcome where there is no clip yet."""
        self.workspace = name
        self.bar.show_workspace(name)
        empty = self.project is None or (self.project.document.clip is None and not self.project.document.characters)
        self.stack.setCurrentWidget(self.welcome if empty else getattr(self, name))
        self.timeline.setVisible(not empty)
        if self._picture is not None:
            self.in_sight().show_picture(*self._picture)
        self._refresh.start()

    def _changed(self, before: Document, after: Document) -> None:
        if (before.clip is None) != (after.clip is None) or bool(before.characters) != bool(after.characters):
            self.show_workspace(self.workspace)
        self.video.document_changed(before, after)
        self.character.document_changed(before, after)
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
        document = project.document
        clicks = sum(len(track.clicks) for track in document.tracks)
        edits = sum(len(character.edits) for character in document.characters)
        counts = f"{len(document.tracks)} points, {clicks} clicks, {len(document.masks)} masks, {edits} pose edits"
        self.status.show_counts(counts)
        viewport = self.character.mesh.viewport
        self.status.device.setText(f"3D: {viewport.host.name}" if viewport is not None else "")

    def show_lanes(self) -> None:
        """Show the lanes of the workspace in sight."""
        project = self.project
        if project is None:
            return
        if self.workspace == "video":
            lanes = video_lanes(project, self.video.proposals.open(project))
        else:
            lanes = character_lanes(project, self.character.motion.solved(project.frame_count))
        self.timeline.show_lanes(lanes, self.workspace)
        self._fit_timeline()

    def _resized_by_hand(self) -> None:
        self._sized = True

    def _fit_timeline(self) -> None:
        """Give the lanes the room they need, up to two fifths, until the user has chosen otherwise."""
        height = self.split.height()
        wanted = min(self.timeline.wanted_height(), 2 * height // 5)
        if not self._sized and height > 0 and abs(self.split.sizes()[1] - wanted) > 1:
            self.split.setSizes([height - wanted - 8, wanted])

    def _show_frame(self, frame: int) -> None:
        self.timeline.show_frame(frame)
        loader = self.opened.loader if self.opened is not None else None
        picture = loader.request(frame) if loader is not None else QImage()
        if picture is not None:
            self._loaded(frame, picture)

    def _loaded(self, frame: int, picture: QImage) -> None:
        self._picture = (frame, picture)
        self.in_sight().show_picture(frame, picture)

    def in_sight(self) -> VideoWorkspace | CharacterWorkspace:
        """The workspace shown."""
        return self.video if self.workspace == "video" else self.character

    def _hint(self, sentence: str) -> None:
        if self.sender() is self.in_sight():
            self.status.show_hint(sentence)

    def _shown_at(self, frame: int, sentence: str) -> None:
        project = self.project
        if project is not None:
            where = f", shown at frame {frame}" if frame != project.frame else ""
            notes = self.video.notes if self.workspace == "video" else self.character.tracks.notes
            notes.say(sentence + where)

    def tell(self, sentence: str, details: str = "") -> None:
        """Say what went wrong in the panel that is seen, and keep it among the messages."""
        self.side.log.add(sentence, details)
        self._error_bar().tell(sentence, details)

    def tell_note(self, sentence: str) -> None:
        """Say what went well, or is worth knowing; kept among the messages."""
        self.side.log.add(sentence, level="note")
        self._error_bar().tell(sentence, level="note")

    def _error_bar(self) -> ErrorBar:
        if self.stack.currentWidget() is self.welcome:
            return self.welcome.errors
        return self.video.errors if self.workspace == "video" else self.character.mesh.errors

    def _propagate_on_release(self, on: bool) -> None:
        if self.opened is not None:
            self.opened.keeper.propagate_on_release = on
            self.opened.keeper.keep_up()

    def do(self, name: str) -> None:
        """Do a command."""
        self.dispatch.do(name)

    # dropping and closing ----------------------------------------------------------------------------------------

    def dragEnterEvent(self, event: QDragEnterEvent) -> None:
        """Take files that are known."""
        paths = [Path(url.toLocalFile()) for url in event.mimeData().urls() if url.isLocalFile()]
        if any(files.kind_of(path) for path in paths):
            event.acceptProposedAction()

    def dropEvent(self, event: QDropEvent) -> None:
        """Open a project, or bring a video or a mesh in."""
        for url in event.mimeData().urls():
            self.files.take(Path(url.toLocalFile()))
        event.acceptProposedAction()

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
        self.character.close_view()
        event.accept()
