"""Poses and points of key frames by incremental mapping (pycolmap), in a temporary folder.

Pixel centres: pycolmap puts the centre of the top-left pixel at (0.5, 0.5); shifted here, both ways.
"""

from __future__ import annotations

import tempfile
import threading
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import attrs
import numpy as np
from numpy.typing import NDArray

from imitation.cameras.consent import ENOUGH, Consent, Verified, consent, least, worst_pair
from imitation.cameras.features import Features, Matches
from imitation.cameras.follow import Tracks
from imitation.geometry.projection import Array
from imitation.progress import Progress, part, silent

ATTEMPTS = 3  # models that are mapped at most, each begun where those before contradict their pictures most
GUESS = 1.2  # focal length over the longest side where nothing is known, as the mapper's own default
CENTRE = 0.5
BESIDE = 2  # key frames apart: pairs that are asked whether a model agrees with them


@attrs.frozen(eq=False)
class Model:
    """Some frames' poses and the points they see, in pixels of the working size.

    Attributes
    ----------
    focal : pixels.
    poses : frame -> (R (3, 3), T (3,)), world to camera.
    points : (p, 3), world.
    frames, index, pixels : (m,), (m,), (m, 2): in which frame which point is seen where.
    """

    focal: float
    poses: dict[int, tuple[Array, Array]]
    points: Array
    frames: NDArray[np.int64]
    index: NDArray[np.int64]
    pixels: Array


def _database(
    pycolmap: Any,
    path: Path,
    features: Sequence[Features],
    matches: Mapping[tuple[int, int], Matches],
    tracks: Tracks,
    size: tuple[int, int],
    focal: float | None,
    tick: Callable[[float], None],
) -> Verified:
    """Write features and verified matches; give the pixels of those, for pairs of neighbouring key frames."""
    camera = pycolmap.Camera.create_from_model_name(1, "SIMPLE_PINHOLE", focal or GUESS * max(size), *size)
    camera.has_prior_focal_length = focal is not None
    options = pycolmap.TwoViewGeometryOptions()
    options.ransac.random_seed = 0
    options.ransac.max_error = 3.0
    places = [np.concatenate([f.pixels, tracks.pixels[f.frame]]) for f in features]
    kept: Verified = {}
    database = pycolmap.Database.open(path)
    try:
        database.write_camera(camera, True)
        rig = pycolmap.Rig(rig_id=1)
        rig.add_ref_sensor(camera.sensor_id)
        database.write_rig(rig, True)
        for number, found in enumerate(features, start=1):
            image = pycolmap.Image(name=f"{found.frame:06d}", camera_id=1, image_id=number)
            database.write_image(image, True)
            frame = pycolmap.Frame(frame_id=number, rig_id=1)
            frame.add_data_id(image.data_id)
            database.write_frame(frame, True)
            database.write_keypoints(number, (places[number - 1] + CENTRE).astype(np.float32))
        for done, ((i, j), pair) in enumerate(matches.items()):
            tick(done / len(matches))
            pair = np.concatenate([pair, _corners(features[i], features[j], tracks)])
            if len(pair) < options.min_num_inliers:
                continue
            first, second = places[i] + CENTRE, places[j] + CENTRE
            verified = pycolmap.estimate_two_view_geometry(
                camera, first, camera, second, pair.astype(np.uint32), options
            )
            database.write_matches(i + 1, j + 1, pair.astype(np.uint32))
            database.write_two_view_geometry(i + 1, j + 1, verified)
            if j - i <= BESIDE:
                sure = np.asarray(verified.inlier_matches, np.int64).reshape(-1, 2)
                kept[i, j] = places[i][sure[:, 0]], places[j][sure[:, 1]]
    finally:
        database.close()
    return kept


def _corners(first: Features, second: Features, tracks: Tracks) -> Matches:
    """Followed corners that two key frames share, as matches; they are listed after the features."""
    _, a, b = np.intersect1d(tracks.ids[first.frame], tracks.ids[second.frame], True, return_indices=True)
    pairs: Matches = np.stack([a + len(first.pixels), b + len(second.pixels)], axis=1)
    return pairs


def _options(pycolmap: Any, focal: float | None, begin: tuple[int, int] | None = None) -> Any:
    options = pycolmap.IncrementalPipelineOptions()
    if begin is not None:
        options.init_image_id1, options.init_image_id2 = begin[0] + 1, begin[1] + 1
    options.num_threads = 1
    options.random_seed = 0
    options.extract_colors = False
    options.min_model_size = 3
    options.max_num_models = 5
    options.init_num_trials = 60
    # Short walks: the search for a pair 16 degrees apart would cost more than all the rest.
    options.mapper.init_min_tri_angle = 4.0
    options.ba_global_frames_ratio = 1.4
    options.ba_global_points_ratio = 1.4
    options.ba_global_max_refinements = 2
    options.ba_local_max_refinements = 1
    options.ba_global_function_tolerance = 1e-6
    options.ba_local_function_tolerance = 1e-6
    if focal is not None:
        options.ba_refine_focal_length = False
        options.mapper.abs_pose_refine_focal_length = False
    return options


def _read(best: Any, features: Mapping[int, Features]) -> Model:
    """Poses, and the points of features; corners are triangulated anew with the frames between."""
    camera = next(iter(best.cameras.values()))
    names = {number: int(image.name) for number, image in best.images.items() if image.has_pose}
    poses = {}
    for number, frame in sorted(names.items()):
        matrix = best.images[number].cam_from_world().matrix()
        poses[frame] = (np.array(matrix[:, :3]), np.array(matrix[:, 3]))
    points: list[Array] = []
    frames, index, pixels = [], [], []
    for identity in sorted(best.points3D):
        point = best.points3D[identity]
        track = sorted(point.track.elements, key=lambda e: (e.image_id, e.point2D_idx))
        if track[0].point2D_idx >= len(features[names[track[0].image_id]].pixels):
            continue
        points.append(np.array(point.xyz))
        for element in track:
            frames.append(names[element.image_id])
            index.append(len(points) - 1)
            pixels.append(best.images[element.image_id].points2D[element.point2D_idx].xy - CENTRE)
    return Model(
        float(camera.params[0]),
        poses,
        np.array(points).reshape(-1, 3),
        np.array(frames, np.int64),
        np.array(index, np.int64),
        np.array(pixels).reshape(-1, 2),
    )


def map_key_frames(
    features: Sequence[Features],
    matches: Mapping[tuple[int, int], Matches],
    tracks: Tracks,
    size: tuple[int, int],
    *,
    focal: float | None = None,
    progress: Progress | None = None,
) -> Model | None:
    """Poses of key frames and their points; None where the mapper finds no model.

    Features carry the wide pairs, followed corners the near ones, where blur or grass leaves few features alike.

    Of several models the one with most frames is taken. A frame that is posed by far points alone has no scale: what it
    then adds keeps a wrong one, and near points are thrown away as outliers, with small residuals. So a model is asked
    whether it obeys the matches of neighbouring key frames, which need no scale; where it does not, another is begun at
    the pair that it contradicts most, and the one that obeys best is given.

    The mapper runs in a thread of its own with one thread of work and a fixed seed; it stops between two images, which
    may take longer than ``progress`` asks for.
    """
    import pycolmap

    report = progress or silent
    before = pycolmap.logging.minloglevel
    pycolmap.logging.minloglevel = 3
    try:
        with tempfile.TemporaryDirectory(prefix="cameras-", ignore_cleanup_errors=True) as name:
            folder = Path(name)
            (folder / "models").mkdir()
            verified = _database(
                pycolmap,
                folder / "features.db",
                features,
                matches,
                tracks,
                size,
                focal,
                lambda done: report(0.4 * done),
            )
            names, images = [f.frame for f in features], {f.frame: f for f in features}
            begin: tuple[int, int] | None = None
            tried: list[tuple[int, int]] = []
            best: tuple[Model, Consent] | None = None
            for attempt in range(ATTEMPTS):
                share = part(report, 1 - 0.6 / 3**attempt, 1 - 0.2 / 3**attempt)
                mapped = _largest(_run(pycolmap, folder, _options(pycolmap, focal, begin), len(features), share))
                if mapped is not None:
                    model = _read(mapped, images)
                    obeyed = consent(model.focal, model.poses, names, verified, (np.array(size) - 1) / 2)
                    # As many frames, to a tenth, and no pair of pictures contradicts it as much.
                    if best is None or (
                        len(model.poses) >= 0.9 * len(best[0].poses) and least(obeyed) > least(best[1])
                    ):
                        best = model, obeyed
                if best is None:
                    return None
                begin = worst_pair(best[1], verified, tried)
                if least(best[1]) >= ENOUGH or begin is None:
                    break
                tried.append(begin)
            assert best is not None  # an attempt without a model has returned
            return best[0]
    finally:
        pycolmap.logging.minloglevel = before


def _largest(models: dict[int, Any]) -> Any:
    """Of the mapper's models the one with most frames, then points; None where there is none."""
    order = sorted(models.items())
    return (
        max(order, key=lambda item: (item[1].num_reg_images(), item[1].num_points3D(), -item[0]))[1] if order else None
    )


def _run(pycolmap: Any, folder: Path, options: Any, count: int, report: Progress) -> dict[int, Any]:
    """Run the mapper in a thread so that the caller's progress is asked every tenth of a second."""
    token = pycolmap.CancellationToken()
    result: dict[str, Any] = {}
    registered = [0]

    def registered_one() -> None:
        registered[0] += 1

    def work() -> None:
        try:
            result["models"] = pycolmap.incremental_mapping(
                folder / "features.db",
                folder,
                folder / "models",
                options,
                next_image_callback=registered_one,
                cancellation_token=token,
            )
        except Exception as error:  # noqa: BLE001 - handed to the caller's thread below
            result["error"] = error

    thread = threading.Thread(target=work, name="camera mapping", daemon=True)
    thread.start()
    try:
        while thread.is_alive():
            thread.join(0.1)
            report(min(1.0, registered[0] / count))
    except BaseException:
        token.cancel()
        thread.join()
        raise
    if "error" in result:
        raise result["error"]
    models: dict[int, Any] = result["models"]
    return models
