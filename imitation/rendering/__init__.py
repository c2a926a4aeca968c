"""Composites: character, shadow, occlusion, plate."""

from imitation.rendering.composite import composite, draw_points, over_frame, render_sequence, studio
from imitation.rendering.ground import Footing, Ground, Plane, footing_at, ground_shadow
from imitation.rendering.layout import label, side_by_side, side_by_side_frames
from imitation.rendering.light import Look, look_at
from imitation.rendering.matte import SINK, Layer, Matte, flattened, grained
from imitation.rendering.mesh import Renderer, Rendering, render_mesh
from imitation.rendering.motion_blur import blurred, pose_at
from imitation.rendering.occlusion import extended_depth, visibility
from imitation.rendering.side import side_cameras, side_view
from imitation.rendering.tone import add_grain, adjusted_look, background_normals, grain_of, match_look

__all__ = [
    "SINK",
    "Footing",
    "Ground",
    "Layer",
    "Look",
    "Matte",
    "Plane",
    "Renderer",
    "Rendering",
    "add_grain",
    "adjusted_look",
    "background_normals",
    "blurred",
    "composite",
    "draw_points",
    "extended_depth",
    "flattened",
    "footing_at",
    "grain_of",
    "grained",
    "ground_shadow",
    "label",
    "look_at",
    "match_look",
    "over_frame",
    "pose_at",
    "render_mesh",
    "render_sequence",
    "side_by_side",
    "side_by_side_frames",
    "side_cameras",
    "side_view",
    "studio",
    "visibility",
]
