"""Features of frames and distances between frames and atoms (paper B, section 3 and eq. 1-5)."""

from tvmedit.features.distances import PAPER_TAPS, atom_distances, frame_distances, hann_taps, turned
from tvmedit.features.feature import Features, Method
from tvmedit.features.frames import checked_meshes
from tvmedit.features.heading import facing
from tvmedit.features.paper import SphericalHistograms
from tvmedit.features.robust import CylinderHistograms
from tvmedit.features.sequence import frame_features
from tvmedit.features.yaw import yaw_free_atom_distances

__all__ = [
    "PAPER_TAPS",
    "CylinderHistograms",
    "Features",
    "Method",
    "SphericalHistograms",
    "atom_distances",
    "checked_meshes",
    "facing",
    "frame_distances",
    "frame_features",
    "hann_taps",
    "turned",
    "yaw_free_atom_distances",
]
