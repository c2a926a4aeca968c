"""Structure as printed: the procedure of Fig. 3 with eq. 7 and 8, frame after frame."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tvmedit.structure.structure import Cluster, Span, Structure, texton_curve

DERIVED_SHARE = 0.55
"""Beta as a share of the median atom distance where none is given: 0.07 as printed fits no histogram that was tried."""


def parse_printed(atoms: NDArray[np.floating], beta: float | None) -> Structure:
    """Follow Fig. 3.

    Decisions where the figure leaves one open: a new texton starts at a local minimum of d_A(t, t_first), seen one
    frame late, if the texton's maximum stands at least beta / 2 over it; a cluster is tested once it has two textons
    (their frames are the first reference range); a new cluster starts at the first of the two atoms of eq. 8.
    """
    n = len(atoms)
    derived = beta is None
    threshold = DERIVED_SHARE * float(np.median(atoms)) if beta is None else float(beta)
    novelty = np.full(n, np.nan)
    clusters: list[Cluster] = []
    cluster_first, texton_first = 0, 0
    textons: list[Span] = []
    highest = 0.0
    t = 1
    while t < n:
        if len(textons) >= 2:
            # d_min(t), eq. 7: the reference runs from the cluster's first atom to the last of the previous texton.
            novelty[t] = float(atoms[t, cluster_first:texton_first].min())
            if t - 1 > texton_first and novelty[t - 1] > threshold and novelty[t] > threshold:
                clusters.append(_cluster(cluster_first, t - 2, textons, novelty[t - 1], threshold, len(clusters)))
                cluster_first = texton_first = t - 1
                textons, highest = [], 0.0
        here = float(atoms[t - 1, texton_first])
        highest = max(highest, here)
        if t - 2 > texton_first:
            minimum = here < atoms[t - 2, texton_first] and here <= atoms[t, texton_first]
            if minimum and highest - here > threshold / 2:
                textons.append((texton_first, t - 2))
                texton_first, highest = t - 1, 0.0
        t += 1
    clusters.append(_cluster(cluster_first, n - 1, textons, None, threshold, len(clusters)))
    source = "derived: 0.55 times the median atom distance" if derived else "given"
    count = len(clusters)
    reason = f"{count} cluster{'s' if count > 1 else ''} with beta = {threshold:.3g} ({source})."
    found = tuple(clusters)
    return Structure(found, "paper", threshold, texton_curve(atoms, found), novelty, reason)


def _cluster(first: int, last: int, textons: list[Span], novelty: float | None, beta: float, kind: int) -> Cluster:
    inside = tuple(texton for texton in textons if texton[1] <= last)
    cyclic = len(inside) >= 2
    spans = inside or ((first, last),)
    period = float(np.median([b - a + 1 for a, b in spans]))
    if novelty is None:
        reason = "It runs to the end: no two successive atoms differ from all before by more than beta."
    else:
        reason = f"The next two atoms differ from all of it by {novelty:.3g}, more than beta = {beta:.3g}."
    return Cluster(first, last, cyclic, spans, period, kind=kind, reason=reason)
