"""Tracks of a point: exact at clicks, right on synthetic motion, local in their dependence on clicks."""

from __future__ import annotations

import numpy as np
import pytest

from imitation.errors import Cancelled, InputError
from imitation.tracking import PreparedClip, compute_flow, prepare_clip, track_point, track_span
from tests.imitation.tracking.worlds import moving


@pytest.fixture(scope="module")
def world() -> tuple[PreparedClip, np.ndarray]:
    """A clip of 21 frames with its flow, and the true path."""
    frames, path = moving(seed=11)
    return prepare_clip(frames, flow=compute_flow(frames)), path


def clicks_at(path: np.ndarray, *frames: int) -> dict[int, tuple[float, float]]:
    """True clicks in the frames given."""
    return {t: (float(path[t, 0]), float(path[t, 1])) for t in frames}


@pytest.mark.parametrize(("mode", "allowed"), [("robust", 0.2), ("paper", 1.0)])
def test_follows_smooth_motion_between_clicks(world, mode, allowed):
    """Between two clicks on moving texture the path is the true one."""
    clip, path = world
    track = track_point(clip, clicks_at(path, 0, 20), mode=mode)
    assert np.abs(track.positions - path).max() < allowed


@pytest.mark.parametrize("mode", ["robust", "paper"])
@pytest.mark.parametrize("at", [0, 9, 20])
def test_works_before_the_first_and_after_the_last_click(world, mode, at):
    """One click is enough: the track runs from it to both ends of the clip."""
    clip, path = world
    track = track_point(clip, clicks_at(path, at), mode=mode)
    assert np.abs(track.positions - path).max() < (0.5 if mode == "robust" else 3.0)
    assert (track.state == "visible").all()


@pytest.mark.parametrize("mode", ["robust", "paper"])
def test_passes_through_its_clicks(world, mode):
    """Clicks are met exactly, however wrong they are."""
    clip, path = world
    clicks = {2: (40.25, 60.5), 9: (200.0, 10.0), 15: tuple(path[15])}
    track = track_point(clip, clicks, mode=mode)
    for frame, place in clicks.items():
        assert tuple(track.positions[frame]) == place
        assert track.confidence[frame] == 1.0
    assert np.isfinite(track.positions).all()


@pytest.mark.parametrize("mode", ["robust", "paper"])
def test_a_correction_changes_only_the_spans_beside_it(world, mode):
    """Added, moved or removed, a click leaves every other span as it was, bit for bit."""
    clip, path = world
    clicks = clicks_at(path, 1, 5, 10, 15, 19)
    before = track_point(clip, clicks, mode=mode)
    moved = track_point(clip, clicks | {10: (path[10, 0] + 6, path[10, 1] - 5)}, mode=mode)
    removed = track_point(clip, {t: p for t, p in clicks.items() if t != 10}, mode=mode)
    added = track_point(clip, clicks | {12: (path[12, 0] + 4, path[12, 1])}, mode=mode)
    for other, kept in ((moved, [*range(6), *range(15, 21)]), (removed, [*range(6), *range(15, 21)])):
        for name in ("positions", "confidence", "state", "cost"):
            # The cost of the step into a click's frame belongs to the span before it.
            rows = [t for t in kept if t != 15] if name == "cost" else kept
            assert np.array_equal(getattr(before, name)[rows], getattr(other, name)[rows]), name
    assert np.array_equal(before.positions[:11], added.positions[:11])
    assert np.array_equal(before.positions[15:], added.positions[15:])
    assert not np.array_equal(before.positions[6:10], moved.positions[6:10])


def test_a_span_on_its_own_equals_its_part_of_the_track(world):
    """``track_span`` is the unit that ``track_point`` puts together."""
    clip, path = world
    track = track_point(clip, clicks_at(path, 4, 12))
    span = track_span(clip, (4, *path[4]), (12, *path[12]))
    assert np.array_equal(span.positions, track.positions[4:13])
    head = track_span(clip, None, (4, *path[4]))
    assert np.array_equal(head.positions, track.positions[:5])
    tail = track_span(clip, (12, *path[12]), None, until=16)
    assert len(tail.positions) == 5


def test_ends_and_starts_anew(world):
    """Where the user says that the track is absent there is nothing, and no span passes over it."""
    clip, path = world
    clicks = clicks_at(path, 2, 14)
    track = track_point(clip, clicks, absent=[(6, 9)])
    assert np.isnan(track.positions[6:10]).all()
    assert (track.state[6:10] == "outside").all()
    assert (track.confidence[6:10] == 0).all()
    assert np.isfinite(np.delete(track.positions, range(6, 10), axis=0)).all()
    alone = track_point(clip, clicks_at(path, 2), absent=[(6, 9)])
    assert np.array_equal(alone.positions[:6], track.positions[:6])
    assert np.isnan(alone.positions[10:]).all()


def test_the_same_bits_with_flow_given_or_computed(world):
    """Flow computed on demand, in any order, is the flow of ``compute_flow``."""
    clip, path = world
    lazy = track_point(clip.frames, clicks_at(path, 12, 20))
    assert np.array_equal(lazy.positions, track_point(clip, clicks_at(path, 12, 20)).positions)


def test_preview_without_dense_flow(world):
    """The quick preview follows easy motion."""
    clip, path = world
    track = track_point(clip.frames, clicks_at(path, 0, 20), flow="lk")
    assert np.abs(track.positions - path).max() < 0.3


def test_cancel(world):
    """A progress callback stops the solve, and the next solve is the same as ever."""
    clip, path = world
    calls = []

    def stop(fraction: float) -> None:
        calls.append(fraction)
        if fraction > 0.5:
            raise Cancelled

    clicks = clicks_at(path, 0, 20)
    whole = track_point(clip, clicks)
    with pytest.raises(Cancelled):
        track_point(clip, clicks, progress=stop)
    assert calls == sorted(calls)
    assert np.array_equal(track_point(clip, clicks).positions, whole.positions)


@pytest.mark.parametrize(
    ("clicks", "says"),
    [
        ({}, "at least one click"),
        ({3: (np.nan, 5.0)}, "frame 3"),
        ({3: (np.inf, 5.0)}, "frame 3"),
        ({21: (5.0, 5.0)}, "frame 21"),
        ({-1: (5.0, 5.0)}, "frame -1"),
        ({3: (400.0, 5.0)}, "outside the picture"),
        ({3: (5.0, 1.0, 2.0)}, "two finite numbers"),
    ],
)
def test_refuses_bad_clicks(world, clicks, says):
    """Clicks that cannot be meant are refused in one sentence."""
    with pytest.raises(InputError, match=says):
        track_point(world[0], clicks)


def test_refuses_other_bad_input(world):
    """Wrong masks, flow, frames, modes and options are named."""
    clip, path = world
    frames, clicks = clip.frames, clicks_at(path, 3)
    cases = [
        ({"mask": [np.zeros((5, 5), bool)] * 21}, "size of the frames"),
        ({"mask": [np.zeros((200, 320), bool)] * 3}, "one mask a frame"),
        ({"flow": compute_flow(frames[:3])}, "another clip"),
        ({"flow": "fast"}, '"fast"'),
        ({"mode": "magic"}, '"magic"'),
        ({"absent": [(2, 4)]}, "absent"),
        ({"absent": [(4, 2)]}, "comes after"),
    ]
    for arguments, says in cases:
        with pytest.raises(InputError, match=says):
            track_point(frames, clicks, **arguments)
    with pytest.raises(InputError, match="no frames"):
        track_point([], clicks)
    with pytest.raises(InputError, match="uint8 RGB"):
        track_point([np.zeros((4, 4))], {0: (1.0, 1.0)})


def test_a_clip_of_one_frame():
    """One frame and one click make a track of one place."""
    track = track_point([np.zeros((40, 50, 3), np.uint8)], {0: (3.0, 4.0)})
    assert track.positions.tolist() == [[3.0, 4.0]]
