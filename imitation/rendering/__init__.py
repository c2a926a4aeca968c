"""Composites: character, shadow, occlusion, plate."""

from imitation.rendering.composite import Layer, composite, draw_points, over_frame, render_sequence, studio
from imitation.rendering.ground import Footing, Ground, Plane, footing_at, ground_shadow
from imitation.rendering.layout import label, side_by_side, side_by_side_frames
from imitation.rendering.light import Look, look_at
from imitation.rendering.mesh import Renderer, Rendering, render_mesh
from imitation.rendering.side import side_cameras, side_view

__all__ = [
    "Footing",
    "Ground",
    "Layer",
    "Look",
    "Plane",
    "Renderer",
    "Rendering",
    "composite",
    "draw_points",
    "footing_at",
    "ground_shadow",
    "label",
    "look_at",
    "over_frame",
    "render_mesh",
    "render_sequence",
    "side_by_side",
    "side_by_side_frames",
    "side_cameras",
    "side_view",
    "studio",
]
