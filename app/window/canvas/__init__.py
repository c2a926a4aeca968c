"""The 2D picture with its layers and gestures."""

from app.window.canvas.outlines import Outline, OutlineLayer
from app.window.canvas.overlays import GhostPath, Overlay, PointCloudLayer, TrackLayer, TrackMark
from app.window.canvas.view import View, fitted
from app.window.canvas.widget import Canvas, as_image

__all__ = [
    "Canvas",
    "GhostPath",
    "Outline",
    "OutlineLayer",
    "Overlay",
    "PointCloudLayer",
    "TrackLayer",
    "TrackMark",
    "View",
    "as_image",
    "fitted",
]
