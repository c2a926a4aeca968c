"""Symmetry: a hidden limb follows its mirror's motion (the paper's rabbit)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from imitation.errors import InputError
from imitation.motion.banded import Array
from imitation.motion.keys import KeyTracks
from imitation.motion.stride import agreed_lags, measured_lag
from imitation.motion.transfer import transfer_track

Mirror = str | tuple[str, int | None]
"""A key point's partner on the other side, and by how many frames the key point is later (0); None finds it."""


def mirror_motion(
    points: Array,
    rest: Array,
    hidden_rest: Array,
    partners: NDArray[np.int64],
    normal: Array,
    lags: NDArray[np.int64] | None = None,
) -> Array:
    """Places of hidden key points that move as their mirrors do.

    In the body's own frame, found in every frame from the visible key points, a hidden point is where the mirror image
    of its partner is, shifted so that in frame 0 it is where the mesh has it (the offset of eq. 5).

    Parameters
    ----------
    points : (n, k, 3) visible key points, world.
    rest : (k, 3) their places in frame 0.
    hidden_rest : (h, 3) places of the hidden key points in frame 0.
    partners : (h,) which visible key point each one mirrors.
    normal : (3,) of the body's plane of symmetry in frame 0, world, unit length.
    lags : (h,) frames by which the hidden limb is later than its partner: half a cycle in a walk, whose other half
        stands in for the frames before the clip; default 0.

    Returns
    -------
    (n, h, 3) world.
    """
    lags = np.zeros(len(partners), np.int64) if lags is None else lags
    rotation, centre = body_frames(points, rest)
    own = np.einsum("nji,nkj->nki", rotation, points - centre[:, None])
    earlier = np.arange(len(points))[:, None] - lags
    # Two lags are a cycle: frames beyond the clip's ends have their like within it.
    outside = (earlier < 0) | (earlier >= len(points))
    frames = np.clip(np.where(outside, earlier + 2 * lags, earlier), 0, len(points) - 1)
    image = own[frames, partners]
    image = image - 2 * (image @ normal)[..., None] * normal
    image += hidden_rest - rest.mean(axis=0) - image[0]
    places: Array = np.einsum("nij,nhj->nhi", rotation, image) + centre[:, None]
    places += hidden_rest - places[0]
    return places


def sagittal_normal(vertices: Array, across: Array, rounds: int = 30) -> Array:
    """Unit normal (3,) of the plane in which a mesh (v, 3) is most nearly its own mirror image.

    The legs of a walking pose are no mirror images of each other, so only the better matching part of the vertices
    counts; and a slim body is nearly its own image front to back as well, so that ``across`` (3,), a direction roughly
    from one side to the other, has a say.
    """
    from scipy.spatial import cKDTree

    if np.linalg.norm(across) == 0:
        raise InputError("A hidden limb and its mirror are the same vertex; pair them with vertices on both sides.")
    hint = across / np.linalg.norm(across)
    points = vertices[:: max(1, len(vertices) // 1000)] - vertices.mean(axis=0)
    tree = cKDTree(points)
    best, found = np.inf, hint
    for start in (hint, *np.linalg.svd(points, full_matrices=False)[2], *_directions(20)):
        normal, residual = _settle_plane(points, tree, start, rounds)
        badness = residual / np.sqrt(max(abs(float(normal @ hint)), 1e-6))
        if badness < best:
            best, found = badness, normal
    return found


def _directions(count: int) -> Array:
    """Unit vectors (count, 3) spread evenly over a half sphere."""
    height = (np.arange(count) + 0.5) / count
    turn = np.arange(count) * np.pi * (3 - np.sqrt(5))
    flat = np.sqrt(1 - height**2)
    return np.stack([flat * np.cos(turn), flat * np.sin(turn), height], axis=1)


def _settle_plane(points: Array, tree: Any, normal: Array, rounds: int) -> tuple[Array, float]:
    """Closest-point iterations from a first normal: the plane's normal, and how far image and body lie apart."""
    offset, residual = 0.0, np.inf
    for _ in range(rounds):
        distance, nearest = tree.query(points - 2 * (points @ normal - offset)[:, None] * normal)
        near = distance <= np.quantile(distance, 0.6)
        residual = float(distance[near].mean())
        first, second = points[near], points[nearest[near]]
        middle = (first + second).mean(axis=0) / 2
        # The reflection that maps the one set onto the other best: smallest eigenvector of their covariance.
        moment = (first - middle).T @ (second - middle)
        turned = np.linalg.eigh(moment + moment.T)[1][:, 0]
        turned = turned * (np.sign(turned @ normal) or 1.0)
        if np.abs(turned - normal).max() < 1e-6:
            break
        normal, offset = turned, float(middle @ turned)
    return normal, residual


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


def partner_of(mirror: Mirror) -> tuple[str, int | None]:
    """Partner, and lag in frames or None where it is to be found."""
    return (mirror, 0) if isinstance(mirror, str) else (mirror[0], None if mirror[1] is None else int(mirror[1]))


def mirror_lags(lifted: Array, keys: KeyTracks, normal: Array, symmetry: Mapping[str, Mirror]) -> dict[str, int]:
    """Lag of every mirrored key point, frames: given, or measured where both sides are seen.

    Parameters
    ----------
    lifted : (n, k, 3) of the key points in ``keys``, world.
    normal : (3,) of the plane of symmetry in frame 0.
    """
    rotation, centre = body_frames(lifted, keys.start)
    own = np.einsum("nji,nkj->nki", rotation, lifted - centre[:, None])
    image = own - 2 * (own @ normal)[..., None] * normal
    measured: dict[str, int | None] = {}
    for name, mirror in symmetry.items():
        partner, lag = partner_of(mirror)
        if lag is None and name in keys.names and partner in keys.names:
            key, other = keys.names.index(name), keys.names.index(partner)
            seen = keys.observed[:, key], keys.observed[:, other]
            measured[name] = measured_lag(own[:, key], image[:, other], *seen)
    return agreed_lags({name: partner_of(mirror)[1] for name, mirror in symmetry.items()}, measured)


def follow_mirrors(
    lifted: Array,
    rest: Array,
    keys: KeyTracks,
    hidden: Mapping[str, Array],
    vertices: Mapping[str, int],
    symmetry: Mapping[str, Mirror],
) -> tuple[KeyTracks, Array]:
    """Fill the frames in which a key point is hidden with its mirror's motion, and append those that always are.

    Parameters
    ----------
    lifted : (n, k, 3) of the visible key points.
    rest : (v, 3) the character in frame 0.
    hidden : name -> place (3,) in frame 0 of key points without a track of their own; ``vertices`` are theirs.
    """
    count = len(lifted)
    filled = lifted.copy()
    normal = sagittal_normal(rest, _across(rest, vertices, symmetry))
    lags = mirror_lags(lifted, keys, normal, symmetry)
    for key, name in enumerate(keys.names):
        if name in symmetry and not keys.observed[:, key].all():
            partner = partner_of(symmetry[name])[0]
            if partner not in keys.names:
                continue
            other = keys.names.index(partner)
            mirrored = _mirror_one(lifted, normal, keys.start, keys.start[key], other, lags[name])
            seen = np.flatnonzero(keys.observed[:, key])
            boundary = {int(frame): lifted[frame, key] for frame in seen}
            filled[:, key] = transfer_track(mirrored, boundary)
    appended = [
        _mirror_one(
            lifted,
            normal,
            keys.start,
            place,
            keys.names.index(partner_of(symmetry[name])[0]),
            lags[name],
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


def _across(rest: Array, vertices: Mapping[str, int], symmetry: Mapping[str, Mirror]) -> Array:
    """Direction from one side to the other: the mean over all pairs, also of those that are never hidden."""
    total = np.zeros(3)
    for name, mirror in symmetry.items():
        between = rest[vertices[partner_of(mirror)[0]]] - rest[vertices[name]]
        total += between if between @ total >= 0 else -between
    return total


def _mirror_one(lifted: Array, normal: Array, start: Array, place: Array, partner: int, lag: int) -> Array:
    return mirror_motion(lifted, start, place[None], np.array([partner]), normal, np.array([lag]))[:, 0]
