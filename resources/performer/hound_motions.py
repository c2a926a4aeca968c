"""Motions of a hound, each a pose as a function of phase and amplitude; the body is that of the sample's film."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from resources.world.gait import BonePose, bend_legs
from resources.world.rotation import about, compose
from resources.world.skeleton import Skeleton

Array = NDArray[np.float64]

# The values of a pose: height (metres) and pitch (nose down positive), roll of the trunk, bend between chest and
# pelvis; pitch and turn of neck, pitch of the head, raise and wag of the tail (radians); then for each leg how far
# its foot stands before its place, and over the ground (metres).
HEIGHT, PITCH, ROLL, SWING, NECK, LOOK, HEAD, TAIL, WAG = range(9)
FORWARD, LIFT = 9, 13
POSE_VALUES = 17
LEGS = ("left front", "left hind", "right front", "right hind")
WALK_ORDER = {"left hind": 0.0, "left front": 0.25, "right hind": 0.5, "right front": 0.75}
TROT_ORDER = {"left hind": 0.0, "right front": 0.0, "right hind": 0.5, "left front": 0.5}
HOUND_MOTIONS = ("walk", "trot", "bow", "shake", "sniff")
HOUND_PERIODS = dict(zip(HOUND_MOTIONS, (1.2, 0.64, 1.6, 0.56, 2.4), strict=True))
"""Seconds a period."""
HOUND_TRAVELS = frozenset({"walk", "trot"})


def hound_pose(name: str, phase: float, amplitude: float = 1.0) -> Array:
    """Pose values (17,) of a motion at a phase in periods; amplitude 1 is the motion as designed."""
    pose = np.zeros(POSE_VALUES)
    pose[NECK], pose[HEAD] = 0.1, -0.05
    p, a = phase % 1.0, amplitude
    turn = 2 * np.pi * p
    if name == "walk":
        _steps(pose, p, a, WALK_ORDER, duty=0.64, reach=0.165, lift=0.075)
        pose[HEIGHT] += -0.012 + 0.006 * np.sin(2 * turn)
        pose[SWING], pose[ROLL] = 0.035 * a * np.sin(turn + 1.2), 0.03 * a * np.sin(turn + 2.8)
        pose[NECK] += 0.05 * a * np.sin(2 * turn)
        pose[WAG] = 0.12 * np.sin(turn)
    elif name == "trot":
        _steps(pose, p, a, TROT_ORDER, duty=0.5, reach=0.19, lift=0.1)
        pose[HEIGHT] += -0.015 + 0.02 * a * np.cos(2 * turn + 0.6)
        pose[NECK] -= 0.12 * a
        pose[TAIL] = 0.25 * a
    elif name == "bow":
        down = a * (0.5 - 0.5 * np.cos(turn))
        pose[PITCH], pose[HEIGHT] = 0.34 * down, -0.095 * down
        pose[FORWARD + 0] = pose[FORWARD + 2] = 0.14 * down
        pose[NECK], pose[HEAD] = pose[NECK] - 0.35 * down, -0.1 * down
        pose[TAIL] = 0.5 * down
        pose[WAG] = 0.35 * down * np.sin(4 * turn)
    elif name == "shake":
        pose[ROLL] = 0.26 * a * np.sin(turn)
        pose[LOOK] = 0.3 * a * np.sin(turn - 0.9)
        pose[WAG] = 0.5 * a * np.sin(turn + 1.2)
        pose[NECK] += 0.25 * a
        pose[HEIGHT] -= 0.02
    elif name == "sniff":
        pose[NECK] += 0.85 * a + 0.06 * np.sin(3 * turn)
        pose[HEAD] += 0.25 * a
        pose[LOOK] = 0.45 * a * np.sin(turn)
        pose[PITCH], pose[HEIGHT] = 0.06 * a, -0.02 * a
        pose[TAIL] = -0.2 * a
    else:
        raise KeyError(name)
    return pose


def _steps(
    pose: Array, phase: float, amplitude: float, order: dict[str, float], *, duty: float, reach: float, lift: float
) -> None:
    """Feet of a gait: evenly back while they stand, forward in an arc while they swing."""
    for k, leg in enumerate(LEGS):
        u = (phase - order[leg]) % 1.0
        if u < duty:
            pose[FORWARD + k] += reach * amplitude * (1 - 2 * u / duty)
            continue
        v = (u - duty) / (1 - duty)
        eased = v * v * (3 - 2 * v)
        pose[FORWARD + k] += reach * amplitude * (2 * eased - 1)
        pose[LIFT + k] += lift * amplitude * np.sin(np.pi * v) ** 2


def hound_bones(skeleton: Skeleton, poses: Array) -> tuple[Array, Array]:
    """Motions of all bones from the rest pose, in the body's frame: rotations (n, b, 3, 3), translations (n, b, 3)."""
    joints = BonePose(skeleton, len(poses))
    legs = {leg.name: leg for leg in skeleton.legs}
    for k, name in enumerate(LEGS):
        leg = legs[name]
        sole = leg.soles[0][1]
        place = np.tile(sole, (len(poses), 1))
        place[:, 0] += poses[:, FORWARD + k]
        place[:, 2] += np.maximum(poses[:, LIFT + k], 0.0)
        joints.put(leg.foot, about("y", 6.0 * np.maximum(poses[:, LIFT + k], 0.0)), sole, place)
    hips = np.mean([joints.joint(leg.upper) for leg in skeleton.legs], axis=0)
    middle = np.tile(hips, (len(poses), 1))
    middle[:, 2] += poses[:, HEIGHT]
    trunk = compose(about("z", poses[:, SWING]), about("y", poses[:, PITCH]), about("x", poses[:, ROLL]))
    joints.put("pelvis", trunk, hips, middle)
    joints.turn("chest", compose(about("z", -2 * poses[:, SWING]), about("x", -1.6 * poses[:, ROLL])))
    bend_legs(joints)
    joints.turn("neck", compose(about("z", 0.5 * poses[:, LOOK]), about("y", poses[:, NECK])))
    joints.turn("head", compose(about("z", 0.5 * poses[:, LOOK]), about("y", poses[:, HEAD])))
    for side, sign in (("left", 1.0), ("right", -1.0)):
        flap = 0.06 + 0.4 * np.abs(poses[:, ROLL])
        joints.turn(f"{side} ear", compose(about("x", sign * flap), about("y", 0.3 * poses[:, NECK])))
    for part in range(3):
        bend = compose(about("z", 0.6 * poses[:, WAG]), about("y", -0.4 * poses[:, TAIL]))
        joints.turn(f"tail {part + 1}", bend)
    return joints.motions()
