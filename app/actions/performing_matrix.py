"""The self-similarity of a sequence for the eye: a picture without marks, and single values."""

from __future__ import annotations

import attrs
import numpy as np
from numpy.typing import NDArray

from app.actions.performing_report import matrix_picture
from app.actions.session import Session
from app.formats import Picture
from app.stages.performance.results import Distances
from imitation.errors import InputError


@attrs.frozen(eq=False)
class Similarity:
    """Atom distances as a picture.

    Attributes
    ----------
    picture : (s, s, 3) uint8, dark where two moments look alike; frame 0 is at the top left.
    atoms : (n, n) float32, the distances themselves.
    """

    picture: Picture
    atoms: NDArray[np.float32]

    def __len__(self) -> int:
        return len(self.atoms)

    def distance(self, one: int, other: int) -> float:
        """How different two moments are."""
        return float(self.atoms[one, other])


def similarity(session: Session, sequence_id: str) -> Similarity:
    """Draw the self-similarity of a sequence that was compared; safe in any thread.

    Raises ``InputError`` when it was not.
    """
    found = session.ready(session.stages.distances(sequence_id))
    if not isinstance(found, Distances):
        raise InputError(f"{session.document.sequence(sequence_id).name} has not been compared yet: analyse it first.")
    return Similarity(matrix_picture(found.atoms, []), found.atoms)
