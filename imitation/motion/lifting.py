"""Lifting: the depths of all key points in all frames by one space-time solve.

The unknown of a key point in a frame is its depth along the ray of its 2D track. They are found together from the
contacts, from accelerations that the picture bounds, and from distances between neighbouring key points that stay
roughly as they are in frame 0. It replaces deform, eq. 12, deform of paper A 3.4-3.5, whose rays leave the depth to
each frame alone.
"""

from __future__ import annotations

import attrs
import numpy as np
from numpy.typing import NDArray

from imitation.cameras import CameraPath
from imitation.errors import InputError
from imitation.motion.banded import Array, solve_band
from imitation.motion.rays import rays_of, windowed_acceleration
from imitation.progress import Progress, silent


@attrs.frozen
class LiftSettings:
    """Standard deviations of the terms; lengths in units of the character's diagonal.

    Attributes
    ----------
    anchor : depth of a contact, of frame 0 and of an edited frame.
    prior : depth of a given earlier deformation.
    acceleration : floor of the acceleration per frame^2.
    window : frames over which the acceleration seen in the picture is averaged.
    stretch : relative change of the distance between neighbouring key points.
    trust : frames' worth of belief in `stretch` when it is estimated again per pair.
    rounds : how often accelerations and stretches are estimated again.
    """

    anchor: float = 0.001
    prior: float = 0.10
    acceleration: float = 0.002
    window: float = 3.0
    stretch: float = 0.02
    trust: float = 10.0
    rounds: int = 3
    steps: int = 40
    tolerance: float = 1e-4


@attrs.frozen(eq=False)
class Lift:
    """Solution of the space-time solve.

    Attributes
    ----------
    depths : (n, k) camera z, world units.
    points : (n, k, 3) world.
    cost : final value of the energy.
    acceleration : (n - 2, k) standard deviations of the acceleration used, diagonals per frame^2.
    stretch : (p,) standard deviations of the pairs' distances used, diagonals.
    """

    depths: Array
    points: Array
    cost: float
    acceleration: Array
    stretch: Array


@attrs.frozen(eq=False)
class LiftProblem:
    """The energy's data, lengths in diagonals: what `minimise` needs to find depths (n, k).

    ``doubt`` (n, p) is the variance that the tracks' own errors add to the distance of each pair.
    """

    centres: Array
    directions: Array
    pairs: NDArray[np.int32]
    lengths: Array
    target: Array
    weight: Array
    doubt: Array

    def points(self, depths: Array) -> Array:
        """Places (n, k, 3) of depths (n, k)."""
        places: Array = self.centres[:, None] + depths[..., None] * self.directions
        return places


def lift_tracks(
    pixels: Array,
    cameras: CameraPath,
    rest: Array,
    pairs: NDArray[np.int32],
    diagonal: float,
    *,
    anchors: Array | None = None,
    prior: Array | None = None,
    start: Array | None = None,
    spread: Array | None = None,
    settings: LiftSettings | None = None,
    progress: Progress | None = None,
) -> Lift:
    """Find the depths of all key points in all frames.

    Parameters
    ----------
    pixels : (n, k, 2) the target's 2D tracks without gaps.
    cameras : the clip's cameras.
    rest : (k, 3) places of the key points in frame 0, world.
    pairs : (p, 2) neighbouring key points, whose distance is roughly kept.
    diagonal : the character's bounding-box diagonal, world units; the unit of all standard deviations.
    anchors : (n, k) depths that are known (contacts, edits), NaN elsewhere; frame 0 is always known.
    prior : (n, k) depths of an earlier deformation, NaN where none.
    start : (n, k) depths to start from; default those of frame 0, moved with the anchors.
    spread : (n, k) how far each 2D track may be off, standard deviation, pixels; None for exact tracks. Distances to a
        doubtful point say so much less, so that a wrong track does not take its neighbours along.

    Raises
    ------
    InputError
        A key point is behind the first camera, or the lengths differ.
    """
    settings = settings or LiftSettings()
    report = progress or silent
    if len(pixels) != len(cameras):
        raise InputError(f"The tracks have {len(pixels)} frames but there are {len(cameras)} cameras.")
    first = cameras[0].depth(rest)
    if first.min() <= 0:
        raise InputError("A key point is behind the camera in frame 0; align the character with the subject.")
    known = np.full(pixels.shape[:2], np.nan) if anchors is None else anchors.copy()
    known[0] = first
    problem = _problem(pixels, cameras, rest, pairs, diagonal, known, prior, settings, spread)
    depths = (starting_depths(known) if start is None else start) / diagonal
    lengths = np.maximum(problem.lengths, 1e-6)
    stretch = settings.stretch * lengths
    acceleration = np.zeros((max(len(pixels) - 2, 0), pixels.shape[1]))
    cost = 0.0
    for turn in range(settings.rounds):
        report(turn / settings.rounds)
        acceleration = np.sqrt(settings.acceleration**2 + seen_acceleration(problem, depths, settings.window))
        depths, cost = minimise(problem, depths, acceleration, stretch, settings.steps, settings.tolerance)
        stretch = _estimate_stretch(problem, depths, settings)
    report(1.0)
    points = problem.points(depths) * diagonal
    return Lift(depths * diagonal, points, cost, acceleration, stretch)


def prepare_lift(
    pixels: Array,
    cameras: CameraPath,
    rest: Array,
    pairs: NDArray[np.int32],
    diagonal: float,
    known: Array,
    prior: Array | None,
    depths: Array,
    settings: LiftSettings,
) -> tuple[LiftProblem, Array, Array, Array]:
    """The energy around a solution (n, k), world units: problem, depths, accelerations and stretches in diagonals."""
    problem = _problem(pixels, cameras, rest, pairs, diagonal, known, prior, settings)
    scaled = depths / diagonal
    acceleration = np.sqrt(settings.acceleration**2 + seen_acceleration(problem, scaled, settings.window))
    return problem, scaled, acceleration, _estimate_stretch(problem, scaled, settings)


def starting_depths(known: Array) -> Array:
    """Depths (n, k) of frame 0, moved by the mean change of the known ones, interpolated in time."""
    frames = np.arange(len(known))
    change = []
    for key in range(known.shape[1]):
        present = np.flatnonzero(np.isfinite(known[:, key]))
        if len(present) > 1:
            change.append(np.interp(frames, present, known[present, key] - known[0, key]))
    moved = known[0] + (np.mean(change, axis=0) if change else np.zeros(len(known)))[:, None]
    start: Array = np.where(np.isfinite(known), known, np.maximum(moved, 0.2 * known[0]))
    return start


def minimise(
    problem: LiftProblem, depths: Array, acceleration: Array, stretch: Array, steps: int, tolerance: float
) -> tuple[Array, float]:
    """Damped Gauss-Newton on the banded system: the depths of a local minimum and its cost."""
    from imitation.motion.kernels import energy, normal_equations

    count, keys = depths.shape
    arguments = (
        problem.centres,
        problem.directions,
        problem.pairs,
        problem.lengths,
        1 / (stretch**2 + problem.doubt),
        1 / acceleration**2,
        problem.target,
        problem.weight,
    )
    depths = np.ascontiguousarray(depths)
    cost, damping = float(energy(depths, *arguments)), 1e-4
    band, gradient = np.zeros((2 * keys + 1, count * keys)), np.zeros(count * keys)
    for _ in range(steps):
        normal_equations(depths, *arguments, band, gradient)
        diagonal = band[0].copy()
        before = cost
        while damping < 1e8:
            band[0] = diagonal * (1 + damping)
            trial = depths - solve_band(band, gradient).reshape(count, keys)
            trial_cost = float(energy(trial, *arguments)) if trial.min() > 0 else np.inf
            if trial_cost < cost:
                depths, cost, damping = trial, trial_cost, damping / 4
                break
            damping = damping * 8
        if before - cost <= tolerance * before:
            break
    return depths, cost


def seen_acceleration(problem: LiftProblem, depths: Array, window: float) -> Array:
    """What the picture shows of the squared acceleration (n - 2, k), averaged over a window of frames."""
    if len(depths) < 3:
        return np.zeros((0, depths.shape[1]))
    return windowed_acceleration(problem.points(depths), problem.directions, window)[0]


def _problem(
    pixels: Array,
    cameras: CameraPath,
    rest: Array,
    pairs: NDArray[np.int32],
    diagonal: float,
    known: Array,
    prior: Array | None,
    settings: LiftSettings,
    spread: Array | None = None,
) -> LiftProblem:
    centres, directions = rays_of(cameras, pixels)
    lengths = np.linalg.norm(rest[pairs[:, 0]] - rest[pairs[:, 1]], axis=1) / diagonal
    target, weight = np.zeros(known.shape), np.zeros(known.shape)
    for depths, deviation in ((known, settings.anchor), (prior, settings.prior)):
        if depths is not None:
            present = np.isfinite(depths)
            target[present] += depths[present] / diagonal / deviation**2
            weight[present] += 1 / deviation**2
    target[weight > 0] /= weight[weight > 0]
    doubt = np.zeros((len(pixels), len(pairs)))
    if spread is not None:
        focal = np.sqrt(cameras.K[:, 0, 0] * cameras.K[:, 1, 1])[:, None]
        size = (spread * known[0] / focal / diagonal) ** 2
        doubt = size[:, pairs[:, 0]] + size[:, pairs[:, 1]]
    return LiftProblem(centres / diagonal, directions, pairs, lengths, target, weight, doubt)


def _estimate_stretch(problem: LiftProblem, depths: Array, settings: LiftSettings) -> Array:
    """Per pair, what its length did in the solution, blended with what is expected and kept within [0.3, 10] of it."""
    points = problem.points(depths)
    length = np.linalg.norm(points[:, problem.pairs[:, 0]] - points[:, problem.pairs[:, 1]], axis=2)
    expected = settings.stretch * np.maximum(problem.lengths, 1e-6)
    share = expected**2 / (expected**2 + problem.doubt)
    residual = (share * (length - problem.lengths) ** 2).sum(axis=0)
    estimate = np.sqrt((settings.trust * expected**2 + residual) / (settings.trust + len(depths)))
    bounded: Array = np.clip(estimate, 0.3 * expected, 10 * expected)
    return bounded
