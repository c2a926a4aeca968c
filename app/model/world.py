"""What the user decides about cameras, ground and scale."""

from __future__ import annotations

from typing import Literal

import attrs

from app.model.frozen import FrozenMap
from app.model.values import MediaRef, Point3, Unknown

CameraSource = Literal["solve", "static", "file"]
GroundKind = Literal["local", "plane", "depth"]


@attrs.frozen
class CameraChoice:
    """Where the cameras come from.

    Attributes
    ----------
    source : solved from the video, one static camera, or read from a file of another program.
    focal : focal length in pixels when the user knows it; None solves or guesses it.
    file : the model that is read when source is "file".
    """

    source: CameraSource = "solve"
    focal: float | None = None
    file: MediaRef | None = None
    unknown: Unknown = attrs.field(factory=FrozenMap, repr=False)


@attrs.frozen
class KnownLength:
    """Two places of the solved scene, in the camera solution's own units, and the distance between them in metres."""

    first: Point3
    second: Point3
    metres: float


@attrs.frozen
class WorldChoice:
    """Where contacts lie, what is up, how long a metre is.

    Attributes
    ----------
    ground : "local" fits the recovered points near each contact (stairs), "plane" one plane to the selected
        points (the paper's rabbit), "depth" keeps one track at a constant depth (its salamander).
    plane_points : the selected points for "plane", in the camera solution's own units; empty takes all points.
    depth_track : the track of constant depth for "depth"; depth its depth, None takes 1.
    from_above : the camera looks down on the subject, so that up is towards it; else it is held level.
    length : a known length that makes the world metric.
    """

    ground: GroundKind = "local"
    plane_points: tuple[Point3, ...] = ()
    depth_track: str | None = None
    depth: float | None = None
    from_above: bool = False
    length: KnownLength | None = None
    unknown: Unknown = attrs.field(factory=FrozenMap, repr=False)
