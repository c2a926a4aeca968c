"""Heat maps on a posed mesh: how far it is stretched, and how deep it sinks into the ground or the background."""

from __future__ import annotations

import math
from typing import Any, Literal

import attrs
import numpy as np
from numpy.typing import NDArray

from app.actions.checking import sunk_in_frame
from app.actions.session import Session
from app.stages.collision import REACH
from app.stages.results import Array, World
from imitation.errors import InputError

Kind = Literal["stretch", "sunk"]
WIDEST = 1.5
"""Lengths over that at rest, and their reciprocals, between which the colours of the stretch map run."""
DEEPEST = 0.05
"""Share of the character's height at which the colours of the other map end."""
COLD, REST, HOT = (64, 132, 220), (206, 200, 190), (232, 88, 40)
Colour = tuple[int, int, int]


@attrs.frozen(eq=False)
class Heat:
    """A coloured pose.

    Attributes
    ----------
    colours : uint8 (v, 3) sRGB. values : (v,) what they stand for.
    title, marks : the legend: (share of the bar, text) from its cold end to its hot end. ramp : colours of the bar.
    note : what the values rest on.
    """

    colours: NDArray[np.uint8]
    values: Array
    title: str
    marks: tuple[tuple[float, str], ...]
    ramp: tuple[Colour, ...]
    note: str = ""


def heat_of(session: Session, character_id: str, kind: Kind, frame: int, vertices: Array) -> Heat:
    """Colour a pose (v, 3) of a frame; may run in any thread.

    Raises ``InputError`` where the character was not placed, or no ground is known to sink into.
    """
    return (
        _stretch(session, character_id, vertices)
        if kind == "stretch"
        else _sunk(session, character_id, frame, vertices)
    )


def _rest(session: Session, character_id: str) -> tuple[Array, NDArray[np.int32]]:
    placed: Any = session.ready(session.stages.alignment(character_id))
    if placed is None:
        name = session.document.character(character_id).name
        raise InputError(f"{name} has not been placed yet: pair three points with it, or place it by hand.")
    return placed.vertices, placed.faces


def _stretch(session: Session, character_id: str, vertices: Array) -> Heat:
    from imitation.geometry.stretch import VertexStretch

    rest, faces = _rest(session, character_id)
    memory, key = session.media.memory, ("stretch", character_id)
    held = memory.get(key)
    if held is None or held[0] is not rest:
        held = memory[key] = (rest, VertexStretch(rest, faces))
    values = held[1](vertices)
    share = np.clip(np.log(values) / math.log(WIDEST), -1.0, 1.0)
    ends = ((0.0, f"{100 / WIDEST:.0f} %"), (0.5, "as at rest"), (1.0, f"{100 * WIDEST:.0f} %"))
    note = f"edges {100 * float(values.min()):.0f} to {100 * float(values.max()):.0f} % of their length"
    return Heat(_diverging(share), values, "Stretch", ends, (COLD, REST, HOT), note)


def _sunk(session: Session, character_id: str, frame: int, vertices: Array) -> Heat:
    rest, _ = _rest(session, character_id)
    world = session.ready(session.stages.world)
    if not isinstance(world, World):
        raise InputError("The ground is not known yet: run what is missing first.")
    height = float(np.ptp(rest[:, 2])) or 1.0
    deep = sunk_in_frame(session, world, frame, vertices)
    behind = _behind(session, vertices, REACH * float(np.ptp(rest, axis=0).max()))
    if deep is None and behind is None:
        raise InputError(
            "No ground is known to sink into: mark contacts, choose the ground, or measure the background."
        )
    parts = [part for part in (deep, behind) if part is not None]
    values = np.max(parts, axis=0)
    limit = DEEPEST * height
    share = np.clip(values / limit, 0.0, 1.0)
    end = f"{100 * limit:.1f} cm" if world.metric else f"{limit:.2g}"
    worst = f"{100 * float(values.max()):.1f} cm" if world.metric else f"{float(values.max()):.2g} units"
    rests = "ground and measured background" if behind is not None and deep is not None else "the measured background"
    note = f"deepest {worst}; against {rests if behind is not None else 'the ground'}"
    return Heat(_diverging(share), values, "Below the surface", ((0.0, "0"), (1.0, end)), (REST, HOT), note)


def _behind(session: Session, vertices: Array, reach: float) -> Array | None:
    """How far the pose goes into the measured background (v,), 0 where nothing is known; None without one."""
    collider = _collider(session, reach)
    return None if collider is None else np.maximum(np.nan_to_num(collider.behind(vertices)), 0.0)


def _collider(session: Session, reach: float) -> Any:
    """The measured background to be met with; the newest is kept."""
    from app.actions.scenery import background_for_view

    stages = session.stages
    if stages.depth not in session.cache:
        return None
    key = (stages.depth.key, stages.world.key, reach)
    held = session.media.memory.get("collider")
    if held is None or held[0] != key:
        from imitation.depth import Collider

        try:
            made = Collider(background_for_view(session), reach)
        except InputError:
            made = None
        held = session.media.memory["collider"] = (key, made)
    return held[1]


def _diverging(share: Array) -> NDArray[np.uint8]:
    """Colours (v, 3) of values between -1 (cold) and 1 (hot)."""
    ends = np.where(share[:, None] < 0, np.array(COLD, float), np.array(HOT, float))
    weight = np.abs(share)[:, None]
    colours: NDArray[np.uint8] = np.rint((1 - weight) * np.array(REST, float) + weight * ends).astype(np.uint8)
    return colours
