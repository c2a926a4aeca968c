"""The 3D view, sole owner of the 3D library."""

from app.window.viewport.drag import VertexChosen, VertexMoved, VertexMoving, VertexReleased
from app.window.viewport.gizmo import Gizmo, GizmoMoved, GizmoMoving, GizmoReleased
from app.window.viewport.handles import Handle
from app.window.viewport.widget import Viewport

__all__ = [
    "Gizmo",
    "GizmoMoved",
    "GizmoMoving",
    "GizmoReleased",
    "Handle",
    "VertexChosen",
    "VertexMoved",
    "VertexMoving",
    "VertexReleased",
    "Viewport",
]
