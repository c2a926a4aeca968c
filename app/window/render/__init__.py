"""Films, comparisons and motions as files: the dialog that orders them, with a frame of them beforehand."""

from app.window.render.dialog import open_render

__all__ = ["open_render"]
