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
    from imitation.depth import Background, DepthMap, DepthSolver, Sketch

WIDTH = 480
"""Pixels on the longest side at which a project's depth is solved: contacts and occlusion need no more."""
BEHIND = 720
"""Pixels on the longest side at which depth behind the subject is chosen."""
KEY_SECONDS = 2.0
MOST = 26
LABEL = "Measuring the background"


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


@attrs.frozen(eq=False)
class Plan:
    """Which frames are solved, and how deep is searched.

    Attributes
    ----------
    keys : frames, in order. near, far, middle : depths, units of the cameras.
    """

    keys: tuple[int, ...]
    near: float
    far: float
    middle: float


@once
def plan(document: Document) -> Stage:
    """Which frames get a depth map: the cameras decide."""
    clip = document.clip
    if clip is None:
        return Stage("depth/plan", LABEL, _plan, blocked=tracking.NO_CLIP)
    needs = (scene.cameras(document), tracking.masks(document))
    return Stage("depth/plan", LABEL, _plan, (clip, WIDTH), needs, weight=3.0)


@once
def sketch(document: Document, slot: str, turn: str) -> Stage:
    """One key frame's depth after the "first" or "second" pass; ``slot`` is its place among the key frames, as text."""
    clip = document.clip
    name = f"depth/{turn}/{slot}"
    if clip is None:
        return Stage(name, LABEL, _first, blocked=tracking.NO_CLIP)
    needs: tuple[Stage, ...] = (plan(document), scene.cameras(document), tracking.masks(document))
    if turn == "second":
        needs += _sketches(document, "first")
    compute = _first if turn == "first" else _second
    return Stage(name, LABEL, compute, (clip, WIDTH, int(slot)), needs, version=4, weight=KEY_SECONDS / 2)


@once
def _sketches(document: Document, turn: str) -> tuple[Stage, ...]:
    """Those of all key frames, looked up once and not once for each of those that stand on them."""
    count = slots(document.clip.frame_count) if document.clip is not None else 0
    return tuple(sketch(document, str(k), turn) for k in range(count))


@once
def depth(document: Document) -> Stage:
    """Depth of the background in key frames, units of the cameras."""
    clip = document.clip
    if clip is None:
        return Stage("depth", LABEL, _depth, blocked=tracking.NO_CLIP)
    needs: tuple[Stage, ...] = (plan(document), scene.cameras(document), tracking.masks(document))
    needs += _sketches(document, "second")
    return Stage("depth", LABEL, _depth, (clip, WIDTH), needs, version=5, weight=2.0)


def slots(frames: int) -> int:
    """How many key frames a clip can have at most: a stage each, empty where the cameras choose fewer."""
    return min(frames, MOST)


@once
def plate(document: Document, frame: str) -> Stage:
    """One frame without the subject, with depth behind it; ``frame`` is its number as text."""
    clip = document.clip
    label = f"Clean plate of frame {frame}"
    if clip is None:
        return Stage(f"plate/{frame}", label, _plate, blocked=tracking.NO_CLIP)
    needs = (depth(document), scene.cameras(document), tracking.masks(document))
    return Stage(f"plate/{frame}", label, _plate, (clip, int(frame)), needs, version=4, weight=0.8)


def in_world(depth_: NDArray[np.floating], world: World) -> NDArray[np.float32]:
    """Depth (h, w) in the units of the user's world."""
    return (depth_ * np.float32(world.scale)).astype(np.float32)


def map_in_world(each: DepthMap, world: World) -> DepthMap:
    """A depth map in the user's world."""
    return attrs.evolve(each, depth=in_world(each.depth, world), camera=world.camera(each.frame))


def background(
    frames: Any, maps: list[DepthMap], cameras: CameraPath, masks: Masks | None, *, shadows: bool = False
) -> Background:
    """What is known of the background, ready to give any frame's depth and plate; see ``Background``."""
    from imitation.depth import Background

    return Background(frames, cameras, maps, masks=masks, longest=BEHIND, shadows=shadows)


def _plan(context: Context, inputs: tuple[Clip, int], cameras: CameraPath, masks: Masks | None) -> Plan:
    clip, width = inputs
    context.progress(0.0)
    solver = _solver(context, clip, width, cameras, masks)
    keys = solver.key_frames()
    if len(keys) > slots(clip.frame_count):
        raise AssertionError(f"{len(keys)} key frames have only {slots(clip.frame_count)} stages")
    return Plan(tuple(keys), solver.reach.near, solver.reach.far, solver.reach.middle)


def _first(
    context: Context, inputs: tuple[Clip, int, int], plan_: Plan, cameras: CameraPath, masks: Masks | None
) -> Sketch | None:
    clip, width, slot = inputs
    if slot >= len(plan_.keys):
        return None
    solver = _solver(context, clip, width, cameras, masks, plan_)
    return solver.first(plan_.keys[slot], plan_.keys, context.progress)


def _second(
    context: Context, inputs: tuple[Clip, int, int], plan_: Plan, cameras: CameraPath, masks: Masks | None,
    *sketches: Sketch | None,
) -> Sketch | None:  # fmt: skip
    clip, width, slot = inputs
    if slot >= len(plan_.keys):
        return None
    known = {each.frame: each for each in sketches if each is not None}
    if len(known) == 1:
        return known[plan_.keys[0]]
    solver = _solver(context, clip, width, cameras, masks, plan_)
    return solver.second(plan_.keys[slot], known, context.progress)


def _depth(
    context: Context, inputs: tuple[Clip, int], plan_: Plan, cameras: CameraPath, masks: Masks | None,
    *sketches: Sketch | None,
) -> list[DepthMap]:  # fmt: skip
    clip, width = inputs
    solver = _solver(context, clip, width, cameras, masks, plan_)
    known = {each.frame: each for each in sketches if each is not None}
    maps = []
    for done, frame in enumerate(plan_.keys):
        context.progress(done / len(plan_.keys))
        maps.append(solver.finish(frame, known))
    context.media.leave_depth_solver()
    context.progress(1.0)
    return maps


def _solver(
    context: Context, clip: Clip, width: int, cameras: CameraPath, masks: Masks | None, plan_: Plan | None = None
) -> DepthSolver:
    from imitation.depth import DepthSolver, Range

    frames = context.media.frames(clip)
    if plan_ is None:
        return DepthSolver(frames, cameras, masks, longest=width, progress=context.progress)
    reach = Range(plan_.near, plan_.far, plan_.middle)
    solver: DepthSolver = context.media.depth_solver(
        (clip.media.fingerprint, id(cameras), id(masks), width, reach),
        lambda: DepthSolver(frames, cameras, masks, longest=width, reach=reach),
    )
    return solver


def _plate(
    context: Context, inputs: tuple[Clip, int], maps: list[DepthMap], cameras: CameraPath, masks: Masks | None
) -> PlateFrame:
    clip, frame = inputs
    context.progress(0.0)
    made = background(context.media.frames(clip), maps, cameras, masks).plate(frame)
    context.progress(1.0)
    return PlateFrame(made.picture, made.depth.depth, float(made.filled.mean()), float(made.invented.mean()))
