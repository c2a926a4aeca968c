"""Clicks where the user says that the point is hidden reach the spans beside them; other marks change no span."""

from __future__ import annotations

from app.model.document import Document
from app.model.frozen import FrozenMap
from app.model.tracks import Track
from app.model.values import Clip, Interval, MediaRef
from app.stages import tracking

CLICKS = FrozenMap({0: (10.0, 12.0), 10: (14.0, 12.0), 20: (18.0, 12.0)})


def keys_of(*occluded: Interval) -> tuple[list[str], str]:
    """Keys of the three spans and of the track, which end in frame 29."""
    clip = Clip(MediaRef("clip.mp4", "f" * 16), frame_count=30, fps=25.0, width=64, height=48)
    track = Track("t1", "paw", CLICKS, occluded=occluded)
    document = Document(clip=clip, tracks=(track,))
    return [span.key for span in tracking.spans(document, track)], tracking.track(document, track).key


def test_a_hidden_click_changes_the_spans_beside_it() -> None:
    """And only those; the mark's own length does not matter to them."""
    plain, marked = keys_of()[0], keys_of(Interval(8, 11))[0]
    assert [a == b for a, b in zip(plain, marked, strict=True)] == [False, False, True]
    assert keys_of(Interval(10, 10))[0] == marked


def test_hidden_frames_without_a_click_solve_nothing_again() -> None:
    """The spans stay as they are; what is said of the frames changes the track."""
    plain, marked = keys_of(), keys_of(Interval(3, 6))
    assert plain[0] == marked[0]
    assert plain[1] != marked[1]
