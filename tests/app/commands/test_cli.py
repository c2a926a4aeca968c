"""The command line: answers, files, exit codes."""

from __future__ import annotations

import json
import shutil
from contextlib import closing
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from app.commands import main
from app.commands.main import BAD_INPUT, BUG, DONE, STOPPED, USAGE, run
from app.formats import open_video, read_sequence
from imitation import Cancelled
from tests.app.filmed import FRAMES
from tests.support.scenes import small_clip

pytestmark = [pytest.mark.xdist_group("solved project"), pytest.mark.slow]


@pytest.fixture
def project(solved_project: Path, tmp_path: Path) -> Path:
    """A copy of the solved project that a test may change."""
    copy = tmp_path / "film.motionwright"
    shutil.copytree(solved_project, copy)
    return copy


def answer(capsys: pytest.CaptureFixture[str], *arguments: object) -> Any:
    """Run a verb and read its JSON."""
    capsys.readouterr()
    assert run(["--json", *map(str, arguments)]) == DONE
    return json.loads(capsys.readouterr().out)


def test_info_says_that_all_is_solved(solved_project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """After animate every step is fresh."""
    steps = answer(capsys, "info", solved_project)["steps"]
    assert {step["state"] for step in steps.values()} == {"fresh"}


def test_cameras_are_those_of_the_film(
    solved_project: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The solved focal length is near the true one, and the path can be written for other programs."""
    told = answer(capsys, "cameras", solved_project, "--write", tmp_path / "transforms.json")
    assert told["verdict"] == "ok"
    assert told["focal"] == pytest.approx(small_clip(FRAMES).cameras.K[0, 0, 0], rel=0.15)
    assert len(json.loads((tmp_path / "transforms.json").read_text())["frames"]) == FRAMES


def test_tracks_are_where_the_points_are(
    solved_project: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Tracks from three clicks stay within pixels of the truth, and can be written."""
    answer(capsys, "track", solved_project, "--write", tmp_path / "tracks.json")
    from app.formats.tracks import read_tracks

    written = read_tracks(tmp_path / "tracks.json")
    truth, seen = small_clip(FRAMES).tracks(), small_clip(FRAMES).visibility()
    errors = [np.linalg.norm(written[name].positions - truth[name], axis=1)[seen[name]] for name in truth]
    assert np.median(np.concatenate(errors)) < 1.5


def test_the_character_moves_as_the_subject_did(solved_project: Path, tmp_path: Path) -> None:
    """The exported animation follows the true walk: shape and motion, up to the unknown scale of the film."""
    target = tmp_path / "walk.glb"
    assert run(["--quiet", "export", str(solved_project), str(target)]) == DONE
    moved = read_sequence(target)
    walk = small_clip(FRAMES).walk
    assert walk is not None
    assert float(moved.fps) == 25
    assert len(moved) == FRAMES
    made, true = np.asarray(moved.vertices, float), walk.vertices
    size = np.linalg.norm(np.ptp(true[0], axis=0))
    scale = np.linalg.norm(true[0] - true[0].mean(0)) / np.linalg.norm(made[0] - made[0].mean(0))
    paths = (
        scale * np.linalg.norm(np.diff(made.mean(1), axis=0), axis=1),
        np.linalg.norm(np.diff(true.mean(1), axis=0), axis=1),
    )
    assert paths[0].sum() == pytest.approx(paths[1].sum(), rel=0.25)
    lengths = [scale * np.linalg.norm(x[:, 0] - x[:, 300], axis=1) / size for x in (made,)] + [
        np.linalg.norm(true[:, 0] - true[:, 300], axis=1) / size
    ]
    assert np.abs(lengths[0] - lengths[1]).max() < 0.12


@pytest.mark.parametrize("name", ["walk.usda", "walk.npz", "frames"])
def test_every_form_of_export_reads_back(solved_project: Path, tmp_path: Path, name: str) -> None:
    """USD, npz and a folder of PLY files hold all frames."""
    assert run(["--quiet", "export", str(solved_project), str(tmp_path / name)]) == DONE
    if name.endswith(".usda"):
        assert (tmp_path / name).read_text().startswith("#usda")
    else:
        assert len(read_sequence(tmp_path / name)) == FRAMES


def test_render_makes_a_film_of_the_clip_s_length(solved_project: Path, tmp_path: Path) -> None:
    """The film has the clip's frames and rate, and shows the character over the video."""
    target = tmp_path / "film.mp4"
    assert run(["--quiet", "render", str(solved_project), str(target), "--view", "video"]) == DONE
    with open_video(target) as film:
        assert (len(film), float(film.fps), film.size) == (FRAMES, 25.0, (320, 180))
        changed = np.abs(film[10].astype(int) - small_clip(FRAMES).frames[10]).max(axis=2) > 40
    mask = small_clip(FRAMES).mask(10)
    assert changed[mask].mean() > 0.25
    assert changed[~mask].mean() < 0.05


def test_set_says_what_it_did(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Clicks, contacts and the ground are set by name."""
    done = answer(
        capsys, "set", project, "--click", "nose", 5, 100, 80, "--contact", "nose", 3, 4, "--ground", "plane"
    )["done"]
    assert done == ["Use one ground plane", "Correct nose, frame 5", "Mark contact of nose, frames 3-4"]


def test_an_animation_on_comes_after_a_change(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """What hangs on a change is out of date; what does not stays."""
    run(["--quiet", "set", str(project), "--click", "nose", "5", "100", "80"])
    steps = answer(capsys, "info", project)["steps"]
    tracks = {name: step["state"] for name, step in steps.items() if name.startswith("track/")}
    assert sorted(tracks.values()).count("fresh") == len(tracks) - 1
    assert steps["cameras"]["state"] == "fresh"


REFUSED = [
    (["info", "nowhere"], BAD_INPUT, "no Motionwright project"),
    (["new", "{tmp}/p", "--clip", "{tmp}/none.mp4"], BAD_INPUT, "does not exist"),
    (["check", "{tmp}/broken.mp4"], BAD_INPUT, "broken.mp4"),
    (["check", "{tmp}/empty.ply"], BAD_INPUT, "empty.ply"),
    (["set", "{project}", "--click", "nose", "900", "1", "1"], BAD_INPUT, "outside the clip"),
    (["set", "{project}", "--click", "nose", "3", "nan", "1"], BAD_INPUT, "two finite numbers"),
    (["set", "{project}", "--contact", "fin", "1", "2"], BAD_INPUT, "no track called fin"),
    (["set", "{project}", "--pair", "subject", "nose", "99999"], BAD_INPUT, "has no vertex 99999"),
    (["export", "{project}", "{tmp}/out.xyz"], BAD_INPUT, "no known form"),
    (["compare", "{project}", "{tmp}/out.mp4"], BAD_INPUT, "edited frame"),
    (["render", "{project}"], USAGE, "Missing argument"),
    (["dance"], USAGE, "No such command"),
]


@pytest.mark.parametrize(("arguments", "code", "words"), REFUSED)
def test_exit_codes_and_one_sentence(
    project: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], arguments: list[str], code: int, words: str
) -> None:
    """Bad input gives one sentence on the error stream and the right status."""
    (tmp_path / "broken.mp4").write_bytes(b"not a video")
    (tmp_path / "empty.ply").write_bytes(b"")
    filled = [argument.format(tmp=tmp_path, project=project) for argument in arguments]
    capsys.readouterr()
    assert run(["--quiet", *filled]) == code
    said = capsys.readouterr().err
    assert words in said
    if code == BAD_INPUT:
        assert said.count("\n") == 1
        assert "Traceback" not in said


def test_a_pair_that_the_mesh_does_not_have_is_told_at_once(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A vertex beyond the mesh is refused by the names that were typed, and earlier results stay."""
    assert run(["--quiet", "set", str(project), "--pair", "subject", "nose", "99999"]) == BAD_INPUT
    assert "subject has no vertex 99999 to pair nose with" in capsys.readouterr().err
    assert {step["state"] for step in answer(capsys, "info", project)["steps"].values()} == {"fresh"}


def test_a_pair_of_a_mesh_that_is_away_is_told_on_solving(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Whether it has such a vertex is seen once the mesh is there again."""
    file = project / "project.json"
    before = file.read_text()
    file.write_text(before.replace("subject.ply", "away.ply"))
    assert run(["--quiet", "set", str(project), "--pair", "subject", "nose", "99999"]) == DONE
    file.write_text(file.read_text().replace("away.ply", "subject.ply"))
    assert run(["--quiet", "animate", str(project)]) == BAD_INPUT
    assert "99999" in capsys.readouterr().err


def test_a_missing_medium_is_named(project: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A project whose clip is gone opens, says what is missing, and keeps its results."""
    body = json.loads((project / "project.json").read_text())
    body["document"]["clip"]["media"]["path"] = str(tmp_path / "gone.mp4")
    (project / "project.json").write_text(json.dumps(body))
    assert run(["info", str(project)]) == DONE
    assert run(["--quiet", "render", str(project), str(tmp_path / "out.mp4")]) == BAD_INPUT
    assert "gone.mp4 is missing" in capsys.readouterr().err


def test_a_bug_and_a_stop_have_their_own_codes(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """A bug is called a bug, a stop a stop; neither shows a traceback."""

    def broken(*values: Any, **options: Any) -> None:
        raise RuntimeError("lost a wheel")

    def stopped(*values: Any, **options: Any) -> None:
        raise Cancelled

    monkeypatch.setattr(main.cli, "main", broken)
    assert run(["info", "x"]) == BUG
    assert "RuntimeError: lost a wheel" in capsys.readouterr().err
    monkeypatch.setattr(main.cli, "main", stopped)
    assert run(["info", "x"]) == STOPPED
    assert "Traceback" not in capsys.readouterr().err


def test_check_tells_what_a_file_is(solved_project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Videos, meshes and projects are recognised."""
    folder = solved_project.parent
    told = answer(capsys, "check", folder / "clip.mp4", folder / "subject.ply", solved_project)
    assert [found["kind"] for found in told.values()] == ["video", "mesh", "project"]


def test_ambiguous_limbs_are_told(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Animate looks for them, as values and as lines with the frame whose edit decides; info repeats what was found."""
    before = answer(capsys, "info", project)["characters"]["subject"]
    assert before["ambiguous"] is None or isinstance(before["ambiguous"], list)
    told = answer(capsys, "animate", project)["subject"]
    limbs = told["ambiguous"]
    names = set(answer(capsys, "info", project)["tracks"])
    for limb in limbs:
        first, last = limb["frames"]
        assert limb["limb"] in names
        assert 0 <= first <= limb["decide"] <= last < FRAMES
    assert answer(capsys, "info", project)["characters"]["subject"]["ambiguous"] == limbs
    assert run(["animate", str(project)]) == DONE
    said = capsys.readouterr().out
    assert ("an edit of frame" in said) == bool(limbs)


def test_a_project_becomes_metric_without_a_window(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A length between two clicked points of the scene, or the camera's height, scales the world; info says so."""
    before = answer(capsys, "info", project)["world"]
    assert before["metric"] is False
    assert run(["info", str(project)]) == DONE
    assert "no length is known" in capsys.readouterr().out
    done = answer(capsys, "set", project, "--camera-height", 1.4)["done"]
    assert done == ["Put the camera at 1.4 m"]
    answer(capsys, "contacts", project)
    world = answer(capsys, "info", project)["world"]
    assert world["metric"] is True
    assert "camera's height" in world["note"]
    done = answer(capsys, "set", project, "--length-pixels", 0, 60, 150, 200, 150, 2.5)["done"]
    assert done == ["Set a length of 2.5 m"]
    assert answer(capsys, "info", project)["world"]["camera_height"] is None
    names = list(answer(capsys, "info", project)["tracks"])
    assert answer(capsys, "set", project, "--length", names[0], names[1], 0, 0.5)["done"] == ["Set a length of 0.5 m"]
    answer(capsys, "contacts", project)
    assert answer(capsys, "info", project)["world"]["metric"] is True


def test_horizon_and_mirrors_are_set(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Pitch and roll, several points at a constant depth, mirrors with a lag or without."""
    names = list(answer(capsys, "info", project)["tracks"])
    done = answer(
        capsys, "set", project, "--pitch", 4, "--roll", -1, "--ground", "depth", "--depth-of", names[0],
        "--depth-of", names[1], "--mirror", names[0], names[1], "auto", "--mirror", names[2], names[3], -7,
    )["done"]  # fmt: skip
    assert "Tilt the camera by 4 degrees" in done
    from app.actions.session import Session

    with closing(Session.open(project)) as session:
        document = session.document
        assert document.world.pitch == 4
        assert document.world.roll == -1
        assert [document.track(each).name for each in document.world.depth_tracks] == names[:2]
        lags = {track.name: track.mirror_lag for track in document.tracks}
        assert lags[names[0]] is None
        assert lags[names[2]] == -7
        assert lags[names[3]] == 7
        assert document.characters[0].solve.symmetry
    assert run(["set", str(project), "--mirror", names[0], names[1], "soon"]) == BAD_INPUT
