"""Symmetry: a hidden limb follows its mirror's motion (the paper's rabbit)."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike, NDArray

from imitation.errors import InputError
from imitation.motion.banded import Array
from imitation.motion.keys import KeyTracks
from imitation.motion.transfer import transfer_track

Mirror = str | tuple[str, int]
"""A key point's partner on the other side, and by how many frames the key point is later (0)."""


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


def body_frames(points: Array, rest: Array, rounds: int = 10) -> tuple[Array, Array]:
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
            weight = 1 / (1 + (residual / (0.02 * size)) ** 2) ** 2
        rotations[frame], centres[frame] = rotation, second - rotation @ first
    return rotations, centres


def hidden_names(
    symmetry: Mapping[str, Mirror], tracks: Mapping[str, ArrayLike], pairs: Mapping[str, int]
) -> tuple[str, ...]:
    """Paired names with a mirror whose own track is missing or begins later than frame 0; refuses bad mirrors."""
    hidden = []
    for name in symmetry:
        partner = partner_of(symmetry[name])[0]
        for known in (name, partner):
            if known not in pairs:
                raise InputError(f'The symmetry of "{name}" and "{partner}" names "{known}", which has no pair.')
        if name == partner:
            raise InputError(f'"{name}" cannot be its own mirror; name the point on the other side.')
        if name not in tracks or not np.isfinite(np.asarray(tracks[name], np.float64)[:1]).all():
            hidden.append(name)
    for name in hidden:
        partner = partner_of(symmetry[name])[0]
        if partner in hidden:
            raise InputError(f'"{partner}" is hidden itself and cannot be the mirror of "{name}"; track one of them.')
    return tuple(hidden)


def partner_of(mirror: Mirror) -> tuple[str, int]:
    """Partner and lag in frames."""
    return (mirror, 0) if isinstance(mirror, str) else (mirror[0], int(mirror[1]))


def follow_mirrors(
    lifted: Array,
    keys: KeyTracks,
    hidden: Mapping[str, Array],
    vertices: Mapping[str, int],
    symmetry: Mapping[str, Mirror],
) -> tuple[KeyTracks, Array]:
    """Fill the frames in which a key point is hidden with its mirror's motion, and append those that always are.

    Parameters
    ----------
    lifted : (n, k, 3) of the visible key points.
    hidden : name -> place (3,) in frame 0 of key points without a track of their own; ``vertices`` are theirs.
    """
    count = len(lifted)
    filled = lifted.copy()
    for key, name in enumerate(keys.names):
        if name in symmetry and not keys.observed[:, key].all():
            partner, lag = partner_of(symmetry[name])
            if partner not in keys.names:
                continue
            other = keys.names.index(partner)
            mirrored = _mirror_one(lifted, keys.start, keys.start[key], other, lag)
            seen = np.flatnonzero(keys.observed[:, key])
            boundary = {int(frame): lifted[frame, key] for frame in seen}
            filled[:, key] = transfer_track(mirrored, boundary)
    appended = [
        _mirror_one(
            lifted, keys.start, place, keys.names.index(partner_of(symmetry[name])[0]), partner_of(symmetry[name])[1]
        )
        for name, place in hidden.items()
    ]
    if not appended:
        return keys, filled
    more = len(appended)
    nothing = np.zeros((count, more), bool)
    extended = KeyTracks(
        names=(*keys.names, *hidden),
        vertices=np.concatenate([keys.vertices, [vertices[name] for name in hidden]]).astype(np.int64),
        start=np.concatenate([keys.start, np.stack(list(hidden.values()))]),
        pixels=np.concatenate([keys.pixels, np.full((count, more, 2), np.nan)], axis=1),
        observed=np.concatenate([keys.observed, nothing], axis=1),
        planted=np.concatenate([keys.planted, nothing], axis=1),
        places=np.concatenate([keys.places, np.full((count, more, 3), np.nan)], axis=1),
        confidence=np.concatenate([keys.confidence, np.zeros((count, more))], axis=1),
        noise=np.concatenate([keys.noise, np.zeros(more)]),
    )
    return extended, np.concatenate([filled, np.stack(appended, axis=1)], axis=1)


def _mirror_one(lifted: Array, start: Array, place: Array, partner: int, lag: int) -> Array:
    return mirror_motion(lifted, start, place[None], np.array([partner]), np.array([lag]))[:, 0]
