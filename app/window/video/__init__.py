"""The Video workspace."""

from app.window.video.workspace import VideoWorkspace

__all__ = ["VideoWorkspace"]
