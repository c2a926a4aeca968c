"""Figures of dense depth and what follows from it, each beside a baseline of the same run (seeds not developed on)."""

from __future__ import annotations

import functools
import time
from typing import Any

import attrs
import cv2
import numpy as np
import pytest

from imitation import CameraPath
from imitation.cameras import solve_cameras
from imitation.depth import Background, DepthMap, DepthSolver, background_mesh, joined_mesh
from imitation.depth.solve import COARSE
from tests.benchmarks.record import Recorder
from tests.imitation.depth.scenes import HARD, World, distance_to, filmed_room, ray_cast

pytestmark = [pytest.mark.bench, pytest.mark.timeout(3600)]

SEEDS = (101, 102)  # developed on 11 and 21
KEYS, SCORED = list(range(0, 40, 4)), (8, 20, 32)


@attrs.frozen(eq=False)
class Run:
    """A solved room: without a prior, with it, the maps, CPU seconds a key frame of both passes."""

    world: World
    solver: DepthSolver
    plain: dict[int, Any]
    second: dict[int, Any]
    maps: dict[int, DepthMap]
    seconds: float


def run(world: World, cameras: CameraPath | None = None, keys: list[int] | None = None) -> Run:
    """Both passes over the key frames."""
    chosen = keys or KEYS
    solver = DepthSolver(world.frames, cameras or world.cameras, world.masks)
    start = time.process_time()
    first = {t: solver.first(t, chosen) for t in chosen}
    second = {t: solver.second(t, first) for t in chosen}
    maps = {t: solver.finish(t, second) for t in chosen}
    seconds = (time.process_time() - start) / len(chosen)
    return Run(world, solver, without_prior(solver, chosen), second, maps, seconds)


def without_prior(solver: DepthSolver, keys: list[int]) -> dict[int, Any]:
    """A pass with the planes and the views of the second, but nothing to lead it: the first alone is coarser."""
    pictures, count = solver.pictures, round(len(solver.planes(keys[0])) / COARSE)
    finer = DepthSolver(
        pictures.frames, pictures.cameras, pictures.masks, longest=max(pictures.size), reach=solver.reach, planes=count
    )
    return {t: finer.first(t, keys) for t in keys}


@functools.lru_cache(maxsize=2)
def room(seed: int) -> Run:
    """A room with exact cameras; solved twice, so that compiling is not timed."""
    world = filmed_room(seed, textures=HARD)
    warm = DepthSolver(world.frames, world.cameras, world.masks)
    sketches = {t: warm.first(t, KEYS) for t in KEYS[:2]}
    warm.second(0, sketches)
    return run(world)


def errors(depth: np.ndarray, each: Run, frame: int) -> np.ndarray:
    """Relative errors of the pixels off the subject and its rim."""
    truth, off = each.world.depth(frame), each.solver.pictures.hidden(frame) == 0
    return np.abs(depth - truth)[off] / truth[off]


def within(found: np.ndarray, share: float = 0.01) -> float:
    """Per cent of the errors that are smaller than a share."""
    return float(100 * (found < share).mean())


def sgbm(world: World, frame: int) -> np.ndarray:
    """Depth (h, w) by OpenCV's StereoSGBM, 8 paths, on a rectified pair with a baseline of a tenth of the depth."""
    centres = world.cameras.centres
    across = (centres - centres[frame]) @ world.cameras[frame].R[0]
    middle = float(np.median(world.depth(frame)))
    # The other view must lie to the right; where the clip ends, the pair is seen from its other end.
    side = 1.0 if across.max() >= 0.08 * middle else -1.0
    other = int(np.argmin(np.abs(across - side * 0.1 * middle)))
    left, right = (frame, other) if side > 0 else (other, frame)
    one, two = world.cameras[left], world.cameras[right]
    turn = two.R @ one.R.T
    shift = two.T - turn @ one.T
    R1, R2, P1, P2, *_ = cv2.stereoRectify(
        one.K, np.zeros(5), two.K, np.zeros(5), world.size, turn, shift.reshape(3, 1), alpha=-1
    )  # fmt: skip
    pictures = []
    for camera, R, P, t in ((one, R1, P1, left), (two, R2, P2, right)):
        x, y = cv2.initUndistortRectifyMap(camera.K, None, R, P, world.size, cv2.CV_32FC1)
        pictures.append(cv2.remap(cv2.cvtColor(world.frames[t], cv2.COLOR_RGB2GRAY), x, y, cv2.INTER_LINEAR))
    base = float(np.linalg.norm(shift))
    most = 16 * int(np.ceil(P1[0, 0] * base / 3.0 / 16))
    matcher = cv2.StereoSGBM_create(
        0, most, 5, P1=8 * 25, P2=32 * 25, disp12MaxDiff=1, uniquenessRatio=5, speckleWindowSize=60, speckleRange=2,
        mode=cv2.STEREO_SGBM_MODE_HH,
    )  # fmt: skip
    flip = frame == right
    if flip:  # seen from the right: mirrored, so that it is the left one
        pictures = [np.ascontiguousarray(p[:, ::-1]) for p in pictures[::-1]]
    disparity = matcher.compute(*pictures).astype(np.float64) / 16
    if flip:
        disparity = disparity[:, ::-1]
    R, P, camera = (R2, P2, two) if flip else (R1, P1, one)
    columns, rows = np.meshgrid(np.arange(world.size[0]), np.arange(world.size[1]))
    with np.errstate(divide="ignore", invalid="ignore"):
        z = np.where(disparity > 0, P1[0, 0] * base / disparity, np.nan)
    rays = np.stack([columns, rows, np.ones_like(rows)], -1) @ np.linalg.inv(P[:, :3]).T
    own = ((rays * z[..., None]) @ R)[..., 2]
    back = np.stack([columns, rows, np.ones_like(rows)], -1) @ np.linalg.inv(camera.K).T @ R.T @ P[:, :3].T
    at = (back[..., :2] / back[..., 2:]).astype(np.float32)
    return cv2.remap(own, at[..., 0], at[..., 1], cv2.INTER_NEAREST, borderValue=np.nan)


def test_depth_with_exact_cameras(bench: Recorder) -> None:
    """480 x 270, every pixel off the subject, three frames of two rooms."""
    rooms = [room(seed) for seed in SEEDS]
    ours = np.concatenate([errors(r.maps[t].depth, r, t) for r in rooms for t in SCORED])
    plain = np.concatenate([errors(1 / r.plain[t].inverse, r, t) for r in rooms for t in SCORED])
    pair = np.concatenate([errors(sgbm(r.world, t), r, t) for r in rooms for t in SCORED])
    known = np.isfinite(pair)
    note = (
        f"StereoSGBM: {100 * pair[known].mean():.1f} % mean, {within(pair[known]):.1f} % within 1 % "
        f"on {100 * known.mean():.0f} % of the pixels; two rooms"
    )
    name = "the same views, no prior"
    bench.record("depth 480 x 270, exact cameras: mean error", 100 * ours.mean(), asked=0.5, unit="%",
                 baseline=100 * plain.mean(), baseline_name=name, note=note)  # fmt: skip
    bench.record("depth 480 x 270, exact cameras: within 1 %", within(ours), asked=95, better="higher", unit="%",
                 baseline=within(plain), baseline_name=name, note=note)  # fmt: skip
    bench.record("depth: CPU a key frame, 480 x 270", max(r.seconds for r in rooms), asked=4, unit="s",
                 baseline=7, baseline_name="the prototype", note="both passes, one core")  # fmt: skip


def shaken(cameras: CameraPath, pixels: float, depth: float) -> CameraPath:
    """Cameras with an independent pose error a frame that moves points at a depth by ``pixels`` rms."""
    random = np.random.default_rng(5)
    turn, shift = random.normal(size=(len(cameras), 3)), random.normal(size=(len(cameras), 3))

    def made(size: float) -> CameraPath:
        R = np.stack(
            [cv2.Rodrigues(size * 0.5 / cameras.K[0, 0, 0] * v)[0] @ r for v, r in zip(turn, cameras.R, strict=True)]
        )
        T = cameras.T + size * 0.5 * depth / cameras.K[0, 0, 0] * shift
        return CameraPath(K=cameras.K, R=R, T=T)

    columns, rows = np.meshgrid(np.linspace(0, 479, 9), np.linspace(0, 269, 6))
    corner = np.stack([columns.ravel(), rows.ravel()], 1)

    def moved(path: CameraPath) -> float:
        off = []
        for t in range(len(path)):
            points = cameras[t].lift(corner, np.full(len(corner), depth))
            off.append(path[t].project(points) - corner)
        return float(np.sqrt((np.concatenate(off) ** 2).sum(1).mean()))

    return made(pixels / moved(made(1.0)))


def test_depth_with_slightly_wrong_cameras(bench: Recorder) -> None:
    """Cameras off by 0.27 px rms, and those that we solve from the video."""
    world = room(SEEDS[0]).world
    for pixels, asked in ((0.27, 86), (0.38, None)):
        each = run(world, shaken(world.cameras, pixels, 7.0))
        ours = np.concatenate([errors(each.maps[t].depth, each, t) for t in SCORED])
        plain = np.concatenate([errors(1 / each.plain[t].inverse, each, t) for t in SCORED])
        bench.record(f"depth 480 x 270, cameras off by {pixels} px: within 1 %", within(ours), asked=asked,
                     better="higher", unit="%", baseline=within(plain), baseline_name="the same views, no prior",
                     note=f"mean {100 * ours.mean():.2f} %; rms distance, independent from frame to frame")  # fmt: skip
    path = solve_cameras(world.frames, masks=world.masks)
    each = run(world, path)
    scale = np.linalg.norm(np.ptp(world.cameras.centres, axis=0)) / np.linalg.norm(np.ptp(path.centres, axis=0))
    ours = np.concatenate([errors(scale * each.maps[t].depth, each, t) for t in SCORED])
    plain = np.concatenate([errors(scale / each.plain[t].inverse, each, t) for t in SCORED])
    focal = path.K[0, 0, 0] / world.cameras.K[0, 0, 0] - 1
    bench.record("depth 480 x 270, our own cameras: within 1 %", within(ours), asked=80, better="higher", unit="%",
                 baseline=within(plain), baseline_name="the same views, no prior",
                 note=f"mean {100 * ours.mean():.2f} %, focal length off by {100 * focal:+.2f} %, "
                 "scale from the length of the path")  # fmt: skip


def test_depth_at_960(bench: Recorder) -> None:
    """960 x 540, five key frames as the prototype had, frame 20."""
    each = run(filmed_room(SEEDS[1], (960, 540), textures=HARD), keys=[4, 12, 20, 28, 36])
    ours, plain = errors(each.maps[20].depth, each, 20), errors(1 / each.plain[20].inverse, each, 20)
    name = "the same views, no prior"
    bench.record("depth 960 x 540, exact cameras: mean error", 100 * ours.mean(), asked=0.28, unit="%",
                 baseline=100 * plain.mean(), baseline_name=name, note="one frame, five key frames")  # fmt: skip
    bench.record("depth 960 x 540, exact cameras: within 1 %", within(ours), asked=98.5, better="higher", unit="%",
                 baseline=within(plain), baseline_name=name, note="one frame, five key frames")  # fmt: skip
    bench.record("depth: CPU a key frame, 960 x 540", each.seconds, asked=18, unit="s", baseline=31,
                 baseline_name="the prototype", note="both passes, one core")  # fmt: skip


def psnr(first: np.ndarray, second: np.ndarray) -> float:
    """Peak signal to noise ratio, dB."""
    return float(10 * np.log10(255**2 / np.mean((first.astype(float) - second) ** 2)))


def test_the_hole_behind_the_subject(bench: Recorder) -> None:
    """Filled share and PSNR over the whole hole, worst of three frames, beside inpainting alone."""
    each = room(SEEDS[0])
    clean = filmed_room(SEEDS[0], blob=False, textures=HARD).frames
    background = Background(
        each.world.frames, each.world.cameras, list(each.maps.values()), masks=each.world.masks
    )  # fmt: skip
    filled, ours, telea, spent = [], [], [], []
    for frame in SCORED:
        start = time.process_time()
        plate = background.plate(frame)
        spent.append(time.process_time() - start)
        mask, hidden = each.world.masks[frame], background.pictures.hidden(frame)
        painted = cv2.inpaint(each.world.frames[frame], hidden, 5, cv2.INPAINT_TELEA)
        filled.append(100 * plate.filled[mask].mean())
        ours.append(psnr(plate.picture[mask], clean[frame][mask]))
        telea.append(psnr(painted[mask], clean[frame][mask]))
    name = "inpainting alone (Telea)"
    bench.record("plate: hole filled from other frames, worst of 3", min(filled), asked=97.5, better="higher", unit="%",
                 baseline=0, baseline_name=name, note=f"{max(spent):.2f} s CPU a plate at 480 x 270")  # fmt: skip
    bench.record("plate: PSNR over the hole, worst of 3", min(ours), asked=26, better="higher", unit="dB",
                 baseline=max(telea), baseline_name=name + ", best of 3")  # fmt: skip


def test_the_background_mesh(bench: Recorder) -> None:
    """Vertices of a key frame's mesh farther than 100 mm from the true surfaces."""
    each = room(SEEDS[0])
    background = Background(
        each.world.frames, each.world.cameras, list(each.maps.values()), masks=each.world.masks
    )  # fmt: skip

    def far(mesh: Any) -> float:
        return float(100 * (distance_to(each.world.parts, mesh.vertices) > 0.1).mean())

    one = np.mean([far(background_mesh(background.plate(t).depth)) for t in SCORED])
    every = np.mean([far(background_mesh(background.plate(t).depth, step=1, cut=1.0)) for t in SCORED])
    joined = joined_mesh(list(each.maps.values()))
    bench.record("background mesh of a key frame: vertices off by more than 100 mm", one, asked=2, unit="%",
                 baseline=every, baseline_name="every pixel, no cut",
                 note=f"joined mesh of all key frames {far(joined):.2f} %, {len(joined.vertices)} vertices; "
                 "completed depth, three frames")  # fmt: skip


def test_the_edge_of_occlusion(bench: Recorder) -> None:
    """RMSE in the occlusion band of a ball behind box and post, against a composite of 4 x 4 samples."""
    from imitation.rendering import Rendering, visibility

    each = room(SEEDS[0])
    world, frame = each.world, 32
    background = Background(world.frames, world.cameras, list(each.maps.values()), masks=world.masks)
    plate = background.plate(frame)
    clean = filmed_room(SEEDS[0], blob=False, textures=HARD)
    camera = world.cameras[frame]
    figures: dict[str, list[float]] = {"none": [], "hard": [], "soft": [], "true": []}
    for centre in ((-1.15, 2.9, 0.75), (0.3, 1.3, 0.9), (1.2, 2.5, 0.7)):
        fine = _ball_depth(camera, world.size, np.array(centre), 0.55, 4)
        truth_depth = ray_cast(world.parts, camera, world.size, 4)[0]
        shown = ((fine < truth_depth) & np.isfinite(fine)).reshape(270, 4, 480, 4).mean((1, 3))
        cover = np.isfinite(fine).reshape(270, 4, 480, 4).mean((1, 3))
        color = np.array([250.0, 60.0, 40.0])
        back = clean.frames[frame].astype(float)
        truth = back + shown[..., None] * (color - back)
        depth = _ball_depth(camera, world.size, np.array(centre), 0.55, 1)
        rgba = np.zeros((270, 480, 4), np.uint8)
        rgba[..., :3], rgba[..., 3] = color, np.rint(255 * cover)
        ball = Rendering(rgba, depth.astype(np.float32))
        band = cv2.dilate(((shown > 0.02) & (shown < 0.98)).astype(np.uint8), np.ones((5, 5))) > 0
        band &= cv2.erode((cover > 0.99).astype(np.uint8), np.ones((3, 3))) > 0
        for name, matte in (
            ("none", np.ones((270, 480))),
            ("hard", visibility(ball.depth, plate.depth.depth, soft=False)),
            ("soft", visibility(ball.depth, plate.depth.depth)),
            ("true", visibility(ball.depth, world.depth(frame))),
        ):
            alpha = cover * matte
            out = back + alpha[..., None] * (color - back)
            figures[name].append(float(((out - truth)[band] ** 2).mean()))
    rms = {name: float(np.sqrt(np.mean(values))) for name, values in figures.items()}
    # The recipe's scene had one body behind post, box and stair; before a weakly textured box depth knows least.
    apart = ", ".join(
        f"{name} {np.sqrt(value):.1f}"
        for name, value in zip(("box", "post", "weakly textured box"), figures["soft"], strict=True)
    )
    bench.record("occlusion edge: RMSE in the band", rms["soft"], asked=16, baseline=rms["hard"], unit="levels",
                 baseline_name="hard test", note=f"no test {rms['none']:.1f}, true depth {rms['true']:.1f}; completed "
                 f"depth, balls behind {apart}")  # fmt: skip


def _ball_depth(camera: Any, size: tuple[int, int], centre: np.ndarray, radius: float, finer: int) -> np.ndarray:
    columns, rows = np.meshgrid(
        (np.arange(size[0] * finer) + 0.5) / finer - 0.5, (np.arange(size[1] * finer) + 0.5) / finer - 0.5
    )
    rays = camera.rays(np.stack([columns, rows], -1))
    offset = camera.centre - centre
    a, b, c = (rays**2).sum(-1), rays @ offset, offset @ offset - radius**2
    root = b * b - a * c
    return np.where(root > 0, (-b - np.sqrt(np.maximum(root, 0))) / a, np.inf)
