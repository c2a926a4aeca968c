"""How right is a structure: precision and recall of boundaries (Fig. 5), and textons against a known phase."""

from __future__ import annotations

from collections.abc import Sequence

import attrs
import numpy as np
from numpy.typing import NDArray

from tvmedit.structure.structure import Structure


@attrs.frozen
class Agreement:
    """Boundaries found against boundaries labelled, matched one to one within a tolerance."""

    matched: int
    found: int
    labelled: int

    @property
    def precision(self) -> float:
        """Share of the found boundaries that are right; 1 where none is found."""
        return self.matched / self.found if self.found else 1.0

    @property
    def recall(self) -> float:
        """Share of the labelled boundaries that are found; 1 where none is labelled."""
        return self.matched / self.labelled if self.labelled else 1.0

    @property
    def f_score(self) -> float:
        """Harmonic mean of precision and recall."""
        total = self.found + self.labelled
        return 2 * self.matched / total if total else 1.0

    def __add__(self, other: Agreement) -> Agreement:
        """Pool two sequences."""
        return Agreement(self.matched + other.matched, self.found + other.found, self.labelled + other.labelled)


def compare_boundaries(found: Sequence[int], labelled: Sequence[int], *, tolerance: float = 5) -> Agreement:
    """Match boundaries one to one, as many as possible, within a tolerance in frames."""
    matched, j = 0, 0
    wanted = sorted(labelled)
    for frame in sorted(found):
        while j < len(wanted) and wanted[j] < frame - tolerance:
            j += 1
        if j < len(wanted) and abs(wanted[j] - frame) <= tolerance:
            matched += 1
            j += 1
    return Agreement(matched, len(set(found)), len(set(labelled)))


def texton_errors(structure: Structure, part: NDArray[np.int64], phase: NDArray[np.float64]) -> NDArray[np.float64]:
    """Error of each texton's length against a known phase.

    Parameters
    ----------
    structure : Structure
    part : (n,) int
        Which motion a frame belongs to.
    phase : (n,) float
        Phase of that motion, growing by 1 a period.

    Returns
    -------
    (k, 2) float64
        Of each texton of a cyclic cluster that lies inside one motion: how much more or less than one period the true
        motion advances over it, and the frame step in periods (no texton can be right to less than a frame).
    """
    errors = []
    for cluster in structure.clusters:
        if not cluster.cyclic:
            continue
        for first, last in cluster.textons:
            if part[first] != part[last]:
                continue
            advance = phase[last] - phase[first]
            step = advance / max(last - first, 1)
            errors.append((advance + step - 1.0, step))
    return np.array(errors, np.float64).reshape(-1, 2)
