"""The pages of the window: a workspace is loaded and made when it is first shown, the welcome lies over empty ones."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, cast

from PySide6.QtCore import QSize, QTimer, Signal
from PySide6.QtWidgets import QStackedWidget

from app.model.document import Document
from app.window.controls import ErrorBar
from app.window.frames import FrameLoader
from app.window.project import Project
from app.window.viewport.hosts import Choice
from app.window.welcome import Welcome
from app.window.workspaces import Workspace

if TYPE_CHECKING:
    from app.window.character import CharacterWorkspace
    from app.window.performance import PerformanceWorkspace
    from app.window.video import VideoWorkspace

BREATH = 1
"""Milliseconds between two steps: with none the next one would come before all that has been waiting."""
Making = Iterator[Workspace | None]
"""Makes a page step by step, and gives it at last."""


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
        self._makers: dict[str, Callable[[Choice], Making]] = {
            "video": _video,
            "character": _character,
            "performance": _performance,
        }
        self._making: dict[str, Making] = {}
        self._then: Callable[[], object] | None = None
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
        if name not in self.workspaces:
            while name not in self.workspaces:
                self._step(name)
            if name == self.name:
                self._go_on()
        return self.workspaces[name]

    def _step(self, name: str) -> None:
        """Do the next step of making a page."""
        if name not in self._making:
            self._making[name] = self._makers[name](self._viewport)
        page = next(self._making[name])
        if page is not None:
            del self._making[name]
            self.workspaces[name] = page
            self.addWidget(page)
            self.made.emit(page)

    def prepare(self, then: Callable[[], object]) -> bool:
        """Do one step of making the page chosen; where there is more to do, ``then`` is called in a later event.

        A page of many parts takes a fifth of a second to load and build: in one go the window would stand still.
        """
        if self.name in self.workspaces:
            return False
        self._step(self.name)
        if self.name in self.workspaces:
            return False
        self._then = then
        QTimer.singleShot(BREATH, self, self._go_on)
        return True

    def _go_on(self) -> None:
        """Go on with what waits for the page chosen: in its own event, or at once where somebody needs the page now."""
        then, self._then = self._then, None
        if then is not None:
            then()

    def attach(self, project: Project, loader: FrameLoader | None) -> None:
        """Let the pages take another project."""
        for page in self.workspaces.values():
            page.attach(project, loader)

    def attach_clip(self, project: Project, loader: FrameLoader | None) -> None:
        """Let the pages take the frames of the project's clip."""
        for page in self.workspaces.values():
            page.attach_clip(project, loader)

    def detach(self) -> None:
        """Let the pages let go of the project."""
        for page in self.workspaces.values():
            page.detach()

    def document_changed(self, before: Document, after: Document) -> None:
        """Let the pages follow an edit."""
        for page in self.workspaces.values():
            page.document_changed(before, after)

    def close_views(self) -> None:
        """End every thread and render window."""
        self._then = None
        for making in list(self._making):
            self.page(making)  # what is half made has threads already
        for page in self.workspaces.values():
            page.close_view()

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

    def turn_to(self, name: str) -> None:
        """Choose a workspace; it is not shown yet."""
        if name != self.name:
            if self.name in self.workspaces:
                self.in_sight.leave()
            self.name = name

    def choose(self, document: Document | None) -> None:
        """Bring the workspace chosen into sight, or the welcome where there is nothing to show."""
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


def _video(viewport: Choice) -> Making:
    from app.window.video import VideoWorkspace

    yield VideoWorkspace()


def _character(viewport: Choice) -> Making:
    from app.window.character import CharacterWorkspace

    yield CharacterWorkspace(viewport)


def _performance(viewport: Choice) -> Making:
    from app.window.performance import PerformanceWorkspace

    yield None
    page = PerformanceWorkspace(viewport, whole=False)
    yield None
    page.put_together()
    yield None
    yield page
