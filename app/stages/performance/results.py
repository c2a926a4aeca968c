"""Results of performance stages where no engine type fits."""

from __future__ import annotations

from typing import TYPE_CHECKING

import attrs
import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    # Only names: the engine loads slowly, and the window opens without it.
    from tvmedit.cuts import Blend, Seam
    from tvmedit.graph import Performance
    from tvmedit.measuring import Measurement


@attrs.frozen(eq=False)
class Statistics:
    """What a sequence holds; lengths in metres.

    Attributes
    ----------
    frames, seconds : how much there is.
    vertices, faces : least, median and most a frame.
    moving : whether all frames have the same faces.
    coloured, textured : so many frames have colours, pictures.
    low, high : corners (x, y, z) of the box around all frames.
    height : body height that features are normalised by.
    """

    frames: int
    seconds: float
    vertices: tuple[int, int, int]
    faces: tuple[int, int, int]
    moving: bool
    coloured: int
    textured: int
    low: tuple[float, ...]
    high: tuple[float, ...]
    height: float


@attrs.frozen(eq=False)
class Measured:
    """What one pass over a sequence leaves."""

    measurement: Measurement
    statistics: Statistics


@attrs.frozen(eq=False)
class Distances:
    """Frame distances (eq. 2) and atom distances (eq. 5), each (n, n) float32."""

    frames: NDArray[np.float32]
    atoms: NDArray[np.float32]


@attrs.frozen(eq=False)
class Assembled:
    """A performance with every clip in its place.

    Attributes
    ----------
    performance : aligned, unless the user wants it as filmed.
    seams : score of every joint, without blends.
    """

    performance: Performance
    seams: tuple[Seam, ...]


@attrs.frozen(eq=False)
class Blended:
    """The in-betweens of a performance.

    Attributes
    ----------
    blends : one a cut that was looked at; those that were refused are empty and say why.
    """

    blends: tuple[Blend, ...]
