"""Cameras and points of a clip as the mapper alone finds them, to ask dense depth apart from our own camera solve."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import cv2
import numpy as np

from imitation import CameraPath

CENTRE = 0.5  # where the mapper has the centre of the top left pixel
OVERLAP = 12  # frames on each side that a frame is matched with, and others at doubling distance


def mapped_cameras(frames: Sequence[np.ndarray], masks: Sequence[np.ndarray], folder: Path) -> CameraPath:
    """Every frame's camera by pycolmap with its own features, matches and defaults, one focal length.

    Points carry the mapper's own filter: rays that meet at less than 1.5 degrees, or miss by 4 pixels, are dropped.
    """
    import pycolmap

    pictures, hidden, database = folder / "pictures", folder / "masks", folder / "features.db"
    for each in (pictures, hidden, folder / "models"):
        each.mkdir()
    for t, (frame, mask) in enumerate(zip(frames, masks, strict=True)):
        cv2.imwrite(str(pictures / f"{t:05d}.png"), cv2.cvtColor(frame, cv2.COLOR_RGB2BGR))
        grown = cv2.dilate(mask.astype(np.uint8), np.ones((7, 7), np.uint8))
        cv2.imwrite(str(hidden / f"{t:05d}.png.png"), 255 * (1 - grown))
    reader = pycolmap.ImageReaderOptions()
    reader.camera_model, reader.mask_path = "SIMPLE_PINHOLE", str(hidden)
    pairing = pycolmap.SequentialPairingOptions()
    pairing.overlap, pairing.quadratic_overlap, pairing.loop_detection = OVERLAP, True, False
    before = pycolmap.logging.minloglevel
    pycolmap.logging.minloglevel = 3
    try:
        pycolmap.set_random_seed(0)
        pycolmap.extract_features(database, pictures, camera_mode=pycolmap.CameraMode.SINGLE, reader_options=reader)
        pycolmap.match_sequential(database, pairing_options=pairing)
        models = pycolmap.incremental_mapping(database, pictures, folder / "models")
    finally:
        pycolmap.logging.minloglevel = before
    best = max(models.values(), key=lambda model: model.num_reg_images())
    images = {int(image.name.split(".")[0]): image for image in best.images.values() if image.has_pose}
    assert len(images) == len(frames), f"the mapper posed {len(images)} of {len(frames)} frames"
    numbers = {name: i for i, name in enumerate(sorted(best.points3D))}
    K, poses, rows, observed = [], [], [], []
    for t in range(len(frames)):
        image = images[t]
        own = best.cameras[image.camera_id].calibration_matrix().copy()
        own[:2, 2] -= CENTRE
        K.append(own)
        poses.append(image.cam_from_world().matrix())
        for seen in image.points2D:
            if seen.has_point3D():
                rows.append((t, *(seen.xy - CENTRE)))
                observed.append(numbers[seen.point3D_id])
    return CameraPath(
        K=np.array(K),
        R=np.array(poses)[:, :, :3],
        T=np.array(poses)[:, :, 3],
        points=np.array([best.points3D[name].xyz for name in sorted(best.points3D)]),
        observations=np.array(rows),
        observed=np.array(observed, np.int32),
    )
