"""The printed energy (paper A, eq. 10-11, after its [26]): differential coordinates follow the triangles' normals."""

from __future__ import annotations

from typing import Any

import numpy as np

from imitation.deformation.system import System
from imitation.geometry import quaternion_matrix
from imitation.geometry.projection import Array


class PaperIteration:
    """Plain iteration ``A U_{k+1} = b(U_k)`` with ``A = L' L + lambda C' C``.

    At rest each differential coordinate is written as the shortest combination of its one-ring's triangle normals;
    in a pose the same combination of the posed normals, brought to the rest length, is what the Laplacian should make.
    Flat regions have none and do not resist (the reason why this is not the default).
    """

    def __init__(self, system: System) -> None:
        self.system = system
        faces = system.place[system.mesh.triangles]
        self.faces, self.corner = faces, faces.T.ravel()
        self.face = np.tile(np.arange(len(faces)), 3)
        detail = system.arrays[3]
        self.length = np.linalg.norm(detail, axis=1)
        normals = self._normals(system.rest)[self.face]
        gram = np.zeros((len(detail), 3, 3))
        np.add.at(gram, self.corner, normals[:, :, None] * normals[:, None, :])
        solved = np.einsum("nij,nj->ni", np.linalg.pinv(gram, rcond=1e-6, hermitian=True), detail)
        self.share = np.einsum("ni,ni->n", normals, solved[self.corner])

    def _normals(self, pose: Array) -> Array:
        corners = pose[self.faces]
        across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        normals: Array = across / np.maximum(np.linalg.norm(across, axis=1, keepdims=True), 1e-300)
        return normals

    def wanted(self, pose: Array) -> Array:
        """Differential coordinates (m, 3) of eq. 10 for a pose (m, 3)."""
        parts = self._normals(pose)[self.face] * self.share[:, None]
        total = np.stack([np.bincount(self.corner, parts[:, axis], len(pose)) for axis in range(3)], axis=1)
        length = np.linalg.norm(total, axis=1)
        result: Array = total * np.divide(self.length, length, out=np.zeros_like(length), where=length > 0)[:, None]
        return result

    def relax(
        self, pose: Array, turns: Array, constraints: tuple[Any, ...], iterations: int, tolerance: float
    ) -> tuple[Array, int, float]:
        """Iterate; the pose, the number of steps and the last root mean square step."""
        from imitation.deformation.kernels import apply_inverse, constrain

        area, total, coupling, ground, shifted = self.system.arrays[4:]
        step, made = np.inf, 0
        wanted: Array = np.einsum("nij,nj->ni", quaternion_matrix(turns), self.system.arrays[3])
        for made in range(1, iterations + 1):
            new = np.ascontiguousarray(wanted)
            apply_inverse(ground, shifted, area, total, coupling, np.zeros_like(pose), new)
            constrain(new, *constraints)
            step = float(np.sqrt(np.square(new - pose).sum(axis=1).mean()))
            pose = new
            if step <= tolerance and made > 1:
                break
            wanted = self.wanted(pose)
        return pose, made, step
