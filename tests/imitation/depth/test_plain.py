"""Surfaces of one colour: found in the picture, laid onto planes where the costs allow it."""

from __future__ import annotations

import numpy as np
import pytest

from imitation.depth.plain import parts_of, plain_surfaces, with_planes

SIZE = (60, 80)
DEEP = 30


def two_walls() -> tuple[np.ndarray, np.ndarray]:
    """A picture of noise with a green wall and, beside it, a grey one as bright; which pixels show which."""
    random = np.random.default_rng(4)
    picture = random.integers(0, 256, (*SIZE, 3)).astype(np.uint8)
    names = np.zeros(SIZE, int)
    names[10:50, 10:40], names[10:50, 40:70] = 1, 2
    picture[names == 1], picture[names == 2] = (90, 150, 110), (125, 125, 125)
    noise = np.rint(random.normal(size=picture.shape) * 1.5)
    return np.clip(picture + noise * (names > 0)[..., None], 0, 255).astype(np.uint8), names


def costs(truth: np.ndarray, seed: int, strength: float = 12.0) -> np.ndarray:
    """Volume (h, w, d) whose pixels tell little of the true planes (h, w), under much noise."""
    random = np.random.default_rng(seed)
    away = np.abs(np.arange(DEEP) - truth[..., None])
    volume = 60 + strength * np.minimum(away, 4) / 4 + random.normal(size=(*SIZE, DEEP)) * 8
    return np.clip(np.rint(volume), 0, 255).astype(np.uint8)


def test_walls_of_one_colour_are_told_apart_to_the_pixel() -> None:
    """Equal brightness, other colour: two surfaces with few wrong pixels; noise is none, nor what the subject hides."""
    picture, truth = two_walls()
    hidden = np.zeros(SIZE, np.uint8)
    names, count = plain_surfaces(picture, hidden)
    assert count == 2
    for name in (1, 2):
        mine = names == names[30, 25 if name == 1 else 55]
        assert (mine ^ (truth == name)).sum() < 0.06 * (truth == name).sum()
    hidden[:, 40:] = 1
    names, count = plain_surfaces(picture, hidden)
    assert count == 1
    assert not names[:, 40:].any()


def test_a_plain_wall_becomes_the_plane_that_its_costs_show() -> None:
    """A third of it was found far off and the rest jitters: after it, all of it is on the slanted plane."""
    picture, names = two_walls()
    rows, columns = np.mgrid[: SIZE[0], : SIZE[1]]
    truth = 6 + 0.12 * columns + 0.08 * rows
    found = (truth + np.random.default_rng(1).normal(size=SIZE)).astype(np.float32)
    found[:, :20] += 9
    laid = with_planes(found, costs(truth, 2), picture, np.zeros(SIZE, np.uint8))
    wall = names == 1
    assert np.abs(laid - truth)[wall].mean() < 0.4 < 2 < np.abs(found - truth)[wall].mean()
    textured = plain_surfaces(picture, np.zeros(SIZE, np.uint8))[0] == 0
    np.testing.assert_array_equal(laid[textured], found[textured])
    some = with_planes(found, costs(truth, 2), picture, np.zeros(SIZE, np.uint8), 3.0)
    np.testing.assert_array_equal(some, np.where(np.abs(laid - found) >= 3, laid, found))


def test_two_planes_of_nearly_one_colour_are_parted() -> None:
    """A side of a box before a wall, five levels apart: one surface to smoothing, two planes to what follows."""
    picture, names = two_walls()
    random = np.random.default_rng(7)
    wall, side = (
        np.rint(np.array(c) + random.normal(size=(*SIZE, 3)) * 1.5) for c in ((130, 120, 125), (125, 119, 130))
    )
    picture = np.where((names == 1)[..., None], wall, np.where((names == 2)[..., None], side, picture)).astype(np.uint8)
    columns = np.mgrid[: SIZE[0], : SIZE[1]][1]
    truth = np.where(names == 2, 18 + 0.1 * (columns - 40), 6.0)
    found = (truth + random.normal(size=SIZE)).astype(np.float32)
    found[15:45, 25:40] += 12  # what is near has spread over the wall
    hidden = np.zeros(SIZE, np.uint8)
    joined, count = plain_surfaces(picture, hidden)
    assert count == 1
    assert parts_of(joined, picture)[1] == 2
    laid = with_planes(found, costs(truth, 2, 40.0), picture, hidden)
    inner = (names > 0) & (np.abs(columns - 40) > 3)
    assert np.abs(laid - truth)[inner].mean() < 0.4 < 1.5 < np.abs(found - truth)[inner].mean()


def test_the_top_of_a_box_does_not_go_with_the_wall_behind_it() -> None:
    """A strip of six rows, eight levels from the wall's colour: one surface to smoothing, a small part of its costs."""
    picture, _ = two_walls()
    random = np.random.default_rng(11)
    rows = np.mgrid[: SIZE[0], : SIZE[1]][0]
    wall, top, front = (np.zeros(SIZE, bool) for _ in range(3))
    wall[2:44, 6:74], top[38:44, 16:64], front[44:56, 16:64] = True, True, True
    wall &= ~top
    for mine, colour in ((wall, (118, 145, 122)), (top, (126, 148, 120)), (front, (150, 100, 150))):
        picture[mine] = np.rint(np.array(colour) + random.normal(size=(*SIZE, 3)) * 1.5).astype(np.uint8)[mine]
    truth = np.where(top, 16 + 0.4 * (rows - 38.0), np.where(front, 18.4, 5.0))
    found = (truth + 0.5 * random.normal(size=SIZE)).astype(np.float32)
    hidden = np.zeros(SIZE, np.uint8)
    names = plain_surfaces(picture, hidden)[0]
    assert names[41, 40] == names[20, 40] != names[50, 40]
    laid = with_planes(found, costs(truth, 5, 40.0), picture, hidden)
    off = np.abs(laid - truth)
    assert (off[top] > 2).mean() < 0.1
    assert max(off[wall].mean(), off[front].mean()) < 0.4


def test_a_curved_surface_that_its_costs_show_stays() -> None:
    """Of one colour, but no plane: what single pixels tell clearly is kept, to the bit."""
    picture, _ = two_walls()
    columns = np.mgrid[: SIZE[0], : SIZE[1]][1]
    truth = 15 + 10 * np.sin(columns / 5.0)
    found = truth.astype(np.float32)
    laid = with_planes(found, costs(truth, 3, 60.0), picture, np.zeros(SIZE, np.uint8))
    np.testing.assert_array_equal(laid, found)


@pytest.mark.parametrize("level", [0, 255])
def test_a_blank_picture_without_any_evidence(level: int) -> None:
    """Equal costs everywhere: numbers within the search."""
    picture = np.full((*SIZE, 3), level, np.uint8)
    found = np.random.default_rng(0).uniform(0, DEEP - 1, SIZE).astype(np.float32)
    laid = with_planes(found, np.full((*SIZE, DEEP), 128, np.uint8), picture, np.zeros(SIZE, np.uint8))
    assert np.isfinite(laid).all()
    assert laid.min() >= 0
    assert laid.max() <= DEEP - 1
