"""By how much one side of a body is later than the other: half a stride in a walk, nothing in a bound."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from imitation.motion.banded import Array

FEWEST, SHARE = 8, 0.25
"""Frames, and share of the clip, in which both sides must be seen to be compared."""
ALIKE = 0.6
"""Largest rms difference of the two sides, of their own motion, that counts as the same motion."""
LONGER = 0.3
"""What a lag of the whole clip has to fit better by: of two lags that fit alike the shorter one is meant."""


def measured_lag(own: Array, mirror: Array, seen: NDArray[np.bool_], mirror_seen: NDArray[np.bool_]) -> int | None:
    """Frames by which a limb is later than its mirror's image, from the frames in which both are seen.

    Parameters
    ----------
    own : (n, 3) the limb in the body's own frame. mirror : (n, 3) its mirror, reflected, in the same frame.
    seen, mirror_seen : (n,) where their places are observed.

    Returns
    -------
    The lag, None where too little is seen of both, where they hardly move or where no lag makes them alike.
    """
    count = len(own)
    best: tuple[float, int] | None = None
    for lag in range(-(count // 2), count // 2 + 1):
        frames = np.arange(max(0, lag), min(count, count + lag))
        frames = frames[seen[frames] & mirror_seen[frames - lag]]
        if len(frames) < max(FEWEST, SHARE * count):
            continue
        first, second = own[frames], mirror[frames - lag]
        motion = 0.5 * (first.var(axis=0).sum() + second.var(axis=0).sum())
        if motion <= 0:
            continue
        apart = float(np.sqrt((first - second).var(axis=0).sum() / motion))
        worth = apart * (1 + LONGER * abs(lag) / count)
        if apart < ALIKE and (best is None or worth < best[0]):
            best = (worth, lag)
    return None if best is None else best[1]


def agreed_lags(given: Mapping[str, int | None], measured: Mapping[str, int | None]) -> dict[str, int]:
    """The lag of every mirrored limb: as given, else measured, else as large as that of the body's other limbs, else 0.

    A limb that is never seen beside its mirror shares the gait of the others; half a stride later and half a stride
    earlier are the same place in a cycle, so their size is what counts.
    """
    known = [abs(lag) for name in given if (lag := given[name] if given[name] is not None else measured.get(name))]
    still = [name for name in given if (given[name] if given[name] is not None else measured.get(name)) == 0]
    usual = int(np.median(known)) if len(known) > len(still) else 0
    lags = {}
    for name, lag in given.items():
        found = measured.get(name)
        lags[name] = lag if lag is not None else found if found is not None else usual
    return lags
