"""The cameras of a clip, one a frame, with what is known about them."""

from __future__ import annotations

from typing import Literal, overload

import attrs
import numpy as np
from numpy.typing import ArrayLike, NDArray

from imitation.errors import InputError
from imitation.geometry.projection import Array, Camera

Verdict = Literal["ok", "static", "rotation", "planar", "failed"]


def _stack(value: ArrayLike, shape: tuple[int, ...]) -> Array:
    array = np.array(value, dtype=np.float64)
    if array.ndim != len(shape) + 1 or array.shape[1:] != shape:
        wanted = ", ".join(map(str, shape))
        raise InputError(f"A camera path needs arrays of shape (frames, {wanted}), but got {array.shape}.")
    if not np.isfinite(array).all():
        raise InputError("A camera path must hold finite numbers only, but some are NaN or infinite.")
    array.setflags(write=False)
    return array


def _matrices(value: ArrayLike) -> Array:
    return _stack(value, (3, 3))


def _vectors(value: ArrayLike) -> Array:
    return _stack(value, (3,))


def _optional(value: ArrayLike | None) -> Array:
    array = np.zeros((0, 3)) if value is None else np.array(value, dtype=np.float64).reshape(-1, 3)
    array.setflags(write=False)
    return array


def _numbers(value: ArrayLike | None) -> Array:
    return np.zeros(0) if value is None else np.array(value, dtype=np.float64)


@attrs.frozen(eq=False)
class CameraPath:
    """Cameras of all frames of a clip (paper A, 3.1).

    Attributes
    ----------
    K : (n, 3, 3) intrinsic matrices, pixels, pixel centres at integers.
    R : (n, 3, 3) rotations, world to camera, OpenCV axes.
    T : (n, 3) translations; ``x_cam = R x_world + T``.
    verdict : what the picture allowed: "ok" (parallax found), "static", "rotation", "planar", "failed".
    points : (p, 3) background points, world.
    reason : one sentence that says why, and what is unknown (scale, up, depth).
    residuals : (n,) reprojection error per frame, pixels, NaN where unknown.
    observations : (m, 3) rows of (frame, x, y), the tracked pixels of ``observed`` points, for display.
    observed : (m,) index into points for each observation.
    """

    K: Array = attrs.field(converter=_matrices)
    R: Array = attrs.field(converter=_matrices)
    T: Array = attrs.field(converter=_vectors)
    verdict: Verdict = "ok"
    points: Array = attrs.field(default=None, converter=_optional)
    reason: str = ""
    residuals: Array = attrs.field(default=None, converter=_numbers)
    observations: Array = attrs.field(default=None, converter=_optional)
    observed: NDArray[np.int32] = attrs.field(factory=lambda: np.zeros(0, np.int32))

    def __attrs_post_init__(self) -> None:
        if not len(self.K) == len(self.R) == len(self.T):
            raise InputError(
                f"A camera path needs K, R and T of as many frames, got {len(self.K)}, {len(self.R)}, {len(self.T)}."
            )
        if not len(self.residuals):
            object.__setattr__(self, "residuals", np.full(len(self.K), np.nan))

    def __len__(self) -> int:
        return len(self.K)

    @overload
    def __getitem__(self, frame: int) -> Camera: ...
    @overload
    def __getitem__(self, frame: slice) -> CameraPath: ...
    def __getitem__(self, frame: int | slice) -> Camera | CameraPath:
        if isinstance(frame, slice):
            return attrs.evolve(
                self, K=self.K[frame], R=self.R[frame], T=self.T[frame], residuals=self.residuals[frame]
            )
        return Camera(self.K[frame], self.R[frame], self.T[frame])

    @property
    def centres(self) -> Array:
        """Centres of projection (n, 3), world."""
        centres: Array = -np.einsum("nji,nj->ni", self.R, self.T)
        return centres

    def transformed(self, scale: float, rotation: ArrayLike, translation: ArrayLike) -> CameraPath:
        """The same cameras in a new world ``X' = scale * rotation @ X + translation``; the pictures do not change."""
        rotation, translation = np.asarray(rotation, np.float64), np.asarray(translation, np.float64)
        R = self.R @ rotation.T
        T = scale * self.T - np.einsum("nij,j->ni", R, translation)
        return attrs.evolve(self, R=R, T=T, points=scale * self.points @ rotation.T + translation)
