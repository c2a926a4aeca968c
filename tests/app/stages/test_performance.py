"""Stages of performances: what they give, what an edit makes stale, and what it does not."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import attrs
import numpy as np
import pytest

from app.actions import performing
from app.actions.performing_frames import performance_frames, sequence_footage
from app.actions.session import Session
from app.model.edits import performance, sequences
from app.model.performance import Motion
from app.stages.performance.composing import node_of
from imitation import InputError
from tests.app.captured import small_capture, write_capture
from tvmedit import Unreachable

pytestmark = pytest.mark.xdist_group("captured")


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Session]:
    """A project of one sequence with three key motions."""
    folder = tmp_path_factory.mktemp("performance")
    session = Session.new(folder / "film")
    performing.add_sequence(session, write_capture(folder / "take.npz"))
    walk, squat = 10, small_capture().boundaries[0] + 20
    for frame in (walk, squat, walk):
        session.apply(performance.add_key(session.document, Motion("s1", frame)))
    session.save()
    yield session
    session.close()


@pytest.fixture
def session(made: Session) -> Iterator[Session]:
    """The project, whose document is put back afterwards."""
    before = made.history.present
    yield made
    made.jump(before)


def states(session: Session) -> dict[str, str]:
    """How the stages stand."""
    names = ("database", "graph", "paths", "performance", "blends")
    found = {name: session.runner.state(getattr(session.stages, name)) for name in names}
    for kind in ("features", "distances", "structure"):
        found[kind] = session.runner.state(getattr(session.stages, kind)("s1"))
    return found


def test_the_motions_are_those_performed(session: Session) -> None:
    """Boundaries lie within five frames of the truth; statistics are those of the meshes."""
    structure: Any = session.result(session.stages.structure("s1"))
    found = [cluster.first for cluster in structure.clusters[1:]]
    assert np.abs(np.array(found) - small_capture().boundaries).max() <= 5
    counted: Any = session.result(session.stages.features("s1"))
    assert counted.statistics.frames == len(small_capture())
    assert counted.statistics.coloured == len(small_capture())
    assert counted.statistics.height == pytest.approx(1.75, abs=0.06)


def test_a_performance_of_the_key_motions(session: Session) -> None:
    """The keys come in order, every clip stands where the one before it ended, meshes are those of the files."""
    placed: Any = session.result(session.stages.performance)
    graph: Any = session.result(session.stages.graph)
    keys = [placed.performance.path[k] for k in placed.performance.keys]
    assert keys == [node_of(graph, ["s1"], key.motion) for key in session.document.performance.keys]
    cuts = [seam for seam in placed.seams if seam.kind == "cut"]
    assert max(seam.after for seam in cuts) < 0.25 < max(seam.before for seam in cuts)
    session.result(session.stages.blends)
    frames = performance_frames(session)
    assert len(frames) == len(placed.performance)
    sequence, frame = placed.performance.frames[3]
    filmed = sequence_footage(session, "s1")[int(frame)]
    assert int(sequence) == 0
    np.testing.assert_allclose(frames[3].vertices[:, 2], filmed.vertices[:, 2])
    assert frames[3].colours is not None


def test_mu_searches_again_and_compares_nothing(session: Session) -> None:
    """Another mu leaves everything below the graph as it is; back again, nothing is computed."""
    session.result(session.stages.blends)
    session.apply(performance.set_mu(session.document, 0.91))
    now = states(session)
    assert {now[name] for name in ("features", "distances", "structure", "database")} == {"fresh"}
    assert now["graph"] != "fresh"
    session.result(session.stages.paths)
    session.undo()
    assert set(states(session).values()) == {"fresh"}


def test_a_boundary_by_hand_is_followed_downstream(session: Session) -> None:
    """A moved boundary keeps features and distances; motions and everything after them are of the new boundaries."""
    before: Any = session.result(session.stages.graph)
    session.result(session.stages.blends)
    present = tuple(c.first for c in session.result(session.stages.structure("s1")).clusters[1:])  # type: ignore[attr-defined]
    session.apply(sequences.move_boundary(session.document, "s1", present, present[-1], present[-1] + 7))
    now = states(session)
    assert now["features"] == now["distances"] == "fresh"
    assert now["structure"] == now["database"] == now["performance"] == "stale"
    after: Any = session.result(session.stages.graph)
    assert after.analyses[0].structure.clusters[-1].first == present[-1] + 7
    assert len(after.nodes) == len(before.nodes)


def test_a_representative_by_hand(session: Session) -> None:
    """The texton of the chosen frame stands for its motion."""
    graph: Any = session.result(session.stages.graph)
    cluster = graph.analyses[0].structure.clusters[0]
    node = graph.nodes[0]
    other = next(texton for texton in cluster.textons if texton != (node.first, node.last))
    session.apply(sequences.set_representative(session.document, "s1", other[0] + 1))
    chosen: Any = session.result(session.stages.graph)
    assert (chosen.nodes[0].first, chosen.nodes[0].last) == other


def test_the_front_is_turned_without_reading_again(session: Session) -> None:
    """A front set by the user turns all headings by one angle."""
    before: Any = session.result(session.stages.analysis("s1"))
    session.apply(sequences.set_front(session.document, "s1", 90.0))
    assert states(session)["features"] == "fresh"
    after: Any = session.result(session.stages.analysis("s1"))
    assert after.headings[0] == pytest.approx(np.pi / 2)
    np.testing.assert_allclose(np.diff(after.headings), np.diff(before.headings), atol=1e-9)


def test_a_forbidden_motion_is_not_played(session: Session) -> None:
    """Without the motion between them a key is out of reach: the smallest mu that helps is named, and does help."""
    graph: Any = session.result(session.stages.graph)
    named = performing.motions(session.document, graph)
    session.apply(performance.set_forbidden(session.document, named[2].motion, True))
    with pytest.raises(Unreachable) as caught:
        session.result(session.stages.paths)
    said = str(performing.explained(caught.value, named))
    mu = float(re.search(r"is ([\d.]+),", said)[1])  # type: ignore[index]
    assert re.fullmatch(
        r"take/2 cannot be reached from take/1: the smallest mu that reaches it is [\d.]+, "
        r"which adds take/\d to take/2\.",
        said,
    )
    session.apply(performance.set_mu(session.document, mu))
    found: Any = session.result(session.stages.paths)
    assert all(2 not in path.path for path in found)


def test_a_wanted_length(session: Session) -> None:
    """A length that can be reached is kept exactly; of another the nearest is taken, and why is said."""
    found: Any = session.result(session.stages.paths)
    graph: Any = session.result(session.stages.graph)
    period = len(graph.nodes[0])
    session.apply(performance.set_length(session.document, len(found[0]) + period))
    (exact,) = session.result(session.stages.paths)  # type: ignore[misc]
    assert len(exact) == len(found[0]) + period
    assert exact.note == ""
    session.apply(performance.set_length(session.document, 2))
    (nearest,) = session.result(session.stages.paths)  # type: ignore[misc]
    assert "2 frames cannot be reached" in nearest.note


def test_names_and_looks_make_nothing_stale(session: Session) -> None:
    """Renaming and hiding a sequence leaves all results as they are."""
    session.result(session.stages.blends)
    session.apply(sequences.rename_sequence(session.document, "s1", "other"))
    session.apply(sequences.show_sequence(session.document, "s1", False))
    assert set(states(session).values()) == {"fresh"}


def test_blends_of_a_cut_serve_wherever_it_is_played(session: Session) -> None:
    """The same cut later in a performance has the same in-betweens, placed where the performer is then."""
    graph: Any = session.result(session.stages.graph)
    named = performing.motions(session.document, graph)
    walk, again = named[0], named[3]
    session.apply(performance.set_keys(session.document, ()))
    for motion in (walk, again, walk, again):
        session.apply(performance.add_key(session.document, motion.motion))
    made: Any = session.result(session.stages.blends)
    placed: Any = session.result(session.stages.performance)
    first = made.blends[0]
    later = next(b for b in made.blends[1:] if (b.cut.leave, b.cut.enter) == (first.cut.leave, first.cut.enter))
    assert later.shapes
    assert sorted(later.shapes) == [k + later.cut.position - first.cut.position for k in sorted(first.shapes)]
    k = min(first.shapes)
    one = first.shapes[k].vertices
    two = later.shapes[k + later.cut.position - first.cut.position].vertices
    place = placed.performance.transforms
    yaw = place[later.cut.position - 1, 0] - place[first.cut.position - 1, 0]
    turned = one[:, 0] * np.cos(yaw) - one[:, 1] * np.sin(yaw)
    np.testing.assert_allclose(turned - turned[0], two[:, 0] - two[0, 0], atol=1e-6)
    frames = performance_frames(session)
    np.testing.assert_array_equal(frames[k].vertices, one)
    assert frames.blended(k)
    assert not performance_frames(session, blended=False).blended(k)


def test_a_hard_cut_is_left_alone(session: Session) -> None:
    """A cut that the user wants hard is not blended."""
    made: Any = session.result(session.stages.blends)
    cut = made.blends[0].cut
    edit = performance.set_hard_cut(session.document, Motion("s1", cut.leave), Motion("s1", cut.enter), True)
    session.apply(edit)
    left: Any = session.result(session.stages.blends)
    assert all((b.cut.leave, b.cut.enter) != (cut.leave, cut.enter) for b in left.blends)


def test_rates_and_sizes_that_do_not_go_together(session: Session) -> None:
    """Different rates are converted when a sequence is added; forced apart, the database says so; so do units."""
    media = session.document.sequence("s1").media
    assert media is not None
    made, note = performing.add_sequence(session, Path(media.path), name="fast", fps=30.0)
    added = session.document.sequence(made)
    assert (added.fps, added.source_fps) == (15.0, 30.0)
    assert "played at 15" in note
    session.apply(sequences.set_facts(session.document, made, fps=30.0))
    with pytest.raises(InputError, match="fast is played at 30 frames a second and take at 15"):
        session.result(session.stages.database)
    session.apply(sequences.set_facts(session.document, made, fps=15.0, unit=0.001))
    with pytest.raises(InputError, match=r"Sequence 2 is 0\.001 times as tall"):
        session.result(session.stages.database)


def test_files_that_changed_are_refused(session: Session) -> None:
    """Another number of frames than the project was made with is said, not played."""
    document = session.document
    shorter = attrs.evolve(document.sequence("s1"), source_count=7, frame_count=7)
    session.history.apply(document.with_sequence(shorter), "Break it")
    with pytest.raises(InputError, match="put the old files back"):
        session.result(session.stages.features("s1"))


def test_nothing_is_composed_of_nothing(session: Session) -> None:
    """What is missing is said."""
    session.apply(performance.set_keys(session.document, ()))
    assert session.runner.state(session.stages.performance) == "blocked"
    with pytest.raises(InputError, match="key motion"):
        session.result(session.stages.performance)


def test_a_reopened_project_finds_its_results(session: Session) -> None:
    """Stored results come back from the folder with the same bits."""
    session.result(session.stages.blends)
    before = performance_frames(session)
    again = Session.open(session.folder.path)
    try:
        assert again.runner.state(again.stages.blends) == "fresh"
        again.result(again.stages.performance)
        again.result(again.stages.blends)
        after = performance_frames(again)
        for position in range(0, len(before), 9):
            np.testing.assert_array_equal(before[position].vertices, after[position].vertices)
    finally:
        again.close()
