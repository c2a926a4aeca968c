"""Poses from a handheld video (paper A, 3.1)."""

from imitation.cameras.path import CameraPath

__all__ = ["CameraPath"]
