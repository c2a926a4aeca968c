"""From the cameras' own world to the user's: what is up, where the ground lies, how long a metre is."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import attrs
import numpy as np

from app.model.tracks import Contact
from app.model.world import WorldChoice
from app.stages.assumed import ASSUMED_DEPTH, assumed_ground, held_up, known_length
from app.stages.assumed import assumes as _assumes
from app.stages.assumed import held as _held
from app.stages.results import Array, PlacedContact, World
from imitation import CameraPath
from imitation.errors import InputError, NoSolution

if TYPE_CHECKING:
    from imitation.depth import Background

STRAYS = 0.04
"""Residual, as a share of the distance, from which on the measured background is not believed under a contact."""
UNLIKE = 2.0
"""Factor between the depths of measured background and local ground from which on the former is not believed."""
SOUNDINGS = 5
"""Frames of a contact in which the background under it is asked."""
FIRM = 0.5
"""A local ground that fewer of the points nearby speak for is not believed against the other contacts."""
APART = 0.08
"""How far, of its depth, a foot may be from the others before it is taken for misplaced."""


def make_world(choice: WorldChoice, path: CameraPath, marked: Sequence[Any] = ()) -> World:
    """Level the world on its ground, put the ground at height 0, scale it by a known length.

    ``marked`` are the two tracks of a length that is seen between tracks.

    Raises ``InputError`` when the user's choice does not fit the cameras.
    """
    if path.verdict == "failed":
        raise InputError(f"The cameras could not be solved: {path.reason}")
    from imitation.cameras import world_from_ground

    plane, found = _plane(choice, path)
    known = known_length(choice, path, plane, marked)
    length = None if known is None else known[:3]
    depth = None
    if plane is not None:
        recovered = None if length is not None or _assumes(choice, path) else choice.height
        scale, rotation, translation = world_from_ground(plane, path, length=length, camera_height=recovered)
    else:
        scale = 1.0 if length is None else length[2] / float(np.linalg.norm(np.subtract(length[1], length[0])))
        rotation, translation = _without_ground(choice, path), np.zeros(3)
        depth = choice.depth or ASSUMED_DEPTH * scale
    cameras = path.transformed(scale, rotation, translation)
    normal = np.array([0.0, 0.0, 1.0])
    metric = length is not None or (plane is not None and choice.height is not None)
    by = "the camera's height" if known is None else f"a length {known[3]}"
    notes = [found, f"in metres by {by}" if metric else "the scale is unknown", path.reason]
    return World(
        cameras,
        scale,
        rotation,
        translation,
        normal,
        0.0,
        metric=metric,
        levelled=plane is not None or choice.from_above or _held(choice) or path.verdict != "static",
        grounded=plane is not None,
        depth=depth,
        note="; ".join(note for note in notes if note),
    )


def depth_anchors(track: Any, world: World) -> list[PlacedContact]:
    """Give a track's 3D places under the assumption of constant depth (the paper's salamander, section 4).

    They are contacts of one frame in every other frame: known places of a point that moves on, where a contact of
    several frames would make it stand still.
    """
    from imitation.cameras import constant_depth

    depth = world.depth or ASSUMED_DEPTH
    ground = constant_depth(depth)
    anchors = []
    for frame in range(0, len(track.positions), 2):
        if np.isfinite(track.positions[frame]).all():
            place = ground.intersect(world.cameras[frame], track.positions[frame])
            anchors.append(PlacedContact(frame, frame, place, ground.name, float("nan")))
    return anchors


def place_contact(contact: Contact, name: str, track: Any, choice: WorldChoice, world: World) -> PlacedContact:
    """Put a contact where its point's rays meet the ground (paper A, 3.2); it stands still, so the mean place counts.

    Raises ``InputError`` when the track is not there during the contact, or no ray meets a ground.
    """
    first, last = contact.span.first, contact.span.last
    if contact.place is not None:
        return PlacedContact(first, last, np.array(contact.place), "as given", 0.0)
    frames = [t for t in range(first, last + 1) if np.isfinite(track.positions[t]).all()]
    if not frames:
        raise InputError(
            f"{name} is not in the picture in frames {first}-{last}, where it is said to touch the ground: "
            "move the contact or click the point there."
        )
    # It stands still, so the frames in which the track is sure of it say where; near a click it is surest.
    sure = 0.7 * max(track.confidence[t] for t in frames)
    frames = [t for t in frames if track.confidence[t] >= sure]
    # The foot may hide the ground in one frame and show it in another: the best supported of some frames counts.
    tried = sorted({frames[round(share * (len(frames) - 1))] for share in (0.0, 0.25, 0.5, 0.75, 1.0)})
    grounds = [ground_under(choice, world, frame, track.positions[frame]) for frame in tried]
    ground = max(grounds, key=_support)
    places = []
    for frame in frames:
        try:
            places.append(ground.intersect(world.cameras[frame], track.positions[frame]))
        except NoSolution:
            continue
    if not places:
        raise InputError(
            f"{name} does not meet the ground in frames {first}-{last} ({ground.name}): "
            "choose another ground, or say where it touches."
        )
    place = np.median(np.array(places), axis=0)
    return PlacedContact(first, last, place, ground.name, float(ground.residual), _support(ground))


def place_on_background(
    contact: Contact, name: str, track: Any, choice: WorldChoice, world: World, known: Background
) -> PlacedContact:
    """Put a contact where its point's rays meet the measured background; where that has no depth, on the local ground.

    The residual is how far the background near it strays from a plane, and the places of its frames from their median.

    Raises ``InputError`` when the track is not there during the contact, or no ground is found at all.
    """
    first, last = contact.span.first, contact.span.last
    frames = [t for t in range(first, last + 1) if np.isfinite(track.positions[t]).all()]
    if contact.place is not None or not frames:
        return place_contact(contact, name, track, choice, world)
    surest = sorted(frames, key=lambda t: (-round(float(track.confidence[t]), 2), abs(2 * t - first - last)))[
        :SOUNDINGS
    ]
    places, asked, off, reason = [], [], [], ""
    for frame in sorted(surest):
        try:
            place, residual = known.place(frame, track.positions[frame])
        except NoSolution as refusal:
            reason = str(refusal)
            continue
        if residual > STRAYS * float(world.cameras[frame].depth(place)):
            reason = "The measured background strays there."
            continue
        places.append(place)
        asked.append(frame)
        off.append(residual)
    if places:
        place = np.median(np.array(places), axis=0)
        apart = _differing(np.array(places), asked, track, choice, world)
        residual = float(np.sqrt(np.mean(np.square(off)) + np.mean(np.square(apart))))
        found = PlacedContact(first, last, place, "the measured background", residual)
        camera = world.cameras[frames[0]]
        if residual <= STRAYS * float(camera.depth(place)):
            try:
                instead = place_contact(contact, name, track, choice, world)
            except InputError:
                return found
            # What stays hidden through the clip may be measured as the sky beside it: the points nearby know better.
            if 1 / UNLIKE < float(camera.depth(place)) / float(camera.depth(instead.place)) < UNLIKE:
                return found
            reason = "The measured background is far from the recovered points there."
        else:
            reason = "The measured background differs from frame to frame there."
    instead = place_contact(contact, name, track, choice, world)
    return attrs.evolve(instead, ground=f"{instead.ground}, for {reason[0].lower()}{reason[1:].rstrip('.')}")


def _differing(places: Array, frames: Sequence[int], track: Any, choice: WorldChoice, world: World) -> Array:
    """How far the places (k, 3) of a contact's frames differ, world units: along their rays, beside the local ground.

    A foot that slides, or whose point was not marked exactly, moves its place too; that says nothing of the background.
    """
    middle = frames[len(frames) // 2]
    cameras, share = [world.cameras[frame] for frame in frames], np.ones(len(places))
    try:
        ground = ground_under(choice, world, middle, track.positions[middle])
        for k, (frame, camera) in enumerate(zip(frames, cameras, strict=True)):
            beside = float(camera.depth(ground.intersect(camera, track.positions[frame])))
            share[k] = float(camera.depth(places[k])) / beside
    except NoSolution:
        strayed: Array = np.linalg.norm(places - np.median(places, axis=0), axis=1)
        return strayed
    differing: Array = np.abs(share / np.median(share) - 1) * [
        float(c.depth(p)) for c, p in zip(cameras, places, strict=True)
    ]
    return differing


def agreed(
    found: dict[str, list[PlacedContact]], tracks: Mapping[str, Any], world: World
) -> dict[str, list[PlacedContact]]:
    """Put weakly supported contacts that disagree with all others where the others say the subject is.

    The feet of one subject stand within a body's length of each other. A contact on few points whose depth is far from
    the depths of the contacts around it in time was taken from something behind or before the subject; it goes to their
    depth on its own ray.
    """
    contacts = [(name, contact) for name, each in found.items() for contact in each]
    firm = [contact for _, contact in contacts if contact.support >= FIRM]
    if world.depth is not None or len(firm) < 3:
        return found
    times = np.array([(contact.first + contact.last) / 2 for contact in firm])
    depths = np.array([float(world.cameras[int(t)].depth(c.place)) for t, c in zip(times, firm, strict=True)])
    mended: dict[str, list[PlacedContact]] = {name: [] for name in found}
    for name, contact in contacts:
        middle = (contact.first + contact.last) // 2
        near = np.argsort(np.abs(times - middle), kind="stable")[:4]
        expected = float(np.median(depths[near]))
        own = float(world.cameras[middle].depth(contact.place))
        if contact.support < FIRM and abs(own - expected) > APART * expected:
            pixel = tracks[name].positions[middle]
            place = world.cameras[middle].lift(pixel, np.array(expected))
            reason = f"the depth of the other feet, for {contact.ground} disagrees with them"
            contact = PlacedContact(contact.first, contact.last, place, reason, float("nan"), contact.support)
        mended[name].append(contact)
    return mended


def _support(ground: Any) -> float:
    """Share of the points nearby that speak for a local fit; 1 for a ground that does not rest on points nearby."""
    plane = ground.plane
    if ground.name.startswith("wide fit"):
        return FIRM
    if plane is None or not ground.name.startswith(("level local", "tilted local")) or not len(plane.used):
        return 1.0
    return float(plane.used.mean())


def _plane(choice: WorldChoice, path: CameraPath) -> tuple[Any, str]:
    """Give the ground plane in the cameras' world, None where there is none, and how it was found."""
    from imitation.cameras import plane_ground
    from imitation.cameras.levels import recovered_ground

    if choice.ground == "depth":
        return None, "a constant depth is assumed"
    if choice.ground == "plane" and choice.plane_points:
        ground = plane_ground(choice.plane_points)
        return ground.plane, ground.name
    if _assumes(choice, path):
        return assumed_ground(choice, path)
    if len(path.points) < 3:
        if choice.ground == "plane":
            raise InputError("There are no recovered points to lay a plane through: assume a constant depth instead.")
        return None, "no ground is known, a constant depth is assumed"
    try:
        ground = recovered_ground(path)
    except NoSolution:
        return None, "no level ground was found, a constant depth is assumed"
    # A camera held by hand is level sideways, but its pitch is open: the ground says more of what is up.
    return ground.plane, ground.name


def ground_under(choice: WorldChoice, world: World, frame: int, pixel: Array) -> Any:
    """What a point seen at a pixel would stand on, by the user's choice: a ``Ground`` with its name."""
    from imitation.cameras import Ground, Plane, constant_depth
    from imitation.cameras.standing import standing_ground

    if world.depth is not None:
        return constant_depth(world.depth)
    plane = Ground("the ground plane", plane=Plane(world.normal, world.offset))
    if choice.ground == "plane":
        return plane
    try:
        return standing_ground(world.cameras.points, world.cameras, frame, pixel, up=world.normal)
    except NoSolution as reason:
        return attrs.evolve(plane, name=f"the ground plane, for {str(reason)[0].lower()}{str(reason)[1:].rstrip('.')}")


def _without_ground(choice: WorldChoice, path: CameraPath) -> Array:
    """The rotation to Z up where no ground is known: as the user says that the camera is held."""
    if choice.from_above:
        # The direction towards the first camera is up, picture up the world's +Y.
        right, down, forward = path.R[0]
        return np.stack([right, -down, -forward])
    if _held(choice):
        from imitation.cameras.world import rotation_to_z

        return rotation_to_z(held_up(choice, path))
    return np.eye(3)
