"""The pages of the window: a workspace is loaded and made when it is first shown, the welcome lies over empty ones."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, cast

from PySide6.QtCore import QSize, Signal
from PySide6.QtWidgets import QStackedWidget

from app.model.document import Document
from app.window.controls import ErrorBar
from app.window.viewport.hosts import Choice
from app.window.welcome import Welcome
from app.window.workspaces import Workspace

if TYPE_CHECKING:
    from app.window.character import CharacterWorkspace
    from app.window.performance import PerformanceWorkspace
    from app.window.video import VideoWorkspace


class Pages(QStackedWidget):
    """The workspaces by name, and the welcome that lies over those with nothing to show.

    ``made`` comes with a workspace that was just made, before it is shown.

    Attributes
    ----------
    workspaces : those made so far.
    """

    made = Signal(object)

    def __init__(self, welcome: Welcome, viewport: Choice) -> None:
        super().__init__()
        self.welcome = welcome
        self._makers: dict[str, Callable[[Choice], Workspace]] = {
            "video": _video,
            "character": _character,
            "performance": _performance,
        }
        self._viewport = viewport
        self.names = tuple(self._makers)
        self.workspaces: dict[str, Workspace] = {}
        self.name = self.names[0]
        self.addWidget(welcome)

    def begin(self, name: str) -> None:
        """Make the page that is shown first."""
        self.name = name
        self.page(name)

    def page(self, name: str) -> Workspace:
        """The workspace of a name, made where nobody has asked for it before."""
        page = self.workspaces.get(name)
        if page is None:
            page = self.workspaces[name] = self._makers[name](self._viewport)
            self.addWidget(page)
            self.made.emit(page)
        return page

    def wake(self) -> None:
        """Let the pages read what they show: the window is on the screen."""
        for page in self.workspaces.values():
            page.asleep = False

    def fit(self, window_width: int) -> None:
        """Fit into a window of another width."""
        for page in self.workspaces.values():
            page.fit(window_width)

    @property
    def in_sight(self) -> Workspace:
        """The workspace chosen, be it under the welcome."""
        return self.page(self.name)

    @property
    def welcoming(self) -> bool:
        """Whether the welcome is shown."""
        return self.currentWidget() is self.welcome

    @property
    def errors(self) -> ErrorBar:
        """The bar of what is seen."""
        return self.welcome.errors if self.welcoming else self.in_sight.errors

    def minimumSizeHint(self) -> QSize:
        """As small as what is seen may be: a hidden page takes no room from the timeline."""
        return self.currentWidget().minimumSizeHint()

    def device(self) -> str:
        """Name what draws in 3D, once something does."""
        return next((name for page in self.workspaces.values() if (name := page.device())), "")

    def choose(self, name: str, document: Document | None) -> None:
        """Bring a workspace into sight, or the welcome where there is nothing to show."""
        if name != self.name:
            if self.name in self.workspaces:
                self.in_sight.leave()
            self.name = name
        empty = document is None or self.in_sight.is_empty(document)
        self.setCurrentWidget(self.welcome if empty else self.in_sight)


class NamedPages:
    """What a window with pages has besides: each of them by its name and its type."""

    pages: Pages

    @property
    def video(self) -> VideoWorkspace:
        """The page of the clip."""
        return cast("VideoWorkspace", self.pages.page("video"))

    @property
    def character(self) -> CharacterWorkspace:
        """The page of the characters."""
        return cast("CharacterWorkspace", self.pages.page("character"))

    @property
    def performance(self) -> PerformanceWorkspace:
        """The page of the captured sequences."""
        return cast("PerformanceWorkspace", self.pages.page("performance"))


def _video(viewport: Choice) -> Workspace:
    from app.window.video import VideoWorkspace

    return VideoWorkspace()


def _character(viewport: Choice) -> Workspace:
    from app.window.character import CharacterWorkspace

    return CharacterWorkspace(viewport)


def _performance(viewport: Choice) -> Workspace:
    from app.window.performance import PerformanceWorkspace

    return PerformanceWorkspace(viewport)
