"""Depth and plates of a project: keys, blocked states, the world's units, files."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import attrs
import numpy as np
import pytest

from app.actions.backgrounds import false_colour, summary
from app.model.document import Document
from app.stages import depth as depth_stages
from app.stages.depth import in_world, map_in_world
from app.stages.media import Media
from app.stages.project import Stages
from app.stages.results import Masks, World
from imitation import CameraPath, Cancelled
from imitation.depth import Background, DepthSolver, background_depth
from imitation.depth.views import key_frames
from tests.imitation.depth.scenes import filmed_room


class Here:
    """The context of a stage without a project."""

    def __init__(self, frames: Any) -> None:
        self.media: Any = Media(Path)  # type: ignore[arg-type]
        self.media.frames = lambda clip: frames
        self.seen: list[float] = []

    def progress(self, fraction: float) -> None:
        """Remember what was reported."""
        self.seen.append(fraction)


def test_without_a_clip_the_stages_say_what_is_missing() -> None:
    """Depth and plates are blocked by the sentence of the clip."""
    stages = Stages(Document())
    assert stages.depth.why_blocked() == "Add a video first."
    assert stages.plate(3).why_blocked() == "Add a video first."
    assert stages.plate(3).name != stages.plate(4).name


CLIP: Any = SimpleNamespace(frame_count=12, media=SimpleNamespace(fingerprint="room"))


def solved(here: Any, world: Any, masks: Masks) -> Any:
    """Run the stages of depth one after the other, as the runner does."""
    held = (world.cameras, masks)
    plan = depth_stages._plan(here, (CLIP, 160), *held)
    slots = range(depth_stages.slots(CLIP.frame_count))
    first = [depth_stages._first(here, (CLIP, 160, k), plan, *held) for k in slots]
    assert [each.frame for each in first if each] == list(plan.keys)
    second = [depth_stages._second(here, (CLIP, 160, k), plan, *held, *first) for k in slots]
    return depth_stages._depth(here, (CLIP, 160), plan, *held, *second)


def test_one_stage_a_key_frame_gives_what_the_engine_gives_at_once() -> None:
    """Spread over stages, the maps have the bits of a single call; no clip has more key frames than stages."""
    world = filmed_room(4, (160, 90), 12)
    here: Any = Here(world.frames)
    maps = solved(here, world, Masks.pack(world.masks))
    whole = background_depth(world.frames, world.cameras, masks=world.masks, longest=160)
    assert [each.frame for each in maps] == [each.frame for each in whole]
    for ours, theirs in zip(maps, whole, strict=True):
        np.testing.assert_array_equal(ours.depth, theirs.depth)
        np.testing.assert_array_equal(ours.confidence, theirs.confidence)
    for count in (3, 12, 25, 47, 48, 49, 97, 240, 1000):
        fast = CameraPath(np.tile(np.eye(3), (count, 1, 1)), np.tile(np.eye(3), (count, 1, 1)),
                          np.arange(count)[:, None] * np.ones(3))  # fmt: skip
        assert len(key_frames(fast, 1.0)) <= depth_stages.slots(count)


def test_the_key_frames_of_a_clip_share_a_solver() -> None:
    """It is made once for all passes, let go of when the maps are there, and another for other cameras."""
    world = filmed_room(4, (160, 90), 12)
    here: Any = Here(world.frames)
    masks = Masks.pack(world.masks)
    plan = depth_stages._plan(here, (CLIP, 160), world.cameras, masks)
    held = (here, CLIP, 160)
    one = depth_stages._solver(*held, world.cameras, masks, plan)
    assert depth_stages._solver(*held, world.cameras, masks, plan) is one
    moved = world.cameras.transformed(2.0, np.eye(3), np.zeros(3))
    assert depth_stages._solver(*held, moved, masks, plan) is not one
    solved(here, world, masks)
    assert here.media._solver is None


def test_a_pass_looks_up_whether_to_stop_many_times() -> None:
    """A cancelled pass ends within a few rows, wherever it is; the fractions only rise."""
    world = filmed_room(4, (160, 90), 12)
    solver = DepthSolver(world.frames, world.cameras, world.masks)
    keys = solver.key_frames()
    seen: list[float] = []
    first = {frame: solver.first(frame, keys, seen.append) for frame in keys[:2]}
    assert seen[: len(seen) // 2] == sorted(seen[: len(seen) // 2])
    assert len(seen) > 2 * 15
    calls = 0

    def stopping(fraction: float) -> None:
        nonlocal calls
        calls += 1
        if fraction > 0.5:
            raise Cancelled

    with pytest.raises(Cancelled):
        solver.second(keys[0], first, stopping)
    assert calls > 3


def test_finding_the_range_can_be_stopped() -> None:
    """The frames that are matched for it are told one by one, and what stops it stops it there."""
    world = filmed_room(4, (160, 90), 12)
    seen: list[float] = []
    DepthSolver(world.frames, world.cameras, world.masks, progress=seen.append)
    assert seen == sorted(seen)
    assert len(set(seen)) >= 6

    def stopping(fraction: float) -> None:
        if fraction > 0.3:
            raise Cancelled

    with pytest.raises(Cancelled):
        DepthSolver(world.frames, world.cameras, world.masks, progress=stopping)


def test_a_stage_gives_what_the_engine_gives_and_the_world_scales_it() -> None:
    """Depth in the cameras' units, a plate from it, and both in a world of twice the size."""
    world = filmed_room(4, (160, 90), 12)
    here: Any = Here(world.frames)
    masks = Masks.pack(world.masks)
    maps = solved(here, world, masks)
    assert here.seen[-1] == 1
    assert all(np.isnan(each.depth[world.masks[each.frame]]).all() for each in maps)
    plate = depth_stages._plate(here, (None, maps[1].frame), maps, world.cameras, masks)  # type: ignore[arg-type]
    assert np.isfinite(plate.depth).all()
    assert plate.filled > plate.invented
    turned = world.cameras.transformed(2.0, np.eye(3), np.array([1.0, 2.0, 3.0]))
    scaled = World(turned, 2.0, np.eye(3), np.zeros(3), np.array([0, 0, 1.0]), 0.0, True, True, True, None, "")
    each = map_in_world(maps[0], scaled)
    np.testing.assert_allclose(each.depth, 2 * maps[0].depth)
    assert each.tolerance == maps[0].tolerance, "it is relative"
    near, far = (Background(world.frames, path, [one], masks=world.masks) for path, one in (
        (world.cameras, maps[0]), (turned, each)))  # fmt: skip
    np.testing.assert_allclose(far.tolerance, near.tolerance / 2, rtol=1e-6)
    before, after = maps[0].points(8), each.points(8)
    np.testing.assert_allclose(after, 2 * before + [1, 2, 3], atol=1e-4)
    np.testing.assert_allclose(in_world(plate.depth, scaled), 2 * plate.depth)
    told = summary(maps)
    assert told["nearest"] < told["median"] < told["farthest"]
    assert 0 < told["confirmed"] <= 1
    assert attrs.evolve(each, frame=5).frame == 5


def test_false_colour_runs_from_blue_to_red() -> None:
    """Near is red, far is blue, unknown is grey."""
    picture = false_colour(np.array([[1.05, 9.5, np.nan]]), 1.0, 10.0)
    assert picture[0, 0, 0] > picture[0, 0, 2]
    assert picture[0, 1, 2] > picture[0, 1, 0]
    np.testing.assert_array_equal(picture[0, 2], [70, 70, 70])
