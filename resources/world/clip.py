"""Clips of the sample world with all that is true of them, by one call."""

from __future__ import annotations

from typing import Literal

import attrs
import numpy as np
from numpy.typing import NDArray

from imitation.cameras.path import CameraPath
from imitation.errors import InputError
from imitation.progress import Progress
from resources.world.body import make_body
from resources.world.camera import Style, lateral_camera, make_camera
from resources.world.gait import Walk, walk
from resources.world.render import Look, Picture, Stage
from resources.world.scene import foreground, garden, room, wall
from resources.world.skeleton import Array, Kind
from resources.world.terrain import FLAT, STAIRS

Place = Literal["garden", "wall", "room"]


@attrs.frozen(eq=False)
class Clip:
    """A rendered clip and its truth.

    Attributes
    ----------
    frames : (n, h, w, 3) uint8 RGB. cameras : the true ones. walk : the subject's, None where nobody walks.
    stage : draws depth and masks on request. fps : frames a second.
    """

    frames: Picture
    cameras: CameraPath
    walk: Walk | None
    stage: Stage
    fps: float = 25.0

    def depth(self, frame: int) -> Array:
        """Exact camera z (h, w) of what stands still, NaN in the sky."""
        return self.stage.depth(frame, self.cameras[frame])

    def mask(self, frame: int) -> NDArray[np.bool_]:
        """Which pixels (h, w) show the subject."""
        return self.stage.mask(frame, self.cameras[frame])

    def masks(self) -> NDArray[np.bool_]:
        """The masks (n, h, w) of all frames."""
        return np.stack([self.mask(t) for t in range(len(self.frames))])

    def track(self, vertex: int) -> Array:
        """True pixels (n, 2) of a vertex of the subject."""
        if self.walk is None:
            raise InputError("Nobody walks in this clip, so that it has no vertex to track.")
        points = self.walk.vertices[:, vertex]
        return np.stack([self.cameras[t].project(points[t]) for t in range(len(self.frames))])

    def tracks(self) -> dict[str, Array]:
        """True pixels (n, 2) of each key point."""
        keys = self.walk.body.key_vertices if self.walk else {}
        return {name: self.track(vertex) for name, vertex in keys.items()}

    def visibility(self) -> dict[str, NDArray[np.bool_]]:
        """Whether (n,) each key point is in the picture and not hidden."""
        if self.walk is None:
            return {}
        names = list(self.walk.body.key_vertices)
        points = np.stack([self.walk.key_points[name] for name in names], axis=1)
        slack = tolerances(self.walk, names)
        seen = np.stack([self.stage.visible(t, self.cameras[t], points[t], slack) for t in range(len(self.frames))])
        return {name: seen[:, i] for i, name in enumerate(names)}


def tolerances(walked: Walk, names: list[str]) -> Array:
    """How far (n,) behind what is seen a named point may lie and still count as seen: soles lie under their feet."""
    return np.array([0.07 if name in walked.contacts else 0.02 for name in names])


def make_clip(
    subject: Kind | None = "quadruped",
    *,
    place: Place = "garden",
    stairs: bool = True,
    style: Style = "handheld",
    azimuth: float = 90.0,
    distance: float = 3.0,
    frames: int = 81,
    look: Look | None = None,
    hidden: bool = False,
    seed: int = 0,
    vertices: int = 2500,
    progress: Progress | None = None,
) -> Clip:
    """Film a subject.

    Parameters
    ----------
    subject : who walks, or None for an empty scene.
    place : "garden" (with stairs or without), "wall" (all that is still lies in one plane), "room" (for depth: the
        camera walks sideways 1.3 m; flat).
    style, azimuth, distance : see ``make_camera``; not used in the room.
    look : size, light, blur, noise. hidden : whether a trunk in the foreground hides part of the picture.
    seed : varies the walk, the hand and the scene.
    """
    if place not in ("garden", "wall", "room"):
        raise InputError(f"The sample world has the places garden, wall and room, but not {place!r}.")
    look = look or Look()
    terrain = STAIRS if stairs and place == "garden" else FLAT
    body = make_body(subject or "quadruped", vertices=vertices)
    walked = walk(body, frames, terrain, seed=seed)
    if place == "room":
        cameras = lateral_camera(frames, seed=seed, size=look.size)
    else:
        cameras = make_camera(
            walked.centre, body.diagonal, azimuth=azimuth, style=style, seed=seed, size=look.size, distance=distance
        )
    scene = wall() if place == "wall" else room(seed=seed) if place == "room" else garden(terrain, seed=seed)
    near = None
    if hidden:
        camera = cameras[frames // 2]
        near = foreground(camera.centre + 1.9 * camera.R[2] + 0.25 * camera.R[0])
    stage = Stage(scene, walked if subject else None, look, near)
    return Clip(stage.clip(cameras, progress), cameras, walked if subject else None, stage)
