"""Where one more click helps most: which track, and which frame of it."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import pairwise

import numpy as np

from imitation.tracking.track import Track


def suggest_correction(track: Track) -> int | None:
    """Frame whose click would help most, or None where every frame is clicked or absent.

    The middle of the longest run of frames without a click: on real clips no measure of confidence picks frames
    better than that (it ranks tracks well: ``rank_tracks``). A run that is open at one side counts twice, and its
    far end is named, because it becomes a run between two clicks then. A frame where the point can be seen is
    preferred to a hidden one near by.
    """
    best: tuple[float, float, int] | None = None
    for first, last, open_start, open_end in _runs(track):
        length = last - first + 1
        if open_start or open_end:
            wanted = first if open_start else last
            weight = 2.0 * length
        else:
            wanted, weight = (first + last) // 2, float(length)
        frame = _seen_near(track, first, last, wanted)
        key = (weight, float(track.cost[first : last + 1].sum()), -frame)
        if best is None or key > best:
            best = key
    return None if best is None else -int(best[2])


def _runs(track: Track) -> list[tuple[int, int, bool, bool]]:
    """Runs of frames that have a path but no click: first, last, open at the start, open at the end."""
    here = [bool(np.isfinite(place).all()) for place in track.positions]
    clicked = np.zeros(len(track), bool)
    clicked[list(track.clicks)] = True
    runs, first = [], None
    for t in range(len(track) + 1):
        free = t < len(track) and here[t] and not clicked[t]
        if free and first is None:
            first = t
        elif not free and first is not None:
            before, after = first > 0 and clicked[first - 1], t < len(track) and clicked[t]
            runs.append((first, t - 1, not before, not after))
            first = None
    return runs


def _seen_near(track: Track, first: int, last: int, wanted: int) -> int:
    reach = max(1, (last - first + 1) // 3)
    frames = np.arange(first, last + 1)
    seen = frames[(track.state[first : last + 1] == "visible") & (np.abs(frames - wanted) <= reach)]
    return wanted if not len(seen) else int(seen[np.argmin(np.abs(seen - wanted))])


def rank_tracks(tracks: Mapping[str, Track]) -> list[str]:
    """Names of the tracks, the one that most needs a correction first.

    By the cost of the dearest span, which tells good tracks from bad ones best; only tracks of one mode compare.
    """

    def dearest(track: Track) -> float:
        marks = sorted({0, len(track), *track.clicks})
        sums = [float(track.cost[a + 1 : b + 1].sum()) for a, b in pairwise(marks)]
        return max(sums, default=0.0)

    return sorted(tracks, key=lambda name: (-dearest(tracks[name]), name))
