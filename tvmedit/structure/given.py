"""Printed textons inside boundaries that the user gave."""

from __future__ import annotations

from collections.abc import Sequence

import attrs
import numpy as np
from numpy.typing import NDArray

from imitation.errors import InputError
from tvmedit.structure.printed import DERIVED_SHARE, parse_printed
from tvmedit.structure.structure import Cluster, Structure, texton_curve


def parse_given(atoms: NDArray[np.floating], beta: float | None, boundaries: Sequence[int]) -> Structure:
    """Textons of Fig. 3 in each of the user's clusters; eq. 8 is not asked."""
    n = len(atoms)
    starts = sorted({0, *(int(frame) for frame in boundaries)})
    if starts[0] < 0 or starts[-1] >= n:
        raise InputError(
            f"The boundaries {list(boundaries)} leave the sequence of {n} frames: give frames 1 to {n - 1}."
        )
    threshold = DERIVED_SHARE * float(np.median(atoms)) if beta is None else float(beta)
    clusters: list[Cluster] = []
    for first, stop in zip(starts, [*starts[1:], n], strict=True):
        inner = parse_printed(atoms[first:stop, first:stop], threshold)
        textons = tuple(
            (a + first, b + first) for cluster in inner.clusters if cluster.cyclic for a, b in cluster.textons
        )
        spans = textons or ((first, stop - 1),)
        period = float(np.median([b - a + 1 for a, b in spans]))
        reason = "Its ends were set by hand."
        clusters.append(Cluster(first, stop - 1, bool(textons), spans, period, kind=len(clusters), reason=reason))
    found = tuple(attrs.evolve(cluster) for cluster in clusters)
    reason = f"{len(found)} clusters set by hand, textons with beta = {threshold:.3g}."
    return Structure(found, "paper", threshold, texton_curve(atoms, found), np.full(n, np.nan), reason)
