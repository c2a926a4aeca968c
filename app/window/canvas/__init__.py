"""The 2D picture with its layers and gestures."""

from app.window.canvas.backdrop import Backdrop, Scale
from app.window.canvas.outlines import Outline, OutlineLayer
from app.window.canvas.overlays import GhostPath, Overlay, TrackLayer, TrackMark
from app.window.canvas.scene_layers import GroundGrid, ScenePoints
from app.window.canvas.snap_layer import SnapMark
from app.window.canvas.view import View, fitted
from app.window.canvas.widget import Canvas, as_image

__all__ = [
    "Backdrop",
    "Canvas",
    "GhostPath",
    "GroundGrid",
    "Outline",
    "OutlineLayer",
    "Overlay",
    "Scale",
    "ScenePoints",
    "SnapMark",
    "TrackLayer",
    "TrackMark",
    "View",
    "as_image",
    "fitted",
]
