"""The built-in sample: its files agree with each other, with the pictures, and with the program that made them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from imitation.errors import InputError
from resources.world import make_body, ply, sample, walk
from resources.world.characters import make_fox, vertex_colours
from resources.world.make import sample_camera
from resources.world.render import Look, Stage
from resources.world.scene import garden
from resources.world.terrain import STAIRS
from resources.world.user import clicks, lasso, marked


@pytest.fixture(scope="module")
def built() -> sample.Sample:
    """The sample as users get it."""
    return sample.load()


def test_the_clip_is_what_was_promised(built: sample.Sample) -> None:
    """81 frames of 960 x 540 at 25 a second, mp4 under 3 MB, truth under 4 MB."""
    frames = list(built.frames())
    assert len(frames) == len(built) == 81
    assert frames[0].shape == (540, 960, 3)
    assert built.fps == 25
    assert built.video.stat().st_size < 3_000_000
    assert (sample.FOLDER / "truth.npz").stat().st_size < 4_000_000
    assert np.linalg.norm(np.diff(built.cameras.centres, axis=0), axis=1).sum() > 1


def test_clicks_are_on_what_is_seen(built: sample.Sample) -> None:
    """16 tracks, each clicked about every 20 frames where the point is to be seen, at most 0.5 px off in x and y."""
    assert len(built.clicks) == 16
    tracks = built.tracks()
    for name, found in built.clicks.items():
        assert found, name
        for frame, place in found.items():
            assert np.abs(tracks[name][frame] - place).max() <= 0.51, (name, frame)
            assert built.truth.visible[name][frame], (name, frame)
    assert np.mean([len(found) for found in built.clicks.values()]) > 3.5


def test_lassos_go_round_the_subject(built: sample.Sample) -> None:
    """About every 15 frames; what is seen of the subject is inside, and not much else."""
    import cv2

    assert len(built.lassos) >= 6
    assert max(np.diff(sorted(built.lassos))) <= 20
    names = list(built.truth.visible)
    vertices = built.subject.key_vertices | built.subject.extra_vertices
    for frame, line in built.lassos.items():
        inside = np.zeros((540, 960), np.uint8)
        cv2.fillPoly(inside, [np.rint(line).astype(np.int32)], 1)
        pixels = built.cameras[frame].project(built.subject.vertices(frame))
        at = np.rint(pixels).astype(int)
        assert inside[at[:, 1], at[:, 0]].mean() > 0.93, frame
        seen = [vertices[n] for n in names if built.truth.visible[n][frame]]
        assert inside[at[seen, 1], at[seen, 0]].all(), frame
        box = np.prod(np.ptp(pixels, axis=0))
        assert inside.sum() < 0.85 * box


def test_marked_contacts_are_true(built: sample.Sample) -> None:
    """Every marked interval lies in a true one, within a frame of its ends, and the sole stands still in it."""
    assert set(built.contacts) == set(built.subject.contacts)
    for name, spans in built.contacts.items():
        track = built.subject.points({name: built.subject.key_vertices[name]})[name]
        for first, last in spans:
            assert any(a <= first <= a + 1 and b - 1 <= last <= b for a, b, _ in built.subject.contacts[name])
            assert np.ptp(track[first : last + 1], axis=0).max() < 1e-12
    for name, spans in built.world_contacts().items():
        for first, _, place in spans:
            assert built.subject.vertices(first)[built.subject.key_vertices[name]] == pytest.approx(place)


def test_characters_stand_on_the_subject(built: sample.Sample) -> None:
    """Aligned, each character is in frame 0 where its truth begins; the hound is the subject itself."""
    assert {name: len(c.vertices) for name, c in built.characters.items()} == {"hound": 2500, "fox": 6000}
    subject = built.subject.vertices(0)
    for name, character in built.characters.items():
        np.testing.assert_allclose(character.aligned, character.moving.vertices(0), atol=2e-6)
        np.testing.assert_array_equal(character.faces, character.moving.faces)
        assert set(character.pairs) == set(built.clicks)
        assert character.colours.std(axis=0).min() > 20
        names = built.subject.key_vertices | built.subject.extra_vertices
        for track, vertex in character.pairs.items():
            gap = np.linalg.norm(character.aligned[vertex] - subject[names[track]])
            assert gap < (1e-5 if name == "hound" else 0.45), track
    hound = built.characters["hound"].moving
    np.testing.assert_array_equal(hound.vertices(50), built.subject.vertices(50))


def test_characters_keep_their_feet_on_the_treads(built: sample.Sample) -> None:
    """The stored motions have the same planted feet as the walks they come from."""
    for moving in built.truth.movers.values():
        sequence = moving.sequence()
        for name, spans in moving.contacts.items():
            for first, last, place in spans:
                stands = sequence[first : last + 1, moving.key_vertices[name]]
                np.testing.assert_allclose(stands, np.broadcast_to(place, stands.shape), atol=1e-9)


def test_known_length_is_that_of_the_post(built: sample.Sample) -> None:
    """The two points are a post's ends: its foot on the ground seen through the true camera, 0.78 m apart."""
    (ax, ay), (bx, by), metres = built.length
    assert metres == 0.78
    depth = built.depth(0)
    foot = built.cameras[0].lift([ax, ay], depth[round(ay), round(ax)])
    assert foot[1] == pytest.approx(-0.72, abs=0.1)
    top = built.cameras[0].lift([bx, by], built.cameras[0].depth(foot))
    assert np.linalg.norm(top - foot) == pytest.approx(0.78, rel=0.12)


@pytest.mark.slow
def test_the_files_are_what_the_program_makes(built: sample.Sample) -> None:
    """Bodies, walk, cameras and one picture made anew agree with the files."""
    body = make_body("quadruped")
    walked = walk(body, 81, STAIRS)
    np.testing.assert_allclose(built.subject.vertices(33), walked.vertices[33], atol=1e-7)
    cameras = sample_camera(walked)
    np.testing.assert_allclose(cameras.R, built.cameras.R, atol=1e-9)
    stage = Stage(garden(STAIRS), walked, Look())
    frame = next(f for t, f in enumerate(built.frames()) if t == 20).astype(float)
    off = frame - stage.frame(20, cameras)
    assert 10 * np.log10(255**2 / (off**2).mean()) > 28
    np.testing.assert_array_equal(built.depth(20), stage.depth(20, cameras[20]))


@pytest.mark.slow
def test_the_fox_is_closed_and_coloured() -> None:
    """About 6,000 vertices, closed, Euler number 2, in a fox's colours."""
    fox = make_fox()
    edges = np.unique(
        np.sort(np.concatenate([fox.faces[:, [0, 1]], fox.faces[:, [1, 2]], fox.faces[:, [2, 0]]])), axis=0
    )
    assert len(fox.vertices) - len(edges) + len(fox.faces) == 2
    assert len(edges) * 2 == len(fox.faces) * 3
    assert abs(len(fox.vertices) - 6000) < 100
    colours = vertex_colours(fox, "fox").astype(int)
    assert (colours[:, 0] > colours[:, 2]).mean() > 0.9


def test_a_missing_sample_says_how_to_make_it(tmp_path: Path) -> None:
    """The message names the command."""
    with pytest.raises(InputError, match=r"python -m resources\.world"):
        sample.load(tmp_path)


def test_ply_files_come_back(tmp_path: Path) -> None:
    """What is written is read again, to float32."""
    rng = np.random.default_rng(2)
    vertices = rng.normal(size=(7, 3)).astype(np.float32).astype(float)
    faces = rng.integers(0, 7, (5, 3)).astype(np.int32)
    colours = rng.integers(0, 255, (7, 3)).astype(np.uint8)
    ply.write(tmp_path / "a.ply", vertices, faces, colours)
    for wrote, came in zip((vertices, faces, colours), ply.read(tmp_path / "a.ply"), strict=True):
        np.testing.assert_array_equal(wrote, came)


def test_user_marks_are_as_rough_as_they_say() -> None:
    """A lasso holds its mask; clicks keep to visible frames; short contacts stay unmarked."""
    import cv2

    mask = np.zeros((90, 120), bool)
    mask[30:60, 40:90] = True
    inside = np.zeros(mask.shape, np.uint8)
    cv2.fillPoly(inside, [np.rint(lasso(mask, np.random.default_rng(0))).astype(np.int32)], 1)
    assert inside[mask].all()
    assert inside.sum() < 2 * mask.sum()
    visible = np.ones(81, bool)
    visible[15:30] = False
    found = clicks(np.zeros((81, 2)), visible, np.random.default_rng(0))
    assert set(found) == {0, 14, 40, 60, 80}
    spans = marked({"paw": [(0, 9, np.zeros(3)), (20, 21, np.zeros(3))]}, np.random.default_rng(0))
    assert len(spans["paw"]) == 1
