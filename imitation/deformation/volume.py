"""Keeps the volume of a closed mesh by one closed-form step after the iteration."""

from __future__ import annotations

from typing import Any

import numpy as np

from imitation.deformation.system import System
from imitation.errors import InputError
from imitation.geometry import is_closed, mesh_volume, volume_gradient
from imitation.geometry.projection import Array


class VolumeKeeper:
    """Moves a pose along the constrained response to the volume's gradient until the rest volume is back.

    ``U += w (Vol_0 - Vol) / (g . w)`` with g the gradient and w the response of the mesh to g under the constraints;
    twice, for the volume is not linear. The handles stay where they are.
    """

    def __init__(self, system: System) -> None:
        self.triangles = system.place[system.mesh.triangles]
        if not is_closed(self.triangles):
            raise InputError("Keeping the volume needs a closed mesh, but this one has holes or edges of three faces.")
        self.system = system
        self.volume = mesh_volume(system.rest, self.triangles)

    def __call__(self, pose: Array, constraints: tuple[Any, ...]) -> Array:
        """The pose (m, 3) with the rest volume."""
        from imitation.deformation.kernels import constrain

        response, handle, owner, row, target, matrix, inverse = constraints
        for _ in range(2):
            slope = volume_gradient(pose, self.triangles)
            slope -= slope.mean(axis=0)
            move = np.ascontiguousarray(np.stack([self.system.invert(slope[:, axis]) for axis in range(3)], axis=1))
            constrain(move, response, handle, owner, row, np.zeros_like(target), matrix, inverse)
            gain = float((slope * move).sum())
            if gain <= 0:
                break
            pose = pose + move * (self.volume - mesh_volume(pose, self.triangles)) / gain
        return np.ascontiguousarray(pose)
