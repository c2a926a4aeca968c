"""Characters: meshes that shall move as the filmed subject does, and the user's edits of their poses."""

from __future__ import annotations

from typing import Literal

import attrs

from app.model.frozen import FrozenMap
from app.model.values import Interval, MediaRef, Point3, Unknown

SolveMethod = Literal["joint", "paper"]
UpAxis = Literal["x", "y", "z"]


@attrs.frozen
class Alignment:
    """How the character stands on the subject in the first frame.

    The program fits scale, orientation and position to the pairs; the values here are applied on top,
    about the character's centre. With ``fitted`` off they stand alone.

    Attributes
    ----------
    scale : factor. rotation : degrees about the world's x, y, z, in this order. translation : metres.
    up : axis of the mesh's file that points up.
    """

    fitted: bool = True
    scale: float = 1.0
    rotation: Point3 = (0.0, 0.0, 0.0)
    translation: Point3 = (0.0, 0.0, 0.0)
    up: UpAxis = "y"
    unknown: Unknown = attrs.field(factory=FrozenMap, repr=False)


@attrs.frozen
class Move:
    """Where the user put one vertex in one frame.

    Attributes
    ----------
    place : world.
    muted : it is kept but has no effect.
    on_ray : only its image point was chosen: along the ray the vertex went where the mesh took it. That holds in this
        frame; what spreads to others is the committed place (eq. 6), for they have their own image points.
    """

    place: Point3
    muted: bool = False
    on_ray: bool = False


@attrs.frozen
class PoseEdit:
    """An edited frame: what the user moved, and the pose that was committed with it.

    Attributes
    ----------
    moves : control vertex -> where the user put it, world.
    committed : vertex -> position of every key point and control vertex of this frame when the edit was released.
    until : last frame the edit reaches when it is the last one; None holds it to the end.
    """

    moves: FrozenMap[int, Move]
    committed: FrozenMap[int, Point3] = attrs.field(factory=FrozenMap)
    until: int | None = None
    unknown: Unknown = attrs.field(factory=FrozenMap, repr=False)


@attrs.frozen
class SolveChoice:
    """How tracks become motion.

    Attributes
    ----------
    method : "joint" (space-time solve of all depths) or "paper" (the printed route).
    smooth : whether corrections between edited frames are monotone cubic (True) or linear as printed.
    symmetry : a hidden limb follows its mirror's motion.
    reach : frames that propagation may change; None is the whole clip.
    keep_volume : hold the volume of a closed mesh.
    lift_feet : feet below the ground of their contacts are lifted onto it, after everything else.
    """

    method: SolveMethod = "joint"
    smooth: bool = True
    symmetry: bool = False
    reach: Interval | None = None
    keep_volume: bool = False
    lift_feet: bool = False
    unknown: Unknown = attrs.field(factory=FrozenMap, repr=False)


@attrs.frozen
class Character:
    """A mesh and how it takes over the subject's motion.

    Attributes
    ----------
    pairs : track id -> vertex of the mesh (index in the file's order).
    following : control vertex -> track id that it was told to follow, so that one pass suffices.
    edits : frame -> edited pose.
    """

    id: str
    name: str
    mesh: MediaRef
    pairs: FrozenMap[str, int] = attrs.field(factory=FrozenMap)
    alignment: Alignment = attrs.field(factory=Alignment)
    solve: SolveChoice = attrs.field(factory=SolveChoice)
    following: FrozenMap[int, str] = attrs.field(factory=FrozenMap)
    edits: FrozenMap[int, PoseEdit] = attrs.field(factory=FrozenMap)
    visible: bool = True
    unknown: Unknown = attrs.field(factory=FrozenMap, repr=False)
