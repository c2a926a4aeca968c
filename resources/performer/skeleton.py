"""The performer's skeleton: eighteen pose values to joints and tapered capsules.

Body frame: x forward, y to the left, z up, metres; the lowest sole stands at z = bounce. About 1.75 m tall.
"""

from __future__ import annotations

import numpy as np
from numba import njit

# The values of a pose: bend, side and twist of the trunk, then left and right of each limb's angle (radians),
# the height of the soles over the ground (metres) and the nod of the head.
BEND, SIDE, TWIST = 0, 1, 2
HIP, SPREAD, KNEE, SHOULDER, ARM_OUT, ELBOW = 3, 5, 7, 9, 11, 13
BOUNCE, NOD, SWAY = 15, 16, 17
POSE_VALUES = 18

JOINTS = (
    "pelvis",
    "chest",
    "head",
    *(
        f"{side} {name}"
        for side in ("left", "right")
        for name in ("shoulder", "elbow", "wrist", "hip", "knee", "ankle", "toe")
    ),
)
CAPSULES = 19
SKIN, SHIRT, TROUSERS, SHOE, HAIR = 0, 1, 2, 3, 4
# One material a capsule, in the order body_capsules makes them.
MATERIALS = np.array(
    [TROUSERS, SHIRT, SHIRT, SKIN, SKIN, SKIN, HAIR] + [SHIRT, SKIN, SKIN, TROUSERS, TROUSERS, SHOE] * 2
)


@njit(cache=True, nogil=True)
def _turn(axis, angle):  # type: ignore[no-untyped-def]  # pragma: no cover - compiled
    """Rotation by an angle about axis 0, 1 or 2."""
    c, s = np.cos(angle), np.sin(angle)
    rotation = np.eye(3)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    rotation[i, i], rotation[j, j], rotation[i, j], rotation[j, i] = c, c, -s, s
    return rotation


@njit(cache=True, nogil=True)
def body_joints(pose):  # type: ignore[no-untyped-def]
    """Joints of one pose.

    Parameters
    ----------
    pose : (18,) float64
        Pose values in the order of this module's constants.

    Returns
    -------
    (17, 3) float64
        Joints in the order of ``JOINTS``, body frame, metres; the pelvis stands above the origin.
    """
    joints = np.zeros((17, 3))
    trunk = _turn(2, pose[TWIST]) @ _turn(1, pose[BEND]) @ _turn(0, pose[SIDE] + pose[SWAY])
    joints[1] = trunk @ np.array([0.0, 0.0, 0.46])
    joints[2] = joints[1] + trunk @ _turn(1, pose[NOD]) @ np.array([0.015, 0.0, 0.24])
    down = np.array([0.0, 0.0, -1.0])
    lowest = 10.0
    for side in range(2):
        sign = 1.0 if side == 0 else -1.0
        row = 3 + 7 * side
        arm = trunk @ _turn(0, sign * pose[ARM_OUT + side]) @ _turn(1, -pose[SHOULDER + side])
        joints[row] = joints[1] + trunk @ np.array([0.0, sign * 0.19, -0.03])
        joints[row + 1] = joints[row] + 0.29 * (arm @ down)
        joints[row + 2] = joints[row + 1] + 0.26 * (arm @ _turn(1, -pose[ELBOW + side]) @ down)
        leg = _turn(0, sign * pose[SPREAD + side]) @ _turn(1, -pose[HIP + side])
        shank = leg @ _turn(1, pose[KNEE + side])
        joints[row + 3] = np.array([0.0, sign * 0.095, -0.03])
        joints[row + 4] = joints[row + 3] + 0.43 * (leg @ down)
        joints[row + 5] = joints[row + 4] + 0.42 * (shank @ down)
        # The foot follows a third of the shank's pitch: it rolls, and lies flat under a straight leg.
        pitch = (pose[KNEE + side] - pose[HIP + side]) / 3.0
        joints[row + 6] = joints[row + 5] + _turn(1, pitch) @ np.array([0.15, sign * 0.02, -0.045])
        lowest = min(lowest, joints[row + 5, 2] - 0.085, joints[row + 6, 2] - 0.035)
    joints[:, 2] += pose[BOUNCE] - lowest
    return joints


@njit(cache=True, nogil=True)
def body_capsules(joints):  # type: ignore[no-untyped-def]
    """Tapered capsules around joints in any frame of reference (they follow the joints alone).

    Returns
    -------
    (19, 8) float64
        First end (3), second end (3), radius at the first and at the second end, metres.
    """
    capsules = np.zeros((CAPSULES, 8))
    pelvis, chest, head = joints[0], joints[1], joints[2]
    across = joints[3] - joints[10]
    across = across / np.sqrt((across * across).sum())
    neck = head - chest
    neck = neck / np.sqrt((neck * neck).sum())
    front = np.cross(across, neck)
    front = front / np.sqrt((front * front).sum())
    hips = joints[6] - joints[13]
    _put(capsules, 0, pelvis + 0.32 * hips, pelvis - 0.32 * hips, 0.095, 0.095)
    _put(capsules, 1, pelvis, chest - 0.14 * neck, 0.105, 0.115)
    _put(capsules, 2, chest - 0.07 * neck + 0.09 * across, chest - 0.07 * neck - 0.09 * across, 0.10, 0.10)
    _put(capsules, 3, chest, head - 0.08 * neck, 0.052, 0.05)
    _put(capsules, 4, head - 0.025 * neck + 0.01 * front, head + 0.045 * neck, 0.078, 0.086)
    _put(capsules, 5, head - 0.01 * neck + 0.06 * front, head - 0.02 * neck + 0.115 * front, 0.024, 0.016)
    _put(capsules, 6, head + 0.05 * neck - 0.02 * front, head + 0.01 * neck - 0.035 * front, 0.084, 0.074)
    for side in range(2):
        row, at = 3 + 7 * side, 7 + 6 * side
        fore = joints[row + 2] - joints[row + 1]
        fore = fore / np.sqrt((fore * fore).sum())
        _put(capsules, at, joints[row], joints[row + 1], 0.052, 0.042)
        _put(capsules, at + 1, joints[row + 1], joints[row + 2], 0.041, 0.031)
        _put(capsules, at + 2, joints[row + 2] + 0.02 * fore, joints[row + 2] + 0.10 * fore, 0.034, 0.028)
        _put(capsules, at + 3, joints[row + 3], joints[row + 4], 0.085, 0.055)
        _put(capsules, at + 4, joints[row + 4], joints[row + 5], 0.054, 0.038)
        toe = joints[row + 6]
        heel = joints[row + 5] - 0.3 * (toe - joints[row + 5])
        drop = joints[row + 5, 2] - toe[2]
        heel[2] = joints[row + 5, 2] - 0.045 + 0.3 * (drop - 0.045)
        _put(capsules, at + 5, heel, toe, 0.042, 0.035)
    return capsules


@njit(cache=True, nogil=True)
def _put(capsules, row, first, second, first_radius, second_radius):  # type: ignore[no-untyped-def]  # pragma: no cover - compiled
    capsules[row, 0:3] = first
    capsules[row, 3:6] = second
    capsules[row, 6] = first_radius
    capsules[row, 7] = second_radius
