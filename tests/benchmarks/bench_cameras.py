"""Figures of the camera solver, beside the mapping library's default route on every frame of the same clip."""

from __future__ import annotations

import tempfile
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from imitation.cameras import CameraPath, solve_cameras
from tests.benchmarks.record import Recorder
from tests.imitation.cameras.compare import path_error
from tests.imitation.cameras.test_real_clips import solve

pytestmark = [pytest.mark.bench, pytest.mark.timeout(3600)]

SEED = 41  # developed on others


def default_route(frames: Sequence[Any], masks: Sequence[Any]) -> tuple[float, dict[int, np.ndarray], float]:
    """Focal length, frame -> [R | T] and CPU seconds of extraction, sequential matching and mapping, one thread."""
    import cv2
    import pycolmap

    pycolmap.logging.minloglevel = 2
    start = time.process_time()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for sub in ("images", "masks", "models"):
            (folder / sub).mkdir()
        for t, (frame, mask) in enumerate(zip(frames, masks, strict=True)):
            cv2.imwrite(str(folder / "images" / f"{t:05d}.png"), frame[..., ::-1])
            grown = cv2.dilate(mask.astype(np.uint8), np.ones((17, 17), np.uint8))
            cv2.imwrite(str(folder / "masks" / f"{t:05d}.png.png"), (1 - grown) * 255)
        reader, extraction = pycolmap.ImageReaderOptions(), pycolmap.FeatureExtractionOptions()
        reader.camera_model, reader.mask_path, extraction.num_threads = "SIMPLE_PINHOLE", folder / "masks", 1
        pycolmap.extract_features(
            folder / "db",
            folder / "images",
            camera_mode=pycolmap.CameraMode.SINGLE,
            reader_options=reader,
            extraction_options=extraction,
            device=pycolmap.Device.cpu,
        )
        pairing, matching = pycolmap.SequentialPairingOptions(), pycolmap.FeatureMatchingOptions()
        pairing.overlap, pairing.num_threads, matching.num_threads = 8, 1, 1
        pycolmap.match_sequential(
            folder / "db", matching_options=matching, pairing_options=pairing, device=pycolmap.Device.cpu
        )
        options = pycolmap.IncrementalPipelineOptions()
        options.num_threads, options.random_seed = 1, 0
        models = pycolmap.incremental_mapping(folder / "db", folder / "images", folder / "models", options)
    best = max(models.values(), key=lambda model: model.num_reg_images())
    poses = {int(i.name[:5]): i.cam_from_world().matrix() for i in best.images.values() if i.has_pose}
    return float(next(iter(best.cameras.values())).params[0]), poses, time.process_time() - start


def test_cameras_beside_the_default_route(bench: Recorder) -> None:
    """80 frames 540p with parallax: CPU, focal length, path, frames posed."""
    from resources.world.clip import make_clip
    from resources.world.render import Look

    clip = make_clip(look=Look(size=(960, 540)), frames=80, place="room", seed=SEED)
    masks = clip.masks()
    truth, focal = clip.cameras.centres, clip.cameras.K[0, 0, 0]
    solve_cameras(clip.frames[:8], masks=masks[:8])  # compiles the loops
    start = time.process_time()
    path = solve_cameras(clip.frames, masks=masks)
    ours = time.process_time() - start
    f, poses, theirs = default_route(clip.frames, masks)
    seen = sorted(poses)
    centres = np.array([-poses[t][:, :3].T @ poses[t][:, 3] for t in seen])
    name = "pycolmap, every frame"
    bench.record(
        "cameras: CPU against pycolmap's default route, 80 frames 540p",
        theirs / ours,
        asked=5,
        better="higher",
        unit="times less",
        baseline=theirs,
        baseline_name="its CPU seconds",
        note=f"ours {ours:.1f} s",
    )
    bench.record(
        "cameras: focal length error",
        100 * abs(path.K[0, 0, 0] / focal - 1),
        asked=0.5,
        unit="%",
        baseline=100 * abs(f / focal - 1),
        baseline_name=name,
    )
    bench.record(
        "cameras: path error, of its length",
        100 * path_error(path.centres, truth),
        asked=0.05,
        unit="%",
        baseline=100 * path_error(centres, truth[seen]),
        baseline_name=name,
    )
    bench.record(
        "cameras: frames posed of 80",
        int(np.isfinite(path.residuals).sum()),
        asked=80,
        better="higher",
        baseline=len(seen),
        baseline_name=name,
    )


def test_verdicts_on_the_sample_world(bench: Recorder) -> None:
    """Static, turning, flat and travelling cameras of the sample world: how many verdicts are right."""
    from resources.world.clip import make_clip
    from resources.world.render import Look

    right = total = 0
    wrong = []
    cases: list[tuple[str, dict[str, Any]]] = [
        ("ok", {}),
        ("ok", {"place": "room"}),
        ("ok", {"style": "passing", "hidden": True}),
        ("ok", {"look": Look(size=(480, 270), light_change=0.3, blur=0.4)}),
        ("static", {"style": "static"}),
        ("rotation", {"style": "rotation"}),
        ("planar", {"place": "wall"}),
    ]
    for wanted, options in cases:
        clip = make_clip(**({"look": Look(size=(480, 270)), "frames": 40, "seed": SEED} | options))
        found = solve_cameras(clip.frames, masks=clip.masks()).verdict
        total += 1
        right += found == wanted
        if found != wanted:
            wrong.append(f"{options}: {found}")
    bench.record(
        "cameras: verdicts right on the synthetic variants",
        right / total,
        asked=1,
        better="higher",
        note=f"{right} of {total} {'; '.join(wrong)}".strip(),
    )


@pytest.mark.realdata
def test_real_clips(bench: Recorder, shared_data: Path) -> None:
    """Frames posed and residuals of the clips with parallax; verdicts of all."""
    paths: dict[str, CameraPath] = {
        name: solve(shared_data / name)
        for name in ("davis_dog", "davis_libby", "davis_parkour", "davis_camel", "mouse_openfield")
    }
    for name in ("davis_dog", "davis_libby", "davis_parkour"):
        path = paths[name]
        posed = np.isfinite(path.residuals)
        bench.record(f"cameras: {name}, share of frames posed", posed.mean(), asked=1, better="higher")
        bench.record(
            f"cameras: {name}, reprojection, rms per frame, mean over frames",
            float(path.residuals[posed].mean()) if posed.any() else np.inf,
            asked=0.7,
            unit="px",
            note=f"worst frame {np.nanmax(path.residuals):.2f}, verdict {path.verdict}",
        )
    bench.record(
        "cameras: verdicts right on davis_camel and mouse_openfield",
        (paths["davis_camel"].verdict == "rotation") + (paths["mouse_openfield"].verdict == "static"),
        asked=2,
        better="higher",
    )
