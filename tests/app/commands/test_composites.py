"""Composites through the command line: films, sheets with alpha, and the sentence where there is no depth."""

from __future__ import annotations

import json
import shutil
from contextlib import closing
from pathlib import Path

import numpy as np
import OpenEXR
import pytest

from app.actions.compositing import Composition, Standing, composited
from app.actions.moving import animated
from app.actions.session import Session
from app.commands.main import BAD_INPUT, DONE, NO_SOLUTION, USAGE, run
from app.formats import open_video, read_image, read_mesh
from tests.app.filmed import FRAMES

pytestmark = [pytest.mark.xdist_group("solved project"), pytest.mark.slow]


@pytest.fixture(scope="module")
def measured(solved_project: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The solved project with its background measured."""
    copy = tmp_path_factory.mktemp("measured") / "film.motionwright"
    shutil.copytree(solved_project, copy)
    assert run(["--quiet", "depth", str(copy)]) == DONE
    return copy


def film(project: Path, target: Path, *options: str) -> np.ndarray:
    """Render and read back all frames."""
    assert run(["--quiet", "render", str(project), str(target), *options]) == DONE
    frames = open_video(target)
    assert len(frames) == FRAMES
    return np.stack([frames[t] for t in range(FRAMES)]).astype(float)


def test_each_option_changes_the_film_in_its_way(measured: Path, tmp_path: Path) -> None:
    """The plate changes the subject's surroundings, light and blur the character; the same options the same bytes."""
    plain = film(measured, tmp_path / "plain.mp4", "--view", "video")
    everything = ["--occlusion", "--shadow", "--plate", "--motion-blur", "0.8", "--grain", "--match-light"]
    whole = film(measured, tmp_path / "whole.mp4", *everything)
    assert plain.shape == whole.shape, "composites are films of the video's view alone"
    again = film(measured, tmp_path / "again.mp4", *everything)
    np.testing.assert_array_equal(again, whole)
    for options in (["--motion-blur"], ["--match-light"], ["--shadow"], ["--plate"]):
        made = film(measured, tmp_path / "one.mp4", *options)
        off = np.abs(made - plain).max(axis=-1)
        assert (off > 12).any(), options
        assert (off > 12).mean() < 0.25, "most of the picture stays as it was filmed"


def test_the_shadow_goes_with_the_subject(measured: Path, tmp_path: Path) -> None:
    """Only with the plate; then the order's option reaches the background that makes the plates."""
    target = tmp_path / "film.mp4"
    assert run(["--quiet", "render", str(measured), str(target), "--remove-shadow"]) == USAGE
    with closing(Session.open(measured)) as session:
        motions = animated(session, [session.document.characters[0].id])
        for plate, asked in ((True, True), (True, False), (False, True)):
            scene = Composition.of(session, motions, Standing(shadow=True, plate=plate, remove_shadow=asked))
            assert scene.background is not None
            assert scene.background.shadows == (plate and asked)
    assert run(["--quiet", "plate", str(measured), str(target), "--remove-shadow"]) == DONE


def test_a_folder_gets_characters_and_shadows_with_alpha(measured: Path, tmp_path: Path) -> None:
    """One PNG a frame: clear round the character, opaque on it, black and partly clear in its shadow."""
    folder = tmp_path / "sheets"
    assert run(["--quiet", "render", str(measured), str(folder), "--shadow", "--occlusion"]) == DONE
    import cv2

    files = sorted(folder.glob("*.png"))
    assert [path.stem for path in files] == [f"{t:05d}" for t in range(FRAMES)]
    sheet = cv2.imread(str(files[4]), cv2.IMREAD_UNCHANGED)
    assert sheet.shape[2] == 4
    alpha = sheet[..., 3]
    assert (alpha == 0).mean() > 0.5
    assert (alpha == 255).any()
    shaded = (alpha > 20) & (alpha < 200) & (sheet[..., :3].max(axis=-1) == 0)
    assert shaded.sum() > 20
    assert read_image(files[0]).shape[:2] == alpha.shape
    assert run(["render", str(measured), str(tmp_path / "other"), "--plate"]) == USAGE
    exr = tmp_path / "linear"
    assert run(["--quiet", "render", str(measured), str(exr), "--shadow", "--occlusion", "--format", "exr"]) == DONE
    linear = OpenEXR.File(str(exr / "00004.exr")).channels()["RGBA"].pixels.astype(float)
    np.testing.assert_allclose(linear[..., 3], alpha / 255, atol=3e-3)
    solid = alpha == 255
    shown = 255 * np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    assert np.abs(shown[solid][:, 2::-1] - sheet[solid][:, :3]).max() < 2
    assert run(["render", str(measured), str(tmp_path / "film.mp4"), "--format", "exr"]) == USAGE


def test_without_parallax_one_sentence_says_what_there_is(
    solved_project: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A camera that stands still has no depth: the sentence names what to leave out and what stays."""
    copy = tmp_path / "still.motionwright"
    shutil.copytree(solved_project, copy)
    assert run(["--quiet", "set", str(copy), "--static"]) == DONE
    capsys.readouterr()
    assert run(["--quiet", "render", str(copy), str(tmp_path / "film.mp4"), "--occlusion"]) == NO_SOLUTION
    told = capsys.readouterr().err.strip().splitlines()
    assert len(told) == 1
    assert "camera stands still" in told[0]
    assert "leave out --occlusion" in told[0]
    assert not (tmp_path / "film.mp4").exists()


def test_depth_answers_as_json(measured: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Key frames, distances, and files."""
    assert run(["--json", "depth", str(measured), "--mesh", str(tmp_path / "background.ply")]) == DONE
    told = json.loads(capsys.readouterr().out)
    assert told["key_frames"][0] == 0
    assert told["mesh"]["triangles"] > 100


def test_a_preview_is_the_frame_of_the_film(measured: Path, tmp_path: Path) -> None:
    """One frame alone has the bits that it has after all those before it; lights are turned by hand."""
    with closing(Session.open(measured)) as session:
        ids = [session.document.characters[0].id]
        standing = Standing(occlusion=True, shadow=True, plate=True, shutter=0.5, grain=None)
        whole = Composition.of(session, animated(session, ids), standing)
        frames = [whole.frame(t) for t in (2, 3, 4)]
        np.testing.assert_array_equal(composited(session, ids, 4, standing), frames[2])
        mine = composited(session, ids, 4, Standing(light_turn=120, brightness=0.5, shadow_strength=0.0))
        plain = composited(session, ids, 4, Standing())
        cover = Composition.of(session, animated(session, ids), Standing()).sheet(4).cover > 0.9
        assert mine[cover].mean() < 0.8 * plain[cover].mean()
        bare = Composition.of(session, animated(session, ids), Standing(shadow_strength=0.0)).sheet(4)
        np.testing.assert_allclose(bare.alpha, bare.cover, atol=1e-6)
    film(measured, tmp_path / "turned.mp4", "--light-turn", "90", "--light-lift", "-10", "--brightness", "0.8")


def test_the_film_without_its_subject(measured: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Plates as a film: where the subject was there is background, elsewhere nothing changes."""
    assert run(["--json", "plate", str(measured), str(tmp_path / "plate.mp4")]) == DONE
    told = json.loads(capsys.readouterr().out)
    assert 0.05 < told["filled_least"] <= told["filled"] <= 1
    plates = open_video(tmp_path / "plate.mp4")
    with closing(Session.open(measured)) as session:
        frames = session.frames()
        off = np.abs(plates[6].astype(float) - frames[6]).max(axis=-1)
    assert 0.002 < (off > 40).mean() < 0.2


def test_depth_is_written_as_pictures_arrays_and_meshes(measured: Path, tmp_path: Path) -> None:
    """False colours and exact arrays agree in size; the mesh is the same in PLY and GLB, in the clip's colours."""
    folder = tmp_path / "depth"
    assert run(["--quiet", "depth", str(measured), "--write", str(folder), "--mesh", str(tmp_path / "b.ply")]) == DONE
    assert run(["--quiet", "depth", str(measured), "--mesh", str(tmp_path / "b.glb")]) == DONE
    with np.load(folder / "depth.npz") as held:
        assert held["depth"].shape[0] == len(held["frames"]) == len(list(folder.glob("depth-*.png")))
        assert read_image(folder / f"depth-{held['frames'][0]:05d}.png").shape[:2] == held["depth"].shape[1:]
    ply, glb = read_mesh(tmp_path / "b.ply"), read_mesh(tmp_path / "b.glb")
    assert len(ply.faces) == len(glb.faces) > 100
    assert ply.colors is not None
    assert ply.colors.std() > 5
    np.testing.assert_allclose(np.ptp(ply.vertices, axis=0), np.ptp(glb.vertices, axis=0), rtol=1e-3)
    assert run(["--quiet", "depth", str(measured), "--mesh", str(tmp_path / "b.xyz")]) == BAD_INPUT


def test_a_character_meets_the_background(measured: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A figure a frame; a subject that walks on the ground is hardly in it."""
    capsys.readouterr()
    assert run(["--json", "depth", str(measured), "--meeting", "subject"]) == DONE
    told = json.loads(capsys.readouterr().out)["penetration"]
    assert len(told["depth"]) == len(told["share"]) == FRAMES
    assert min(told["depth"]) >= 0
    assert np.median(told["share"]) < 0.2
    assert run(["--quiet", "depth", str(measured), "--meeting", "nobody"]) == BAD_INPUT
