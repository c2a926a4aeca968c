"""What is wrong with a motion, the colours that show it, and placing a character by hand."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path

import attrs
import numpy as np
import pytest

from app.actions import aligning, checking, heat, posing
from app.actions.session import Session
from app.model.edits import characters
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


def only(session: Session) -> str:
    """The id of the only character."""
    return session.document.characters[0].id


def test_spans_join_what_is_close() -> None:
    """Two frames apart are one span, four are two."""
    bad = np.zeros(20, bool)
    bad[[3, 4, 7, 12]] = True
    assert checking.spans(bad) == [(3, 7), (12, 12)]
    assert checking.spans(np.zeros(4, bool)) == []


def test_a_limb_that_is_pulled_out_is_the_worst_stretch(session: Session) -> None:
    """The span holds the edited frame, names how long the mesh is, and points at a vertex near the pulled one."""
    vertices = animated(session)
    size = float(np.linalg.norm(np.ptp(vertices[0], axis=0)))
    before = checking.check_motion(session, only(session))
    vertex = free_vertex(session, vertices)
    posing.move_vertex(session, only(session), FRAME, vertex, vertices[FRAME, vertex] + [0, 0, 0.5 * size])
    animated(session)
    heard = []
    after = checking.check_motion(session, only(session), heard=lambda: heard.append(1))
    assert len(heard) == len(vertices)
    worst = next(each for each in after.problems if each.kind == "stretch")
    assert worst.first <= FRAME <= worst.last
    assert worst.severity > max((each.severity for each in before.problems if each.kind == "stretch"), default=0.0)
    assert "stretched to" in worst.text
    assert f"frames {worst.first}–{worst.last}" in worst.text or f"frame {worst.first}" in worst.text
    near = np.linalg.norm(vertices[FRAME] - vertices[FRAME, vertex], axis=1)
    assert near[worst.vertex] < 0.4 * size


def test_a_sunken_pose_is_below_the_ground(session: Session) -> None:
    """Stood on its contacts nothing is below; put half its height under them it is as deep as it was put."""
    vertices = animated(session)[FRAME]
    world = session.result(session.stages.world)
    placed = [each for track in session.document.tracks for each in session.result(session.stages.contacts(track.id))]
    level = float(np.median([each.place[2] for each in placed]))
    standing = np.add(vertices, [0, 0, level - vertices[:, 2].min()])
    height = float(np.ptp(vertices[:, 2]))
    assert checking.sunk_in_frame(session, world, FRAME, standing).max() == pytest.approx(0.0, abs=1e-9)
    sunk = checking.sunk_in_frame(session, world, FRAME, standing - [0, 0, 0.5 * height])
    assert sunk.max() == pytest.approx(0.5 * height)
    assert sunk[int(standing[:, 2].argmax())] == 0.0


def test_drift_is_what_is_seen_in_a_frame(session: Session) -> None:
    """The distance of a vertex from its point in pixels; a pose moved sideways drifts by as much everywhere."""
    vertices = animated(session)
    world = session.result(session.stages.world)
    camera = world.camera(FRAME)
    found = checking.drift_in_frame(session, only(session), FRAME, vertices[FRAME])
    assert set(found) <= set(session.document.characters[0].pairs.values())
    check = checking.check_motion(session, only(session))
    names = {session.document.characters[0].pairs[track]: track for track in check.drift}
    for vertex, pixels in found.items():
        assert pixels == pytest.approx(check.drift[names[vertex]][FRAME])
    shifted = checking.drift_in_frame(session, only(session), FRAME, vertices[FRAME] + 0.2 * camera.R[0])
    assert min(shifted.values()) > max(found.values())


@pytest.mark.parametrize(
    ("usual", "worse", "frames", "found"),
    [
        (0.1, 1.2, 2, 0),  # a little over, for a moment
        (0.1, 1.2, 4, 1),  # the same, long enough to be seen
        (0.1, 2.5, 1, 1),  # a flash
        (1.0, 1.3, 4, 0),  # pairs that are as loose everywhere
        (1.0, 3.5, 4, 1),  # one that stands out of them
    ],
)
def test_what_of_a_drift_is_warned_of(
    session: Session, monkeypatch: pytest.MonkeyPatch, usual: float, worse: float, frames: int, found: int
) -> None:
    """Distances in multiples of what is seen, one point farther for some frames, twice: one problem, or none."""
    limit = checking.drift_limit(session)
    count = len(animated(session))
    drift = {track: np.full(count, usual * limit) for track in session.document.characters[0].pairs}
    first = next(iter(drift))
    for begin in (2, 2 + frames + 4):
        drift[first][begin : begin + frames] = worse * limit
    assert 2 + 2 * frames + 4 < count
    monkeypatch.setattr(checking, "_drift", lambda *_: drift)
    drifting = [each for each in checking.check_motion(session, only(session)).problems if each.kind == "drift"]
    assert len(drifting) == found
    if found:
        assert (drifting[0].first, drifting[0].last, len(drifting[0].more)) == (2, 1 + frames, 1)
        assert "once more" in drifting[0].text


def test_a_motion_that_is_wrong_as_a_whole_is_not_excused(session: Session, monkeypatch: pytest.MonkeyPatch) -> None:
    """All points far from the video, evenly: each is warned of."""
    limit, count = checking.drift_limit(session), len(animated(session))
    pairs = session.document.characters[0].pairs
    monkeypatch.setattr(checking, "_drift", lambda *_: {track: np.full(count, 4 * limit) for track in pairs})
    problems = checking.check_motion(session, only(session)).problems
    assert sum(each.kind == "drift" for each in problems) == len(pairs)


def test_each_point_and_kind_is_one_problem(session: Session) -> None:
    """And the hidden stretches of a point are no drift."""
    check = checking.check_motion(session, only(session))
    named = [(each.kind, each.subject, each.vertex if each.subject else -1) for each in check.problems]
    assert len(set(named)) == len(named)
    for track, pixels in check.drift.items():
        state = session.result(session.stages.track(track)).state
        assert np.isnan(pixels[state != "visible"]).all()


def test_colours_say_where(session: Session) -> None:
    """At rest all is grey; a stretched mesh is hot, a squeezed one cold; below the ground is hot."""
    vertices = animated(session)
    placed = session.result(session.stages.alignment(only(session))).vertices
    calm = heat.heat_of(session, only(session), "stretch", 0, placed)
    assert np.ptp(calm.colours.astype(int), axis=0).max() <= 1
    hot = heat.heat_of(session, only(session), "stretch", 0, 1.5 * placed)
    assert (hot.colours == heat.HOT).all()
    assert (heat.heat_of(session, only(session), "stretch", 0, placed / 1.5).colours == heat.COLD).all()
    sunk = heat.heat_of(session, only(session), "sunk", FRAME, vertices[FRAME] - [0, 0, 0.1])
    lowest = int(vertices[FRAME][:, 2].argmin())
    assert sunk.values[lowest] > 0.05
    assert tuple(sunk.colours[int(vertices[FRAME][:, 2].argmax())]) == heat.REST


def test_a_placement_by_hand_is_what_was_shown_before(session: Session) -> None:
    """What the gizmo shows while it is dragged is where the character then stands; taken off its pairs it stays."""
    character = only(session)
    placed = session.result(session.stages.alignment(character)).vertices
    centre = placed.mean(0)
    change = {"shift": np.array([0.1, -0.2, 0.05]), "turn": np.array([0.1, 0.3, -0.2]), "scale": 1.2}
    shown = aligning.stood(placed, centre, **change)
    for part in change:
        session.apply(aligning.changed(session.document, character, **{part: change[part]}), gesture="place")
    now = session.result(session.stages.alignment(character)).vertices
    assert np.allclose(now, shown, atol=1e-9)
    session.apply(aligning.by_hand(session, character))
    assert not session.document.characters[0].alignment.fitted
    assert np.allclose(session.result(session.stages.alignment(character)).vertices, now, atol=1e-9)
    session.apply(aligning.to_pairs(session.document, character))
    assert np.allclose(session.result(session.stages.alignment(character)).vertices, placed, atol=1e-12)


def test_a_mesh_without_pairs_is_stood_on_the_subject(session: Session) -> None:
    """On the ground under the mask of frame 0, as high as the mask, its long side across the picture."""
    placed = session.result(session.stages.alignment(only(session))).vertices
    world = session.result(session.stages.world)
    for track in tuple(session.document.characters[0].pairs):
        session.apply(characters.remove_pair(session.document, only(session), track))
    with pytest.raises(InputError):
        session.result(session.stages.alignment(only(session)))
    session.apply(aligning.by_hand(session, only(session)))
    stands = session.result(session.stages.alignment(only(session))).vertices
    size = float(np.linalg.norm(np.ptp(placed, axis=0)))
    assert abs(stands[:, 2].min() - world.offset) < 0.15 * size
    assert 0.6 < np.ptp(stands[:, 2]) / np.ptp(placed[:, 2]) < 1.6
    assert np.linalg.norm(stands.mean(0) - placed.mean(0)) < 0.6 * size
    assert attrs.asdict(session.document.characters[0].alignment)["up"] == "z"
