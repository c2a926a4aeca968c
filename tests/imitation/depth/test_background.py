"""Behind the subject: the clean plate, depth of any frame, places of contacts, and the background as triangles."""

from __future__ import annotations

import attrs
import cv2
import numpy as np
import pytest

from imitation import InputError, NoSolution
from imitation.depth import Background, background_depth, background_mesh, joined_mesh, projected
from tests.imitation.depth.conftest import Solved
from tests.imitation.depth.scenes import filmed_room


def psnr(first: np.ndarray, second: np.ndarray) -> float:
    """Peak signal to noise ratio, dB."""
    return float(10 * np.log10(255**2 / np.mean((first.astype(float) - second) ** 2)))


@pytest.fixture(scope="module")
def empty() -> np.ndarray:
    """The same film without the blob."""
    return filmed_room(3, (256, 144), 16, blob=False).frames


@pytest.mark.parametrize("frame", [6, 7])
def test_the_plate_shows_what_is_behind(solved: Solved, empty: np.ndarray, frame: int) -> None:
    """A key frame and one between: the hole is filled, far better than by inpainting, the rest is untouched."""
    plate = solved.background.plate(frame)
    mask = solved.world.masks[frame]
    hidden = solved.background.pictures.hidden(frame)
    assert plate.filled[mask].mean() > 0.9
    ours = psnr(plate.picture[mask], empty[frame][mask])
    telea = cv2.inpaint(solved.world.frames[frame], hidden, 5, cv2.INPAINT_TELEA)
    assert ours > psnr(telea[mask], empty[frame][mask]) + 5
    assert ours > 22
    np.testing.assert_array_equal(plate.picture[hidden == 0], solved.world.frames[frame][hidden == 0])
    np.testing.assert_array_equal(plate.filled | plate.invented, hidden > 0)
    assert not (plate.filled & plate.invented).any()


def test_depth_behind_the_subject(solved: Solved) -> None:
    """A number everywhere; behind the blob mostly within 3 %."""
    plate = solved.background.plate(7)
    truth = solved.world.depth(7)
    assert np.isfinite(plate.depth.depth).all()
    error = np.abs(plate.depth.depth - truth) / truth
    assert (error[plate.filled] < 0.03).mean() > 0.8
    assert (error[solved.background.pictures.hidden(7) == 0] < 0.03).mean() > 0.93


def test_what_no_frame_sees_is_marked_as_invented(solved: Solved) -> None:
    """A mask that stands still over a region in all frames: painted in and said so, with depth from around."""
    world = solved.world
    masks = world.masks.copy()
    masks[:, 60:, :60] = True
    background = Background(world.frames, world.cameras, solved.maps, masks=masks)
    plate = background.plate(6)
    corner = np.zeros_like(masks[0])
    corner[90:, :15] = True
    assert plate.invented[corner].mean() > 0.9
    assert plate.depth.invented is not None
    assert np.isfinite(plate.depth.depth).all()


def test_gain_of_each_frame_is_evened(solved: Solved, empty: np.ndarray) -> None:
    """Other frames 15 % darker by turns: what they lend is as bright as the frame itself."""
    world = solved.world
    gain = np.where(np.arange(16) % 2, 0.85, 1.0)
    gain[6] = 1.0
    lit = np.rint(world.frames * gain[:, None, None, None]).astype(np.uint8)
    background = Background(lit, world.cameras, solved.maps, masks=world.masks)
    plate = background.plate(6)
    filled = plate.filled & world.masks[6]
    difference = plate.picture[filled].astype(float).mean() - empty[6][filled].mean()
    assert abs(difference) < 3


def test_depth_behind_the_subject_chosen_at_a_smaller_size() -> None:
    """Frames twice as large as their depth was solved: chosen at 1.5 times its size, the plate is about as good."""
    world, bare = filmed_room(3, (384, 216), 12), filmed_room(3, (384, 216), 12, blob=False).frames
    maps = background_depth(world.frames, world.cameras, masks=world.masks, longest=192)
    whole, reduced = (
        Background(world.frames, world.cameras, maps, masks=world.masks, longest=longest) for longest in (None, 288)
    )
    for frame in (4, 5):
        mask, truth = world.masks[frame], world.depth(frame)
        ours, theirs = reduced.plate(frame), whole.plate(frame)
        hole = theirs.filled | theirs.invented
        np.testing.assert_array_equal(ours.filled | ours.invented, hole)
        np.testing.assert_array_equal(ours.picture[~hole], theirs.picture[~hole])
        assert psnr(ours.picture[mask], bare[frame][mask]) > psnr(theirs.picture[mask], bare[frame][mask]) - 1.0
        assert np.isfinite(ours.depth.depth).all()
        errors = [np.mean(np.abs(each.depth.depth - truth)[hole] / truth[hole] > 0.03) for each in (ours, theirs)]
        assert errors[0] < 1.2 * errors[1]


def test_depth_by_projection(solved: Solved) -> None:
    """Into its own camera a map stays what it is; into others it is as good as the others' own."""
    each = solved.maps[2]
    own = projected(each, each.camera, (256, 144))
    there = np.isfinite(each.depth)
    steep = cv2.morphologyEx(np.nan_to_num(1 / each.depth), cv2.MORPH_GRADIENT, np.ones((3, 3))) > 0.01
    flat = there & ~steep
    np.testing.assert_allclose(own[flat], 1 / each.depth[flat], rtol=2e-3)
    between = solved.background.depth(7)
    truth, hidden = solved.world.depth(7), solved.background.pictures.hidden(7) > 0
    error = np.abs(between.depth - truth)[~hidden] / truth[~hidden]
    assert (error < 0.03).mean() > 0.93


def test_places_are_sub_pixel(solved: Solved) -> None:
    """On exact depth a place on the ground is exact between pixels too."""
    exact = attrs.evolve(solved.maps[2], depth=solved.world.depth(6).astype(np.float32))
    camera = solved.world.cameras[6]
    for pixel in ((40.3, 130.7), (128.4, 137.6), (200.8, 133.1)):
        place, residual = exact.place(pixel)
        assert place[2] == pytest.approx(0.0, abs=1e-4)
        np.testing.assert_allclose(camera.project(place), pixel, atol=1e-9)
        assert residual < 1e-3


def test_a_contact_takes_its_place_from_estimated_depth(solved: Solved) -> None:
    """Feet of the blob on the ground: within 3 % of the depth, also where the subject hides the ground."""
    plate = solved.background.plate(6)
    rows, columns = np.nonzero(solved.world.masks[6])
    low = rows.max() - 3
    pixel = (float(np.median(columns[rows == low])), float(low))
    place, residual = plate.depth.place(pixel)
    truth = solved.world.depth(6)[low, round(pixel[0])]
    assert solved.world.cameras[6].depth(place) == pytest.approx(truth, rel=0.03)
    assert 0 <= residual < 0.05 * truth


def test_a_place_where_nothing_is_known(solved: Solved) -> None:
    """Behind the subject in a map that is not completed: one sentence."""
    each = solved.maps[2]
    rows, columns = np.nonzero(solved.world.masks[each.frame])
    with pytest.raises(NoSolution, match="No background depth"):
        each.place((float(columns.mean()), float(rows.mean())))
    with pytest.raises(InputError, match="two finite numbers"):
        each.place((np.nan, 3.0))


def test_the_mesh_lies_on_the_background(solved: Solved) -> None:
    """Vertices near true surfaces, triangles towards the camera, none over a step, a hole where the subject was."""
    each, camera = solved.maps[2], solved.world.cameras[6]
    mesh = background_mesh(each, solved.world.frames[6])
    corners = mesh.vertices[mesh.faces]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert (np.einsum("nk,nk->n", normal, camera.centre - corners[:, 0]) > 0).all()
    z = camera.depth(corners)
    assert (z.max(axis=1) / z.min(axis=1)).max() < 1.0301
    pixels = np.rint(camera.project(mesh.vertices)).astype(int)
    assert not solved.world.masks[6][pixels[:, 1], pixels[:, 0]].any()
    truth = solved.world.depth(6)[pixels[:, 1], pixels[:, 0]]
    assert (np.abs(camera.depth(mesh.vertices) - truth) < 0.1).mean() > 0.9
    np.testing.assert_array_equal(mesh.colors, solved.world.frames[6][pixels[:, 1], pixels[:, 0]])
    assert mesh.faces.dtype == np.int32
    with pytest.raises(InputError, match="step"):
        background_mesh(each, step=0)


def test_the_joined_mesh_adds_only_what_is_new(solved: Solved) -> None:
    """More than one frame's mesh, far less than all, and as exact."""
    pictures = [solved.world.frames[each.frame] for each in solved.maps]
    one = background_mesh(solved.maps[0], pictures[0], least=2)
    all_ = sum(len(background_mesh(each, least=2).vertices) for each in solved.maps)
    joined = joined_mesh(solved.maps, pictures)
    assert len(one.vertices) < len(joined.vertices) < 0.5 * all_
    assert joined.faces.max() < len(joined.vertices) == len(joined.colors)


def test_bad_backgrounds(solved: Solved) -> None:
    """No maps, other sizes, other cameras."""
    world = solved.world
    with pytest.raises(InputError, match="at least one"):
        Background(world.frames, world.cameras, [])
    with pytest.raises(InputError, match="cameras for"):
        Background(world.frames[:9], world.cameras, solved.maps)
    with pytest.raises(InputError, match="pixels"):
        Background(world.frames[:, ::2, ::2], world.cameras, solved.maps)
