"""A rest that is only passed through: where the action before it comes by its posture, and leaves it again.

The exact segmentation lets a rest begin with the first frames that look like it. An action that is done once may pass
through that posture (a bend comes up, sways and only then stands still): the rest begins when the posture has been
left for the last time. What moves is never passed through for long, as the direction of the movement would differ.
"""

from __future__ import annotations

import attrs
import numpy as np
from numpy.typing import NDArray

from tvmedit.structure.structure import Cluster

UNLIKE = 0.6
"""A frame this many lambda from a rest's posture does not belong to it."""
HELD = 0.4
"""A rest: half of its frames are no further than this many lambda from one posture."""
ALIKE = 1.5
"""In a rest frames half a period apart are no more unlike than so many times those a whole period apart."""
LONGEST_SECONDS = 1.0
"""So long an action may pass through the posture of the rest beside it."""


def settle(atoms: NDArray[np.float32], clusters: list[Cluster], novelty: float, fps: float) -> list[Cluster]:
    """Move the boundary between an action that is done once and a rest to where the posture is left."""
    settled = list(clusters)
    reach = round(LONGEST_SECONDS * fps)
    for k in range(1, len(settled)):
        before, after = settled[k - 1], settled[k]
        if before.cyclic == after.cyclic:
            continue
        if after.cyclic:
            frame = after.first + _passed(_away(atoms, after, novelty)[:reach], novelty)
        else:
            frame = after.first - _passed(_away(atoms, before, novelty)[::-1][:reach], novelty)
        settled[k - 1 : k + 1] = _joined_at(before, after, frame)
    return settled


def held(atoms: NDArray[np.float32], clusters: list[Cluster], novelty: float) -> list[Cluster]:
    """Make what holds a posture, or was seen once and did not come back, a motion that is played once.

    Standing repeats at any period, so its period means nothing. A slow change (from standing into a bow) is at any time
    like what was shortly before: where no two whole textons fit, it must have gone away and come back to repeat.
    """
    found = []
    for cluster in clusters:
        if _rests(atoms, cluster, novelty):
            found.append(_once(cluster, "A rest: it holds one posture, and is played once."))
        elif cluster.cyclic and len(cluster.textons) < 2 and _half_as_unlike(atoms, cluster, 1.0):
            found.append(_once(cluster, "A slow change: it does not come back to what it was, and is played once."))
        else:
            found.append(cluster)
    return found


def _rests(atoms: NDArray[np.float32], cluster: Cluster, novelty: float) -> bool:
    """Whether a cluster holds one posture, in which half a period makes no more difference than a whole one."""
    if not cluster.cyclic or not len(_away(atoms, cluster, novelty)):
        return False
    return _half_as_unlike(atoms, cluster, ALIKE)


def _half_as_unlike(atoms: NDArray[np.float32], cluster: Cluster, share: float) -> bool:
    """Whether frames half a period apart are less than ``share`` times as unlike as those a whole period apart."""
    period = round(cluster.period)
    frames = np.arange(cluster.first, cluster.last + 1 - period)
    if len(frames) < 1:
        return False
    whole, half = (float(np.median(atoms[frames, frames + lag])) for lag in (period, (period + 1) // 2))
    return half < share * whole


def _once(cluster: Cluster, reason: str) -> Cluster:
    span = (cluster.first, cluster.last)
    return attrs.evolve(cluster, cyclic=False, textons=(span,), period=float(len(cluster)), reason=reason)


def _away(atoms: NDArray[np.float32], cluster: Cluster, novelty: float) -> NDArray[np.float32]:
    """Distance of a rest's frames from its posture; nothing where it is no rest."""
    inside = atoms[cluster.first : cluster.last + 1, cluster.first : cluster.last + 1]
    posture = int(np.argmin(np.median(inside, axis=0)))
    away: NDArray[np.float32] = inside[posture]
    return away if np.median(away) < HELD * novelty else away[:0]


def _passed(away: NDArray[np.float32], novelty: float) -> int:
    """Number of frames up to half-way down from the last time the posture was left; 0 where it never was."""
    unlike = np.flatnonzero(away > UNLIKE * novelty)
    if not len(unlike):
        return 0
    last = peak = int(unlike[-1])
    while peak > 0 and away[peak - 1] >= away[peak]:
        peak -= 1
    return 0 if peak == 0 else (peak + last + 2) // 2


def _joined_at(before: Cluster, after: Cluster, frame: int) -> tuple[Cluster, Cluster]:
    """Both clusters with their boundary at a frame; unchanged where the rest would be left without a texton."""
    if frame == after.first:
        return before, after
    earlier, later = _cut(before, before.first, frame - 1), _cut(after, frame, after.last)
    return (earlier, later) if earlier.textons and later.textons else (before, after)


def _cut(cluster: Cluster, first: int, last: int) -> Cluster:
    if not cluster.cyclic:
        return attrs.evolve(cluster, first=first, last=last, textons=((first, last),), period=float(last - first + 1))
    kept = tuple(span for span in cluster.textons if first <= span[0] and span[1] <= last)
    return attrs.evolve(cluster, first=first, last=last, textons=kept)
