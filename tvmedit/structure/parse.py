"""``parse_structure``: from atom distances to clusters and textons."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Literal

import numpy as np

from imitation.errors import InputError
from tvmedit.structure.optimal import LONGEST_PERIOD, STILL, parse_optimal
from tvmedit.structure.printed import parse_printed
from tvmedit.structure.structure import Structure


def parse_structure(
    atom_distances: Any,
    *,
    method: Literal["optimal", "paper"] = "optimal",
    beta: float | None = None,
    fps: float,
    longest_period: float = LONGEST_PERIOD,
    sensitivity: float = 1.0,
    force_cyclic: bool = False,
    still: float = STILL,
    boundaries: Sequence[int] | None = None,
) -> Structure:
    """Find clusters and textons (paper B, section 4).

    Parameters
    ----------
    atom_distances : (n, n) float
        Symmetric, from ``atom_distances`` or ``yaw_free_atom_distances``.
    method : "optimal" or "paper"
        "paper": Fig. 3 with eq. 7 and 8. "optimal": the cheapest cut of the whole sequence where new motion costs and
        repetition is free.
    beta : float, optional
        Only "paper": threshold of eq. 8; default 0.55 times the median distance.
    fps : float
        Frames a second.
    longest_period : float
        Seconds; only "optimal", like all that follow.
    sensitivity : float
        1 as measured; less gives fewer clusters.
    force_cyclic : bool
        Every stretch long enough is taken as repeating, however unlike its repeats are; a sequence of one motion, or
        a cluster between the user's boundaries, in which nothing comes again is taken as one round.
    still : float
        A median distance below this is a body that hardly moves; in the unit of the distances.
    boundaries : sequence of int, optional
        The user's own first frames of clusters; textons are found inside them.

    Returns
    -------
    Structure

    Raises
    ------
    InputError
        Distances that are not a square matrix of finite numbers, or parameters out of range.
    """
    atoms = np.ascontiguousarray(atom_distances, dtype=np.float32)
    if atoms.ndim != 2 or atoms.shape[0] != atoms.shape[1] or len(atoms) == 0:
        raise InputError(f"The atom distances have shape {atoms.shape}: give a square matrix of at least one frame.")
    if not np.isfinite(atoms).all():
        raise InputError("The atom distances hold values that are not finite: compute them from finite vertices.")
    if not fps > 0 or not longest_period > 0 or not sensitivity > 0 or not np.isfinite([fps, longest_period]).all():
        raise InputError("The frame rate, the longest period and the sensitivity must be positive numbers.")
    if method == "paper":
        if boundaries is None:
            return parse_printed(atoms, beta)
        return _printed_inside(atoms, beta, boundaries)
    if method != "optimal":
        raise InputError(f'The method is {method!r}: say "optimal" or "paper".')
    return parse_optimal(
        atoms,
        float(fps),
        longest_period=longest_period,
        sensitivity=sensitivity,
        force_cyclic=force_cyclic,
        still=still,
        boundaries=boundaries,
    )


def _printed_inside(atoms: Any, beta: float | None, boundaries: Sequence[int]) -> Structure:
    """Textons as printed inside the user's clusters."""
    from tvmedit.structure.given import parse_given

    return parse_given(atoms, beta, boundaries)
