"""Orders of films: what they need, whole files or none, and a frame that is the film's own."""

from __future__ import annotations

import shutil
import time
from collections.abc import Iterator
from pathlib import Path

import attrs
import numpy as np
import pytest

from app.actions.compositing import MOST_WORKERS, Standing, in_order
from app.actions.films import COMPARISONS, render_film
from app.actions.previewing import Previewer, chequered, lacking, within_reach, without_background
from app.actions.rendering import FilmOrder, computed, write_comparison, write_film, write_motion
from app.actions.session import Session
from app.formats import open_video
from imitation.errors import Cancelled, InputError
from imitation.progress import silent

pytestmark = [pytest.mark.xdist_group("solved project"), pytest.mark.slow]
FRAMES = range(4, 7)
FAST = attrs.evolve(FilmOrder(()), frames=(4, 6))


@pytest.fixture(scope="module")
def solved(solved_project: Path, tmp_path_factory: pytest.TempPathFactory) -> Session:
    """A session on the solved project."""
    copy = tmp_path_factory.mktemp("render") / "film.motionwright"
    shutil.copytree(solved_project, copy)
    session = Session.open(copy)
    yield session
    session.close()


def order_of(session: Session, **changes: object) -> FilmOrder:
    """A short film of all characters."""
    return attrs.evolve(FAST, characters=tuple(each.id for each in session.document.characters), **changes)


@pytest.mark.parametrize("view", ["video", "side", "both"])
def test_a_preview_is_the_frame_of_the_film(
    solved: Session, tmp_path: Path, view: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Frame 5 beforehand is to the bit what is given to the codec as the second of the frames 4 to 6."""
    written: list[np.ndarray] = []
    monkeypatch.setattr("app.actions.films.write_video", lambda path, frames, *_, **__: written.extend(frames))
    order = order_of(solved, view=view, dim=0.3, points=True)
    write_film(solved, order, tmp_path / "film.mp4", silent)
    assert len(written) == len(FRAMES)
    np.testing.assert_array_equal(Previewer().picture(solved, order, 5), written[1])


def test_frames_are_made_beside_each_other_and_come_in_order() -> None:
    """What is quick waits for what is slow before it, and no more is taken than is worked on."""
    taken: list[int] = []

    def given() -> Iterator[int]:
        for number in range(40):
            taken.append(number)
            yield number

    def make(number: int) -> int:
        time.sleep(0.01 if number % 2 else 0.0)
        return number * number

    for number, made in enumerate(in_order(make, given())):
        assert made == number * number
        assert len(taken) <= number + 2 + MOST_WORKERS


def test_a_film_that_is_no_longer_wanted_does_not_wait_for_its_frames() -> None:
    """The question comes while a slow frame is made; what it raises ends the film long before the frame is done."""
    asked = 0

    def tick() -> None:
        nonlocal asked
        asked += 1
        if asked == 3:
            raise Cancelled

    start = time.monotonic()
    with pytest.raises(Cancelled):
        list(in_order(lambda _: time.sleep(2.0), range(8), tick))
    assert time.monotonic() - start < 1.5


def test_light_and_blur_change_the_preview(solved: Session) -> None:
    """Each control is seen in the picture; the same order gives the same picture."""
    previewer = Previewer()
    plain = previewer.picture(solved, order_of(solved), 5).astype(int)
    again = previewer.picture(solved, order_of(solved), 5)
    assert (plain == again).all()
    for change in (
        {"light_turn": 120.0},
        {"light_lift": 30.0},
        {"brightness": 1.5},
        {"warmth": 1.0},
        {"shadow_strength": 0.0},
    ):
        other = previewer.picture(solved, order_of(solved, standing=Standing(**change)), 5)
        assert np.abs(other - plain).max() > 12, change


def test_the_film_has_the_frames_of_the_range(solved: Session, tmp_path: Path) -> None:
    """Three frames were asked for, three are in the file."""
    frames = open_video(write_film(solved, order_of(solved), tmp_path / "film.mp4", silent))
    assert len(frames) == len(FRAMES)
    frames.close()


def test_pictures_with_alpha_replace_an_older_longer_sequence(solved: Session, tmp_path: Path) -> None:
    """Files are numbered by the clip's frames; what the older one had more is gone, foreign files stay."""
    folder = tmp_path / "sheets"
    write_film(solved, order_of(solved, alpha=True, frames=(3, 8)), folder, silent)
    (folder / "notes.txt").write_text("mine")
    write_film(solved, order_of(solved, alpha=True), folder, silent)
    assert sorted(path.name for path in folder.iterdir()) == ["00004.png", "00005.png", "00006.png", "notes.txt"]
    pytest.importorskip("OpenEXR")
    write_film(solved, order_of(solved, alpha=True, form="exr", frames=(5, 5)), folder, silent)
    assert (folder / "00005.exr").stat().st_size > 1000
    assert (folder / "00005.png").is_file(), "the other form stays"
    shown = Previewer().picture(solved, order_of(solved, alpha=True), 5)
    assert shown.shape[2] == 3
    assert {96, 128} <= set(np.unique(chequered(np.zeros((30, 30, 4), np.uint8))))


@pytest.mark.parametrize("alpha", [False, True])
def test_a_cancelled_film_leaves_what_was_there(solved: Session, tmp_path: Path, alpha: bool) -> None:
    """Cancelled in the middle there is no half of a file, and an older one stays as it was."""
    target = tmp_path / ("sheets" if alpha else "film.mp4")
    if alpha:
        target.mkdir()
        (target / "00000.png").write_bytes(b"old")
    else:
        target.write_bytes(b"old")
    before = {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()}

    def stop(fraction: float) -> None:
        if fraction > 0.4:
            raise Cancelled

    with pytest.raises(Cancelled):
        write_film(solved, order_of(solved, alpha=alpha), target, stop)
    assert {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()} == before


def test_missing_results_are_computed_first_and_may_be_cancelled(solved: Session) -> None:
    """A comparison that is not there is computed, its progress told, or given up; an error comes as it was."""
    character = solved.document.characters[0].id
    stage = solved.stages.comparison(character, "anchors_only")
    assert stage not in solved.cache

    def stop(fraction: float) -> None:
        raise Cancelled

    with pytest.raises(Cancelled):
        computed(solved, "Comparing", (stage,), stop)
    assert not solved.runner.jobs
    told: list[float] = []
    rest = computed(solved, "Comparing", (stage,), told.append)
    assert stage in solved.cache
    rest(1.0)
    assert told == sorted(told)
    assert told[-1] == 1.0
    assert computed(solved, "Comparing", (stage,), told.append) == told.append, (
        "nothing to do: all is left for what follows"
    )

    def fail(*_: object) -> None:
        raise InputError("The disk is full.")

    with pytest.raises(InputError, match="disk is full"):
        computed(solved, "Comparing", (attrs.evolve(stage, compute=fail),), told.append)


def test_comparison_and_motion_are_written_in_one_go(solved: Session, tmp_path: Path) -> None:
    """One file each, of the variants and the form asked for."""
    character = solved.document.characters[0].id
    film = write_comparison(solved, character, ["anchors_only", "first_pass"], tmp_path / "compared.mp4", silent)
    frames = open_video(film)
    assert len(frames) == len(solved.frames())
    assert frames.size[0] > 2 * solved.document.clip.width
    frames.close()
    assert set(COMPARISONS) > {"anchors_only", "first_pass"}
    glb = write_motion(solved, character, tmp_path / "motion.glb", "glb", silent)
    assert glb.read_bytes()[:4] == b"glTF"


def test_what_is_lacking_is_named_and_left_out(solved: Session, tmp_path: Path) -> None:
    """Without depth an order with occlusion lacks the background, and can be had without."""
    order = order_of(solved, standing=Standing(occlusion=True, plate=True, shutter=0.5))
    assert lacking(solved, order) == "background"
    plain = without_background(order)
    assert lacking(solved, plain) == ""
    assert plain.standing.shutter == 0.5
    assert within_reach(solved, order) == plain
    assert lacking(solved, attrs.evolve(plain, characters=())) == "motion"
    assert within_reach(solved, attrs.evolve(plain, characters=())) is None
    with pytest.raises(InputError, match="no character"):
        render_film(solved, (), tmp_path / "film.mp4")
