"""Fourteen motions, each a pose as a function of phase and amplitude."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from resources.performer.skeleton import (
    ARM_OUT,
    BEND,
    BOUNCE,
    ELBOW,
    HIP,
    KNEE,
    NOD,
    POSE_VALUES,
    SHOULDER,
    SIDE,
    SPREAD,
    TWIST,
)

Pose = NDArray[np.float64]
Motion = Callable[[Pose, float, float], None]


def _wave(phase: float, power: float = 1.0) -> float:
    """Rise from 0 to 1 at half the period and fall back, smoothly."""
    return float((0.5 - 0.5 * np.cos(2 * np.pi * phase)) ** power)


def _stand(pose: Pose, phase: float, amplitude: float) -> None:
    pose[BEND] += 0.02 * amplitude * np.sin(2 * np.pi * phase)


def _gait(pose: Pose, phase: float, stride: float, lift: float, arms: float, elbow: float, lean: float) -> None:
    for side in range(2):
        angle = 2 * np.pi * (phase + 0.5 * side)
        pose[HIP + side] += stride * np.sin(angle) + 0.08
        pose[KNEE + side] += 0.08 + lift * max(0.0, np.cos(angle + 0.3)) ** 1.5
        pose[SHOULDER + side] -= arms * np.sin(angle)
        pose[ELBOW + side] += elbow + 0.3 * arms * max(0.0, -np.sin(angle))
    pose[BEND] += lean
    pose[TWIST] += 0.12 * stride * np.sin(2 * np.pi * phase)


def _walk(pose: Pose, phase: float, amplitude: float) -> None:
    _gait(pose, phase, 0.42 * amplitude, 0.85 * amplitude, 0.4 * amplitude, 0.15, 0.04)


def _run(pose: Pose, phase: float, amplitude: float) -> None:
    _gait(pose, phase, 0.52 * amplitude, 1.5 * amplitude, 0.75 * amplitude, 1.3, 0.16)
    pose[BOUNCE] += 0.045 * amplitude * _wave(2 * phase + 0.5)


def _march(pose: Pose, phase: float, amplitude: float) -> None:
    for side in range(2):
        up = max(0.0, np.sin(2 * np.pi * (phase + 0.5 * side))) ** 1.2
        pose[HIP + side] += 1.35 * amplitude * up
        pose[KNEE + side] += 1.5 * amplitude * up
        pose[SHOULDER + 1 - side] += 0.7 * amplitude * up
        pose[ELBOW + 1 - side] += 0.7 * amplitude * up


def _raised_arm(pose: Pose, side: int, phase: float, amplitude: float) -> None:
    pose[ARM_OUT + side] += 2.35 + 0.45 * amplitude * np.sin(2 * np.pi * phase)
    pose[ELBOW + side] += 0.25 + 0.2 * np.cos(2 * np.pi * phase)


def _wave_one(pose: Pose, phase: float, amplitude: float) -> None:
    _raised_arm(pose, 1, phase, amplitude)


def _wave_both(pose: Pose, phase: float, amplitude: float) -> None:
    _raised_arm(pose, 0, phase, amplitude)
    _raised_arm(pose, 1, phase, amplitude)


def _squat(pose: Pose, phase: float, amplitude: float) -> None:
    down = amplitude * _wave(phase, 1.2)
    for side in range(2):
        pose[HIP + side] += 1.35 * down
        pose[KNEE + side] += 1.75 * down
        pose[SHOULDER + side] += 1.4 * down
    pose[BEND] += 0.5 * down


def _jack(pose: Pose, phase: float, amplitude: float) -> None:
    out = amplitude * _wave(phase)
    for side in range(2):
        pose[ARM_OUT + side] += 2.6 * out
        pose[SPREAD + side] += 0.5 * out
        pose[KNEE + side] += 0.15 * _wave(2 * phase)
        pose[HIP + side] += 0.1 * _wave(2 * phase)
    pose[BOUNCE] += 0.07 * amplitude * _wave(2 * phase)


def _bend(pose: Pose, phase: float, amplitude: float) -> None:
    down = amplitude * _wave(phase)
    pose[BEND] += 1.35 * down
    pose[SHOULDER : SHOULDER + 2] += 0.9 * down
    pose[NOD] += 0.2 * down


def _side_bend(pose: Pose, phase: float, amplitude: float) -> None:
    lean = amplitude * np.sin(2 * np.pi * phase)
    pose[SIDE] += 0.5 * lean
    pose[ARM_OUT] += 0.25 + 1.1 * max(0.0, lean)
    pose[ARM_OUT + 1] += 0.25 + 1.1 * max(0.0, -lean)


def _twist(pose: Pose, phase: float, amplitude: float) -> None:
    pose[TWIST] += 0.9 * amplitude * np.sin(2 * np.pi * phase)
    pose[ARM_OUT : ARM_OUT + 2] += 1.45


def _kick(pose: Pose, phase: float, amplitude: float) -> None:
    up = amplitude * _wave(phase, 1.8)
    pose[HIP + 1] += 1.4 * up
    pose[KNEE + 1] += 0.9 * _wave(2 * phase) * (0.4 + 0.6 * up)
    pose[BEND] -= 0.2 * up
    pose[SHOULDER] += 0.7 * up
    pose[ARM_OUT : ARM_OUT + 2] += 0.25


def _arm_circles(pose: Pose, phase: float, amplitude: float) -> None:
    for side in range(2):
        pose[SHOULDER + side] += 2 * np.pi * phase
        pose[ARM_OUT + side] += 0.25 * amplitude
    pose[BEND] += 0.05 * amplitude * np.sin(2 * np.pi * phase)


def _punch(pose: Pose, phase: float, amplitude: float) -> None:
    for side in range(2):
        out = amplitude * max(0.0, np.sin(2 * np.pi * (phase + 0.5 * side))) ** 1.5
        pose[SHOULDER + side] += 0.55 + 0.95 * out
        pose[ELBOW + side] += 2.0 - 1.9 * min(out, 1.0)
        pose[TWIST] += (-0.35 if side == 0 else 0.35) * out
    pose[KNEE : KNEE + 2] += 0.25
    pose[HIP : HIP + 2] += 0.15


MOTIONS: dict[str, Motion] = {
    "walk": _walk,
    "run": _run,
    "wave": _wave_one,
    "wave both": _wave_both,
    "squat": _squat,
    "jumping jack": _jack,
    "bend": _bend,
    "side bend": _side_bend,
    "twist": _twist,
    "kick": _kick,
    "march": _march,
    "arm circles": _arm_circles,
    "punch": _punch,
    "stand": _stand,
}
PERIODS: dict[str, float] = dict(
    zip(MOTIONS, (1.1, 0.72, 1.0, 1.1, 2.0, 1.2, 2.4, 2.2, 1.6, 1.4, 1.1, 1.4, 1.0, 3.0), strict=True)
)
"""Seconds a period."""
TRAVELLING = frozenset({"walk", "run"})
WHOLE_CIRCLES = frozenset({"arm circles"})
"""Motions whose shoulder angle grows by a turn a period."""


def motion_pose(name: str, phase: float, amplitude: float = 1.0) -> Pose:
    """Pose values of a motion at a phase.

    Parameters
    ----------
    name : str
        A key of ``MOTIONS``.
    phase : float
        In periods; only its fraction matters.
    amplitude : float
        1 is the motion as designed.

    Returns
    -------
    (18,) float64
    """
    pose = np.zeros(POSE_VALUES)
    pose[ARM_OUT : ARM_OUT + 2] = 0.12
    pose[ELBOW : ELBOW + 2] = 0.12
    pose[SPREAD : SPREAD + 2] = 0.04
    MOTIONS[name](pose, phase % 1.0, amplitude)
    return pose
