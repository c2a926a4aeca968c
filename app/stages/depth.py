"""Stages of the background: dense depth of key frames, and clean plates."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import attrs
import numpy as np
from numpy.typing import NDArray

from app.model.document import Document
from app.model.values import Clip
from app.stages import scene, tracking
from app.stages.context import Context
from app.stages.once import once
from app.stages.results import Masks, World
from app.stages.stage import Stage
from imitation import CameraPath

if TYPE_CHECKING:
    # Only names: the engine loads slowly, and the window opens without it.
    from imitation.depth import Background, DepthMap

WIDTH = 480
"""Pixels on the longest side at which a project's depth is solved: contacts and occlusion need no more."""
KEY_SECONDS = 3.0


@attrs.frozen(eq=False)
class PlateFrame:
    """A frame without the subject.

    Attributes
    ----------
    picture : uint8 RGB (h, w, 3). depth : float32 (h, w) camera z everywhere, units of the cameras.
    filled, invented : share of the picture filled from other frames, and painted in where none sees the place.
    """

    picture: NDArray[np.uint8]
    depth: NDArray[np.float32]
    filled: float
    invented: float


@once
def depth(document: Document) -> Stage:
    """Depth of the background in key frames, units of the cameras."""
    clip = document.clip
    if clip is None:
        return Stage("depth", "Measuring the background", _depth, blocked=tracking.NO_CLIP)
    needs = (scene.cameras(document), tracking.masks(document))
    weight = KEY_SECONDS * max(2.0, clip.frame_count / 6)
    return Stage("depth", "Measuring the background", _depth, (clip, WIDTH), needs, weight=weight)


@once
def plate(document: Document, frame: str) -> Stage:
    """One frame without the subject, with depth behind it; ``frame`` is its number as text."""
    clip = document.clip
    label = f"Clean plate of frame {frame}"
    if clip is None:
        return Stage(f"plate/{frame}", label, _plate, blocked=tracking.NO_CLIP)
    needs = (depth(document), scene.cameras(document), tracking.masks(document))
    return Stage(f"plate/{frame}", label, _plate, (clip, int(frame)), needs, weight=0.8)


def in_world(depth_: NDArray[np.floating], world: World) -> NDArray[np.float32]:
    """Depth (h, w) in the units of the user's world."""
    return (depth_ * np.float32(world.scale)).astype(np.float32)


def map_in_world(each: DepthMap, world: World) -> DepthMap:
    """A depth map in the user's world."""
    return attrs.evolve(
        each, depth=in_world(each.depth, world), camera=world.camera(each.frame),
        tolerance=each.tolerance * world.scale,
    )  # fmt: skip


def background(frames: Any, maps: list[DepthMap], cameras: CameraPath, masks: Masks | None) -> Background:
    """What is known of the background, ready to give any frame's depth and plate."""
    from imitation.depth import Background

    return Background(frames, cameras, maps, masks=masks)


def _depth(context: Context, inputs: tuple[Clip, int], cameras: CameraPath, masks: Masks | None) -> list[DepthMap]:
    from imitation.depth import background_depth

    clip, width = inputs
    frames = context.media.frames(clip)
    return background_depth(frames, cameras, masks=masks, longest=width, progress=context.progress)


def _plate(
    context: Context, inputs: tuple[Clip, int], maps: list[DepthMap], cameras: CameraPath, masks: Masks | None
) -> PlateFrame:
    clip, frame = inputs
    context.progress(0.0)
    made = background(context.media.frames(clip), maps, cameras, masks).plate(frame)
    context.progress(1.0)
    return PlateFrame(made.picture, made.depth.depth, float(made.filled.mean()), float(made.invented.mean()))
