"""The 2D picture with its layers and gestures."""

from app.window.canvas.overlays import GhostPath, Overlay, PointCloudLayer, PolygonLayer, TrackLayer, TrackMark
from app.window.canvas.view import View, fitted
from app.window.canvas.widget import Canvas, as_image

__all__ = [
    "Canvas",
    "GhostPath",
    "Overlay",
    "PointCloudLayer",
    "PolygonLayer",
    "TrackLayer",
    "TrackMark",
    "View",
    "as_image",
    "fitted",
]
