"""Copying poses, and vertices of which only the image point is chosen."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from app.actions import pose_copies, posing
from app.actions.session import Session
from app.storage.schema import document_from_json, document_to_json
from imitation import InputError
from tests.app.actions.test_posing import FRAME, animated, free_vertex

pytestmark = [pytest.mark.xdist_group("solved project"), pytest.mark.slow]


@pytest.fixture
def session(solved_project: Path, tmp_path: Path) -> Iterator[Session]:
    """A session on a copy of the solved project."""
    copy = tmp_path / "film.motionwright"
    shutil.copytree(solved_project, copy)
    opened = Session.open(copy)
    yield opened
    opened.close()


def test_of_a_vertex_on_its_ray_only_the_image_point_is_held(session: Session) -> None:
    """Its pixel is the one asked for, its depth is the mesh's own; committed anew it keeps to its ray."""
    character = session.document.characters[0].id
    before = animated(session)
    vertex = free_vertex(session, before)
    world = session.result(session.stages.world)
    camera = world.camera(FRAME)
    size = np.linalg.norm(np.ptp(before[0], axis=0))
    pixel = np.add(camera.project(before[FRAME, vertex]), [14.0, -9.0])
    held = camera.lift(pixel, float(camera.depth(before[FRAME, vertex])) + 0.1 * size)
    drag = posing.PoseDrag(session, character, FRAME)
    drag.move({vertex: held}, on_rays=[vertex])
    session.apply(posing.release(session, drag, [vertex]))
    move = session.document.characters[0].edits[FRAME].moves[vertex]
    assert move.on_ray
    assert np.allclose(camera.project(np.array(move.place)), pixel, atol=1e-6)
    assert abs(float(camera.depth(np.array(move.place)) - camera.depth(held))) > 0.03 * size, "the depth gave way"
    assert np.allclose(animated(session)[FRAME, vertex], move.place, atol=1e-6 * size)
    posing.move_vertex(session, character, FRAME, free_vertex(session, before) ^ 1, before[FRAME, vertex ^ 1])
    posing.delete_move(session, character, FRAME, vertex ^ 1)
    again = session.document.characters[0].edits[FRAME]
    assert np.allclose(camera.project(np.array(again.committed[vertex])), pixel, atol=1e-6)
    assert document_from_json(document_to_json(session.document), "x") == session.document


def test_a_pasted_pose_goes_along_with_the_body(session: Session) -> None:
    """The same vertices are moved as far, turned with the body; one entry that names both frames."""
    character = session.document.characters[0].id
    before = animated(session)
    vertex = free_vertex(session, before)
    offset = np.array([0.01, -0.02, 0.05])
    posing.move_vertex(session, character, FRAME, vertex, before[FRAME, vertex] + offset)
    copy = pose_copies.copy_pose(session, character, FRAME)
    assert np.allclose(copy.offsets[vertex], offset)
    entries = len(session.history.versions)
    session.apply(pose_copies.paste_pose(session, 18, copy))
    assert len(session.history.versions) == entries + 1
    assert session.history.undo_label == f"Paste pose of frame {FRAME} of subject, frame 18"
    edit = session.document.characters[0].edits[18]
    assert set(edit.moves) == {vertex}
    assert np.linalg.norm(np.subtract(edit.moves[vertex].place, before[18, vertex])) == pytest.approx(
        np.linalg.norm(offset)
    )
    assert np.allclose(animated(session)[18, vertex], edit.moves[vertex].place, atol=1e-6)


def test_only_an_edited_frame_can_be_copied(session: Session) -> None:
    """The sentence says where to go."""
    animated(session)
    with pytest.raises(InputError, match="no pose edit in frame 3: go to an edited frame"):
        pose_copies.copy_pose(session, session.document.characters[0].id, 3)


def test_the_pose_of_an_edited_frame_is_known_before_it_has_spread(session: Session) -> None:
    """It is what the animation then shows there, to the solver's rest."""
    character = session.document.characters[0].id
    before = animated(session)
    vertex = free_vertex(session, before)
    posing.move_vertex(session, character, FRAME, vertex, before[FRAME, vertex] + [0, 0, 0.04])
    alone = posing.edited_frame(session, character, FRAME)
    assert alone is not None
    assert np.array_equal(alone, animated(session)[FRAME])
    assert np.array_equal(posing.edited_frame(session, character, 3), before[3])
