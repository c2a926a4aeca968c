"""Points found again: in more frames, where they truly show, and not behind the subject."""

from __future__ import annotations

import numpy as np
import pytest

from imitation.cameras.adjust import Bundle
from imitation.cameras.again import MOST, found_again
from imitation.cameras.clip import Clip
from imitation.cameras.follow import follow_corners
from imitation.cameras.poses import Sightings, triangulate
from imitation.errors import Cancelled
from tests.imitation.cameras.scenes import Film, film, handheld, room

FRAMES = 24
SIZE = (384, 216)


@pytest.fixture(scope="module")
def walked() -> Film:
    """A walk past stairs and boxes, with the true cameras."""
    return film(room(33), handheld(FRAMES, SIZE, seed=33), SIZE, seed=33)


def short_lived(film: Film, clip: Clip, longest: int) -> Bundle:
    """Corners followed for a few frames only, with the true cameras and points from their rays."""
    sightings = Sightings.of(follow_corners(clip))
    first = np.full(int(sightings.corner.max()) + 1, FRAMES)
    np.minimum.at(first, sightings.corner, sightings.frame)
    kept = sightings.frame - first[sightings.corner] < longest
    sightings = Sightings(sightings.corner[kept], sightings.frame[kept], sightings.pixels[kept])
    path = film.cameras
    poses = {t: (path.R[t], path.T[t]) for t in range(FRAMES)}
    focal = float(path.K[0, 0, 0])
    points, sound = triangulate(poses, focal, clip.working_centre, sightings)
    used, names = sound[sightings.corner], np.cumsum(sound) - 1
    return Bundle.of(
        focal, clip.working_centre, path.R, path.T, points[sound],
        sightings.frame[used], names[sightings.corner[used]], sightings.pixels[used],
    )  # fmt: skip


def test_points_are_found_in_more_frames_and_where_they_are(walked: Film) -> None:
    """Most corners that were followed for eight frames are found in all, a tenth of a pixel from one place."""
    clip = Clip.of(walked.frames, None)
    before = short_lived(walked, clip, 8)
    after = found_again(clip, before, settle=True)
    sightings = np.bincount(after.point, minlength=len(after.points))
    assert np.median(sightings) > 1.5 * np.median(np.bincount(before.point))
    assert sightings.max() <= MOST + 1  # the patch's own frame stays
    # The points themselves still come from few frames: triangulated anew by the true cameras, all must agree.
    rays = Sightings(after.point, after.camera, after.pixels)
    poses = {t: (walked.cameras.R[t], walked.cameras.T[t]) for t in range(FRAMES)}
    points, _ = triangulate(poses, after.focal, clip.working_centre, rays)
    local = np.einsum("nij,nj->ni", after.R[after.camera], points[after.point]) + after.T[after.camera]
    off = np.linalg.norm(after.focal * local[:, :2] / local[:, 2:] + after.centre - after.pixels, axis=1)
    assert np.median(off) < 0.1
    assert np.mean(off < 0.5) > 0.97


def test_nothing_is_found_behind_the_subject(walked: Film) -> None:
    """A mask over the left half takes what would be found there, and leaves the right."""
    masks = np.zeros(walked.frames.shape[:3], bool)
    before = short_lived(walked, Clip.of(walked.frames, None), 6)
    width = masks.shape[2]
    masks[12:, :, : width // 2] = True
    after = found_again(Clip.of(walked.frames, masks), before, settle=False)
    old = set(zip(before.point.tolist(), before.camera.tolist(), strict=True))
    new = np.array([pair not in old for pair in zip(after.point.tolist(), after.camera.tolist(), strict=True)])
    assert new.sum() > 500
    there = new & (after.camera >= 12)
    assert there.any()
    assert after.pixels[there, 0].min() > width // 2


def test_a_picture_without_contrast_gives_nothing_new(walked: Film) -> None:
    """A grey frame is no place to find anything in."""
    clip = Clip.of(walked.frames, None)
    before = short_lived(walked, clip, 6)
    blank = walked.frames.copy()
    blank[10] = 90
    after = found_again(Clip.of(blank, None), before, settle=False)
    assert (after.camera == 10).sum() <= (before.camera == 10).sum()


def test_cancelled_at_once(walked: Film) -> None:
    """``Cancelled`` leaves at the first question."""

    def stop(fraction: float) -> None:
        raise Cancelled

    clip = Clip.of(walked.frames, None)
    with pytest.raises(Cancelled):
        found_again(clip, short_lived(walked, clip, 6), settle=True, progress=stop)
