"""The built-in sample of performances: takes of the hound, joined by the walk that the film gave its character."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from app.actions import performing
from app.actions.session import Session
from app.formats.tvm import FrameMesh, write_mesh_frames
from app.model.edits import performance, sequences
from app.model.performance import KeyMotion
from imitation.progress import Progress, silent

TAKES = "hound takes"
FILMED = "hound as filmed"
SCRIPT = (("trot", 3.0), ("bow", 2.0), ("walk", 2.6), ("shake", 3.0))
STAIRS = 22
"""Frame of the film in which the hound begins to climb."""
CELL = 0.03
"""Metres: edge length of the meshes."""


def make_takes(target: Path, *, progress: Progress | None = None) -> tuple[tuple[str, int], ...]:
    """Write the hound's takes, meshed anew in every frame, as an npz; gives name and first frame of each motion."""
    from resources.performer import Part, perform_hound

    capture = perform_hound([Part(name, repeats) for name, repeats in SCRIPT], fps=25.0, seed=3, cell=CELL)
    frames = (FrameMesh(*capture.mesh(frame)) for frame in range(len(capture)))
    report = progress or silent
    write_mesh_frames(target, frames, form="npz", fps=25, count=len(capture), name=TAKES, progress=report)
    return tuple(zip(capture.names, (0, *capture.boundaries), strict=True))


def add_sample_performance(session: Session, folder: Path, *, progress: Progress | None = None) -> None:
    """Add the hound's takes and its filmed walk to the sample's project; both are one database of one character.

    The filmed walk leads up some stairs: what it climbs is taken out, so that it joins what is played on the ground.
    """
    target = folder / f"{TAKES}.npz"
    make_takes(target, progress=progress)
    join_sample(session, target)
    target.unlink()


def join_sample(session: Session, takes: Path) -> None:
    """Add the takes, as they were made, and the filmed walk to the sample's project; quick."""
    made, _ = performing.add_sequence(session, takes, name=TAKES, copy=True)
    # The takes begin facing along +x; where a four-legged performer faces cannot be seen by its shoes.
    session.apply(sequences.set_front(session.document, made, 0.0))
    hound = next(each for each in session.document.characters if each.name == "hound")
    filmed, _ = performing.add_character_motion(session, hound.id, name=FILMED)
    session.apply(sequences.set_level(session.document, filmed, True))
    # From here on the hound is on the stairs, which is another motion; that is the user's word.
    session.apply(sequences.set_boundaries(session.document, filmed, (STAIRS,)))


def choose_sample_keys(session: Session) -> None:
    """Choose the filmed walk, the trot, the bow and the filmed walk again as key motions; computes the graph."""
    graph: Any = session.result(session.stages.graph)
    named = performing.motions(session.document, graph)
    takes = performing.sequence_named(session.document, TAKES)
    filmed = performing.sequence_named(session.document, FILMED)

    def named_at(sequence: str, frame: int) -> performing.MotionName:
        return performing.motion_named(session.document, named, f"{sequence}@{frame}")

    walk = named_at(filmed.name, 0)
    trot, bow = (named_at(takes.name, round(share * takes.frame_count)) for share in (0.1, 0.35))
    keys = [KeyMotion(walk.motion), KeyMotion(trot.motion, 2), KeyMotion(bow.motion), KeyMotion(walk.motion)]
    session.apply(performance.set_keys(session.document, keys))
