"""The 2D picture with its layers and gestures."""

from app.window.canvas.outlines import Outline, OutlineLayer
from app.window.canvas.overlays import GhostPath, Overlay, TrackLayer, TrackMark
from app.window.canvas.scene_layers import GroundGrid, ScenePoints
from app.window.canvas.view import View, fitted
from app.window.canvas.widget import Canvas, as_image

__all__ = [
    "Canvas",
    "GhostPath",
    "GroundGrid",
    "Outline",
    "OutlineLayer",
    "Overlay",
    "ScenePoints",
    "TrackLayer",
    "TrackMark",
    "View",
    "as_image",
    "fitted",
]
