"""Posing by hand: the vertex is where it was put, the rest follows, undo brings everything back."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from app.actions import posing
from app.actions.session import Session
from app.model.edits import characters
from app.stages.results import Animation
from imitation import InputError

pytestmark = [pytest.mark.xdist_group("solved project"), pytest.mark.slow]
FRAME = 10


@pytest.fixture
def session(solved_project: Path, tmp_path: Path) -> Iterator[Session]:
    """A session on a copy of the solved project."""
    copy = tmp_path / "film.motionwright"
    shutil.copytree(solved_project, copy)
    opened = Session.open(copy)
    yield opened
    opened.close()


def animated(session: Session) -> np.ndarray:
    """The motion of the only character."""
    result = session.result(session.stages.animation(session.document.characters[0].id))
    assert isinstance(result, Animation)
    return result.vertices


def free_vertex(session: Session, vertices: np.ndarray) -> int:
    """A vertex far from all paired ones."""
    paired = list(session.document.characters[0].pairs.values())
    away = np.linalg.norm(vertices[0][:, None] - vertices[0][paired], axis=2).min(axis=1)
    return int(away.argmax())


def test_a_moved_vertex_is_where_it_was_put_and_undo_takes_it_back(session: Session) -> None:
    """In its frame exactly; its neighbours in time move too; undo finds the old bits without solving."""
    character = session.document.characters[0].id
    before = animated(session)
    vertex = free_vertex(session, before)
    size = np.linalg.norm(np.ptp(before[0], axis=0))
    place = before[FRAME, vertex] + [0, 0, 0.04 * size]
    posing.move_vertex(session, character, FRAME, vertex, place)
    assert session.history.undo_label == f"Move vertex {vertex} of subject, frame {FRAME}"
    after = animated(session)
    assert np.abs(after[FRAME, vertex] - place).max() < 1e-6 * size
    assert np.linalg.norm(after[FRAME + 2, vertex] - before[FRAME + 2, vertex]) > 0.01 * size
    assert np.array_equal(after[0], before[0])
    session.undo()
    assert session.runner.state(session.stages.animation(character)) == "fresh"
    assert np.array_equal(animated(session), before)


def test_feet_are_lifted_onto_their_contacts_and_undo_lets_them_sink(session: Session) -> None:
    """No foot is below its contacts; what is lifted goes straight up; without it the old bits are there at once."""
    character = session.document.characters[0]
    before = animated(session)
    session.apply(characters.set_solve(session.document, character.id, lift_feet=True))
    after, world = animated(session), session.result(session.stages.world)
    up = world.normal  # type: ignore[attr-defined]
    change = after - before
    assert np.abs(change - (change @ up)[..., None] * up).max() < 1e-12
    assert (change @ up).min() >= 0
    for track in session.document.tracks:
        for contact in session.result(session.stages.contacts(track.id)) or () if track.contacts else ():  # type: ignore[attr-defined]
            foot = after[contact.first : contact.last + 1, character.pairs[track.id]]
            assert (foot @ up).min() > float(contact.place @ up) - 1e-9
    session.undo()
    assert session.runner.state(session.stages.animation(character.id)) == "fresh"
    assert np.array_equal(animated(session), before)


def test_deleting_an_edit_is_as_if_it_had_never_been(session: Session) -> None:
    """Two edits, one deleted: the bits of the other alone."""
    character = session.document.characters[0].id
    before = animated(session)
    vertex = free_vertex(session, before)
    size = np.linalg.norm(np.ptp(before[0], axis=0))
    posing.move_vertex(session, character, 5, vertex, before[5, vertex] + [0, 0, 0.03 * size])
    alone = animated(session)
    session.apply(posing.poses.set_edit_end(session.document, character, 5, 9))
    session.undo()
    posing.move_vertex(session, character, 15, vertex, alone[15, vertex] + [0, 0, 0.03 * size])
    both = animated(session)
    assert not np.array_equal(both[15], alone[15])
    posing.delete_move(session, character, 15, vertex)
    assert np.array_equal(animated(session), alone)


def test_a_muted_move_has_no_effect_and_comes_back(session: Session) -> None:
    """Muting the only move of a frame gives the base solution, unmuting the edit."""
    character = session.document.characters[0].id
    before = animated(session)
    vertex = free_vertex(session, before)
    posing.move_vertex(session, character, FRAME, vertex, before[FRAME, vertex] + [0, 0, 0.02])
    edited = animated(session)
    posing.mute_move(session, character, FRAME, vertex, True)
    assert np.array_equal(animated(session), before)
    posing.mute_move(session, character, FRAME, vertex, False)
    assert np.allclose(animated(session), edited, atol=1e-6)


def test_a_drag_follows_the_mouse_and_commits_what_was_seen(session: Session) -> None:
    """Each move of a drag gives a mesh with the vertex under the hand; release commits every key point."""
    character = session.document.characters[0].id
    before = animated(session)
    vertex = free_vertex(session, before)
    drag = posing.PoseDrag(session, character, FRAME)
    for step in range(1, 4):
        place = before[FRAME, vertex] + [0, 0, 0.01 * step]
        mesh = drag.move({vertex: place})
        assert np.abs(mesh[vertex] - place).max() < 1e-6
    edit = posing.release(session, drag, [vertex])
    committed = edit.document.characters[0].edits[FRAME].committed
    assert set(committed) == {vertex, *session.document.characters[0].pairs.values()}


def test_what_is_made_ready_is_all_that_a_release_needs(session: Session, monkeypatch: pytest.MonkeyPatch) -> None:
    """After it no slow direction is looked for and no mesh is factored until the edit has spread; the bits agree."""
    import imitation.deformation.modes as slow
    import imitation.deformation.system as system

    character = session.document.characters[0].id
    before = animated(session)
    vertex = free_vertex(session, before)
    place = before[FRAME, vertex] + [0, 0, 0.05]
    posing.move_vertex(session, character, FRAME, vertex, place)
    cold = animated(session)
    session.undo()
    session.cache._held.clear()
    session.cache.store.clear()  # type: ignore[union-attr]
    session.media.memory.clear()
    session.media._deformers.clear()
    animated(session)
    session.media._deformers.clear()
    posing.make_ready(session, character)
    posing.make_ready(session, character, FRAME, [vertex])

    def never(*given: object) -> None:
        raise AssertionError("this was to be ready")

    monkeypatch.setattr(slow, "slow_modes", never)
    monkeypatch.setattr(system, "factorise", never)
    posing.move_vertex(session, character, FRAME, vertex, place)
    assert np.array_equal(animated(session), cold)


def test_posing_before_animating_says_what_to_do(session: Session) -> None:
    """A character whose inputs changed has to be animated first."""
    from app.model.edits import tracks

    track = session.document.tracks[0]
    session.apply(tracks.set_click(session.document, track.id, 7, (100, 100)))
    with pytest.raises(InputError, match="animate it, then pose it"):
        posing.PoseDrag(session, session.document.characters[0].id, FRAME)


def test_frame_0_is_posed_before_anything_is_solved(session: Session) -> None:
    """An edit of frame 0 is the start of the solution; it goes on from there, and undo finds the old bits."""
    character = session.document.characters[0].id
    before, key = animated(session), session.stages.base(character).key
    vertex = next(iter(session.document.characters[0].pairs.values()))
    size = np.linalg.norm(np.ptp(before[0], axis=0))
    place = before[0, vertex] + [0, 0, -0.05 * size]
    posing.move_vertex(session, character, 0, vertex, place)
    assert session.stages.base(character).key != key
    # The next drag does not wait for the clip to be solved anew.
    session.result(session.stages.start(character))
    assert session.ready(session.stages.base(character)) is None
    assert np.array_equal(posing.PoseDrag(session, character, 0).before[vertex], place)
    after = animated(session)
    assert np.array_equal(after[0, vertex], place)
    assert np.linalg.norm(after[-1, vertex] - before[-1, vertex]) > 0.01 * size
    report = session.result(session.stages.animation(character)).report  # type: ignore[attr-defined]
    assert report["edited_frames"] == 1
    session.undo()
    assert session.runner.state(session.stages.animation(character)) == "fresh"
    assert np.array_equal(animated(session), before)


def test_frame_0_with_an_end_leaves_the_solution_alone(session: Session) -> None:
    """Where the user says how far the edit of frame 0 counts, the rest of the clip keeps its bits."""
    character = session.document.characters[0].id
    before, key = animated(session), session.stages.base(character).key
    vertex = free_vertex(session, before)
    posing.move_vertex(session, character, 0, vertex, before[0, vertex] + [0, 0, 0.03])
    session.apply(posing.poses.set_edit_end(session.document, character, 0, 8))
    assert session.stages.base(character).key == key
    after = animated(session)
    assert np.array_equal(after[8:], before[8:])
    assert not np.array_equal(after[4], before[4])


def test_a_move_of_frame_0_deleted_is_as_if_never_made(session: Session) -> None:
    """Two moves in frame 0, one deleted: the bits of the other alone."""
    character = session.document.characters[0].id
    before = animated(session)
    free, paired = free_vertex(session, before), next(iter(session.document.characters[0].pairs.values()))
    posing.move_vertex(session, character, 0, free, before[0, free] + [0, 0, 0.03])
    alone = session.document.characters[0].edits[0].committed
    posing.move_vertex(session, character, 0, paired, before[0, paired] + [0.02, 0, 0])
    posing.delete_move(session, character, 0, paired)
    again = session.document.characters[0].edits[0].committed
    assert set(again) == set(alone)
    np.testing.assert_allclose([again[v] for v in again], [alone[v] for v in again], atol=1e-12)
