"""Engine of motion imitation from a handheld video: arrays in, arrays out.

Paper A: Zhang et al., "Motion Imitation with a Handheld Camera". The names below are the scripting surface; parts
that need compiled kernels or large packages are imported when they are first used.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from imitation.errors import Cancelled, InputError, NoSolution

if TYPE_CHECKING:
    from imitation.cameras import CameraPath
    from imitation.cameras.solve import solve_cameras
    from imitation.deformation import Deformer, FrameConstraints
    from imitation.depth import Background, BackgroundMesh, DepthMap, Plate, background_depth, background_mesh
    from imitation.geometry import Camera
    from imitation.motion import (
        align_character,
        anchor_depths,
        propose_contacts,
        smooth_depths,
        transfer_track,
    )
    from imitation.propagation import Imitation, ambiguous_spans, commit_edit, compare, imitate, propagate, solve_base
    from imitation.tracking import Track, carry_masks, compute_flow, suggest_correction, track_point, track_span

_PARTS = {
    "Background": "depth",
    "BackgroundMesh": "depth",
    "Camera": "geometry",
    "CameraPath": "cameras",
    "DepthMap": "depth",
    "Plate": "depth",
    "background_depth": "depth",
    "background_mesh": "depth",
    "track_span": "tracking",
    "suggest_correction": "tracking",
    "ambiguous_spans": "propagation",
    "compare": "propagation",
    "solve_cameras": "cameras",
    "Deformer": "deformation",
    "FrameConstraints": "deformation",
    "Imitation": "propagation",
    "Track": "tracking",
    "align_character": "motion",
    "anchor_depths": "motion",
    "carry_masks": "tracking",
    "commit_edit": "propagation",
    "compute_flow": "tracking",
    "imitate": "propagation",
    "propagate": "propagation",
    "propose_contacts": "motion",
    "smooth_depths": "motion",
    "solve_base": "propagation",
    "track_point": "tracking",
    "transfer_track": "motion",
}

__all__ = [
    "Background",
    "BackgroundMesh",
    "Camera",
    "CameraPath",
    "Cancelled",
    "Deformer",
    "DepthMap",
    "FrameConstraints",
    "Imitation",
    "InputError",
    "NoSolution",
    "Plate",
    "Track",
    "align_character",
    "ambiguous_spans",
    "anchor_depths",
    "background_depth",
    "background_mesh",
    "carry_masks",
    "commit_edit",
    "compare",
    "compute_flow",
    "imitate",
    "propagate",
    "propose_contacts",
    "smooth_depths",
    "solve_base",
    "solve_cameras",
    "suggest_correction",
    "track_point",
    "track_span",
    "transfer_track",
]


def __getattr__(name: str) -> Any:
    """Import a part of the engine when one of its names is first used."""
    if name not in _PARTS:
        raise AttributeError(f"module 'imitation' has no attribute {name!r}")
    value = getattr(import_module(f"imitation.{_PARTS[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    """All public names, also those not imported yet."""
    return sorted(__all__)
