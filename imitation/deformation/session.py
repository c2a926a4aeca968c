"""A person drags handles: every step is warm, short and of constant cost; the rest is done when the hand rests."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import attrs
import numpy as np
from numpy.typing import ArrayLike

from imitation.deformation.constraints import FrameConstraints
from imitation.deformation.pose import Pose
from imitation.geometry.projection import Array

if TYPE_CHECKING:
    from imitation.deformation.deformer import Deformer

DRAG_STEPS = 8


class DragSession:
    """Handles of one frame that are added, moved and removed while the mesh follows; nothing is refactored.

    Parameters
    ----------
    asked : the frame's constraints at the beginning. start : the frame's pose.
    """

    def __init__(
        self, deformer: Deformer, asked: FrameConstraints | None = None, start: ArrayLike | Pose | None = None
    ) -> None:
        self._deformer = deformer
        self.asked = asked or FrameConstraints()
        given = deformer.mesh.vertices if start is None else start
        self.pose = given if isinstance(given, Pose) else deformer.pose_of(given)

    @property
    def vertices(self) -> Array:
        """The mesh (n, 3) as it is now."""
        return self.pose.vertices

    def move(self, moves: Mapping[int, ArrayLike], *, iterations: int = DRAG_STEPS) -> Array:
        """Put vertices to world positions (3,), new handles among them, and let the mesh (n, 3) follow some steps."""
        rays = {vertex: pixel for vertex, pixel in self.asked.rays.items() if vertex not in moves}
        depths = {vertex: depth for vertex, depth in self.asked.depths.items() if vertex not in moves}
        self.asked = attrs.evolve(self.asked, points={**self.asked.points, **moves}, rays=rays, depths=depths)
        return self.step(iterations)

    def hold(self, vertex: int) -> None:
        """Keep a vertex where it is."""
        self.asked = attrs.evolve(self.asked, points={**self.asked.points, vertex: np.array(self.vertices[vertex])})

    def release(self, vertex: int) -> None:
        """Let a handle go; the mesh keeps its pose until the next step."""
        points = {other: place for other, place in self.asked.points.items() if other != vertex}
        rays = {other: pixel for other, pixel in self.asked.rays.items() if other != vertex}
        depths = {other: depth for other, depth in self.asked.depths.items() if other != vertex}
        self.asked = attrs.evolve(self.asked, points=points, rays=rays, depths=depths)

    def step(self, iterations: int = DRAG_STEPS) -> Array:
        """Some steps toward the handles; the mesh (n, 3)."""
        self.pose = self._deformer.solve_pose(self.asked, start=self.pose, iterations=iterations)
        return self.pose.vertices

    def refine(self, tolerance: float = 1e-6) -> Array:
        """Go on to the tolerance, when the hand rests; the mesh (n, 3)."""
        self.pose = self._deformer.solve_pose(self.asked, start=self.pose, tolerance=tolerance)
        return self.pose.vertices
