"""The sample's hound performs: further motions of the filmed character, meshed anew in every frame, with its coat."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import lru_cache
from typing import Any

import attrs
import numpy as np
from numpy.typing import NDArray

from resources.performer.hound_motions import (
    FORWARD,
    HOUND_PERIODS,
    HOUND_TRAVELS,
    LIFT,
    hound_bones,
    hound_pose,
)
from resources.performer.mesher import body_mesh, nearest_capsule
from resources.performer.script import Part, laid_out, phases
from resources.world.skeleton import Skeleton, quadruped

Array = NDArray[np.float64]
THINNER = 0.006
"""Metres off every radius: the mesher's blending swells a body more than the sample's does."""
SOFT = 0.01
"""Metres over the lowest foot at which a foot still carries."""


@attrs.frozen(eq=False)
class HoundCapture:
    """A performed sequence of the hound; the truth of every frame, and its meshes made on demand.

    Attributes
    ----------
    fps : float
    rotations, translations : (n, b, 3, 3), (n, b, 3) float64
        Bone motions from the rest pose, world, metres, z up, ground at 0; frame 0 faces +x.
    part : (n,) int64
    phase : (n,) float64
    boundaries : tuple of int
    names : tuple of str
        As in ``Capture``.
    """

    fps: float
    rotations: Array
    translations: Array
    part: NDArray[np.int64]
    phase: Array
    boundaries: tuple[int, ...]
    names: tuple[str, ...]
    seed: int
    cell: float

    def __len__(self) -> int:
        return len(self.rotations)

    def mesh(self, frame: int) -> tuple[Array, NDArray[np.int32], NDArray[np.uint8]]:
        """Vertices (v, 3), faces (m, 3), colours (v, 3) of a frame."""
        flesh, bones = _flesh()
        R, t = self.rotations[frame][bones], self.translations[frame][bones]
        capsules = np.empty_like(flesh)
        capsules[:, :3] = np.einsum("cij,cj->ci", R, flesh[:, :3]) + t
        capsules[:, 3:6] = np.einsum("cij,cj->ci", R, flesh[:, 3:6]) + t
        capsules[:, 6:] = flesh[:, 6:]
        random = np.random.default_rng((self.seed, frame))
        vertices, faces, _ = body_mesh(capsules, cell=self.cell, offset=random.random(3))
        vertices[:, 2] = np.maximum(vertices[:, 2], 0.0)
        nearest = nearest_capsule(vertices, capsules)
        # Back to the rest pose with the bone of the nearest capsule: there the coat is known.
        rest = np.einsum("vij,vi->vj", R[nearest], vertices - t[nearest])
        return vertices, faces, _coat(rest)

    def meshes(self) -> Iterator[tuple[Array, NDArray[np.int32]]]:
        """Vertices and faces of every frame in order, one at a time."""
        for frame in range(len(self)):
            yield self.mesh(frame)[:2]


def perform_hound(
    script: Sequence[Part],
    *,
    fps: float = 25.0,
    seed: int = 0,
    period_spread: float = 0.03,
    amplitude_spread: float = 0.04,
    cell: float = 0.026,
) -> HoundCapture:
    """Let the hound perform a script of its motions (``HOUND_MOTIONS``); the same seed and script, the same bits.

    The arguments are those of ``perform``.
    """
    random = np.random.default_rng([seed, 21])
    rate = fps * np.ceil(100 / fps)
    tracks = [
        phases(part, HOUND_PERIODS[part.motion], rate, random, period_spread, amplitude_spread) for part in script
    ]
    gaps = [int(rate * random.uniform(0.4, 0.6)) for _ in script[1:]]
    poses, part, phase, travel, middles = laid_out(
        script, tracks, gaps, hound_pose, travelling=HOUND_TRAVELS, turning={}
    )
    rotations, translations = hound_bones(_skeleton(), poses)
    translations[:, :, 0] += _way(poses, travel)[:, None]
    stride = round(rate / fps)
    return HoundCapture(
        fps=fps,
        rotations=rotations[::stride],
        translations=translations[::stride],
        part=part[::stride],
        phase=phase[::stride],
        boundaries=tuple(round(middle / stride) for middle in middles),
        names=tuple(item.motion for item in script),
        seed=seed,
        cell=cell,
    )


def _way(poses: Array, travel: Array) -> Array:
    """How far (n,) the body has come, so that the feet that carry it do not slide."""
    feet, height = poses[:, FORWARD : FORWARD + 4], np.maximum(poses[:, LIFT : LIFT + 4], 0.0)
    carrying = np.exp(-(height - height.min(axis=1, keepdims=True)) / SOFT)
    moved = -np.diff(feet, axis=0, prepend=feet[:1])
    step = (carrying * moved).sum(axis=1) / carrying.sum(axis=1)
    return np.asarray(np.cumsum(travel * step))


@lru_cache(maxsize=1)
def _skeleton() -> Skeleton:
    return quadruped()


@lru_cache(maxsize=1)
def _flesh() -> tuple[Array, NDArray[np.int64]]:
    """Capsules (c, 8) of the rest pose, and the bone of each."""
    skeleton = _skeleton()
    names = list(skeleton.bones)
    rows = [np.r_[piece.start, piece.end, np.array(piece.radii) - THINNER] for piece in skeleton.flesh]
    return np.array(rows), np.array([names.index(piece.bone) for piece in skeleton.flesh])


@lru_cache(maxsize=1)
def _known_coat() -> tuple[Any, NDArray[np.uint8]]:
    """The coat of the sample's character: its vertices in the rest pose and their colours."""
    from scipy.spatial import cKDTree

    from resources.world.sample import load

    hound = load().characters["hound"]
    return cKDTree(hound.moving.rest), hound.colours


def _coat(places: Array) -> NDArray[np.uint8]:
    tree, colours = _known_coat()
    near, index = tree.query(places, k=3)
    shares = 1.0 / np.maximum(near, 1e-6)
    shares /= shares.sum(axis=1, keepdims=True)
    mixed: NDArray[np.uint8] = np.rint((shares[..., None] * colours[index]).sum(axis=1)).astype(np.uint8)
    return mixed
