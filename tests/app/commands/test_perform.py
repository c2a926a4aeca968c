"""``perform``: from files to a composed performance, without a window; answers, files, exit codes."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from app.commands.main import BAD_INPUT, DONE, NO_SOLUTION, run
from app.formats import open_video, read_image, read_sequence
from app.formats.tvm import open_mesh_frames
from resources.world.body import make_body
from resources.world.gait import walk
from tests.app.captured import small_capture, write_capture

pytestmark = pytest.mark.xdist_group("captured")


@pytest.fixture(scope="module")
def project(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A project of one sequence, its performance composed."""
    folder = tmp_path_factory.mktemp("perform")
    write_capture(folder / "take.npz")
    assert run(["--quiet", "perform", "add", str(folder / "film"), str(folder / "take.npz")]) == DONE
    keys = ["--key", "take/1", "--key", "take@90", "--key", "take/1"]
    assert run(["--quiet", "perform", "compose", str(folder / "film"), *keys]) == DONE
    return folder / "film"


def answer(capsys: pytest.CaptureFixture[str], *arguments: object) -> Any:
    """Run a verb and read its JSON."""
    capsys.readouterr()
    assert run(["--json", "perform", *map(str, arguments)]) == DONE
    return json.loads(capsys.readouterr().out)


def refused(capsys: pytest.CaptureFixture[str], code: int, *arguments: object) -> str:
    """Run a verb that must fail with this exit code; gives its sentence."""
    capsys.readouterr()
    assert run(["--json", "perform", *map(str, arguments)]) == code
    return capsys.readouterr().err.strip().splitlines()[-1]


def test_analyse_says_what_and_why(project: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Motions with their frames and reasons, and pictures of the curve and the matrix."""
    told = answer(capsys, "analyse", project, "--report", tmp_path)["sequences"]["take"]
    assert len(told["clusters"]) == 4
    assert all(cluster["reason"] for cluster in told["clusters"])
    assert told["frames"] == len(small_capture())
    matrix = read_image(tmp_path / "take-matrix.png")
    # Within the walk moments alike come back; walk and squat are never alike.
    middle = told["boundaries"][0] * len(matrix) // len(small_capture())
    assert matrix[: middle // 2, : middle // 2].min() < matrix[: middle // 2, middle + 9 : middle + 60].min()
    assert read_image(tmp_path / "take-curve.png").shape[2] == 3


def test_evaluate_beside_the_printed_method(project: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Precision and recall against the truth; the printed method's in the same answer."""
    labels = tmp_path / "labels.json"
    labels.write_text(json.dumps({"take": list(small_capture().boundaries)}))
    told = answer(capsys, "evaluate", project, "--labels", labels)["take"]
    assert told["precision"] == told["recall"] == 1.0
    assert told["printed"]["f_score"] < 1.0
    labels.write_text('{"take": [1.5]}')
    assert "frame number" in refused(capsys, BAD_INPUT, "evaluate", project, "--labels", labels)


def test_the_path_can_be_composed_again(project: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A written path holds every frame, and its choices compose the same performance."""
    first = answer(capsys, "compose", project, "--path", tmp_path / "path.json")
    written = json.loads((tmp_path / "path.json").read_text())
    assert written == first
    assert len(written["frames"]) == len(written["transforms"]) == written["frame_count"]
    answer(capsys, "compose", project, "--key", "take/3")
    again = answer(capsys, "compose", project, "--from", tmp_path / "path.json")
    assert again == first


def test_exports_hold_the_performance(project: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A folder of PLY, an npz and a film have all frames at the rate, with colours."""
    count = answer(capsys, "compose", project)["frame_count"]
    answer(capsys, "export", project, tmp_path / "ply")
    answer(capsys, "export", project, tmp_path / "take.npz", "--path", tmp_path / "path.json")
    frames = open_mesh_frames(tmp_path / "ply")
    with open_mesh_frames(tmp_path / "take.npz") as packed:
        assert len(frames) == len(packed) == count
        assert packed.fps == 15
        np.testing.assert_allclose(frames[9].vertices, packed[9].vertices)
        np.testing.assert_array_equal(frames[9].colours, packed[9].colours)  # type: ignore[arg-type]
    assert (tmp_path / "path.json").is_file()
    answer(capsys, "export", project, tmp_path / "film.mp4", "--size", 128, 96, "--turntable")
    with open_video(tmp_path / "film.mp4") as film:
        assert (len(film), film.size, film.fps) == (count, (128, 96), 15)
        assert np.ptp(film[5].astype(int)) > 60


def test_one_glb_needs_one_topology(project: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Frames with faces of their own cannot be one animated GLB; a moving mesh can, and keeps its colours."""
    assert "faces of their own" in refused(capsys, BAD_INPUT, "export", project, tmp_path / "x.glb")
    assert not (tmp_path / "x.glb").exists()


@pytest.mark.slow
def test_a_moving_mesh_comes_out_as_one_glb(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A walk on the spot of one mesh, played twice."""
    from app.formats import write_sequence

    walking = walk(make_body("biped", vertices=800), 120)
    write_sequence(tmp_path / "walk.glb", walking.vertices, walking.body.faces, 25)
    answer(capsys, "add", tmp_path / "p", tmp_path / "walk.glb")
    told = answer(capsys, "compose", tmp_path / "p", "--key", "walk/1", "--repeat", 1, 3)
    assert told["frame_count"] % 3 == 0
    answer(capsys, "export", tmp_path / "p", tmp_path / "out.glb")
    moving = read_sequence(tmp_path / "out.glb")
    assert len(moving) == told["frame_count"]
    # It walks on over the wraps: three rounds go three times as far as one.
    way = moving.vertices.mean(axis=1)[:, 0]
    third = told["frame_count"] // 3
    assert way[-1] - way[0] > 2.5 * (way[third - 1] - way[0])


def test_out_of_reach_is_exit_code_4(project: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Which key, the smallest mu, and what it adds; the project goes on working."""
    said = refused(capsys, NO_SOLUTION, "compose", project, "--key", "take/1", "--key", "take/2", "--forbid", "take/3")
    assert "take/2 cannot be reached from take/1: the smallest mu" in said
    answer(capsys, "compose", project, "--allow-all", "--key", "take/1", "--key", "take@90", "--key", "take/1")


@pytest.mark.parametrize(
    ("arguments", "reason"),
    [
        (["compose", "--key", "take/9"], "no motion called take/9"),
        (["compose", "--key", "take@900"], "no frame 900"),
        (["compose", "--forbid", "take/1"], "forbidden and a key motion"),
        (["compose", "--mu", "-1"], "0 or more"),
        (["compose", "--alternative", "99"], "alternative 99 is not there"),
        (["analyse", "--boundaries", "x"], "are no frames"),
        (["analyse", "--boundaries", "5000"], "must be frames 1 to"),
        (["add", "nowhere"], "does not exist"),
        (["add"], "nothing to add"),
    ],
)
def test_bad_input_is_exit_code_3(
    project: Path, tmp_path: Path, arguments: list[str], reason: str, capsys: pytest.CaptureFixture[str]
) -> None:
    """One sentence that says what is wrong; the project is as it was."""
    import shutil

    copy = tmp_path / "copy.motionwright"
    shutil.copytree(project.with_name("film.motionwright"), copy)
    assert reason in refused(capsys, BAD_INPUT, arguments[0], copy, *arguments[1:])


def test_guesses_are_warned_of(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A folder without rate, axis and unit is taken with a warning on the error stream, and says so in its answer."""
    write_capture(tmp_path / "ply", "ply")
    assert run(["--json", "perform", "add", str(tmp_path / "p"), str(tmp_path / "ply")]) == DONE
    out, err = capsys.readouterr()
    assert json.loads(out)["added"][0]["guessed"] == ["fps", "up", "unit"]
    assert "Guessed for ply: 25 frames a second, Z up, metres" in err


def test_check_knows_such_sequences(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """``check`` says what a capture is, in a folder and in an npz."""
    capsys.readouterr()
    paths = [write_capture(tmp_path / "ply", "ply"), write_capture(tmp_path / "take.npz")]
    assert run(["--json", "check", *map(str, paths)]) == DONE
    told = json.loads(capsys.readouterr().out)
    for path, fps in zip(paths, ("not stated", 15.0), strict=True):
        assert "faces of its own" in told[str(path)]["kind"]
        assert (told[str(path)]["frames"], told[str(path)]["fps"]) == (len(small_capture()), fps)
