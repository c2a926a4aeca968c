"""Whether mapped key frames obey the matches of neighbouring ones: what tells a path whose scale has broken."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from imitation.geometry.projection import Array

Pose = tuple[Array, Array]
Verified = dict[tuple[int, int], tuple[Array, Array]]
"""Matches of pairs of key frames that one movement of the camera explains: places (k, 2) in both, pixels."""
Consent = Mapping[tuple[int, int], float]
"""Share of each pair's matches that obey."""

WITHIN = 3.0 / 960  # of the longest side, from its epipolar line: as matches are verified
ENOUGH = 0.8  # of a pair's matches that obey; what moves by itself and false matches are the rest
FEWEST = 30  # matches of a pair that has a say


def consent(
    focal: float, poses: Mapping[int, Pose], frames: Sequence[int], verified: Verified, centre: Array
) -> Consent:
    """Share of each pair's matches that lie on the epipolar lines of the mapped poses; pairs not posed are left out.

    Reprojection errors do not tell this: they are taken over the points that the mapper kept. Points that it threw away
    because they contradict its poses are among the matches.

    Parameters
    ----------
    poses : frame -> (R (3, 3), T (3,)), world to camera. frames : of the key frames that pairs are named by.
    centre : (2,) principal point, pixels.
    """
    back = np.linalg.inv(np.array([[focal, 0, centre[0]], [0, focal, centre[1]], [0, 0, 1.0]]))
    within = WITHIN * (2 * float(np.max(centre)) + 1)
    obeyed = {}
    for (i, j), (first, second) in verified.items():
        if frames[i] not in poses or frames[j] not in poses or len(first) < FEWEST:
            continue
        (R1, T1), (R2, T2) = poses[frames[i]], poses[frames[j]]
        turn = R2 @ R1.T
        x, y, z = T2 - turn @ T1
        across = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
        ones = np.ones((len(first), 1))
        lines = np.concatenate([first, ones], axis=1) @ (back.T @ across @ turn @ back).T
        off = np.abs((np.concatenate([second, ones], axis=1) * lines).sum(1))
        obeyed[i, j] = float((off < within * np.hypot(lines[:, 0], lines[:, 1])).mean())
    return obeyed


def least(obeyed: Consent) -> float:
    """The share of the pair that obeys least; 1 where none has a say."""
    return min(obeyed.values(), default=1.0)


def worst_pair(obeyed: Consent, verified: Verified, tried: Sequence[tuple[int, int]]) -> tuple[int, int] | None:
    """The pair with most matches that contradict the poses, away from those tried; None where none contradicts.

    Pairs of next neighbours are left out: they are too close together for a path to begin with.
    """

    def against(pair: tuple[int, int]) -> float:
        return (1 - obeyed[pair]) * len(verified[pair][0])

    open_ = [
        pair for pair in sorted(obeyed)
        if pair[1] > pair[0] + 1 and obeyed[pair] < ENOUGH
        and not any(a <= pair[1] and pair[0] <= b for a, b in tried)
    ]  # fmt: skip
    return max(open_, key=against) if open_ else None
