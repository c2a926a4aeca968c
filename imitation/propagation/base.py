"""The base solution: the character's motion from the video alone, before any edit (paper A, 3.2-3.5)."""

from __future__ import annotations

import time
from collections.abc import Callable, Collection, Mapping, Sequence
from typing import TYPE_CHECKING, Literal

import attrs
import numpy as np
from numpy.typing import ArrayLike, NDArray

from imitation.cameras import CameraPath
from imitation.errors import InputError
from imitation.motion.anchors import Loss
from imitation.motion.banded import Array
from imitation.motion.contacts import Contact
from imitation.motion.keys import KeyTracks, diagonal, key_tracks
from imitation.motion.lifting import LiftSettings, lift_tracks
from imitation.motion.polishing import pixel_noise, polish
from imitation.motion.rays import depths_of, lift_points, rays_of
from imitation.motion.smoothing import smooth_depths
from imitation.motion.symmetry import Mirror, follow_mirrors, hidden_names
from imitation.progress import Progress, part

if TYPE_CHECKING:
    from imitation.deformation import Deformer, FrameConstraints

Method = Literal["joint", "paper"]
OnFrame = Callable[[int, Array], None]
FREE, MIRRORED = 0.02, 0.9
DOUBT = 30.0
"""Pixels that a track without any confidence may be off, as distances between key points see it."""
SOFT = 0.999
"""Softness of a key point held by its track: a small give, so that a wrong track does not tear the mesh."""
SAME = 1e-3


@attrs.frozen(eq=False)
class Base:
    """The base solution; arrays only, so that it can be kept and sent.

    Attributes
    ----------
    rest : (v, 3) the character aligned with the subject in frame 0, world.
    faces : (m, 3).
    cameras : the clip's cameras.
    keys : the key points' transferred tracks.
    lifted : (n, k, 3) 3D tracks of the key points, world: what the mesh is held by.
    softness : (n, k) how hard it is held, in (0, 1].
    vertices : (n, v, 3) the deformed character, world.
    method : "joint" or "paper".
    noise : (k,) estimated jitter of the 2D tracks, pixels.
    seconds : CPU seconds of each step.
    """

    rest: Array
    faces: NDArray[np.int32]
    cameras: CameraPath
    keys: KeyTracks
    lifted: Array
    softness: Array
    vertices: Array
    method: Method
    noise: Array
    seconds: dict[str, float]

    def __len__(self) -> int:
        return len(self.vertices)

    @property
    def key_points(self) -> Array:
        """Places (n, k, 3) of the paired vertices, world."""
        return self.vertices[:, self.keys.vertices]


def solve_base(
    vertices: ArrayLike,
    faces: ArrayLike,
    cameras: CameraPath,
    tracks: Mapping[str, ArrayLike],
    pairs: Mapping[str, int],
    contacts: Mapping[str, Sequence[Contact]] | None = None,
    *,
    method: Method = "joint",
    confidence: Mapping[str, ArrayLike] | None = None,
    symmetry: Mapping[str, Mirror] | None = None,
    start: ArrayLike | None = None,
    loss: Loss = "quadratic",
    beta: float = 1e-4,
    alpha: float = 10.0,
    settings: LiftSettings | None = None,
    deformer: Deformer | None = None,
    progress: Progress | None = None,
    on_frame: OnFrame | None = None,
) -> Base:
    """Find the character's motion from tracks, cameras and contacts.

    Parameters
    ----------
    vertices, faces : the character (v, 3), (m, 3), aligned with the subject in frame 0, world.
    cameras : one camera a frame.
    tracks : name -> (n, 2) pixels, NaN where absent.
    pairs : track name -> vertex.
    contacts : track name -> intervals (first frame, last frame, place (3,) world) in which the point is planted.
    method : "joint" lifts all key points by one space-time solve; "paper" is the printed route: deform with rays,
        smooth the depths (eq. 12), deform with the upgraded 3D tracks.
    confidence : track name -> (n,) in [0, 1].
    symmetry : track name -> its mirror on the other side, or (mirror, frames by which it is later); None for the
        frames finds them from both tracks. Where the track is hidden it moves as its mirror does, also throughout.
    start : (v, 3) the character's pose in frame 0, world, see `start_pose`; lengths and offsets come from it. Default
        ``vertices``, which stay the shape that the deformation keeps to.
    loss, beta : of the anchors (eq. 3-4).
    alpha : depth smoothing of the printed route (eq. 12).
    deformer : a prepared `Deformer` of this mesh; made here by default.
    on_frame : called with each frame's final vertices as they are ready.

    Raises
    ------
    InputError
        The parts do not fit each other; one sentence says which and what to do.
    """
    vertices, faces = _mesh(vertices, faces)
    if method not in ("joint", "paper"):
        raise InputError(f'The method must be "joint" or "paper", but is "{method}".')
    if not len(cameras):
        raise InputError("There are no cameras; solve or give one camera a frame first.")
    pose = vertices if start is None else _start(start, vertices)
    hidden = hidden_names(symmetry or {}, tracks, pairs)
    keys = key_tracks(
        pose,
        cameras,
        tracks,
        {name: vertex for name, vertex in pairs.items() if name not in hidden},
        contacts or {},
        confidence=confidence,
        beta=beta,
        loss=loss,
        denoise=method == "joint",
    )
    if len(keys) < 3:
        raise InputError(
            f"Only {len(keys)} track{'s are' if len(keys) > 1 else ' is'} paired with the character, "
            "which leaves its pose open; pair at least three."
        )
    clock = Clock()
    deformer = deformer or make_deformer(vertices, faces)
    clock.lap("prepare")
    solve = _solve_joint if method == "joint" else _solve_paper
    lifted, noise = solve(
        keys, vertices, pose, faces, cameras, deformer, clock, alpha, settings, part(progress, 0.0, 0.55)
    )
    if symmetry:
        places = {name: pose[pairs[name]] for name in hidden}
        keys, lifted = follow_mirrors(lifted, pose, keys, places, pairs, symmetry)
        noise = keys.noise
    softness = key_softness(keys, mirrored=symmetry or {})
    frames = [points_constraint(keys.vertices, lifted[frame], softness[frame]) for frame in range(len(cameras))]
    posed = deformer.solve_sequence(frames, start=pose, progress=part(progress, 0.55, 1.0), on_frame=on_frame)
    if np.abs(posed[0] - pose).max() < SAME * diagonal(vertices):
        # What was accepted as frame 0 to the bit, but where control vertices hold what key points alone do not.
        posed[0] = pose
    clock.lap("deformation")
    return Base(vertices, faces, cameras, keys, lifted, softness, posed, method, noise, clock.seconds)


def _solve_joint(
    keys: KeyTracks,
    vertices: Array,
    pose: Array,
    faces: NDArray[np.int32],
    cameras: CameraPath,
    deformer: Deformer,
    clock: Clock,
    alpha: float,
    settings: LiftSettings | None,
    progress: Progress,
) -> tuple[Array, Array]:
    """Lift, deform once on rays and feet for a weak depth prior, lift again, polish."""
    size = diagonal(vertices)
    pairs = key_pairs(vertices, faces, keys.vertices)
    anchors = np.where(keys.planted, depths_of(cameras, keys.places), np.nan)
    spread = np.where(keys.planted, 0.0, DOUBT * (1 - keys.confidence))
    first = lift_tracks(
        keys.pixels, cameras, keys.start, pairs, size, anchors=anchors, spread=spread, settings=settings
    )
    clock.lap("lifting")
    posed = _deform_on_rays(keys, cameras, deformer, pose, first.points, part(progress, 0.05, 0.9))
    prior = depths_of(cameras, posed[:, keys.vertices])
    prior[~keys.observed] = np.nan
    clock.lap("depth prior")
    second = lift_tracks(
        keys.pixels, cameras, keys.start, pairs, size,
        anchors=anchors, prior=prior, start=first.depths, spread=spread, settings=settings,
    )  # fmt: skip
    noise = pixel_noise(second.points, cameras, keys.observed & ~keys.planted)
    held = np.zeros(keys.planted.shape, bool)
    held[0] = True
    polished = polish(
        second.points, cameras, rays_of(cameras, keys.pixels)[1], size,
        noise=noise, planted=keys.planted, held=held, observed=keys.observed,
    )  # fmt: skip
    polished[0] = keys.start
    clock.lap("lifting")
    progress(1.0)
    return polished, keys.noise


def _solve_paper(
    keys: KeyTracks,
    vertices: Array,
    pose: Array,
    faces: NDArray[np.int32],
    cameras: CameraPath,
    deformer: Deformer,
    clock: Clock,
    alpha: float,
    settings: LiftSettings | None,
    progress: Progress,
) -> tuple[Array, Array]:
    """The printed route: eq. 7-11, then eq. 12, then every 2D track upgraded to 3D."""
    posed = _deform_on_rays(keys, cameras, deformer, pose, keys.places, progress)
    clock.lap("first deformation")
    clamped: NDArray[np.bool_] = np.asarray(np.isfinite(keys.places).all(axis=2))
    clamped[0] = True
    depths = depths_of(cameras, posed[:, keys.vertices])
    depths[0] = cameras[0].depth(keys.start)
    depths = np.where(np.isfinite(keys.places).all(axis=2), depths_of(cameras, keys.places), depths)
    smoothed = smooth_depths(depths, alpha=alpha, clamped=clamped)
    lifted = lift_points(cameras, keys.pixels, smoothed)
    lifted[0] = keys.start
    clock.lap("depth smoothing")
    return lifted, np.zeros(len(keys))


def _deform_on_rays(
    keys: KeyTracks, cameras: CameraPath, deformer: Deformer, start: Array, places: Array, progress: Progress
) -> Array:
    """First deformation: anchors in 3D (eq. 7), all other key points on their rays (eq. 8)."""
    from imitation.deformation import FrameConstraints

    anchored = np.isfinite(keys.places).all(axis=(0, 2))
    softness = key_softness(keys)
    frames = []
    for frame in range(len(cameras)):
        points = {int(keys.vertices[key]): places[frame, key] for key in np.flatnonzero(anchored)}
        rays = {
            int(keys.vertices[key]): (float(keys.pixels[frame, key, 0]), float(keys.pixels[frame, key, 1]))
            for key in np.flatnonzero(~anchored)
        }
        given = {int(keys.vertices[key]): float(softness[frame, key]) for key in range(len(keys))}
        frames.append(FrameConstraints(points=points, rays=rays, camera=cameras[frame], depths={}, softness=given))
    # What is read off is a weak prior (a tenth of the diagonal): the last digits of the mesh do not matter.
    return deformer.solve_sequence(frames, start=start, tolerance=1e-5, progress=progress)


def key_pairs(vertices: Array, faces: NDArray[np.int32], keys: NDArray[np.int64]) -> NDArray[np.int32]:
    """Pairs (p, 2) of key points whose geodesic regions on the character touch: their distance is roughly kept."""
    from imitation.geometry import key_adjacency

    return np.asarray(key_adjacency(vertices, faces, keys.tolist()), np.int32).reshape(-1, 2)


def key_softness(keys: KeyTracks, mirrored: Collection[str] = ()) -> Array:
    """Softness (n, k): contacts and frame 0 hard, the rest as far as its track is trusted, nearly free in gaps."""
    softness = np.maximum(SOFT * keys.confidence, FREE)
    for key, name in enumerate(keys.names):
        if name in mirrored:
            softness[~keys.observed[:, key], key] = MIRRORED
    softness[keys.planted] = 1.0
    softness[0] = 1.0
    return softness


def points_constraint(vertices: NDArray[np.int64], places: Array, softness: Array) -> FrameConstraints:
    """Constraints of a frame whose key points are all known in 3D."""
    from imitation.deformation import FrameConstraints

    return FrameConstraints(
        points={int(vertex): place for vertex, place in zip(vertices, places, strict=True)},
        rays={},
        camera=None,
        depths={},
        softness={int(vertex): float(soft) for vertex, soft in zip(vertices, softness, strict=True)},
    )


def make_deformer(vertices: Array, faces: NDArray[np.int32]) -> Deformer:
    """Factor the character's mesh once."""
    from imitation.deformation import Deformer

    return Deformer(vertices, faces)


def _mesh(vertices: ArrayLike, faces: ArrayLike) -> tuple[Array, NDArray[np.int32]]:
    vertices, faces = np.asarray(vertices, np.float64), np.asarray(faces, np.int32)
    if vertices.ndim != 2 or vertices.shape[1:] != (3,) or not len(vertices):
        raise InputError(f"The character's vertices need shape (vertices, 3), but have {vertices.shape}.")
    if not np.isfinite(vertices).all():
        raise InputError(f"Vertex {int(np.argmin(np.isfinite(vertices).all(axis=1)))} of the character is not finite.")
    if faces.ndim != 2 or faces.shape[1:] != (3,) or not len(faces):
        raise InputError(f"The character's faces need shape (faces, 3), but have {faces.shape}.")
    return vertices, faces


def _start(start: ArrayLike, vertices: Array) -> Array:
    pose = np.asarray(start, np.float64)
    if pose.shape != vertices.shape or not np.isfinite(pose).all():
        raise InputError(f"The pose in frame 0 needs {len(vertices)} finite places, but has shape {pose.shape}.")
    return pose


class Clock:
    """CPU seconds of successive steps."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = {}
        self._last = time.thread_time()

    def lap(self, name: str) -> None:
        """Add the CPU time since the last lap to a step."""
        now = time.thread_time()
        self.seconds[name] = self.seconds.get(name, 0.0) + now - self._last
        self._last = now
