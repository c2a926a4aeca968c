"""The 3D view, sole owner of the 3D library."""

from app.window.viewport.drag import VertexChosen, VertexMoved, VertexMoving, VertexReleased
from app.window.viewport.handles import Handle
from app.window.viewport.widget import Viewport

__all__ = ["Handle", "VertexChosen", "VertexMoved", "VertexMoving", "VertexReleased", "Viewport"]
