"""Engine of time-varying mesh editing: captured performances cut, joined and played on.

Source: Xu, Yamasaki, Aizawa, "Motion Editing for Time-Varying Mesh". Names are loaded when they are first used.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from tvmedit.analysis import Analysis, analyse
    from tvmedit.features import Features, atom_distances, frame_distances, frame_features
    from tvmedit.structure import Cluster, Structure, parse_structure

_HOME = {
    "Analysis": "tvmedit.analysis",
    "Cluster": "tvmedit.structure",
    "Features": "tvmedit.features",
    "Structure": "tvmedit.structure",
    "analyse": "tvmedit.analysis",
    "atom_distances": "tvmedit.features",
    "frame_distances": "tvmedit.features",
    "frame_features": "tvmedit.features",
    "parse_structure": "tvmedit.structure",
}

__all__ = [
    "Analysis",
    "Cluster",
    "Features",
    "Structure",
    "analyse",
    "atom_distances",
    "frame_distances",
    "frame_features",
    "parse_structure",
]


def __getattr__(name: str) -> Any:
    """Load a public name from its module."""
    if name not in _HOME:
        raise AttributeError(f"module 'tvmedit' has no attribute {name!r}")
    return getattr(importlib.import_module(_HOME[name]), name)
