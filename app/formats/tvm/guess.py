"""What files do not say: frame rate, up axis, unit. Guessed from a few frames, and named as guesses."""

from __future__ import annotations

from typing import Literal

import attrs
import numpy as np
from numpy.typing import NDArray

from app.formats.meshfile import Up
from app.formats.tvm.frames import MeshFrames

FPS = 25.0
LOOKED_AT = 5
STANDING = 1.6
"""Height over depth from which a body is taken to stand along z."""
PERSON = 1.7
"""Metres."""


@attrs.frozen
class Guess:
    """Facts of a sequence, stated or guessed.

    Attributes
    ----------
    fps, up, unit : as in ``CapturedSequence``.
    guessed : which of them the files do not say.
    why : sentences on the guesses and on what was chosen, empty where nothing was.
    """

    fps: float
    up: Up
    unit: float
    guessed: tuple[Literal["fps", "up", "unit"], ...]
    why: str


def guess_facts(
    frames: MeshFrames, *, fps: float | None = None, up: Up | None = None, unit: float | None = None
) -> Guess:
    """Take what the user says, else what the files say, else guess.

    Up: y as most programs have it, or z where the body is more than 1.6 times as long along it. Unit: metres,
    centimetres or millimetres, whichever brings the body nearest to a person's height.
    """
    guessed: list[Literal["fps", "up", "unit"]] = []
    words: list[str] = []
    rate = fps if fps is not None else float(frames.fps) if frames.fps is not None else None
    if rate is None:
        rate = FPS
        guessed.append("fps")
        words.append(f"{FPS:g} frames a second")
    axis, metres = up or frames.up, unit or frames.unit
    if axis is None or metres is None:
        looked = np.unique(np.linspace(0, len(frames) - 1, min(LOOKED_AT, len(frames))).round().astype(int))
        ends = np.array([[mesh.min(axis=0), mesh.max(axis=0)] for mesh in (frames[int(k)].vertices for k in looked)])
        if axis is None:
            axis = _up(ends)
            guessed.append("up")
            words.append(f"{axis.upper()} up")
        if metres is None:
            height = float(np.median(ends[:, 1, 1 if axis == "y" else 2] - ends[:, 0, 1 if axis == "y" else 2]))
            metres, named = _unit(height)
            guessed.append("unit")
            words.append(named)
    why = f"Guessed for {frames.name}: {', '.join(words)}; say so if it is otherwise." if words else ""
    return Guess(float(rate), axis, float(metres), tuple(guessed), f"{why} {frames.remark}".strip())


def _up(ends: NDArray[np.float64]) -> Up:
    """Y as most programs have it, unless the body stands along z: an animal may be longer than it is high."""
    extents = np.median(ends[:, 1] - ends[:, 0], axis=0)
    return "z" if extents[2] > STANDING * extents[1] else "y"


def _unit(height: float) -> tuple[float, str]:
    """The unit that brings the body nearest to a person's height, counted in powers of ten."""
    units = ((1.0, "metres"), (0.01, "centimetres"), (0.001, "millimetres"))
    return min(units, key=lambda unit: abs(np.log(max(height * unit[0], 1e-300) / PERSON)))
