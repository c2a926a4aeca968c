"""Which host a machine gets."""

from __future__ import annotations

import functools
import os
from typing import Literal, Protocol

from PySide6.QtGui import QGuiApplication
from PySide6.QtWidgets import QWidget

from app.window.viewport.background import Background
from app.window.viewport.lens import Lens

Choice = Literal["auto", "raster", "gl"]

WITHOUT_OPENGL = ("offscreen", "minimal", "vnc", "linuxfb")
"""Platforms of Qt on which nothing is drawn by OpenGL."""


class Host(Protocol):
    """What the viewport needs of a host."""

    name: str
    background: Background

    def draw(self, lens: Lens, *, fine: bool) -> None:
        """Draw the scene."""

    def finish(self) -> None:
        """Close the render window."""


@functools.cache
def _has_graphics_card() -> bool:
    """Whether the platform is a desktop with an OpenGL that is not computed by the processor; asked once a run."""
    if QGuiApplication.platformName() in WITHOUT_OPENGL:
        return False
    from PySide6.QtGui import QOffscreenSurface, QOpenGLContext

    context = QOpenGLContext()
    surface = QOffscreenSurface()
    surface.create()
    if not context.create() or not context.makeCurrent(surface):
        return False
    name = context.functions().glGetString(0x1F01)
    context.doneCurrent()
    surface.destroy()
    return not any(word in str(name).lower() for word in ("llvmpipe", "softpipe", "swiftshader", "software"))


def choose(wanted: Choice) -> Literal["raster", "gl"]:
    """The host for a wish: ``auto`` takes OpenGL only where a graphics card is behind it."""
    if wanted != "auto":
        return wanted
    return "gl" if _has_graphics_card() else "raster"


def await_opengl(window: QWidget) -> None:
    """Have a window made, before it is shown, in the way that OpenGL needs.

    Otherwise Qt makes it anew when the first view of that kind comes into it: it blinks, and loses the keys where no
    window manager gives them back. What tells Qt so is a child that draws in OpenGL, though it is never shown.
    """
    if QGuiApplication.platformName() in WITHOUT_OPENGL:
        return
    from PySide6.QtOpenGLWidgets import QOpenGLWidget

    child = QOpenGLWidget(window)
    child.resize(0, 0)
    child.hide()


def make_host(choice: Literal["raster", "gl"], parent: QWidget) -> QWidget:
    """Make the host; the 3D libraries are loaded here and not before."""
    os.environ.setdefault("QT_API", "pyside6")
    if choice == "gl":
        from app.window.viewport.gl_host import GlHost

        return GlHost(parent)
    from app.window.viewport.raster_host import RasterHost

    return RasterHost(parent)
