"""Motions in a row, performed: poses, truth and one mesh a frame."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import attrs
import numpy as np
from numpy.typing import NDArray

from resources.performer.mesher import body_mesh
from resources.performer.motions import PERIODS, TRAVELLING, WHOLE_CIRCLES, motion_pose
from resources.performer.skeleton import POSE_VALUES, SHOULDER, SWAY, body_capsules, body_joints

Array = NDArray[np.float64]
LIMBS = ([7, 8, 9], [8, 9], [13, 14, 15], [14, 15], [11, 12], [17, 18])
"""Capsules that a broken capture may miss: arms, forearms, legs, shanks."""


@attrs.frozen
class Part:
    """One motion of a script: its name, how often it is repeated, and how its speed changes over the part."""

    motion: str
    repeats: float = 4
    speed_up: float = 1.0


@attrs.frozen(eq=False)
class Capture:
    """A performed sequence: the truth of every frame, and its meshes made on demand.

    Attributes
    ----------
    fps : float
    joints : (n, 17, 3) float64
        World, metres, z up, ground at 0.
    headings : (n,) float64
        Radians about z; 0 faces +x.
    part : (n,) int64
        Which part of the script a frame belongs to.
    phase : (n,) float64
        Phase of that part's motion, growing by 1 a period.
    boundaries : tuple of int
        First frame of every part but the first: the middle of the transition.
    names : tuple of str
        Motion of each part.
    """

    fps: float
    joints: Array
    headings: Array
    part: NDArray[np.int64]
    phase: Array
    boundaries: tuple[int, ...]
    names: tuple[str, ...]
    seed: int
    cell: float
    noise: float
    bump: float
    cell_spread: float
    broken: bool = False

    def __len__(self) -> int:
        return len(self.joints)

    def mesh(self, frame: int, *, copy: int = 0) -> tuple[Array, NDArray[np.int32], NDArray[np.uint8]]:
        """Vertices (v, 3), faces (m, 3), colours (v, 3) of a frame; another copy is another capture of the pose."""
        return self.mesh_of_joints(self.joints[frame], seed=(self.seed, frame, copy))

    def mesh_of_joints(
        self, joints: Array, *, seed: tuple[int, ...]
    ) -> tuple[Array, NDArray[np.int32], NDArray[np.uint8]]:
        """Mesh any joints with this capture's noise."""
        random = np.random.default_rng(seed)
        capsules = body_capsules(joints)
        offset = random.random(3)
        cell = self.cell * float(np.exp(self.cell_spread * random.standard_normal()))
        bumps = np.zeros((0, 5))
        if self.bump:
            waves = random.standard_normal((6, 3))
            waves *= (2 * np.pi / random.uniform(0.12, 0.4, 6) / np.linalg.norm(waves, axis=1))[:, None]
            bumps = np.c_[waves, random.uniform(0, 2 * np.pi, 6), np.full(6, self.bump / np.sqrt(3.0))]
        if self.broken and random.random() < 0.08:
            limb = LIMBS[int(random.integers(len(LIMBS)))]
            capsules = np.delete(capsules, limb, axis=0)
        if self.broken and random.random() < 0.05:
            middle = joints[0] + random.uniform(-0.6, 0.6, 3)
            capsules = np.vstack([capsules, np.r_[middle, middle + random.uniform(-0.1, 0.1, 3), 0.12, 0.09]])
        vertices, faces, colours = body_mesh(capsules, cell=cell, offset=offset, bumps=bumps)
        if self.noise:
            vertices = vertices + self.noise * random.standard_normal(vertices.shape)
        return vertices, faces, colours

    def meshes(self) -> Iterator[tuple[Array, NDArray[np.int32]]]:
        """Vertices and faces of every frame in order, one at a time."""
        for frame in range(len(self)):
            vertices, faces, _ = self.mesh(frame)
            yield vertices, faces


def perform(
    script: Sequence[Part],
    *,
    fps: float = 25.0,
    seed: int = 0,
    hard: bool = False,
    turning: float | None = None,
    period_spread: float | None = None,
    amplitude_spread: float | None = None,
    cell: float = 0.028,
    noise: float | None = None,
    bump: float | None = None,
    broken: bool = False,
) -> Capture:
    """Perform a script of motions.

    Parameters
    ----------
    script : sequence of Part
        The motions in order.
    fps : float
        Frames a second.
    seed : int
        Same seed and script, same bits.
    hard : bool
        Vertex noise 10 mm, bumps 10 mm, mesh size varying by 12 %, turning, more variation from repeat to repeat.
    turning : float, optional
        Largest turning in rad/s.
    period_spread, amplitude_spread : float, optional
        Log standard deviation from repeat to repeat.
    cell : float
        Mesh edge length in metres.
    noise, bump : float, optional
        Metres, over what ``hard`` chooses.
    broken : bool
        Limbs missing in 8 % of the frames, a stray blob in 5 %.

    Returns
    -------
    Capture
    """
    random = np.random.default_rng([seed, 7])
    rate = fps * np.ceil(120 / fps)
    period_sd = (0.07 if hard else 0.05) if period_spread is None else period_spread
    amplitude_sd = (0.08 if hard else 0.05) if amplitude_spread is None else amplitude_spread
    tracks = [_phases(part, rate, random, period_sd, amplitude_sd) for part in script]
    gaps = [int(rate * random.uniform(0.3, 0.6)) for _ in script[1:]]
    poses, part, phase, travel, middles = _blend(script, tracks, gaps)
    steps = len(poses)
    poses[:, SWAY] += 0.025 * _low_pass(random.standard_normal(steps), 0.8 * rate)
    turn = (0.6 if hard else 0.0) if turning is None else turning
    yaw_rate = turn * np.clip(0.6 * _low_pass(random.standard_normal(steps), 1.5 * rate), -1, 1)
    joints, headings = _walk_on(poses, travel, np.cumsum(yaw_rate) / rate)
    stride = round(rate / fps)
    return Capture(
        fps=fps,
        joints=joints[::stride],
        headings=headings[::stride],
        part=part[::stride],
        phase=phase[::stride],
        boundaries=tuple(round(middle / stride) for middle in middles),
        names=tuple(item.motion for item in script),
        seed=seed,
        cell=cell,
        noise=(0.010 if hard else 0.0) if noise is None else noise,
        bump=(0.010 if hard else 0.0) if bump is None else bump,
        cell_spread=0.12 if hard else 0.0,
        broken=broken,
    )


def _phases(
    part: Part, rate: float, random: np.random.Generator, period_sd: float, amplitude_sd: float
) -> tuple[Array, Array]:
    """Phase and amplitude of one part at each step; amplitudes run smoothly from repeat to repeat."""
    cycles = int(np.ceil(part.repeats)) + 2
    periods = PERIODS[part.motion] * np.exp(period_sd * random.standard_normal(cycles))
    periods /= part.speed_up ** np.linspace(0.0, 1.0, cycles)
    knots = np.exp(amplitude_sd * random.standard_normal(cycles + 1))
    starts = np.r_[0.0, np.cumsum(periods)]
    length = float(np.interp(part.repeats, np.arange(cycles + 1), starts))
    times = np.arange(max(2, round(length * rate))) / rate
    phase = np.interp(times, starts, np.arange(cycles + 1))
    return phase + random.random(), np.interp(phase, np.arange(cycles + 1), knots)


def _blend(
    script: Sequence[Part], tracks: list[tuple[Array, Array]], gaps: list[int]
) -> tuple[Array, NDArray[np.int64], Array, Array, list[int]]:
    """Lay the parts one after another, both motions running through each transition."""
    total = sum(len(phase) for phase, _ in tracks)
    poses, weights = np.zeros((total, POSE_VALUES)), np.zeros(total)
    part, phase_of, travel = np.zeros(total, np.int64), np.zeros(total), np.zeros(total)
    middles, first = [], 0
    for index, (item, (phase, amplitude)) in enumerate(zip(script, tracks, strict=True)):
        last = first + len(phase)
        before = gaps[index - 1] // 2 if index else 0
        after = gaps[index] // 2 if index < len(gaps) else 0
        step = np.arange(max(0, first - before), min(total, last + after))
        speed_in, speed_out = phase[1] - phase[0], phase[-1] - phase[-2]
        local = step - first
        run = np.interp(local, np.arange(len(phase)), phase)
        run += np.minimum(local, 0) * speed_in + np.maximum(local - len(phase) + 1, 0) * speed_out
        size = np.interp(local, np.arange(len(phase)), amplitude)
        rise = _smoothstep((local + before) / max(1, 2 * before)) if before else np.ones(len(step))
        fall = _smoothstep((len(phase) + after - local) / max(1, 2 * after)) if after else np.ones(len(step))
        weight = rise * fall
        rows = np.array([motion_pose(item.motion, p, a) for p, a in zip(run, size, strict=True)])
        if item.motion in WHOLE_CIRCLES:
            # Within a transition the arm must not wind through a whole turn: count turns from its middle.
            turns = np.floor(run)
            for near in ((before, 0), (after, len(phase))):
                if near[0]:
                    inside = np.abs(local - near[1]) <= near[0]
                    centre = np.round(np.interp(near[1], local, run))
                    rows[inside, SHOULDER : SHOULDER + 2] += (2 * np.pi * (turns - centre))[inside, None]
        poses[step] += weight[:, None] * rows
        weights[step] += weight
        travel[step] += weight * (item.motion in TRAVELLING)
        part[first:last], phase_of[first:last] = index, phase
        if index:
            middles.append(first)
        first = last
    return poses / weights[:, None], part, phase_of, travel / weights, middles


def _walk_on(poses: Array, travel: Array, headings: Array) -> tuple[Array, Array]:
    """Joints in the world: a travelling body moves so that its standing foot does not."""
    local = np.array([body_joints(pose) for pose in poses])
    place = np.zeros(2)
    joints = np.empty_like(local)
    previous = None
    for step in range(len(local)):
        c, s = np.cos(headings[step]), np.sin(headings[step])
        turn = np.array([[c, -s], [s, c]])
        feet = local[step, [8, 15]]
        weight = np.exp(-(feet[:, 2] - feet[:, 2].min()) / 0.01)
        planted = feet[:, :2] @ turn.T
        if previous is not None:
            place = place - travel[step] * (weight[:, None] * (planted - previous)).sum(axis=0) / weight.sum()
        previous = planted
        joints[step] = local[step]
        joints[step, :, :2] = local[step, :, :2] @ turn.T + place
    return joints, headings


def _smoothstep(x: Array) -> Array:
    inside = np.clip(x, 0.0, 1.0)
    return inside * inside * (3.0 - 2.0 * inside)


def _low_pass(noise: Array, width: float) -> Array:
    """Gaussian low-pass of white noise, scaled back to unit variance."""
    from scipy.ndimage import gaussian_filter1d

    smooth = gaussian_filter1d(noise, width / 2.5, mode="reflect")
    spread = float(np.sqrt(2 * np.sqrt(np.pi) * width / 2.5))
    return np.asarray(smooth * spread)
