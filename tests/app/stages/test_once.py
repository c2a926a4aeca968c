"""Stages of one version are made once; another version has its own."""

from __future__ import annotations

from collections import Counter

import attrs
import pytest

from app.model.document import Document
from app.model.edits import tracks
from app.model.values import Clip, MediaRef
from app.stages import stage as stages
from app.stages.once import VERSIONS, once
from app.stages.project import Stages


def marked(count: int) -> Document:
    """A document with some tracks."""
    document = Document(clip=Clip(MediaRef("clip.mp4", "f" * 16), frame_count=20, fps=25.0, width=64, height=48))
    for number in range(count):
        document = tracks.add_track(document, 0, (10.0 + number, 12.0), name=f"point {number}").document
    return document


def test_stages_of_a_version_are_made_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """However many contacts stand on the world: their number grows with the tracks and not with its square."""
    made: Counter[str] = Counter()
    begin = stages.Stage.__attrs_post_init__

    def count(stage: stages.Stage) -> None:
        made[stage.name] += 1
        begin(stage)

    monkeypatch.setattr(stages.Stage, "__attrs_post_init__", count)
    document = marked(8)
    all_ = Stages(document)
    for track in document.tracks:
        all_.contacts(track.id)
        all_.track(track.id)
        all_.spans(track.id)
    assert set(made.values()) == {1}


def test_versions_are_told_apart_by_identity() -> None:
    """An equal document is another version; the last few are kept, and no more."""
    calls: list[tuple[Document, object]] = []

    @once
    def make(document: Document, part: object) -> object:
        calls.append((document, part))
        return object()

    first, second = Document(name="a"), Document(name="a")
    part = object()
    assert make(first, part) is make(first, part)
    assert make(first, "x" + "y") is make(first, "xy")
    assert make(first, part) is not make(second, part)
    assert len(calls) == 3
    kept = make(first, part)
    for number in range(VERSIONS):
        make(attrs.evolve(first, name=str(number)), part)
    assert make(first, part) is not kept
