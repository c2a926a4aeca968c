"""The compiled loops against plain code."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from imitation.depth.agreement import agreeing
from imitation.depth.projection import FRONT, Wanted, consensus, projected_inverse
from imitation.depth.semiglobal import FINE, LARGE, LEAST, SMALL, SOFTENING, semiglobal
from imitation.depth.spans import AROUND, TILE, likely_planes
from imitation.depth.sweep import (
    FLOOR,
    GRADIENT,
    GRADIENT_CUT,
    INTENSITY,
    INTENSITY_CUT,
    SHARE,
    UNLIKELY,
    _network,
    geometry,
    sweep,
)
from imitation.geometry.projection import Camera
from resources.world.camera import lateral_camera

SIZE = (48, 32)
PLANES = np.linspace(0.08, 0.3, 24).astype(np.float32)


def signals(seed: int, count: int) -> np.ndarray:
    """Smooth signals (count, h, w, 4), a corner of each masked."""
    random = np.random.default_rng(seed)
    made = np.stack([cv2.GaussianBlur(random.normal(size=(SIZE[1], SIZE[0], 4)), (0, 0), 1.5) for _ in range(count)])
    made[..., 0] *= 120
    made[..., 1:3] *= 40
    made[..., 3] = 0
    made[:, :6, :9, 3] = 1
    return made.astype(np.float32)


def plain_sweep(reference: np.ndarray, views: np.ndarray, poses: list[Camera], camera: Camera, prior: np.ndarray | None,
                sigma: float) -> np.ndarray:  # fmt: skip
    """The same by remapping whole pictures, NaN where not seen."""
    columns, rows = np.meshgrid(np.arange(SIZE[0], dtype=float), np.arange(SIZE[1], dtype=float))
    volume = np.zeros((SIZE[1], SIZE[0], len(PLANES)))
    for d, w in enumerate(PLANES):
        points = camera.lift(np.stack([columns, rows], -1), np.full(columns.shape, 1 / w))
        costs = []
        for n, pose in enumerate(poses):
            pixels = pose.project(points)
            x, y = (np.ascontiguousarray(pixels[..., i]).astype(np.float32) for i in (0, 1))
            seen = (x >= 0) & (y >= 0) & (x < SIZE[0] - 1.001) & (y < SIZE[1] - 1.001) & (reference[..., 3] == 0)
            warped = cv2.remap(views[n].astype(np.float64), x, y, cv2.INTER_LINEAR)
            x0, y0 = np.clip(x.astype(int), 0, SIZE[0] - 2), np.clip(y.astype(int), 0, SIZE[1] - 2)
            masked = sum(views[n, y0 + i, x0 + j, 3] for i in (0, 1) for j in (0, 1)) > 0
            cost = INTENSITY * np.minimum(np.abs(warped[..., 0] - reference[..., 0]), INTENSITY_CUT) / INTENSITY_CUT
            slope = np.abs(warped[..., 1] - reference[..., 1]) + np.abs(warped[..., 2] - reference[..., 2])
            cost = cost + GRADIENT * np.minimum(slope, GRADIENT_CUT) / GRADIENT_CUT
            if prior is not None:
                at = prior[n][np.clip((y + 0.5).astype(int), 0, 31), np.clip((x + 0.5).astype(int), 0, 47)]
                back = camera.project(pose.lift(np.stack([x, y], -1), 1 / np.where(at > 0, at, 1)))
                apart = ((back - np.stack([columns, rows], -1)) ** 2).sum(-1)
                keep = np.maximum(np.exp(-apart / (2 * sigma**2)), FLOOR)
                cost = np.where(at > 0, 1 - (1 - cost) * keep, cost)
            costs.append(np.where(seen & ~masked, 255 * cost, np.nan))
        padded = np.pad(np.array(costs), ((0, 0), (1, 1), (1, 1)), constant_values=np.nan)
        block = np.stack([padded[:, i : i + SIZE[1], j : j + SIZE[0]] for i in range(3) for j in range(3)])
        number = np.isfinite(block).sum(0)
        means = np.where(number >= 5, np.nansum(block, 0) / np.maximum(number, 1), np.inf)
        means.sort(axis=0)
        count = np.isfinite(means).sum(0)
        used = np.ceil(SHARE * count - 1e-9)
        best = np.where(np.arange(len(poses))[:, None, None] < used, means, 0).sum(0) / np.maximum(used, 1)
        volume[..., d] = np.where(count > 0, best, np.nan)
    return volume


@pytest.mark.parametrize("guided", [False, True])
@pytest.mark.parametrize("count", [3, 8])
def test_the_cost_of_a_plane(guided: bool, count: int) -> None:
    """Every cost within two levels of plain code (whole numbers on the way), with and without the prior."""
    made = signals(count, count + 1)
    path = lateral_camera(count + 1, size=SIZE, way=0.8)
    poses = [path[t] for t in range(1, count + 1)]
    maps = geometry((path.K[0], path.R[0], path.T[0]), [(p.K, p.R, p.T) for p in poses])
    prior = None
    if guided:
        prior = np.random.default_rng(5).uniform(0.08, 0.3, (count, SIZE[1], SIZE[0])).astype(np.float32)
        prior[:, ::3] = 0
    hidden = made[0, ..., 3].astype(np.uint8)
    volume = sweep(made[0], hidden, made[1:], maps, PLANES, prior, 1.0).astype(float)
    expected = plain_sweep(made[0], made[1:], poses, path[0], prior, 1.0)
    seen = np.isfinite(expected) & (hidden == 0)[..., None]
    assert seen.mean() > 0.5
    off = np.abs(volume - expected)[seen]
    # A place a hair from a pixel's border may round to the other side; the prior's curve is an approximation.
    assert np.quantile(off, 0.97) < (6 if guided else 2)


@pytest.mark.parametrize("guided", [False, True])
def test_planes_that_are_not_tried_change_nothing_else(guided: bool) -> None:
    """Costs of the planes that a tile tries are those of a sweep over all of them, beside other tiles' too."""
    made = signals(7, 5)
    path = lateral_camera(5, size=SIZE, way=0.8)
    maps = geometry((path.K[0], path.R[0], path.T[0]), [(p.K, p.R, p.T) for p in (path[t] for t in range(1, 5))])
    hidden = made[0, ..., 3].astype(np.uint8)
    random = np.random.default_rng(8)
    prior = random.uniform(0.08, 0.3, (4, SIZE[1], SIZE[0])).astype(np.float32) if guided else None
    first = random.integers(0, 20, (-(-SIZE[1] // TILE), -(-SIZE[0] // TILE)))
    spans = np.stack([first, np.minimum(first + random.integers(1, 9, first.shape), len(PLANES))], -1).astype(np.int16)
    every = sweep(made[0], hidden, made[1:], maps, PLANES, prior)
    some = sweep(made[0], hidden, made[1:], maps, PLANES, prior, spans=spans)
    wide = np.repeat(np.repeat(spans, TILE, axis=0), TILE, axis=1)[: SIZE[1], : SIZE[0]]
    tried = (np.arange(len(PLANES)) >= wide[..., :1]) & (np.arange(len(PLANES)) < wide[..., 1:])
    tried |= (hidden > 0)[..., None]
    np.testing.assert_array_equal(some[tried], every[tried])
    assert (some[~tried] == UNLIKELY).all()


def test_likely_planes_are_round_what_is_known() -> None:
    """What any layer says at or beside a tile is tried there, with planes round it; all of them where none speaks."""
    layers = np.zeros((2, 3 * TILE, 3 * TILE), np.float32)
    step = PLANES[1] - PLANES[0]
    layers[0, 5, 5], layers[1, 9, 3] = PLANES[10] + 0.3 * step, PLANES[12] - 0.3 * step
    layers[1, TILE - 2, 2 * TILE + 4] = PLANES[-1] + 9 * step
    spans = likely_planes(layers, PLANES)
    assert tuple(spans[0, 0]) == (10 - AROUND, 12 + AROUND + 1)
    assert tuple(spans[1, 1]) == tuple(spans[2, 0]) == (0, len(PLANES))
    assert tuple(spans[0, 2]) == tuple(spans[1, 2]) == (len(PLANES) - AROUND, len(PLANES)), "beyond the search, beside"
    for few in (2, AROUND - 2):
        spans = likely_planes(layers, PLANES[:few])
        assert (spans == (0, few)).all(), "fewer planes than are tried round a depth"


def test_the_network_sorts() -> None:
    """Sorting by exchange: all patterns of nought and one, which is a proof."""
    pairs = _network(8)
    for pattern in range(256):
        values = [(pattern >> i) & 1 for i in range(8)]
        for i, j in pairs:
            values[i], values[j] = min(values[i], values[j]), max(values[i], values[j])
        assert values == sorted(values)


def test_semiglobal_matching_against_plain_code() -> None:
    """The plane chosen is the least of the sum over eight paths."""
    random = np.random.default_rng(2)
    volume = random.integers(0, 255, (14, 17, 11)).astype(np.uint8)
    picture = random.integers(0, 255, (14, 17, 3)).astype(np.uint8)
    table = np.maximum(min(1, FINE * 17 / 11) ** 1.5 * LARGE / (1 + np.arange(256) / SOFTENING), LEAST).round()
    total = np.zeros(volume.shape)
    for dy, dx in ((0, 1), (0, -1), (1, 0), (-1, 0), (1, 1), (1, -1), (-1, 1), (-1, -1)):
        path = np.zeros(volume.shape)
        for y in range(14)[:: -1 if dy < 0 else 1]:
            for x in range(17)[:: -1 if dx < 0 else 1]:
                py, px = y - dy, x - dx
                path[y, x] = volume[y, x]
                if 0 <= py < 14 and 0 <= px < 17:
                    before = path[py, px]
                    aside = np.pad(before, 1, constant_values=1e9)
                    large = table[np.abs(picture[y, x].astype(int) - picture[py, px]).max()]
                    least = before.min()
                    step = np.minimum(np.minimum(aside[:-2], aside[2:]) + SMALL, least + large)
                    path[y, x] += np.minimum(before, step) - least
        total += path
    plane = semiglobal(volume, picture)
    best = total.min(axis=2)
    chosen = np.rint(plane).astype(int)
    # The parabola moves by half a plane at most.
    at = np.minimum.reduce([
        np.take_along_axis(total, np.clip(chosen + s, 0, 10)[..., None], 2)[..., 0] for s in (-1, 0, 1)
    ])  # fmt: skip
    np.testing.assert_array_equal(at, best)


def test_agreement_counts_the_frames_that_see_the_same(solved: object) -> None:
    """Exact depths of other frames agree but where something hides the place; wrong ones do not."""
    world = solved.world  # type: ignore[attr-defined]
    exact = [(1 / world.depth(t)).astype(np.float32) for t in (4, 8, 12)]
    poses = [world.cameras[t] for t in (4, 8, 12)]
    both = agreeing(exact[1], poses[1], [exact[0], exact[2]], [poses[0], poses[2]], 0.004)
    assert (both == 2).mean() > 0.85
    assert (both >= 1).mean() > 0.97
    none = agreeing(exact[1] * 1.1, poses[1], [exact[0], exact[2]], [poses[0], poses[2]], 0.004)
    assert (none == 0).mean() > 0.85


def test_consensus_takes_what_most_say() -> None:
    """Two that agree outvote one that is nearer; of equal votes the nearer surface wins; nothing stays nothing."""
    layers = np.array([[0.2, 0.2, 0.0], [0.2004, 0.3, 0.0], [0.5, 0.0, 0.0]], np.float32)[:, None]
    best, support = consensus(layers, 0.001)
    np.testing.assert_allclose(best[0], [0.2002, 0.3, 0.0], atol=1e-6)
    np.testing.assert_array_equal(support[0], [2, 1, 0])


def plain_projection(inverse: np.ndarray, source: Camera, camera: Camera, size: tuple[int, int]) -> np.ndarray:
    """Splats pixel by pixel, in the kernel's precision."""
    maps = geometry((source.K, source.R, source.T), [(camera.K, camera.R, camera.T)])
    A, b = maps.A[0], maps.b[0]
    splats = []
    for y, x in zip(*np.nonzero(inverse > 0), strict=True):
        w = inverse[y, x]
        a = [float(A[r, 0]) * x + float(A[r, 1]) * y + float(A[r, 2]) + float(w * b[r]) for r in range(3)]
        if a[2] <= 0:
            continue
        u, v = a[0] / a[2], a[1] / a[2]
        four = [(int(np.floor(v)) + dy, int(np.floor(u)) + dx) for dy in (0, 1) for dx in (0, 1)]
        inside = [(py, px) for py, px in four if 0 <= px < size[0] and 0 <= py < size[1]]
        splats += [(py, px, float(w) / a[2], (1 - abs(u - px)) * (1 - abs(v - py))) for py, px in inside]
    front, total, weight = (np.zeros(size[::-1], np.float32) for _ in range(3))
    for py, px, there, share in splats:
        if share > 0.1:
            front[py, px] = max(front[py, px], np.float32(there))
    for py, px, there, share in splats:
        if there >= float(front[py, px]) * (1 - FRONT):
            total[py, px] += np.float32(share * there)
            weight[py, px] += np.float32(share)
    return np.divide(total, weight, out=np.zeros_like(total), where=weight > 0)


@pytest.mark.parametrize("ahead", [0.0, 5.0], ids=["beside", "among"])
def test_projection_against_plain_code(ahead: float) -> None:
    """The same to the bit, over the picture's border, through a map's gaps, and for what lies behind the camera."""
    random = np.random.default_rng(4)
    inverse = random.uniform(0.05, 0.4, (34, 70)).astype(np.float32)
    inverse[random.random(inverse.shape) < 0.2] = 0
    K = np.array([[60.0, 0, 34.5], [0, 60.0, 16.5], [0, 0, 1]])
    turn = cv2.Rodrigues(np.array([0.03, -0.05, 0.2]))[0]
    size = (75, 37)
    here, there = Camera(K, np.eye(3), np.zeros(3)), Camera(K, turn, np.array([0.9, -0.4, -ahead]))
    expected = plain_projection(inverse, here, there, size)
    assert 0.2 < (expected > 0).mean() < 1
    np.testing.assert_array_equal(projected_inverse(inverse, here, there, size), expected)
    wanted = random.random(expected.shape) < 0.05
    wanted[:, 0] = wanted[-1] = True
    part = projected_inverse(inverse, here, there, size, Wanted.of(wanted))
    np.testing.assert_array_equal(part, np.where(wanted, expected, 0))


@pytest.mark.parametrize("ranked", [False, True])
def test_consensus_against_plain_code(ranked: bool) -> None:
    """The same to the bit, where all layers agree and where they part."""
    random = np.random.default_rng(6)
    layers = (0.2 + 0.01 * random.integers(0, 3, (6, 40, 30)) + random.normal(0, 4e-4, (6, 40, 30))).astype(np.float32)
    layers[:, ::2] = (0.2 + random.normal(0, 3e-4, layers[:, ::2].shape)).astype(np.float32)
    layers[random.random(layers.shape) < 0.3] = 0
    worth = (1 / (1 + 0.15 * np.arange(6))).astype(np.float32) if ranked else np.ones(6, np.float32)
    best, support = np.zeros((40, 30), np.float32), np.zeros((40, 30), np.uint8)
    for place in np.ndindex(best.shape):
        said = layers[:, *place]
        top = -1.0
        for w in said[said > 0]:
            votes, total, weight = np.float32(0), np.float32(0), np.float32(0)
            with_it = (said > 0) & (np.abs(said - w) <= np.float32(0.001))
            for k in np.flatnonzero(with_it):
                votes, total, weight = votes + worth[k], total + worth[k] * said[k], weight + worth[k]
            if votes > top + 1e-6 or (votes > top - 1e-6 and w > best[place]):
                top, best[place], support[place] = float(votes), total / weight, with_it.sum()
    found = consensus(layers, 0.001, worth if ranked else None)
    np.testing.assert_array_equal(found[0], best)
    np.testing.assert_array_equal(found[1], support)
