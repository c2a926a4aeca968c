"""The dialog: films, comparisons and motions, each on a page; it stays open beside the window."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QTimer, Signal
from PySide6.QtGui import QCloseEvent, QKeyEvent, Qt
from PySide6.QtWidgets import QButtonGroup, QDialog, QHBoxLayout, QStackedWidget, QToolButton, QVBoxLayout, QWidget

from app.stages.job import Job
from app.window import icons, settings
from app.window.project import Project
from app.window.render.background_page import BackgroundPage
from app.window.render.film_page import FilmPage
from app.window.render.motion_page import ComparePage, MotionPage
from app.window.render.page import Page

if TYPE_CHECKING:
    from app.window.shell import Shell

PAGES = (
    ("film", "Film", "render"),
    ("compare", "Comparison", "wipe"),
    ("motion", "Motion", "export"),
    ("background", "Background", "background"),
)
SOON = 80
"""Milliseconds that a frame rests before it is made: while the clip plays, nothing is."""


class RenderDialog(QDialog):
    """Belongs to one project and closes with it. ``asked`` names a command of the window.

    Work goes on when it is closed: ``left`` hands its job over.
    """

    asked = Signal(str)
    left = Signal(object)

    def __init__(self, project: Project, parent: QWidget) -> None:
        super().__init__(parent)
        self.project = project
        self.setWindowTitle("Render and export")
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setMinimumSize(860, 560)
        self.resize(1120, 720)
        geometry = settings.settings().value("render/geometry")
        if geometry is not None:
            self.restoreGeometry(geometry)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        self.film, self.compare, self.motion = FilmPage(project), ComparePage(project), MotionPage(project)
        self.background = BackgroundPage(project)
        self._pages: tuple[Page, ...] = (self.film, self.compare, self.motion, self.background)
        self.stack = QStackedWidget()
        self.tabs: dict[str, QToolButton] = {}
        column.addLayout(self._tabs())
        column.addWidget(self.stack, 1)
        for page in self._pages:
            page.asked.connect(self._asked)
        self._later = QTimer(self)
        self._later.setSingleShot(True)
        self._later.setInterval(SOON)
        self._later.timeout.connect(self.refresh)
        for signal in (
            project.document_changed,
            project.frame_changed,
            project.stage_finished,
            project.work_changed,
        ):
            signal.connect(self._soon)
        self._wait = False
        project.closing.connect(self._project_closes)
        self.film.target.write.setFocus()

    def _tabs(self) -> QHBoxLayout:
        row = QHBoxLayout()
        row.setContentsMargins(12, 10, 12, 0)
        row.setSpacing(4)
        group = QButtonGroup(self)
        for page, (name, text, icon) in zip(self._pages, PAGES, strict=True):
            tab = QToolButton()
            tab.setProperty("tab", "true")
            tab.setIcon(icons.icon(icon))
            tab.setText(text)
            tab.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
            tab.setCheckable(True)
            tab.setFocusPolicy(Qt.FocusPolicy.TabFocus)
            tab.clicked.connect(lambda _=False, name=name: self.show_page(name))
            group.addButton(tab)
            self.tabs[name] = tab
            row.addWidget(tab)
            self.stack.addWidget(page)
        row.addStretch(1)
        return row

    def show_page(self, name: str) -> None:
        """Bring a page into sight."""
        self.tabs[name].setChecked(True)
        self.stack.setCurrentIndex([page for page, *_ in PAGES].index(name))
        self.refresh()

    def _project_closes(self) -> None:
        """Nothing may read the project's files any more."""
        self._wait = True
        self.close()

    def _soon(self, *_: object) -> None:
        self._later.start()

    def refresh(self) -> None:
        """Show the project as it is on the page in sight."""
        page = self.stack.currentWidget()
        assert isinstance(page, Page)
        page.refresh()

    def _asked(self, command: str) -> None:
        self.asked.emit("measure_background" if command == "measure" else command)

    def event(self, event: QEvent) -> bool:
        """Keep Escape for closing the dialog."""
        escape = isinstance(event, QKeyEvent) and event.key() == Qt.Key.Key_Escape
        if event.type() == QEvent.Type.ShortcutOverride and escape:
            event.accept()
            return True
        return super().event(event)

    def reject(self) -> None:
        """Close, as by the window's own button."""
        self.close()

    def closeEvent(self, event: QCloseEvent) -> None:
        """End what only the dialog needs."""
        self._later.stop()
        settings.settings().setValue("render/geometry", self.saveGeometry())
        for signal in (
            self.project.document_changed,
            self.project.frame_changed,
            self.project.stage_finished,
            self.project.work_changed,
        ):
            signal.disconnect(self._soon)
        for page in self._pages:
            if page.target.job is not None:
                self.left.emit(page.target.job)
            page.close_calls(wait=self._wait)
        event.accept()


def _tell_later(shell: Shell, project: Project, job: Job) -> None:
    """Tell in the window what a job has written, now that the dialog is closed."""
    shell.files.when_done(project, job, lambda _, path: shell.tell_note(f"{Path(str(path)).name} is written."))


def open_render(shell: Shell, page: str = "film") -> RenderDialog | None:
    """Show the dialog of the open project, on a page."""
    project = shell.project
    if project is None:
        return None
    known = [each for each in shell.findChildren(RenderDialog) if each.isVisible()]
    dialog = known[0] if known else RenderDialog(project, shell)
    if not known:
        dialog.asked.connect(shell.do)
        dialog.left.connect(partial(_tell_later, shell, project))
    dialog.show_page(page)
    dialog.show()
    dialog.raise_()
    dialog.activateWindow()
    return dialog
