"""Smooth output: placement of clips, blending across topologies, seam scores (future work in paper B)."""

from tvmedit.cuts.alignment import GroundMove, align_frames
from tvmedit.cuts.blending import Blend, Shape, blend_cut, performance_shape
from tvmedit.cuts.placement import align_performance
from tvmedit.cuts.registration import Registration, register
from tvmedit.cuts.seams import Seam, seam_scores

__all__ = [
    "Blend",
    "GroundMove",
    "Registration",
    "Seam",
    "Shape",
    "align_frames",
    "align_performance",
    "blend_cut",
    "performance_shape",
    "register",
    "seam_scores",
]
