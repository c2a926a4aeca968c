"""Small clips and walks of the sample world for tests, made once a session.

``resources.world.clip.make_clip`` has all the options; these are the forms that tests share.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import attrs
import numpy as np

from imitation.cameras.path import CameraPath
from resources.world import OTHER, SUBJECT, Walk, make_body, make_camera, walk
from resources.world.clip import Clip, make_clip
from resources.world.render import Look

SMALL = Look(size=(320, 180), samples=2, sky=8)


@lru_cache(maxsize=8)
def _clip(options: tuple[tuple[str, Any], ...]) -> Clip:
    return make_clip(**dict(options))


def small_clip(frames: int = 20, **options: Any) -> Clip:
    """A clip of 320 x 180 pixels and 20 frames in a few CPU seconds; options as ``make_clip``, and those of ``Look``.

    The clip is shared: do not write into its arrays.
    """
    names = {field.name for field in attrs.fields(Look)}
    looks = {name: options.pop(name) for name in list(options) if name in names}
    look = attrs.evolve(options.pop("look", SMALL), **looks)
    options = {"vertices": 1200, "look": look, "frames": frames, **options}
    return _clip(tuple(sorted(options.items(), key=lambda item: item[0])))


def room_clip(frames: int = 40, *, size: tuple[int, int] = (480, 270), subject: bool = True, seed: int = 0) -> Clip:
    """The scene that depth is measured on: sideways 1.3 m, gain drift and noise, the subject in front."""
    look = Look(size=size, grain=1.5, gain_drift=0.01, sky=12, seed=seed)
    return _clip(
        (
            ("frames", frames),
            ("look", look),
            ("place", "room"),
            ("seed", seed),
            ("subject", "quadruped" if subject else None),
        )
    )


@lru_cache(maxsize=8)
def walker(
    kind: str = "quadruped", terrain: str = "flat", *, other: bool = False, frames: int = 81, seed: int = 0
) -> Walk:
    """A walk of 81 frames; ``other``: a body of other proportions in the subject's footsteps."""
    walked = walk(make_body(kind, SUBJECT), frames, terrain, seed=seed)  # type: ignore[arg-type]
    return walk(make_body(kind, OTHER), frames, terrain, seed=seed, steps=walked.footfalls) if other else walked  # type: ignore[arg-type]


@attrs.frozen(eq=False)
class FilmedWalk:
    """A walk, a camera and exact tracks, without pictures. ``tracks`` name -> (n, 2), ``contacts`` as in ``Walk``."""

    walk: Walk
    cameras: CameraPath
    tracks: dict[str, np.ndarray]

    @property
    def diagonal(self) -> float:
        """Diagonal of the subject's box in frame 0, metres."""
        return float(np.linalg.norm(np.ptp(self.walk.vertices[0], axis=0)))


def filmed_walk(
    kind: str = "quadruped",
    terrain: str = "flat",
    *,
    azimuth: float = 90.0,
    style: str = "handheld",
    noise: float = 0.0,
    seed: int = 0,
    frames: int = 81,
) -> FilmedWalk:
    """A walker seen by a camera from an azimuth in degrees; tracks of the 16 key points with ``noise`` px (sigma)."""
    walked = walker(kind, terrain, frames=frames, seed=seed)
    cameras = make_camera(walked.centre, walked.body.diagonal, azimuth=azimuth, style=style, seed=seed)  # type: ignore[arg-type]
    rng = np.random.default_rng([seed, 101])
    tracks = {}
    for name, points in walked.key_points.items():
        exact = np.stack([cameras[t].project(points[t]) for t in range(frames)])
        tracks[name] = exact + noise * rng.standard_normal(exact.shape)
    return FilmedWalk(walked, cameras, tracks)
