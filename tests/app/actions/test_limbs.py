"""Ambiguous limbs by name, and the sample's known length."""

from __future__ import annotations

from contextlib import closing
from pathlib import Path
from types import SimpleNamespace

from app.actions.limbs import SHOWN, ambiguous_limbs, limb_lines
from app.actions.sample import fill_with_sample
from app.actions.session import Session
from imitation.propagation import AmbiguousSpan


def found(spans: list[AmbiguousSpan] | None) -> Session:
    """A session in which these spans were found."""
    tracks = [SimpleNamespace(id="t1", name="left paw"), SimpleNamespace(id="t2", name="right knee")]
    return SimpleNamespace(  # type: ignore[return-value]
        document=SimpleNamespace(tracks=tracks),
        stages=SimpleNamespace(ambiguous=lambda _: "stage"),
        ready=lambda _: spans,
    )


def test_limbs_are_named_and_the_longest_comes_first() -> None:
    """Tracks by their names, the frame that decides, which way the other place lies."""
    limbs = ambiguous_limbs(found([AmbiguousSpan("t1", 3, 6, 5, 0.25), AmbiguousSpan("t2", 10, 30, 17, -0.1)]), "c1")
    assert limbs == [
        {"limb": "right knee", "frames": [10, 30], "decide": 17, "other": -0.1},
        {"limb": "left paw", "frames": [3, 6], "decide": 5, "other": 0.25},
    ]
    lines = limb_lines(limbs)
    assert "right knee, frames 10-30" in lines[0]
    assert "0.1 nearer" in lines[0]
    assert "an edit of frame 17 decides" in lines[0]
    assert "0.25 farther" in lines[1]


def test_nobody_looked_and_too_many() -> None:
    """None before anything was computed; a long list is cut for people only."""
    assert ambiguous_limbs(found(None), "c1") is None
    many = ambiguous_limbs(found([AmbiguousSpan("t1", 10 * k, 10 * k + 3, 10 * k, 0.1) for k in range(12)]), "c1")
    assert many is not None
    assert len(many) == 12
    lines = limb_lines(many)
    assert len(lines) == SHOWN + 1
    assert "4 shorter spans" in lines[-1]


def test_the_sample_comes_with_its_known_length(tmp_path: Path) -> None:
    """The post beside the stairs makes the sample metric."""
    with closing(Session.new(tmp_path / "sample.motionwright")) as session:
        fill_with_sample(session)
        seen = session.document.world.seen
        assert seen is not None
        assert seen.metres == 0.78
        assert seen.frame == 0
