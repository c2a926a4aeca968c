"""Edits of sequences and performances: what they change, what they refuse, and that undo is exact."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from app.model.document import Document
from app.model.edits import Edit, characters, performance, sequences
from app.model.history import History
from app.model.performance import KeyMotion, Motion
from app.model.values import MediaRef, ModelError

RUN = MediaRef("run", "f00d")


def document() -> Document:
    """Two sequences of 50 and 40 frames at 25 and 30 frames a second."""
    made = sequences.add_sequence(
        Document(), name="run", frame_count=50, fps=25.0, media=RUN, guessed=("fps", "up", "unit")
    ).document
    return sequences.add_sequence(made, name="walk", frame_count=40, fps=30.0, media=RUN).document


def test_a_sequence_is_files_or_a_characters_motion() -> None:
    """Both, or neither, is refused; names and ids are free."""
    made = characters.add_character(document(), RUN, name="cat").document
    made = sequences.add_sequence(made, name="run", frame_count=9, fps=25, character="c3").document
    assert [s.name for s in made.sequences] == ["run", "walk", "run 2"]
    assert len({s.id for s in made.sequences}) == 3
    with pytest.raises(ModelError, match="give one of them"):
        sequences.add_sequence(made, name="x", frame_count=9, fps=25)
    gone = characters.delete_character(made, "c3").document
    assert [s.name for s in gone.sequences] == ["run", "walk"]


def test_saying_what_was_guessed() -> None:
    """What the user says is guessed no more; the files' rate is taken over where nothing is converted."""
    made = sequences.set_facts(document(), "s1", source_fps=50.0, up="y").document
    run = made.sequence("s1")
    assert (run.fps, run.source_fps, run.frame_count, run.guessed) == (50.0, 50.0, 50, ("unit",))
    assert sequences.set_facts(made, "s1", unit=0.01).document.sequence("s1").guessed == ()


def test_another_rate_keeps_the_times_of_marks() -> None:
    """Played at half the rate, every second file is shown, and boundaries and keys move to the same second."""
    made = sequences.set_boundaries(document(), "s1", (20, 41)).document
    made = performance.add_key(made, Motion("s1", 30)).document
    made = performance.add_key(made, Motion("s2", 30)).document
    made = sequences.set_facts(made, "s1", fps=12.5).document
    run = made.sequence("s1")
    assert (run.frame_count, run.source_frame(0), run.source_frame(10)) == (25, 0, 20)
    assert run.structure.boundaries == (10, 20)
    assert [key.motion.frame for key in made.performance.keys] == [15, 30]


def test_boundaries_by_hand() -> None:
    """Boundaries are sorted, 0 is none; one is moved, added and taken away among those that are there."""
    made = sequences.set_boundaries(document(), "s1", (30, 10, 0)).document
    assert made.sequence("s1").structure.boundaries == (10, 30)
    moved = sequences.move_boundary(made, "s1", (10, 30), 30, 33)
    assert moved.document.sequence("s1").structure.boundaries == (10, 33)
    assert moved.label == "Move a boundary of run, frame 30 to 33"
    assert moved.frame == 33
    less = sequences.move_boundary(moved.document, "s1", (10, 33), 10, None).document
    assert less.sequence("s1").structure.boundaries == (33,)
    more = sequences.move_boundary(less, "s1", (33,), 0, 5).document
    assert more.sequence("s1").structure.boundaries == (5, 33)
    assert sequences.set_boundaries(more, "s1", None).document.sequence("s1").structure.boundaries is None


def test_key_motions_in_order() -> None:
    """Keys are added at a place, moved, repeated and removed; a change goes back to the best path."""
    made = document()
    for frame in (3, 10, 30):
        made = performance.add_key(made, Motion("s1", frame)).document
    made = performance.add_key(made, Motion("s2", 0), place=1, repeats=2).document
    assert [key.motion.frame for key in made.performance.keys] == [3, 0, 10, 30]
    made = performance.set_alternative(made, 2).document
    made = performance.move_key(made, 3, 0).document
    assert [key.motion.frame for key in made.performance.keys] == [30, 3, 0, 10]
    assert made.performance.alternative == 0
    made = performance.set_repeats(made, 0, 4).document
    made = performance.remove_key(made, 1).document
    assert made.performance.keys == (
        KeyMotion(Motion("s1", 30), 4),
        KeyMotion(Motion("s2", 0), 2),
        KeyMotion(Motion("s1", 10), 1),
    )


def test_deleting_a_sequence_takes_its_motions_along() -> None:
    """Keys, forbidden motions and hard cuts of a deleted sequence go with it; undo brings all back."""
    made = performance.add_key(document(), Motion("s1", 3)).document
    made = performance.add_key(made, Motion("s2", 3)).document
    made = performance.set_forbidden(made, Motion("s1", 9), True).document
    made = performance.set_hard_cut(made, Motion("s1", 9), Motion("s2", 1), True).document
    history = History(made)
    edit = sequences.delete_sequence(made, "s1")
    history.apply(edit.document, edit.label)
    left = history.document.performance
    assert [key.motion.sequence for key in left.keys] == ["s2"]
    assert left.forbidden == ()
    assert left.hard_cuts == ()
    history.undo()
    assert history.document == made


REFUSED: dict[str, Callable[[Document], Edit]] = {
    "at least 2 frames, but has 1": lambda d: sequences.add_sequence(d, name="x", frame_count=1, fps=9, media=RUN),
    "positive number, not -1": lambda d: sequences.set_facts(d, "s1", source_fps=-1),
    "positive number, not nan": lambda d: sequences.set_facts(d, "s1", unit=float("nan")),
    "y or z, not 'x'": lambda d: sequences.set_facts(d, "s1", up="x"),  # type: ignore[arg-type]
    "fewer than 2 frames": lambda d: sequences.set_facts(d, "s1", fps=0.01),
    "frames 1 to 49, not": lambda d: sequences.set_boundaries(d, "s1", (50,)),
    "no boundary at frame 7": lambda d: sequences.move_boundary(d, "s1", (8,), 7, 9),
    "optimal or paper": lambda d: sequences.set_structure(d, "s1", method="magic"),
    "sensitivity must be a positive": lambda d: sequences.set_structure(d, "s1", sensitivity=0),
    "no frame 50": lambda d: sequences.set_representative(d, "s1", 50),
    "no sequence 's9'": lambda d: performance.add_key(d, Motion("s9", 0)),
    "no frame 40": lambda d: performance.set_forbidden(d, Motion("s2", 40), True),
    "no key motion number 0": lambda d: performance.set_repeats(d, 0, 2),
    "0 or more, not -0.5": lambda d: performance.set_mu(d, -0.5),
    "1,000,000 frames, not 0": lambda d: performance.set_length(d, 0),
    "at most 5 seconds": lambda d: performance.set_smoothing(d, seconds=9),
    "already called walk": lambda d: sequences.rename_sequence(d, "s1", "walk"),
    "robust or paper": lambda d: performance.set_methods(d, graph="best"),  # type: ignore[arg-type]
}


@pytest.mark.parametrize("reason", REFUSED)
def test_what_does_not_fit_is_refused(reason: str) -> None:
    """Each refusal is one sentence that says what is wrong."""
    with pytest.raises(ModelError, match=reason):
        REFUSED[reason](document())
