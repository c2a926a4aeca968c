"""Contacts: intervals in which a tracked point is planted on the background."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from imitation.errors import InputError
from imitation.motion.banded import Array

Contact = tuple[int, int, ArrayLike]
"""(first frame, last frame, place (3,) in the world); both frames belong to it."""


def contact_places(contacts: Sequence[Contact], count: int, name: str) -> Array:
    """Places (n, 3) of a point in the frames of its contacts, NaN in the others.

    Raises
    ------
    InputError
        A contact is outside the clip, ends before it begins, overlaps another one or has no finite place.
    """
    places = np.full((count, 3), np.nan)
    for first, last, place in sorted(contacts, key=lambda contact: contact[0]):
        point = np.asarray(place, np.float64)
        if point.shape != (3,) or not np.isfinite(point).all():
            raise InputError(f'The contact of "{name}" from frame {first} needs a place of three finite numbers.')
        if last < first:
            raise InputError(f'The contact of "{name}" ends in frame {last}, before it begins in frame {first}.')
        if first < 0 or last >= count:
            raise InputError(
                f'The contact of "{name}" in frames {first} to {last} is outside the clip, '
                f"whose frames are 0 to {count - 1}; move or remove it."
            )
        if np.isfinite(places[first : last + 1]).any():
            raise InputError(f'Two contacts of "{name}" overlap at frame {first}; keep one of them.')
        places[first : last + 1] = point
    return places
