"""The pages of the window: what every workspace answers to, and which of them is in sight."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QSize, Signal
from PySide6.QtGui import QImage
from PySide6.QtWidgets import QStackedWidget, QWidget

from app.model.document import Document
from app.window.controls import ErrorBar
from app.window.frames import FrameLoader
from app.window.project import Project
from app.window.timeline import Lane
from app.window.timeline.transport import Entry
from app.window.welcome import Welcome


class Workspace(QWidget):
    """A page under a tab of its own.

    ``hint`` says what the mouse will do, ``run_wanted`` asks for everything that is missing, ``lanes_changed`` says
    that the lanes of the timeline may look different now, ``wanted`` names a command that is asked for.

    Attributes
    ----------
    own_timeline : whether it brings a timeline of its own, so that the clip's is not shown beside it.
    errors : the bar in which its errors are told.
    """

    hint = Signal(str)
    run_wanted = Signal()
    lanes_changed = Signal()
    wanted = Signal(str)
    own_timeline = False
    errors: ErrorBar

    def attach(self, project: Project, loader: FrameLoader | None) -> None:
        """Take another project."""

    def attach_clip(self, project: Project, loader: FrameLoader | None) -> None:
        """Take the frames of the project's clip: after ``attach``, and whenever another clip is chosen."""

    def detach(self) -> None:
        """Let go of the project: stop what runs for it."""

    def close_view(self) -> None:
        """End every thread and render window; the workspace cannot be shown again."""

    def leave(self) -> None:
        """Another workspace comes into sight: stop what only makes sense when seen."""

    def is_empty(self, document: Document) -> bool:
        """Whether there is nothing to show here, so that the welcome is shown in its place."""
        return document.clip is None and not document.characters

    def show_picture(self, frame: int, picture: QImage) -> None:
        """Show a frame of the clip."""

    def document_changed(self, before: Document, after: Document) -> None:
        """Follow an edit."""

    def refresh(self) -> None:
        """Show the project as it is."""

    def lanes(self) -> list[Lane]:
        """Give the lanes of the clip's timeline; none for a workspace with its own."""
        return []

    def legend(self) -> Sequence[Entry]:
        """Give the legend of the lanes."""
        return ()

    def counts(self, document: Document) -> str:
        """Say in a few words how much there is, for the line at the bottom."""
        clicks = sum(len(track.clicks) for track in document.tracks)
        edits = sum(len(character.edits) for character in document.characters)
        return f"{len(document.tracks)} points, {clicks} clicks, {len(document.masks)} masks, {edits} pose edits"

    def device(self) -> str:
        """Name what draws in 3D, or nothing where nothing does yet."""
        return ""

    def say(self, sentence: str) -> None:
        """Say something in passing, over the picture."""

    def command(self, name: str) -> bool:
        """Do a command of this workspace; says whether it was one. Asked before all others."""
        return False


class Pages(QStackedWidget):
    """The workspaces by name, and the welcome that lies over those with nothing to show."""

    def __init__(self, workspaces: dict[str, Workspace], welcome: Welcome) -> None:
        super().__init__()
        self.workspaces, self.welcome = workspaces, welcome
        self.name = next(iter(workspaces))
        for page in (*workspaces.values(), welcome):
            self.addWidget(page)

    @property
    def in_sight(self) -> Workspace:
        """The workspace chosen, be it under the welcome."""
        return self.workspaces[self.name]

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
            self.in_sight.leave()
            self.name = name
        empty = document is None or self.in_sight.is_empty(document)
        self.setCurrentWidget(self.welcome if empty else self.in_sight)


def first_workspace(document: Document) -> str:
    """Name the workspace that a project is opened in: where there are captured takes and no film, theirs."""
    captured = bool(document.sequences) and document.clip is None and not document.characters
    return "performance" if captured else "video"
