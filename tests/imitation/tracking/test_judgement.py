"""What a track says of itself: hidden frames, frames outside, confidence, where to click next."""

from __future__ import annotations

import attrs
import numpy as np
import pytest

from imitation.tracking import compute_flow, prepare_clip, rank_tracks, suggest_correction, track_point
from imitation.tracking.chain import hidden_frames
from imitation.tracking.track import assemble_track
from tests.imitation.tracking.worlds import moving


@pytest.mark.parametrize(("seed", "speed"), [(21, 0.0), (22, 7.3)])
def test_a_bar_over_the_point_is_seen_and_crossed(seed, speed):
    """Under a bar of four frames the state is "occluded" and the path less than 4 px off; outside it is right."""
    frames, path = moving(seed=seed, bar=(8, 11), bar_speed=speed)
    track = track_point(prepare_clip(frames, flow=compute_flow(frames)), {0: tuple(path[0]), 20: tuple(path[20])})
    error = np.hypot(*(track.positions - path).T)
    assert error[8:12].max() < 4.0
    assert np.delete(error, range(8, 12)).max() < 0.4
    assert track.state.tolist() == ["occluded" if 8 <= t <= 11 else "visible" for t in range(21)]


@pytest.mark.parametrize("mode", ["robust", "paper"])
def test_leaves_the_picture(mode):
    """After the last click a point that leaves the picture is outside from then on, and has no place."""
    frames, path = moving(frames=24, speed=12.0, wave=0.0, seed=5)
    start = (path[0, 0] + 120.0, path[0, 1])
    track = track_point(frames, {0: start}, mode=mode)
    out = start[0] + 12.0 * np.arange(24) > 319.5
    assert out.any()
    if mode == "robust":
        assert np.count_nonzero((track.state == "outside") != out) <= 1
    gone = track.state == "outside"
    assert np.array_equal(gone, np.isnan(track.positions[:, 0]))
    assert (track.confidence[gone] == 0).all()


def test_hidden_frames_need_sudden_changes():
    """A look that changes little by little is not hidden; one that jumps away and back is; one jump alone is not."""
    match = np.array([1, 0.9, 0.2, 0.1, 0.2, 0.9, 1.0])
    slow, sudden = np.full(7, 0.8), np.array([1, 0.9, 0.0, 0.9, 0.9, 0.0, 0.9])
    assert not hidden_frames(match, slow).any()
    assert hidden_frames(match, sudden).tolist() == [False, False, True, True, True, False, False]
    assert not hidden_frames(match, np.where(np.arange(7) == 2, 0.0, 0.9)).any()


def test_confidence_is_a_share_and_falls_away_from_clicks():
    """Confidence lies in [0, 1], is 1 at clicks, and falls towards the middle of a span."""
    frames, path = moving(seed=23)
    track = track_point(frames, {0: tuple(path[0]), 10: (20.0, 20.0), 20: tuple(path[20])})
    assert ((track.confidence >= 0) & (track.confidence <= 1)).all()
    assert track.confidence[[0, 10, 20]].tolist() == [1, 1, 1]
    assert track.confidence[5] < track.confidence[1]
    good = track_point(frames, {0: tuple(path[0]), 10: tuple(path[10]), 20: tuple(path[20])})
    assert good.confidence.mean() > track.confidence.mean()


def empty_track(count: int, clicks: tuple[int, ...], absent=()):
    """A track with a path everywhere but where it is absent."""
    track = assemble_track(count, [(t, 1.0, 1.0) for t in clicks], [], absent)
    positions = np.ones((count, 2))
    for first, last in absent:
        positions[first : last + 1] = np.nan
    return attrs.evolve(track, positions=positions, state=np.full(count, "visible", dtype="<U8"))


@pytest.mark.parametrize(
    ("count", "clicks", "absent", "frame"),
    [
        (41, (0, 10, 40), (), 25),
        (41, (0, 20), (), 40),
        (41, (25,), (), 0),
        (41, (0, 30), ((34, 40),), 15),
        (3, (0, 1, 2), (), None),
    ],
)
def test_the_next_click_halves_the_longest_gap(count, clicks, absent, frame):
    """The suggestion is the middle of the longest gap; an open end counts twice and is closed at its far end."""
    assert suggest_correction(empty_track(count, clicks, absent)) == frame


def test_the_next_click_is_where_the_point_is_seen():
    """A hidden middle is no place for a click: the nearest frame where the point is seen is taken."""
    track = empty_track(41, (0, 40))
    state = track.state.copy()
    state[18:24] = "occluded"
    assert suggest_correction(attrs.evolve(track, state=state)) in (17, 24)


def test_tracks_are_ranked_by_their_dearest_span():
    """The track whose worst span costs most comes first."""
    frames, path = moving(seed=24)
    clip = prepare_clip(frames)
    clicks = {0: tuple(path[0]), 20: tuple(path[20])}
    tracks = {"right": track_point(clip, clicks), "wrong": track_point(clip, clicks | {10: (20.0, 30.0)})}
    assert rank_tracks(tracks) == ["wrong", "right"]
