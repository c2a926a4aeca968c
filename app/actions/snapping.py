"""Putting a point onto the measured background: where its ray meets the surface, and how sure that is."""

from __future__ import annotations

from typing import TYPE_CHECKING

import attrs
import numpy as np
from numpy.typing import ArrayLike, NDArray

from app.actions.session import Session
from app.stages.results import PlacedContact, World
from imitation.errors import NoSolution

if TYPE_CHECKING:
    from imitation.depth import DepthMap

Array = NDArray[np.float64]
REACH = 0.03
"""Radius of the disc that shows how the surface lies, as a share of its distance."""
ASIDE = 6.0
CORNERS = 40


@attrs.frozen(eq=False)
class Snap:
    """A point on the surface.

    Attributes
    ----------
    place : (3,) world. depth : camera z, world units. residual : rms distance of the surface nearby from a plane,
        along the rays, world units.
    disc : (k, 2) picture pixels of a round that lies on the surface there, to be drawn.
    """

    place: Array
    depth: float
    residual: float
    disc: Array


def snap(surface: DepthMap, pixel: ArrayLike) -> Snap:
    """Put what is seen at a pixel (2,) of the frame of ``surface`` onto it.

    Raises ``NoSolution`` outside the picture, and where no depth is known round the pixel.
    """
    spot = np.asarray(pixel, np.float64)
    height, width = surface.depth.shape
    if not (-0.5 <= spot[0] <= width - 0.5 and -0.5 <= spot[1] <= height - 0.5):
        raise NoSolution("Outside the picture no background was measured.")
    place, residual = surface.place(spot)
    camera = surface.camera
    depth = float(camera.depth(place))
    normal = _normal(surface, spot, place)
    across = np.cross(normal, camera.R[0])
    across /= max(float(np.linalg.norm(across)), 1e-9)
    along = np.cross(across, normal)
    turn = np.linspace(0, 2 * np.pi, CORNERS)[:, None]
    disc = camera.project(place + REACH * depth * (np.cos(turn) * along + np.sin(turn) * across))
    return Snap(place, depth, residual, disc)


def _normal(surface: DepthMap, spot: Array, place: Array) -> Array:
    """Unit normal of the surface round a pixel; towards the camera where the surface ends there."""
    camera = surface.camera
    facing: Array = camera.centre - place
    facing = facing / np.linalg.norm(facing)
    try:
        sides = [surface.place(spot + step)[0] for step in ((ASIDE, 0), (-ASIDE, 0), (0, ASIDE), (0, -ASIDE))]
    except NoSolution:
        return facing
    normal: Array = np.cross(sides[0] - sides[1], sides[2] - sides[3])
    length = float(np.linalg.norm(normal))
    if length < 1e-12:
        return facing
    normal = normal / length
    return normal if normal @ facing > 0 else -normal


def distance_words(snapped: Snap, world: World) -> str:
    """How far away a point is and how sure that is, as a person reads it."""
    if world.metric:
        off = 1000 * snapped.residual
        sure = f"± {off:.0f} mm" if off < 100 else f"± {off / 10:.0f} cm"
        return f"{snapped.depth:.2f} m away  ·  {sure}"
    share = 100 * snapped.residual / max(snapped.depth, 1e-9)
    return f"{snapped.depth:.2f} units away  ·  ± {share:.1f} %"


def placed_contact(session: Session, track_id: str, frame: int) -> tuple[PlacedContact, World] | None:
    """The contact that a track has in a frame as it was placed, and the world it lies in; None where there is none."""
    world = session.ready(session.stages.world)
    found = session.ready(session.stages.contacts(track_id))
    if not isinstance(world, World) or not isinstance(found, list):
        return None
    here = next((each for each in found if each.first <= frame <= each.last), None)
    return None if here is None else (here, world)


def contact_words(session: Session, track_id: str, frame: int) -> str:
    """Where a track's contact in a frame lies and from what that is known; empty where it was not placed yet."""
    found = placed_contact(session, track_id, frame)
    if found is None:
        return ""
    contact, world = found
    depth = float(world.camera(frame).depth(contact.place))
    unit = "m" if world.metric else "units"
    off = ""
    if np.isfinite(contact.residual) and contact.residual > 0 and world.metric:
        off = f", ± {1000 * contact.residual:.0f} mm"
    how = "put there by hand" if contact.ground == "as given" else contact.ground
    return f"{depth:.2f} {unit} away{off}: {how}"


def off_words(session: Session, track_id: str, frame: int, surface: DepthMap) -> str:
    """How far a track's contact lies from the measured surface, along its ray; empty where either is not known."""
    found, pixel = placed_contact(session, track_id, frame), anchor_pixel(session, track_id, frame)
    if found is None or pixel is None:
        return ""
    contact, world = found
    try:
        there = snap(surface, pixel)
    except NoSolution:
        return ""
    away = float(surface.camera.depth(contact.place)) - there.depth
    side = "behind" if away > 0 else "before"
    if not world.metric:
        share = 100 * abs(away) / max(there.depth, 1e-9)
        return (
            f"{share:.1f} % of the distance {side} the measured surface" if share >= 0.05 else "on the measured surface"
        )
    if abs(away) < 0.0005:
        return "on the measured surface"
    return f"{1000 * abs(away):.0f} mm {side} the measured surface"


def anchor_pixel(session: Session, track_id: str, frame: int) -> tuple[float, float] | None:
    """Where the anchor of a track's contact is seen in a frame; None where it was not placed yet, or lies behind."""
    found = placed_contact(session, track_id, frame)
    if found is None:
        return None
    contact, world = found
    camera = world.camera(frame)
    if float(camera.depth(contact.place)) <= 0:
        return None
    x, y = camera.project(contact.place)
    return float(x), float(y)
