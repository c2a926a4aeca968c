"""What every workspace of the window answers to, and which one a project begins in."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import Signal
from PySide6.QtGui import QImage
from PySide6.QtWidgets import QWidget

from app.model.document import Document
from app.window.controls import ErrorBar
from app.window.fold_away import FoldAway
from app.window.frames import FrameLoader
from app.window.project import Project
from app.window.timeline import Lane
from app.window.timeline.transport import Entry


class Workspace(QWidget):
    """A page under a tab of its own.

    ``hint`` says what the mouse will do, ``run_wanted`` asks for everything that is missing, ``lanes_changed`` says
    that the lanes of the timeline may look different now, ``wanted`` names a command that is asked for.

    Attributes
    ----------
    own_timeline : whether it brings a timeline of its own, so that the clip's is not shown beside it.
    errors : the bar in which its errors are told.
    aside : the column that folds away, where it has one.
    asleep : while the window is not on the screen yet: nothing is read that would keep it from there.
    """

    hint = Signal(str)
    run_wanted = Signal()
    lanes_changed = Signal()
    wanted = Signal(str)
    own_timeline = False
    errors: ErrorBar
    aside: FoldAway | None = None
    asleep = False

    def attach(self, project: Project, loader: FrameLoader | None) -> None:
        """Take another project."""

    def attach_clip(self, project: Project, loader: FrameLoader | None) -> None:
        """Take the frames of the project's clip: after ``attach``, and whenever another clip is chosen."""

    def detach(self) -> None:
        """Let go of the project: stop what runs for it."""

    def close_view(self) -> None:
        """End every thread and render window; the workspace cannot be shown again."""

    def looked_at(self) -> bool:
        """Whether it is worth reading what would be shown."""
        return self.isVisible() and not self.asleep

    def fit(self, window_width: int) -> None:
        """Fit into a window of another width."""
        if self.aside is not None:
            self.aside.fit(window_width)

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


def first_workspace(document: Document) -> str:
    """Name the workspace that a project is opened in: where there are captured takes and no film, theirs."""
    captured = bool(document.sequences) and document.clip is None and not document.characters
    return "performance" if captured else "video"
