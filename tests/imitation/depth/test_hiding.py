"""Depth behind the subject without its colours, and what of it may hide a character."""

from __future__ import annotations

import attrs
import numpy as np
import pytest

from imitation import InputError
from imitation.depth import Background, hiding_depth, projected, shown_background
from tests.imitation.depth.conftest import Solved


def test_only_wanted_pixels_are_the_same_pixels(solved: Solved) -> None:
    """Leaving out what is not wanted changes no wanted bit, wherever it lies."""
    wanted = np.zeros(solved.world.size[::-1], bool)
    wanted[40:90, 100:180], wanted[-1], wanted[3, 250] = True, True, True
    for each, frame in ((solved.maps[0], 8), (solved.maps[-1], 2)):
        camera = solved.world.cameras[frame]
        whole = projected(each, camera, solved.world.size)
        part = projected(each, camera, solved.world.size, 0, wanted)
        np.testing.assert_array_equal(part[wanted], whole[wanted])
        assert not part[~wanted].any()
        assert (part > 0).any()


def test_depth_everywhere_needs_no_colours(solved: Solved) -> None:
    """Behind the subject depth is that of the background, and off it what the frame's own map says."""
    for frame in (6, 8):
        found, own = solved.background.everywhere(frame).depth, solved.background.depth(frame)
        assert np.isfinite(found).all()
        known = own.sure(1)
        np.testing.assert_allclose(found[known], own.depth[known], rtol=1e-6)
        mask, truth = solved.world.masks[frame], solved.world.depth(frame)
        off = np.abs(found - truth)[mask] / truth[mask]
        assert np.median(off) < 0.02


def test_a_guess_beside_a_hole_is_not_carried_into_it(solved: Solved) -> None:
    """Where no frame ever sees the background, its depth comes from what is confirmed, not from a wrong rim."""
    world = solved.world
    box = np.zeros(world.size[::-1], bool)
    box[30:110, 60:200] = True
    maps = []
    for each in solved.maps:
        depth, confidence = each.depth.copy(), each.confidence.copy()
        rim = np.zeros_like(box)
        rim[24:116, 54:206] = True
        depth[rim], confidence[rim] = 0.5, 0  # unconfirmed, and far too near
        depth[box] = np.nan
        maps.append(attrs.evolve(each, depth=depth, confidence=confidence))
    background = Background(world.frames, world.cameras, maps, masks=[box] * len(world.frames))
    found = background.everywhere(6).depth
    assert np.median(found[50:90, 90:170]) > 2.0
    assert np.isfinite(found).all()


def test_nothing_hides_where_the_frame_shows_the_subject(solved: Solved) -> None:
    """Within the mask only what looks like the plate hides; off the mask depth alone decides."""
    frame = 8
    plate = solved.background.plate(frame)
    picture, mask = solved.world.frames[frame], solved.world.masks[frame]
    hides = hiding_depth(picture, plate)
    assert np.isnan(hides[mask]).mean() > 0.8
    off = ~(plate.filled | plate.invented)
    np.testing.assert_array_equal(hides[off], plate.depth.depth[off])
    # A mask drawn round a post that stands before the subject: there the frame shows what the plate does.
    _, columns = np.nonzero(plate.filled)
    middle = int(np.median(columns))
    post = plate.filled & (np.abs(np.arange(picture.shape[1])[None] - middle) <= 5)
    before = picture.copy()
    before[post] = plate.picture[post]
    inner = post & (np.abs(np.arange(picture.shape[1])[None] - middle) <= 2)
    assert shown_background(before, plate)[inner].mean() > 0.95
    known = np.isfinite(hiding_depth(before, plate)) & inner
    strayed = hiding_depth(before, plate)[known] / plate.depth.depth[known] - 1
    np.testing.assert_allclose(strayed, 3 * plate.depth.tolerance, rtol=1e-3)
    painted = attrs.evolve(plate, filled=np.zeros_like(plate.filled), invented=plate.filled | plate.invented)
    assert not shown_background(before, painted)[inner].any(), "what was painted in says nothing of what is there"
    with pytest.raises(InputError, match="its plate is"):
        shown_background(picture[:9], plate)
