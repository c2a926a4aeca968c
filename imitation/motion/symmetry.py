"""Symmetry: a hidden limb follows its mirror's motion (the paper's rabbit)."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from imitation.errors import InputError
from imitation.motion.banded import Array


def mirror_motion(
    points: Array,
    rest: Array,
    hidden_rest: Array,
    partners: NDArray[np.int64],
    lags: NDArray[np.int64] | None = None,
) -> Array:
    """Places of hidden key points that move as their mirrors do.

    In the body's own frame, found in every frame from the visible key points, a hidden point is displaced from its
    rest place by the mirror image of its partner's displacement.

    Parameters
    ----------
    points : (n, k, 3) visible key points, world.
    rest : (k, 3) their places in frame 0.
    hidden_rest : (h, 3) places of the hidden key points in frame 0.
    partners : (h,) which visible key point each one mirrors.
    lags : (h,) frames by which the hidden limb is later than its partner (half a cycle in a walk); default 0.

    Returns
    -------
    (n, h, 3) world.
    """
    lags = np.zeros(len(partners), np.int64) if lags is None else lags
    normal = sagittal_normal(rest[partners], hidden_rest)
    rotation, centre = body_frames(points, rest)
    origin = rest.mean(axis=0)
    own = np.einsum("nji,nkj->nki", rotation, points - centre[:, None])
    frames = np.clip(np.arange(len(points))[:, None] - lags, 0, len(points) - 1)
    moved = own[frames, partners] - (rest[partners] - origin)
    mirrored = moved - 2 * (moved @ normal)[..., None] * normal
    places: Array = np.einsum("nij,nhj->nhi", rotation, hidden_rest - origin + mirrored) + centre[:, None]
    # Frame 0 is where the mesh is, also where a lagged partner is not.
    places -= places[0] - hidden_rest
    return places


def sagittal_normal(partners: Array, hidden: Array) -> Array:
    """Unit normal (3,) of the plane that mirrors the partners (h, 3) onto the hidden points (h, 3)."""
    between = partners - hidden
    if not len(between) or np.linalg.norm(between, axis=1).min() == 0:
        raise InputError("A hidden limb and its mirror are the same vertex; pair them with vertices on both sides.")
    # Signs differ where left and right change roles; the common direction is the first singular vector.
    normal: Array = np.linalg.svd(between)[2][0]
    return normal


def body_frames(points: Array, rest: Array, rounds: int = 5) -> tuple[Array, Array]:
    """Rotation (n, 3, 3) and centre (n, 3) of the body in every frame: a rigid fit that the limbs hardly pull."""
    size = float(np.linalg.norm(np.ptp(rest, axis=0)))
    rotations, centres = np.empty((len(points), 3, 3)), np.empty((len(points), 3))
    own = rest - rest.mean(axis=0)
    for frame, places in enumerate(points):
        weight = np.ones(len(rest))
        for _ in range(rounds):
            weight /= weight.sum()
            first, second = weight @ own, weight @ places
            u, _, v = np.linalg.svd((places - second).T @ (weight[:, None] * (own - first)))
            rotation = u @ np.diag([1, 1, np.sign(np.linalg.det(u @ v))]) @ v
            residual = np.linalg.norm(places - second - (own - first) @ rotation.T, axis=1)
            weight = 1 / (1 + (residual / (0.03 * size)) ** 2)
        rotations[frame], centres[frame] = rotation, second - rotation @ first
    return rotations, centres


def check_symmetry(symmetry: Mapping[str, str | tuple[str, int]], names: tuple[str, ...]) -> dict[str, tuple[str, int]]:
    """Hidden name -> (partner, lag); refuses unknown names and partners that are hidden themselves."""
    checked: dict[str, tuple[str, int]] = {}
    for hidden, value in symmetry.items():
        partner, lag = (value, 0) if isinstance(value, str) else value
        for name in (hidden, partner):
            if name not in names:
                raise InputError(f'The symmetry of "{hidden}" and "{partner}" names "{name}", which has no pair.')
        if partner in symmetry:
            raise InputError(
                f'"{partner}" is hidden itself and cannot be the mirror of "{hidden}"; name a tracked point.'
            )
        checked[hidden] = (partner, int(lag))
    return checked
