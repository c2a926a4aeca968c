"""Figures of dense depth and plates on real clips, against points of a camera solve that were held out."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import attrs
import cv2
import numpy as np
import pytest

from imitation import CameraPath
from imitation.cameras import solve_cameras
from imitation.depth import Background, DepthSolver
from tests.benchmarks.bench_depth import psnr, within, without_prior
from tests.benchmarks.held_out import meeting_angles, neighbours, own_errors
from tests.benchmarks.mapped import mapped_cameras
from tests.benchmarks.record import Recorder

pytestmark = [pytest.mark.bench, pytest.mark.realdata, pytest.mark.timeout(3600)]


def real_clip(folder: Path) -> tuple[list[np.ndarray], list[np.ndarray]]:
    """Frames and masks of a clip."""
    import av

    with av.open(str(folder / "clip.mp4")) as container:
        frames = [frame.to_ndarray(format="rgb24") for frame in container.decode(video=0)]
    masks = [cv2.imread(str(file), cv2.IMREAD_GRAYSCALE) > 0 for file in sorted((folder / "masks").glob("*.png"))]
    return frames, masks


@attrs.frozen(eq=False)
class Held:
    """Depth of some frames around the middle of a real clip, solved without every other point of its camera solve."""

    path: CameraPath
    told: np.ndarray
    half: CameraPath
    keys: list[int]
    solver: DepthSolver
    second: dict[int, Any]

    @classmethod
    def of(cls, path: CameraPath, frames: list[np.ndarray], masks: list[np.ndarray]) -> Held:
        """Solve seven key frames."""
        told = path.observed % 2 == 0
        half = attrs.evolve(path, observations=path.observations[told], observed=path.observed[told])
        middle = len(frames) // 2
        keys = [t for t in range(middle - 12, middle + 13, 4) if 0 <= t < len(frames)]
        solver = DepthSolver(frames, half, masks, longest=480)
        first = {t: solver.first(t, keys) for t in keys}
        return cls(path, told, half, keys, solver, {t: solver.second(t, first) for t in keys})

    def asked(self, t: int, sketches: dict[int, Any]) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Held out points that a frame's map covers: names (k,), pixels (k, 2), their depth and the map's (k,)."""
        rows = (self.path.observations[:, 0].astype(int) == t) & ~self.told
        names, places = self.path.observed[rows], self.path.observations[rows, 1:]
        z, depth = self.path[t].depth(self.path.points[names]), self.solver.finish(t, sketches).depth
        pixels = np.rint(places).astype(int)
        inside = np.flatnonzero((pixels >= 0).all(1) & (pixels < np.array(depth.shape[::-1])).all(1) & (z > 0))
        got = depth[pixels[inside, 1], pixels[inside, 0]]
        inside, got = inside[np.isfinite(got)], got[np.isfinite(got)]
        return names[inside], places[inside], z[inside], got


@pytest.mark.parametrize("name", ["davis_dog", "davis_libby", "davis_parkour"])
def test_depth_where_the_mapper_alone_solves_the_cameras(
    bench: Recorder, shared_data: Path, tmp_path: Path, name: str
) -> None:
    """Held out points as the prototype had them: the mapper's own features, cameras and points."""
    frames, masks = real_clip(shared_data / name)
    held = Held.of(mapped_cameras(frames, masks, tmp_path), frames, masks)
    figures = {}
    for label, sketches in (("plain", without_prior(held.solver, held.keys)), ("ours", held.second)):
        parts = [held.asked(t, sketches) for t in held.keys]
        figures[label] = np.concatenate([np.abs(got - z) / z for _, _, z, got in parts])
    ours = figures["ours"]
    bench.record(f"depth of {name}, the mapper's cameras: median difference from held out points",
                 100 * float(np.median(ours)), asked=0.9, unit="%", baseline=100 * float(np.median(figures["plain"])),
                 baseline_name="no prior", note=f"{len(ours)} points of pycolmap's own map, half of them held out; "
                 f"within 1 % {within(ours):.1f} %, within 5 % {within(ours, 0.05):.1f} %; the prototype, parkour: "
                 "0.90 %")  # fmt: skip


@pytest.mark.parametrize("name", ["davis_dog", "davis_libby", "davis_parkour"])
def test_real_clips(bench: Recorder, shared_data: Path, name: str) -> None:
    """Median difference from points of our own solve that were held out; a false hole where nothing is hidden."""
    frames, masks = real_clip(shared_data / name)
    path = solve_cameras(frames, masks=masks)
    held = Held.of(path, frames, masks)
    keys, half, solver, second = held.keys, held.half, held.solver, held.second
    found: dict[str, list[np.ndarray]] = {"first": [], "second": []}
    own: list[np.ndarray] = []
    wide: list[np.ndarray] = []
    beside: list[np.ndarray] = []
    angles = meeting_angles(path)
    for label, sketches in (("first", without_prior(solver, keys)), ("second", second)):
        for t in keys:
            names, pixels, z, got = held.asked(t, sketches)
            found[label].append(np.abs(got - z) / z)
            if label == "second":
                own.append(own_errors(path, t, names))
                wide.append(angles[names] >= 1.5)
                beside.append(np.stack(neighbours(pixels, z, got)))
    ours, plain = (np.concatenate(found[label]) for label in ("second", "first"))
    spread = np.concatenate(own)
    limit = float(np.quantile(spread, 0.25))
    # The prototype's points came from a mapper that by default drops those whose rays meet at less than 1.5 degrees.
    met = ours[np.concatenate(wide)]
    near, scatter = 100 * np.median(np.concatenate(beside, axis=1), axis=1)
    firm, loose = ours[spread <= limit], ours[spread >= np.quantile(spread, 0.75)]
    bench.record(f"depth of {name}: median difference from held out points", 100 * float(np.median(ours)), asked=0.9,
                 unit="%", baseline=100 * float(np.median(plain)), baseline_name="no prior",
                 note=f"{len(ours)} points, {len(keys)} frames, within 5 %: {within(ours, 0.05):.0f} %; the quarter "
                 f"whose tracks fix it best, to {100 * limit:.2f} % themselves: {100 * float(np.median(firm)):.2f} %, "
                 f"the worst fixed quarter: {100 * float(np.median(loose)):.2f} %; {len(met)} points whose rays meet "
                 f"at 1.5 degrees or more: {100 * float(np.median(met)):.2f} %; points with a neighbour within 25 px "
                 f"on the same surface: {near:.2f} %, and from each other, over root two, {scatter:.2f} %")  # fmt: skip
    moved = [np.roll(mask, 150, axis=1) & ~mask for mask in masks]
    both = [a | b for a, b in zip(masks, moved, strict=True)]
    # The hole must be unknown in its own frame only: it stands for a place that the subject hid.
    hole = moved[keys[3]]
    maps = [solver.finish(t, second) for t in keys]
    maps[3] = attrs.evolve(maps[3], depth=np.where(both[keys[3]], np.nan, maps[3].depth).astype(np.float32))
    background = Background(frames, half, maps, masks=[*masks[: keys[3]], both[keys[3]], *masks[keys[3] + 1 :]])
    plate = background.plate(keys[3])
    painted = cv2.inpaint(frames[keys[3]], background.pictures.hidden(keys[3]), 5, cv2.INPAINT_TELEA)
    true = frames[keys[3]][hole]
    bench.record(f"plate of {name}: PSNR over a false hole", psnr(plate.picture[hole], true), asked=30, better="higher",
                 unit="dB", baseline=psnr(painted[hole], true), baseline_name="inpainting alone (Telea)",
                 note=f"{100 * plate.filled[hole].mean():.1f} % filled")  # fmt: skip
