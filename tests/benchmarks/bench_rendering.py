"""Figures of pictures and videos: exactness against the camera model, cost beside VTK and OpenCV."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from app.formats import open_video, write_video
from imitation.rendering import Plane, Renderer, over_frame, render_mesh
from tests.benchmarks.record import Recorder, cpu_seconds
from tests.imitation.rendering.worlds import VtkRenderer, ball, bumpy, off_centre_camera

pytestmark = pytest.mark.bench
SIZE = (960, 540)


def _centroid(alpha: np.ndarray) -> np.ndarray:
    rows, columns = np.mgrid[: alpha.shape[0], : alpha.shape[1]]
    return np.array([(columns * alpha).sum(), (rows * alpha).sum()]) / alpha.sum()


def test_balls_lie_where_the_camera_says(bench: Recorder) -> None:
    """Worst distance of a drawn ball's centroid from K [R | T] X, ours and VTK's with an explicit projection matrix."""
    ours, theirs = [], []
    for seed in range(100, 112):
        camera = off_centre_camera(seed, SIZE)
        centre = np.random.default_rng(seed).uniform(-0.6, 0.6, 3)
        vertices, faces = ball(centre, 0.06)
        expected = camera.project(centre)
        ours.append(
            np.linalg.norm(_centroid(render_mesh(vertices, faces, camera, SIZE, samples=4).rgba[..., 3]) - expected)
        )
        vtk = VtkRenderer(vertices, faces, SIZE, samples=4)
        theirs.append(np.linalg.norm(_centroid(vtk.draw(vertices, camera)[..., 3]) - expected))
        vtk.close()
    bench.record(
        "rendering: worst centroid of a ball against the camera model", max(ours), asked=0.05, unit="px",
        baseline=max(theirs), baseline_name="VTK, explicit matrix, 16 samples", note="12 off-centre cameras",
    )  # fmt: skip


def test_cost_of_a_lit_picture_beside_vtk(bench: Recorder) -> None:
    """CPU of one anti-aliased picture with shadows, beside VTK's with as many samples and none."""
    vertices, faces = bumpy()
    camera = off_centre_camera(3, SIZE)
    frame = np.full((SIZE[1], SIZE[0], 3), 120, np.uint8)
    for samples in (2, 3):
        vtk = VtkRenderer(vertices, faces, SIZE, samples=samples)
        vtk.read(vertices, camera)
        baseline = cpu_seconds(lambda: vtk.read(vertices, camera))  # noqa: B023 - called at once
        vtk.close()
        with Renderer(faces, SIZE, samples=samples) as renderer:
            over_frame(renderer, vertices, camera, frame, Plane([0, 0, -1.2]))
            plain = cpu_seconds(lambda: renderer.draw(vertices, camera))
            whole = cpu_seconds(lambda: over_frame(renderer, vertices, camera, frame, Plane([0, 0, -1.2])))
        name = f"VTK, {samples * samples} samples, no shadow, read back, not averaged"
        bench.record(
            f"rendering: lit picture 960 x 540, {samples * samples} samples", plain * 1e3, unit="ms CPU",
            baseline=baseline * 1e3, baseline_name=name, note=f"{len(vertices)} vertices, self-shadows included",
        )  # fmt: skip
        bench.record(
            f"rendering: composite with ground shadow 960 x 540, {samples * samples} samples", whole * 1e3,
            unit="ms CPU", baseline=baseline * 1e3, baseline_name=name,
        )  # fmt: skip


@pytest.mark.parametrize("gop", [12, 250])
def test_random_frames_beside_opencv(bench: Recorder, tmp_path: Path, gop: int) -> None:
    """CPU of one random frame of 960 x 540 that is not in memory, and of the next one, beside OpenCV's."""
    import cv2

    rng = np.random.default_rng(7)
    texture = cv2.GaussianBlur(rng.integers(0, 255, (700, 1300, 3), np.uint8), (0, 0), 2)
    path = tmp_path / "clip.mp4"
    film = (np.roll(texture, (t, 2 * t), (0, 1))[: SIZE[1], : SIZE[0]] for t in range(300))
    write_video(path, film, 25, gop=gop, quality=23)
    order = rng.integers(0, 300, 20).tolist()
    capture = cv2.VideoCapture(str(path))

    def theirs() -> None:
        for frame in order:
            capture.set(cv2.CAP_PROP_POS_FRAMES, frame)
            capture.read()

    def ours() -> None:
        with open_video(path, memory=1) as video:
            for frame in order:
                video[frame]

    name = "OpenCV, POS_FRAMES"
    bench.record(
        f"video: random frame 960 x 540, GOP {gop}, cold", cpu_seconds(ours, 3) / 20 * 1e3, unit="ms CPU",
        baseline=cpu_seconds(theirs, 3) / 20 * 1e3, baseline_name=name, note="opening and its time table included",
    )  # fmt: skip
    with open_video(path) as video:
        video[99]
        ahead = cpu_seconds(lambda: [video[frame] for frame in range(100, 160)], 1) / 60
        again = cpu_seconds(lambda: [video[frame] for frame in range(159, 99, -1)], 3) / 60
    capture.set(cv2.CAP_PROP_POS_FRAMES, 99)
    capture.read()
    baseline = cpu_seconds(lambda: [capture.read() for _ in range(60)], 1) / 60
    bench.record(
        f"video: next frame 960 x 540, GOP {gop}", ahead * 1e3, unit="ms CPU", baseline=baseline * 1e3,
        baseline_name="OpenCV, read",
    )  # fmt: skip
    bench.record(f"video: previous frame in memory 960 x 540, GOP {gop}", again * 1e3, unit="ms CPU")
