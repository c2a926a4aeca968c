"""What the user decides about cameras, ground and scale."""

from __future__ import annotations

from typing import Literal

import attrs

from app.model.frozen import FrozenMap
from app.model.values import MediaRef, Point2, Point3, Unknown

CameraSource = Literal["solve", "static", "file"]
GroundKind = Literal["local", "background", "plane", "depth"]


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
class SeenLength:
    """Two places that are seen in one frame, and the distance between them in metres.

    Attributes
    ----------
    first, second : pixels in ``frame``.
    tracks : ids of the two tracks that mark the places; empty where pixels alone do. Points that stand still are
        located from all frames, others from the frame alone.
    """

    frame: int
    first: Point2
    second: Point2
    metres: float
    tracks: tuple[str, ...] = ()


@attrs.frozen
class WorldChoice:
    """Where contacts lie, what is up, how long a metre is.

    Attributes
    ----------
    ground : "local" fits the recovered points near each contact (stairs), "background" puts each contact onto the
        measured background (the paper's stairs), "plane" fits one plane to the selected
        points (the paper's rabbit), "depth" keeps tracks at a constant depth (its salamander).
    plane_points : the selected points for "plane", in the camera solution's own units; empty takes all points.
    depth_tracks : the tracks of constant depth for "depth"; depth their depth, None takes 5.
    from_above : the camera looks down on the subject, so that up is towards it; else it is held level.
    pitch, roll : how a camera that only turns, or stands still, is held in frame 0, degrees: downwards from the
        horizon, and clockwise. None and 0 take it as level.
    height : of the first camera above the ground, metres: a known length as well. None assumes 1.6 m where a camera
        that does not move leaves the ground open, and knows nothing where the scene was recovered.
    length, seen : a known length that makes the world metric: of two places, or as it is seen in a frame.
    """

    ground: GroundKind = "local"
    plane_points: tuple[Point3, ...] = ()
    depth_tracks: tuple[str, ...] = ()
    depth: float | None = None
    from_above: bool = False
    pitch: float | None = None
    roll: float = 0.0
    height: float | None = None
    length: KnownLength | None = None
    seen: SeenLength | None = None
    unknown: Unknown = attrs.field(factory=FrozenMap, repr=False)
