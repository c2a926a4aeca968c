"""Meshes, Laplacians, rotations, projections: shared by both engines."""

from imitation.geometry.projection import Camera

__all__ = ["Camera"]
