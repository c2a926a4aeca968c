"""The motion database: one representative texton of each cluster (paper B, section 5)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import attrs
import numpy as np
from numpy.typing import NDArray

from imitation.errors import InputError
from tvmedit.analysis import Analysis
from tvmedit.structure import Cluster
from tvmedit.structure.structure import Span

Textons = Mapping[tuple[int, int], int] | Sequence[tuple[int, int, int]]


@attrs.frozen
class Node:
    """A motion of the database.

    Attributes
    ----------
    sequence : int
        Which analysis it comes from.
    first, last : int
        Its frames there, both included.
    cyclic : bool
        Whether it can be repeated, entered and left anywhere; one that is not is played from first to last.
    cluster : int
        Number of its cluster in the sequence; -1 for one given by its frames that lies in none.
    wrap : float
        How well it repeats: distance of its first atom to the one after its last (as printed: to its last).
    """

    sequence: int
    first: int
    last: int
    cyclic: bool
    cluster: int = -1
    wrap: float = 0.0

    def __len__(self) -> int:
        return self.last - self.first + 1


def texton_distance(atoms: NDArray[np.floating], texton: Span, *, printed: bool) -> float:
    """How smoothly a texton repeats.

    Eq. 6 compares first and last atom, one frame apart even in a perfect loop; the successor rule compares the first
    with the frame after the last, which is what the first replaces.
    """
    first, last = texton
    after = last if printed else min(last + 1, len(atoms) - 1)
    return float(atoms[first, after])


def representative(atoms: NDArray[np.floating], cluster: Cluster, *, printed: bool) -> int:
    """Number of the texton that repeats most smoothly (eq. 9); of equal ones the first.

    One that ends with the sequence has no frame after it to be laid onto: another one is taken if there is any.
    """
    distances = np.array([texton_distance(atoms, texton, printed=printed) for texton in cluster.textons])
    followed = np.array([last + 1 < len(atoms) for _, last in cluster.textons])
    if not printed and followed.any():
        distances[~followed] = np.inf
    return int(np.argmin(distances))


def database(analyses: Sequence[Analysis], *, printed: bool, textons: Textons | None) -> tuple[Node, ...]:
    """Nodes of all sequences in order.

    ``textons`` is the user's own choice: {(sequence, cluster): number of the texton}, the others chosen by eq. 9; or
    the nodes themselves as (sequence, first, last).
    """
    if textons is not None and not isinstance(textons, Mapping):
        return tuple(_given(analyses, item, printed) for item in textons)
    chosen: dict[tuple[int, int], int] = dict(textons or {})
    nodes = []
    for sequence, analysis in enumerate(analyses):
        for number, cluster in enumerate(analysis.structure.clusters):
            best = chosen.pop((sequence, number), None)
            if best is None:
                best = representative(analysis.atom_distances, cluster, printed=printed)
            if not 0 <= best < len(cluster.textons):
                count = len(cluster.textons)
                raise InputError(f"Cluster {number} of sequence {sequence} has {count} textons: no texton {best}.")
            first, last = cluster.textons[best]
            wrap = texton_distance(analysis.atom_distances, (first, last), printed=printed)
            nodes.append(Node(sequence, first, last, cluster.cyclic, number, wrap))
    if chosen:
        sequence, number = next(iter(chosen))
        raise InputError(f"There is no cluster {number} in sequence {sequence}: choose textons of clusters that exist.")
    return tuple(nodes)


def _given(analyses: Sequence[Analysis], item: Any, printed: bool) -> Node:
    """A node by its frames: it repeats if it is a texton of a cyclic cluster."""
    try:
        sequence, first, last = (int(value) for value in item)
    except (TypeError, ValueError):
        raise InputError(f"The texton {item!r} is not (sequence, first, last): give three whole numbers.") from None
    if not 0 <= sequence < len(analyses):
        raise InputError(f"There is no sequence {sequence}: there are {len(analyses)}.")
    analysis = analyses[sequence]
    if not 0 <= first <= last < len(analysis):
        raise InputError(f"Frames {first} to {last} are not in sequence {sequence}, which has {len(analysis)} frames.")
    for number, cluster in enumerate(analysis.structure.clusters):
        if cluster.first <= first and last <= cluster.last:
            wrap = texton_distance(analysis.atom_distances, (first, last), printed=printed)
            return Node(sequence, first, last, cluster.cyclic, number, wrap)
    return Node(sequence, first, last, False)
