"""The panel at the right edge: history or log, whichever was asked for; remembered between runs."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QHBoxLayout, QStackedWidget, QToolButton

from app.window import icons, settings
from app.window.controls import Panel, icon_button, set_tooltip
from app.window.panels.history_list import HistoryList
from app.window.panels.log_list import LogList
from app.window.project import Project

WIDTH = 264
PAGES = (("history", "History"), ("log", "Messages"))


class SidePanel(Panel):
    """Hidden until a page is asked for; asking for the page that is shown hides it again."""

    def __init__(self) -> None:
        super().__init__()
        self.setFixedWidth(WIDTH)
        self.history, self.log = HistoryList(), LogList()
        self.page = ""
        self._project: Project | None = None
        self.history.wanted.connect(self._jump)
        self._tabs: dict[str, QToolButton] = {}
        row = QHBoxLayout()
        row.setContentsMargins(8, 5, 5, 5)
        row.setSpacing(4)
        self._pages = QStackedWidget()
        for (name, text), widget in zip(PAGES, (self.history, self.log), strict=True):
            tab = QToolButton()
            tab.setProperty("toggle", "true")
            tab.setIcon(icons.icon(name))
            tab.setText(text)
            tab.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
            tab.setCheckable(True)
            set_tooltip(tab, text, name)
            tab.clicked.connect(lambda _=False, name=name: self.open_page(name))
            self._tabs[name] = tab
            row.addWidget(tab)
            self._pages.addWidget(widget)
        row.addStretch(1)
        row.addWidget(icon_button("close", "Close this panel", lambda: self.open_page("")))
        self.column.addLayout(row)
        body = QHBoxLayout()
        body.setContentsMargins(8, 0, 8, 8)
        body.addWidget(self._pages)
        self.column.addLayout(body, 1)
        self.open_page(str(settings.settings().value("side", "") or ""))

    def attach(self, project: Project) -> None:
        """Follow the history of another project."""
        self._project = project
        project.saved_changed.connect(self._show_history)
        self._show_history()

    def _jump(self, index: int) -> None:
        if self._project is not None:
            self._project.jump(index)

    def _show_history(self) -> None:
        if self._project is not None and self.page == "history":
            self.history.show_history(self._project.session.history)

    def ask_for(self, name: str) -> None:
        """Open a page, or close the panel where it is open already."""
        self.open_page("" if name == self.page else name)

    def open_page(self, name: str) -> None:
        """Show a page; an empty name closes the panel."""
        names = [page for page, _ in PAGES]
        self.page = name if name in names else ""
        for page, tab in self._tabs.items():
            tab.setChecked(page == self.page)
        if self.page:
            self._pages.setCurrentIndex(names.index(self.page))
        self.setVisible(bool(self.page))
        settings.settings().setValue("side", self.page)
        self._show_history()
