"""Motions in a row, performed: poses, truth and one mesh a frame."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import attrs
import numpy as np
from numpy.typing import NDArray

from resources.performer.mesher import body_mesh
from resources.performer.motions import PERIODS, TRAVELLING, WHOLE_CIRCLES, motion_pose
from resources.performer.script import Part, laid_out, low_pass, phases
from resources.performer.skeleton import SHOULDER, SWAY, body_capsules, body_joints

Array = NDArray[np.float64]
LIMBS = ([7, 8, 9], [8, 9], [13, 14, 15], [14, 15], [11, 12], [17, 18])
"""Capsules that a broken capture may miss: arms, forearms, legs, shanks."""


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
    tracks = [phases(part, PERIODS[part.motion], rate, random, period_sd, amplitude_sd) for part in script]
    gaps = [int(rate * random.uniform(0.3, 0.6)) for _ in script[1:]]
    turned = dict.fromkeys(WHOLE_CIRCLES, slice(SHOULDER, SHOULDER + 2))
    poses, part, phase, travel, middles = laid_out(
        script, tracks, gaps, motion_pose, travelling=TRAVELLING, turning=turned
    )
    steps = len(poses)
    poses[:, SWAY] += 0.025 * low_pass(random.standard_normal(steps), 0.8 * rate)
    turn = (0.6 if hard else 0.0) if turning is None else turning
    yaw_rate = turn * np.clip(0.6 * low_pass(random.standard_normal(steps), 1.5 * rate), -1, 1)
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
