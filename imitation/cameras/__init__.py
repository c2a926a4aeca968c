"""Poses from a handheld video, and the ground that contacts lie on (paper A, 3.1)."""

from imitation.cameras.ground import Ground, constant_depth, constant_depth_track, local_ground, plane_ground
from imitation.cameras.path import CameraPath
from imitation.cameras.plane import Plane, fit_plane
from imitation.cameras.solve import solve_cameras
from imitation.cameras.world import world_from_ground

__all__ = [
    "CameraPath",
    "Ground",
    "Plane",
    "constant_depth",
    "constant_depth_track",
    "fit_plane",
    "local_ground",
    "plane_ground",
    "solve_cameras",
    "world_from_ground",
]
