"""Engine of time-varying mesh editing: captured performances cut, joined and played on.

Source: Xu, Yamasaki, Aizawa, "Motion Editing for Time-Varying Mesh". Names are loaded when they are first used.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from tvmedit.analysis import Analysis, analyse
    from tvmedit.cuts import Blend, Seam, Shape, align_performance, blend_cut, performance_shape, register, seam_scores
    from tvmedit.features import (
        Features,
        atom_distances,
        frame_distances,
        frame_features,
        hann_taps,
        yaw_free_atom_distances,
    )
    from tvmedit.graph import (
        Cut,
        MotionGraph,
        Node,
        Performance,
        Unreachable,
        best_path,
        best_paths,
        compose,
        motion_graph,
    )
    from tvmedit.structure import Agreement, Cluster, Structure, compare_boundaries, parse_structure

_HOME = {
    "tvmedit.analysis": (
        "Analysis",
        "analyse",
    ),
    "tvmedit.cuts": (
        "Blend",
        "Seam",
        "Shape",
        "align_performance",
        "blend_cut",
        "performance_shape",
        "register",
        "seam_scores",
    ),
    "tvmedit.features": (
        "Features",
        "atom_distances",
        "frame_distances",
        "frame_features",
        "hann_taps",
        "yaw_free_atom_distances",
    ),
    "tvmedit.graph": (
        "Cut",
        "MotionGraph",
        "Node",
        "Performance",
        "Unreachable",
        "best_path",
        "best_paths",
        "compose",
        "motion_graph",
    ),
    "tvmedit.structure": (
        "Agreement",
        "Cluster",
        "Structure",
        "compare_boundaries",
        "parse_structure",
    ),
}

__all__ = [
    "Agreement",
    "Analysis",
    "Blend",
    "Cluster",
    "Cut",
    "Features",
    "MotionGraph",
    "Node",
    "Performance",
    "Seam",
    "Shape",
    "Structure",
    "Unreachable",
    "align_performance",
    "analyse",
    "atom_distances",
    "best_path",
    "best_paths",
    "blend_cut",
    "compare_boundaries",
    "compose",
    "frame_distances",
    "frame_features",
    "hann_taps",
    "motion_graph",
    "parse_structure",
    "performance_shape",
    "register",
    "seam_scores",
    "yaw_free_atom_distances",
]


def __getattr__(name: str) -> Any:
    """Load a public name from its module."""
    for home, names in _HOME.items():
        if name in names:
            return getattr(importlib.import_module(home), name)
    raise AttributeError(f"module 'tvmedit' has no attribute {name!r}")
