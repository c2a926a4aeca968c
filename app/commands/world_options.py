"""Options of ``set`` that say what is up, where the ground lies and how long a metre is."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import click

from app.actions import marks
from app.actions.session import Session
from app.model.edits import scene
from app.model.world import KnownLength, SeenLength

_OPTIONS = (
    click.option(
        "--ground",
        type=click.Choice(["local", "background", "plane", "depth"]),
        help="Where contacts lie: on the recovered points near each, on the measured background, on one plane, or at a "
        "constant depth.",
    ),
    click.option("--from-above", is_flag=True, help="The camera looks down on the subject."),
    click.option(
        "--depth-of", multiple=True, help="Track kept at constant depth, with --ground depth; may be given again."
    ),
    click.option("--depth", type=float, help="That depth, metres."),
    click.option(
        "--pitch",
        type=float,
        help="Degrees by which a camera that only turns, or stands still, looks below the horizon in frame 0. "
        "Without it the camera is taken as level.",
    ),
    click.option("--roll", type=float, help="Degrees by which it is turned clockwise in frame 0 (0)."),
    click.option(
        "--camera-height",
        type=float,
        help="Metres from the ground to the first camera: a known length. Where nothing else is known, "
        "1.6 m is assumed.",
    ),
    click.option(
        "--length",
        "lengths",
        nargs=4,
        type=(str, str, int, float),
        multiple=True,
        help="NAME NAME FRAME METRES: the distance of two tracked points in a frame.",
    ),
    click.option(
        "--length-pixels",
        nargs=6,
        type=(int, float, float, float, float, float),
        help="FRAME X Y X Y METRES: the length of a thing between two pixels.",
    ),
    click.option(
        "--length-places",
        nargs=7,
        type=float,
        help="X Y Z X Y Z METRES: the distance of two places, in the units of the solved cameras.",
    ),
)


def world_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add the options to a verb."""
    for option in reversed(_OPTIONS):
        command = option(command)
    return command


def set_world(session: Session, options: dict[str, Any]) -> None:
    """Do what the options say, each an entry of the history."""
    if options["ground"] is not None:
        held = [marks.track_named(session.document, name).id for name in options["depth_of"]]
        session.apply(scene.set_ground(session.document, options["ground"], depth_tracks=held, depth=options["depth"]))
    if options["from_above"]:
        session.apply(scene.set_from_above(session.document, True))
    if options["pitch"] is not None or options["roll"] is not None:
        world = session.document.world
        pitch = world.pitch if options["pitch"] is None else options["pitch"]
        roll = world.roll if options["roll"] is None else options["roll"]
        session.apply(scene.set_horizon(session.document, pitch, roll))
    if options["camera_height"] is not None:
        session.apply(scene.set_camera_height(session.document, options["camera_height"]))


def set_lengths(session: Session, options: dict[str, Any]) -> None:
    """Set the known length; after the clicks, for it may lie between tracks that are new."""
    for first, second, frame, metres in options["lengths"]:
        marks.length_between(session, first, second, frame, metres)
    if options["length_pixels"]:
        frame, ax, ay, bx, by, metres = options["length_pixels"]
        session.apply(scene.set_length(session.document, SeenLength(frame, (ax, ay), (bx, by), metres)))
    if options["length_places"]:
        ax, ay, az, bx, by, bz, metres = options["length_places"]
        session.apply(scene.set_length(session.document, KnownLength((ax, ay, az), (bx, by, bz), metres)))
