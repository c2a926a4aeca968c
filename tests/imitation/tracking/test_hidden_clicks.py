"""Clicks where the user says that the point is hidden: guesses of the place."""

from __future__ import annotations

import numpy as np
import pytest

from imitation.tracking import plan_spans, prepare_clip, track_point, track_span
from tests.imitation.tracking.worlds import Texture, picture

LAST = 20


def covered(seed: int = 5, size: tuple[int, int] = (160, 260)):
    """A point on a patch that goes right; from frame 12 on a larger patch is in front of it that goes left and down.

    Returns frames and the point's true path (n, 2).
    """
    ground, body, front = Texture(seed), Texture(seed + 1), Texture(seed + 2)
    rows, columns = np.arange(size[0], dtype=float), np.arange(size[1], dtype=float)
    pictures, path = [], []
    for t in range(LAST + 1):
        x, y = 60.2 + 5.0 * t, 80.3
        fx, fy = 60.2 + 5.0 * 16 - 5.0 * (t - 16), 80.3 + 1.5 * (t - 16)
        shown = ground(columns, rows)
        inside = (np.abs(columns - x)[None] <= 22) & (np.abs(rows - y)[:, None] <= 22)
        shown = np.where(inside[..., None], body(columns - x, rows - y), shown)
        if t >= 12:
            ahead = (np.abs(columns - fx)[None] <= 34) & (np.abs(rows - fy)[:, None] <= 34)
            shown = np.where(ahead[..., None], front(columns - fx, rows - fy), shown)
        pictures.append(picture(shown))
        path.append((x, y))
    return pictures, np.array(path)


@pytest.fixture(scope="module")
def world():
    """The clip ready for tracking, and the true path."""
    frames, path = covered()
    return prepare_clip(frames), path


def test_what_hides_the_point_is_not_followed(world) -> None:
    """The path is nearer the truth than the one that takes the hidden click for a seen one, and passes through it."""
    clip, path = world
    clicks = {0: tuple(path[0]), 16: (path[16][0] + 3.0, path[16][1] - 2.0)}
    guessed, believed = (track_point(clip, clicks, hidden=hidden) for hidden in ((16,), ()))
    wrong, other = (np.hypot(*(track.positions[:17] - path[:17]).T) for track in (guessed, believed))
    assert wrong[:11].max() < 1
    assert wrong.mean() < 2
    assert wrong.mean() <= other.mean()
    np.testing.assert_array_equal(guessed.positions[16], clicks[16])


def test_a_guess_is_hardly_believed(world) -> None:
    """It is occluded and of low confidence, and so are the frames on its way; the click that is seen is not."""
    clip, path = world
    clicks = {0: tuple(path[0]), 16: tuple(path[16])}
    guessed, believed = (track_point(clip, clicks, hidden=hidden) for hidden in ((16,), ()))
    assert (guessed.confidence[16], guessed.state[16]) == (0.6, "occluded")
    assert (believed.confidence[16], believed.state[16]) == (1.0, "visible")
    assert (guessed.confidence[0], guessed.state[0]) == (1.0, "visible")
    assert guessed.confidence[11:15].max() < 0.6


def test_backwards_from_a_seen_click_to_a_guess(world) -> None:
    """A guess at the left end: the same path as in the clip played backwards."""
    clip, path = world
    mirrored = prepare_clip([clip.frames[t] for t in range(LAST, -1, -1)])
    clicks = {0: tuple(path[0]), 16: tuple(path[16])}
    forward = track_point(clip, clicks, hidden=[16])
    backward = track_point(mirrored, {LAST - t: place for t, place in clicks.items()}, hidden=[LAST - 16])
    np.testing.assert_allclose(backward.positions[::-1][:17], forward.positions[:17], atol=0.05)
    np.testing.assert_allclose(backward.confidence[::-1][:17], forward.confidence[:17], atol=0.01)


def test_between_two_guesses_and_after_the_last(world) -> None:
    """A straight line between them, its place kept after the last; occluded, less and less believed."""
    clip, _ = world
    track = track_point(clip, {4: (50.0, 60.0), 12: (90.0, 80.0)}, hidden=[4, 12])
    np.testing.assert_allclose(track.positions[4:13, 0], np.linspace(50, 90, 9))
    np.testing.assert_allclose(track.positions[13:], np.tile((90.0, 80.0), (8, 1)))
    assert set(track.state) == {"occluded"}
    assert (np.diff(track.confidence[12:]) < 0).all()
    assert track.confidence[8] < track.confidence[12]


def test_only_clicks_in_hidden_frames_matter(world) -> None:
    """Hidden frames without a click change no plan; a span solved alone is the same bits as in the track."""
    clip, path = world
    clicks = [(0, *path[0]), (16, *path[16])]
    assert plan_spans(clicks, 21, hidden=range(3, 9)) == plan_spans(clicks, 21)
    assert [plan.guessed for plan in plan_spans(clicks, 21, hidden=[16])] == [(16,), (16,)]
    span = track_span(clip, *clicks, hidden=[16])
    track = track_point(clip, {0: tuple(path[0]), 16: tuple(path[16])}, hidden=[16])
    np.testing.assert_array_equal(span.positions, track.positions[:17])


def test_the_printed_method_follows_every_click(world) -> None:
    """The mode "paper" gives the same path with and without the mark."""
    clip, path = world
    clicks = {0: tuple(path[0]), 4: tuple(path[4])}
    found = [track_point(clip, clicks, mode="paper", hidden=hidden).positions for hidden in ((4,), ())]
    np.testing.assert_array_equal(*found)
