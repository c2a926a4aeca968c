"""Poses from a handheld video (paper A, 3.1)."""

from imitation.cameras.path import CameraPath
from imitation.cameras.solve import solve_cameras

__all__ = ["CameraPath", "solve_cameras"]
