"""Pictures of the sample world agree with its truth: depth, masks, visibility, light, determinism."""

from __future__ import annotations

import attrs
import numpy as np
import pytest

from imitation.errors import InputError
from imitation.geometry.projection import Camera
from resources.world.clip import make_clip
from resources.world.light import light_maps
from resources.world.noise import cells, layers, noise
from resources.world.raster import rasterise
from resources.world.render import Look, Stage, between, develop
from resources.world.scene import room, wall
from tests.support.scenes import SMALL, small_clip


def test_the_rasteriser_agrees_with_rays() -> None:
    """Which triangle a pixel sees, and how deep, are those of a ray against every triangle, behind the camera too."""
    rng = np.random.default_rng(3)
    vertices = rng.normal(size=(60, 3)) * [2, 2, 3] + [0, 0, 3]
    faces = rng.permutation(60).reshape(20, 3).astype(np.int32)
    camera = Camera(np.array([[40, 0, 15.5], [0, 40, 11.5], [0, 0, 1.0]]), np.eye(3), np.zeros(3))
    closeness, ids, _ = rasterise(vertices, faces, camera, (32, 24))
    for y in range(0, 24, 3):
        for x in range(0, 32, 3):
            ray = camera.rays([x, y])
            best, which = np.inf, -1
            for i, (a, b, c) in enumerate(vertices[faces]):
                try:
                    u, v, depth = np.linalg.solve(np.stack([b - a, c - a, -ray], axis=1), -a)
                except np.linalg.LinAlgError:
                    continue
                if u >= 0 and v >= 0 and u + v <= 1 and 0.05 < depth < best:
                    best, which = depth, i
            assert ids[y, x] == which
            if which >= 0:
                assert closeness[y, x] == pytest.approx(1 / best, rel=1e-9)


def test_depth_is_that_of_the_planes_it_shows() -> None:
    """In the room every pixel lies on the ground, the back wall, or in front of both; those two are met exactly."""
    clip = small_clip(4, place="room", subject=None)
    depth = clip.depth(2)
    y, x = np.mgrid[:180, :320]
    points = clip.cameras[2].lift(np.stack([x, y], axis=-1).astype(float), depth)
    assert np.isfinite(depth).all()
    assert points[..., 2].min() > -1e-9
    assert points[..., 1].max() < 6.0 + 1e-9
    assert (np.abs(points[..., 2]) < 1e-9).mean() > 0.15, "no ground is seen"
    assert (np.abs(points[..., 1] - 6.0) < 1e-9).mean() > 0.1, "no back wall is seen"
    assert 3.0 < np.quantile(depth, 0.02) < 5.0
    assert depth.max() < 11


def test_the_planar_scene_is_planar() -> None:
    """All that stands still before the wall lies in one plane."""
    clip = small_clip(3, place="wall", subject=None)
    y, x = np.mgrid[:180, :320]
    points = clip.cameras[1].lift(np.stack([x, y], axis=-1).astype(float), clip.depth(1))
    np.testing.assert_allclose(points[..., 1], 1.2, atol=1e-9)


@pytest.mark.parametrize("subject", ["quadruped", "biped"])
def test_masks_are_where_the_truth_projects(subject: str) -> None:
    """Visible vertices fall into the mask; every pixel of the mask is inside the projection of some triangle."""
    import cv2

    clip = small_clip(12, subject=subject)
    assert clip.walk is not None
    for t in (0, 11):
        mask, camera = clip.mask(t), clip.cameras[t]
        pixels = camera.project(clip.walk.vertices[t])
        drawn = np.zeros(mask.shape, np.uint8)
        for triangle in pixels[clip.walk.body.faces]:
            cv2.fillConvexPoly(drawn, np.rint(triangle * 256).astype(np.int32), 1, shift=8)
        assert drawn[mask].mean() > 0.999
        seen = clip.stage.visible(t, camera, clip.walk.vertices[t], tolerance=0.005)
        near = cv2.dilate(mask.astype(np.uint8), np.ones((3, 3), np.uint8))
        at = np.rint(pixels[seen]).astype(int)
        assert near[at[:, 1], at[:, 0]].all()
        assert 0.2 < seen.mean() < 0.7
        hidden = drawn.astype(bool) & ~mask
        assert hidden.sum() < 0.4 * drawn.sum()


def test_the_subject_stands_before_the_background() -> None:
    """With the subject, depth is less exactly where the mask is, and the same elsewhere."""
    clip = small_clip(12)
    with_subject, without = clip.stage.depth(6, clip.cameras[6], subject=True), clip.depth(6)
    mask = clip.mask(6)
    assert (with_subject[mask] < np.nan_to_num(without[mask], nan=np.inf)).all()
    np.testing.assert_array_equal(with_subject[~mask], without[~mask])


def test_the_picture_moves_as_depth_and_cameras_say() -> None:
    """A frame warped by true depth and cameras onto another looks like it: far better than unwarped."""
    import cv2

    clip = small_clip(20)
    first, last = 2, 17
    y, x = np.mgrid[:180, :320]
    points = clip.cameras[first].lift(np.stack([x, y], axis=-1).astype(float), clip.depth(first))
    there = clip.cameras[last].project(points)
    grey = [cv2.GaussianBlur(f.mean(axis=2), (0, 0), 1.0) for f in (clip.frames[first], clip.frames[last])]
    maps = there.astype(np.float32)
    warped = cv2.remap(grey[1].astype(np.float32), maps[..., 0], maps[..., 1], cv2.INTER_LINEAR)
    valid = (there > 2).all(axis=-1) & (there < [317, 177]).all(axis=-1) & ~clip.mask(first)
    valid &= np.isfinite(points).all(axis=-1)
    assert np.median(np.abs(warped - grey[0])[valid]) < 0.35 * np.median(np.abs(grey[1] - grey[0])[valid])
    assert np.corrcoef(warped[valid], grey[0][valid])[0, 1] > 0.8


def test_tracks_are_seen_or_hidden() -> None:
    """Near paws are seen, far hips never; tracks have no gap."""
    clip = small_clip(20)
    seen = clip.visibility()
    assert len(seen) == 16
    assert seen["right hind hip"].mean() > 0.8
    assert not seen["left hind hip"].any()
    assert all(np.isfinite(track).all() for track in clip.tracks().values())


def test_the_same_clip_has_the_same_bits() -> None:
    """Rendered twice, equal in every bit; another seed gives another picture."""
    look = Look(size=(96, 54), samples=1, sky=4)
    clips = [make_clip(frames=2, look=look, seed=seed, vertices=600).frames for seed in (3, 3, 4)]
    np.testing.assert_array_equal(clips[0], clips[1])
    assert (clips[0] != clips[2]).mean() > 0.2


def test_pictures_have_contrast_and_texture() -> None:
    """Not burnt out, not drowned, and textured nearly everywhere on the ground and the walls."""
    clip = small_clip(20)
    grey = clip.frames[10].mean(axis=2)
    assert (grey > 250).mean() < 0.03
    assert (grey < 8).mean() < 0.06
    assert 70 < grey.mean() < 165
    blocks = grey[:176].reshape(11, 16, 20, 16).std(axis=(1, 3))
    assert np.quantile(blocks, 0.1) > 3


def test_looks_do_what_they_say() -> None:
    """Light change and gain drift alter brightness over time, blur takes sharpness, a trunk hides, grain is grain."""
    stage = Stage(room(), None, attrs.evolve(SMALL, size=(160, 90)))
    cameras = small_clip(4, place="room", subject=None, size=(160, 90)).cameras

    def frames(**changes: float) -> np.ndarray:
        stage.look = attrs.evolve(SMALL, size=(160, 90), **changes)  # type: ignore[arg-type]
        return np.stack([stage.frame(t, cameras) for t in range(4)]).astype(float)

    plain = frames()
    changed = frames(light_change=0.8)
    assert abs(changed[3].mean() - plain[3].mean()) > 1
    drifted = frames(gain_drift=0.1)
    assert np.abs((drifted - plain).mean(axis=(1, 2, 3))).max() > 2
    silent, noisy = frames(grain=0.0), frames(grain=4.0)
    assert np.std((noisy - silent)[(silent > 40) & (silent < 215)]) == pytest.approx(4, rel=0.1)
    blurred = frames(grain=0.0, blur=0.9)
    assert np.abs(np.diff(blurred[1], axis=1)).mean() < 0.97 * np.abs(np.diff(silent[1], axis=1)).mean()


def test_a_trunk_hides_the_subject() -> None:
    """With a large foreground a good part of the picture is nearer than the subject."""
    plain, hidden = (small_clip(8, hidden=flag).depth(4) for flag in (False, True))
    nearer = hidden < 2.6
    assert nearer.mean() > 0.1
    np.testing.assert_array_equal(plain[~nearer], hidden[~nearer])


def test_between_frames_cameras_move_evenly() -> None:
    """At whole times the camera is the frame's own; half way its centre is in the middle."""
    cameras = small_clip(4, place="wall", subject=None).cameras
    np.testing.assert_array_equal(between(cameras, 2.0).R, cameras[2].R)
    np.testing.assert_allclose(between(cameras, 1.5).centre, cameras.centres[1:3].mean(axis=0), atol=1e-12)


def test_light_maps_hold_what_is_nearest_to_the_light() -> None:
    """Over a sheet the map's height is the sheet's along the light, elsewhere nothing."""
    scene = wall().geometry
    maps = light_maps(scene.vertices, scene.faces, np.array([[0.0, -1.0, 0.0]]), np.zeros(3), 2.0, 16)
    np.testing.assert_allclose(maps.maps[0], -1.2, atol=1e-6)


def test_noise_is_smooth_bounded_and_faded() -> None:
    """Noise stays in its range, joins across its lattice, and vanishes where a pixel is larger than its lumps."""
    rng = np.random.default_rng(1)
    for x, y, z in rng.uniform(-50, 50, (300, 3)):
        assert 0 <= noise(x, y, z) <= 1
        first, second, name = cells(x, y, z)
        assert 0 <= first <= second
        assert 0 <= name < 1
        assert layers(x, y, z, 0.1, 4, 0.5) == 0
    assert noise(3 - 1e-9, 2.5, 1.5) == pytest.approx(noise(3 + 1e-9, 2.5, 1.5), abs=1e-6)


def test_develop_is_monotone() -> None:
    """More light is never darker, black is black, white ends at 1."""
    tones = develop(np.linspace(0, 20, 500))
    assert (np.diff(tones) >= 0).all()
    assert tones[0] == 0
    assert tones[-1] == pytest.approx(1, abs=0.02)


def test_bad_requests_are_refused() -> None:
    """An unknown place and a track of nobody are said in a sentence."""
    with pytest.raises(InputError, match="garden, wall and room"):
        make_clip(place="moon")  # type: ignore[arg-type]
    with pytest.raises(InputError, match="Nobody walks"):
        small_clip(3, place="wall", subject=None).track(0)
