"""Everything that lives as long as a project is open: what the window sees of it, its frames, its keeper."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from PySide6.QtCore import QObject, Signal

from app.actions.session import Session
from app.formats import FrameSource, open_images, open_video
from app.model.document import Document
from app.model.values import Clip, MediaRef
from app.window.frames import FrameLoader
from app.window.keeper import Keeper
from app.window.project import Project


class Opened(QObject):
    """An open project; ``clip_opened`` says that the frames come from another clip now."""

    clip_opened = Signal()

    def __init__(self, session: Session, parent: QObject) -> None:
        super().__init__(parent)
        self.project = Project(session, self)
        self.keeper = Keeper(self.project, self)
        self.loader: FrameLoader | None = None
        self._open_clip()
        self.project.document_changed.connect(self._changed)

    def _changed(self, before: Document, after: Document) -> None:
        if before.clip != after.clip:
            self._open_clip()
            self.clip_opened.emit()

    def _open_clip(self) -> None:
        former, self.loader = self.loader, None
        if former is not None:
            former.close()
            former.deleteLater()
        clip = self.project.document.clip
        if clip is not None:
            locate = self.project.session.media.locate
            self.loader = FrameLoader(lambda: _open(locate, clip), clip.frame_count, self)

    def close(self) -> None:
        """End every thread and close every file."""
        self.keeper.close()
        if self.loader is not None:
            self.loader.close()
            self.loader = None
        self.project.close()


def _open(locate: Callable[[MediaRef], Path], clip: Clip) -> FrameSource:
    path = locate(clip.media)
    return open_images(path, fps=clip.fps) if path.is_dir() else open_video(path)
