"""The bar at the top: the project and whether it is saved, the workspaces, undo, running work, export."""

from __future__ import annotations

from PySide6.QtCore import QSize, Qt, Signal
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QGridLayout, QHBoxLayout, QLabel, QMenu, QProgressBar, QToolButton, QWidget

from app.window import icons, settings
from app.window.controls import Elided, button, icon_button, label, set_tooltip
from app.window.keys import COMMANDS, shown_key
from app.window.name_field import NameField
from app.window.project import Project

MENU_TOO = ("history", "log", "light", "keys", "settings")
"""Commands of other groups that are in the menu as well."""
NARROW = 1120
"""Pixels of width below which the program's mark stands without its name."""
SEPARATED = ("save", "add_clip", "history", "export")
"""Commands above which the menu has a line."""


class TopBar(QWidget):
    """Says what is open and what runs; ``wanted`` names the command that is asked for, ``project_wanted`` a project."""

    wanted = Signal(str)
    project_wanted = Signal(object)

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("topBar")
        self.setAttribute(Qt.WidgetAttribute.WA_StyledBackground)
        self.setFixedHeight(48)
        grid = QGridLayout(self)
        grid.setContentsMargins(12, 0, 12, 0)
        grid.setHorizontalSpacing(16)
        for column, stretch in enumerate((1, 0, 1)):
            grid.setColumnStretch(column, stretch)
        grid.addLayout(self._left(), 0, 0)
        grid.addLayout(self._tabs(), 0, 1)
        grid.addLayout(self._right(), 0, 2)

    def _left(self) -> QHBoxLayout:
        row = QHBoxLayout()
        row.setSpacing(8)
        mark = QLabel()
        mark.setPixmap(icons.application_icon().pixmap(QSize(24, 24)))
        self.menu_button = QToolButton()
        self.menu_button.setIcon(icons.icon("menu"))
        self.menu_button.setIconSize(QSize(18, 18))
        self.menu_button.setFixedSize(30, 28)
        self.menu_button.setToolTip("Project menu")
        self.menu_button.setAccessibleName("Project menu")
        self.menu_button.setPopupMode(QToolButton.ToolButtonPopupMode.InstantPopup)
        self.menu_button.setStyleSheet("QToolButton::menu-indicator { image: none; }")
        self.menu_button.setMenu(self._menu())
        self.name = NameField()
        self.state = Elided("", "caption")
        row.addWidget(mark)
        self.brand = label("Motionwright", "brand")
        row.addWidget(self.brand)
        row.addWidget(self.menu_button)
        row.addWidget(self.name)
        row.addWidget(self.state, 1)
        return row

    def _menu(self) -> QMenu:
        menu = QMenu(self)
        menu.setToolTipsVisible(True)
        menu.aboutToShow.connect(lambda: self._fill(menu))
        self._fill(menu)
        return menu

    def _fill(self, menu: QMenu) -> None:
        """Every command of the project with the key that it has now, and the projects opened lately."""
        menu.clear()
        for command in COMMANDS:
            if command.group == "Project" or command.id in MENU_TOO:
                if command.id in SEPARATED:
                    menu.addSeparator()
                key = shown_key(command.id)
                text = f"{command.text}\t{key}" if key else command.text
                menu.addAction(text, lambda id_=command.id: self.wanted.emit(id_))
                if command.id == "open":
                    self._add_recent(menu)

    def _add_recent(self, menu: QMenu) -> None:
        recent = menu.addMenu("Open recent")
        for path in settings.recent_projects():
            action = recent.addAction(path.stem, lambda path=path: self.project_wanted.emit(path))
            action.setToolTip(str(path))
        recent.setToolTipsVisible(True)
        recent.setEnabled(not recent.isEmpty())

    def _tabs(self) -> QHBoxLayout:
        row = QHBoxLayout()
        row.setSpacing(4)
        self.tabs = {}
        for name, text in (("video", "Video"), ("character", "Character"), ("performance", "Motion graph")):
            tab = QToolButton()
            tab.setProperty("tab", "true")
            tab.setIcon(icons.icon(name))
            tab.setIconSize(QSize(16, 16))
            tab.setText(text)
            tab.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
            tab.setCheckable(True)
            tab.setAutoExclusive(True)
            tab.setFocusPolicy(Qt.FocusPolicy.TabFocus)
            set_tooltip(tab, text, name)
            tab.clicked.connect(lambda _=False, name=name: self.wanted.emit(name))
            self.tabs[name] = tab
            row.addWidget(tab)
        return row

    def _right(self) -> QHBoxLayout:
        row = QHBoxLayout()
        row.setSpacing(8)
        row.addStretch(1)
        self.undo = icon_button("undo", "Undo", lambda: self.wanted.emit("undo"), "undo")
        self.redo = icon_button("redo", "Redo", lambda: self.wanted.emit("redo"), "redo")
        self.job = QWidget()
        inner = QHBoxLayout(self.job)
        inner.setContentsMargins(8, 0, 0, 0)
        inner.setSpacing(8)
        self.job_text = label("", "label")
        self.job_bar = QProgressBar()
        self.job_bar.setRange(0, 1000)
        self.job_bar.setTextVisible(False)
        self.job_bar.setFixedWidth(88)
        inner.addWidget(self.job_text)
        inner.addWidget(self.job_bar)
        inner.addWidget(
            icon_button("cancel", "Cancel the running work", lambda: self.wanted.emit("cancel_work"), "cancel")
        )
        self.job.hide()
        for widget in (self.job, self.undo, self.redo):
            row.addWidget(widget)
        self.export = button("Export", lambda: self.wanted.emit("export"), name="export")
        set_tooltip(self.export, "Meshes, video and cameras for other programs", "export")
        row.addWidget(self.export)
        return row

    def resizeEvent(self, event: QResizeEvent) -> None:
        """In a narrow window the name of the project and its state come before that of the program."""
        super().resizeEvent(event)
        self.brand.setVisible(self.width() >= NARROW)

    def show_workspace(self, name: str) -> None:
        """Mark the tab of the workspace shown."""
        self.tabs[name].setChecked(True)

    def show_document(self, project: Project) -> None:
        """Show name, save state and what undo would do."""
        history = project.session.history
        self.name.show_name(project.document.name)
        saved = "unsaved changes" if history.modified else "saved"
        state = saved if project.session.titled else "not saved yet"
        self.state.setText(f"·  {state}")
        for widget, verb, what in ((self.undo, "Undo", history.undo_label), (self.redo, "Redo", history.redo_label)):
            widget.setEnabled(what is not None)
            set_tooltip(
                widget, f"{verb}: {what}" if what else f"Nothing to {verb.lower()}", verb.lower() if what else ""
            )

    def show_work(self, project: Project) -> None:
        """Show the job that has been running longest, and how many more there are."""
        jobs = list(project.progress.values())
        self.job.setVisible(bool(jobs))
        if jobs:
            fraction, text = jobs[0]
            more = f"  +{len(jobs) - 1}" if len(jobs) > 1 else ""
            self.job_text.setText(f"{text}{more}  {100 * fraction:.0f} %")
            self.job_bar.setValue(round(1000 * fraction))
