"""What the user says, or the program assumes, where the pictures do not tell: horizon, camera height, a length."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from app.model.world import SeenLength, WorldChoice
from app.stages.results import Array
from imitation import CameraPath
from imitation.errors import InputError, NoSolution

ASSUMED_DEPTH = 5.0
ASSUMED_HEIGHT = 1.6
STILL = 3.0
"""Pixels by which the track of a point that stands still may stray from its place."""
TURN = 0.02
"""Angle, radians, between the rays of a point's first and last frame that locates it."""

Length = tuple[Array, Array, float, str]
"""Two places (3,) in the cameras' own world, metres between them, how they were found."""


def assumes(choice: WorldChoice, path: CameraPath) -> bool:
    """Whether a ground is assumed: without parallax any height fits the pictures and sets the scale."""
    return (
        choice.ground == "plane"
        and not choice.plane_points
        and len(path.points) < 3
        and path.verdict in ("rotation", "static")
        and not choice.from_above
    )


def held(choice: WorldChoice) -> bool:
    """Whether the user says how the camera is held."""
    return choice.pitch is not None or choice.roll != 0


def held_up(choice: WorldChoice, path: CameraPath) -> Array:
    """Up (3,) in the cameras' own world, from the pitch and roll of the camera in frame 0."""
    pitch, roll = np.radians(choice.pitch or 0.0), np.radians(choice.roll)
    own = np.array([-np.sin(roll) * np.cos(pitch), -np.cos(roll) * np.cos(pitch), -np.sin(pitch)])
    up: Array = path.R[0].T @ own
    return up


def assumed_ground(choice: WorldChoice, path: CameraPath) -> tuple[Any, str]:
    """A level ground under a camera that does not move, and what of it is assumed."""
    from imitation.cameras import Plane

    told = held(choice)
    up = held_up(choice, path) if told else np.array([0.0, 0.0, 1.0])
    height = choice.height or ASSUMED_HEIGHT
    plane = Plane(up, float(path.centres.mean(axis=0) @ up) - height)
    camera = f"a camera tilted by {choice.pitch or 0:g} degrees" if told else "a level camera"
    if choice.height is not None:
        return plane, f"a level ground {height:g} m under {camera}" + ("" if told else ", whose tilt is assumed")
    return plane, f"a level ground {height:g} m under {camera} is assumed"


def known_length(choice: WorldChoice, path: CameraPath, plane: Any, marked: Sequence[Any]) -> Length | None:
    """Give the places of a known length; ``marked`` are its two tracks, if it has any.

    Raises ``InputError`` when nothing says how far away its ends are.
    """
    if choice.length is not None:
        length = choice.length
        return np.array(length.first), np.array(length.second), length.metres, "between two places"
    seen = choice.seen
    if seen is None:
        return None
    if len(marked) == 2 and len(path.points):
        located = [_located(track, path) for track in marked]
        if located[0] is not None and located[1] is not None:
            return located[0], located[1], seen.metres, "between two points that stand still"
    from imitation.cameras.segment import seen_segment

    first, second = (_pixel(seen, k, marked) for k in (0, 1))
    try:
        ends = seen_segment(path, seen.frame, first, second, plane=plane, depth=choice.depth or ASSUMED_DEPTH)
    except NoSolution as reason:
        raise InputError(str(reason)) from reason
    return ends[0], ends[1], seen.metres, ends[2]


def _pixel(seen: SeenLength, end: int, marked: Sequence[Any]) -> Array:
    """Where an end is in its frame: on its track, as far as that is there; else where it was said to be."""
    said = np.array((seen.first, seen.second)[end])
    if len(marked) == 2 and np.isfinite(marked[end].positions[seen.frame]).all():
        return np.asarray(marked[end].positions[seen.frame], np.float64)
    return said


def _located(track: Any, path: CameraPath) -> Array | None:
    """The place (3,) of a point that stands still while the camera moves; None where it moves or is seen from one side.

    The sure frames of its track count.
    """
    from imitation.motion.proposals import StillPoint

    positions = np.array(track.positions, np.float64)
    positions[np.asarray(track.confidence) < 0.5 * np.nanmax(track.confidence)] = np.nan
    frames = np.flatnonzero(np.isfinite(positions).all(axis=1))
    if len(frames) < 2:
        return None
    chosen = CameraPath(path.K[frames], path.R[frames], path.T[frames], path.verdict)
    fit = StillPoint(positions[frames], chosen, None)
    place = fit.place(0, len(frames) - 1)
    if fit.off(0, len(frames) - 1, place) > STILL:
        return None
    sight = place - chosen.centres
    sight = sight / np.linalg.norm(sight, axis=1, keepdims=True)
    wide = float(np.arccos(np.clip(sight @ sight[0], -1, 1)).max())
    return place if wide > TURN else None
