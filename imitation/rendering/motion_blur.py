"""Motion blur: a moving character drawn at several moments while the shutter is open."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from imitation.errors import InputError
from imitation.geometry.projection import Camera
from imitation.rendering.light import LightMap
from imitation.rendering.mesh import Renderer, Rendering

if TYPE_CHECKING:
    from imitation.cameras.path import CameraPath

APART = 1.5  # pixels that a point may move from one drawn moment to the next
MOST = 9  # moments


def pose_at(vertices: Sequence[NDArray[np.float64]] | NDArray[np.float64], time: float) -> NDArray[np.float64]:
    """Vertices (v, 3) at a time in frames: Catmull-Rom through the four frames around it."""
    last = len(vertices) - 1
    time = float(np.clip(time, 0, last))
    k = min(int(time), max(last - 1, 0))
    s = time - k
    if s == 0 or last == 0:
        return np.asarray(vertices[k], np.float64)
    if s == 1:
        return np.asarray(vertices[k + 1], np.float64)
    p0, p1, p2, p3 = (np.asarray(vertices[int(np.clip(i, 0, last))], np.float64) for i in range(k - 1, k + 3))
    curved: NDArray[np.float64] = p1 + 0.5 * s * (
        p2 - p0 + s * (2 * p0 - 5 * p1 + 4 * p2 - p3 + s * (3 * (p1 - p2) + p3 - p0))
    )
    return curved


def camera_at(cameras: Sequence[Camera] | CameraPath, time: float) -> Camera:
    """The camera at a time in frames, turned and moved evenly from the frame before to the one after."""
    last = len(cameras) - 1
    time = float(np.clip(time, 0, last))
    k = min(int(time), max(last - 1, 0))
    s = time - k
    if s == 0 or last == 0:
        return cameras[k]
    from scipy.spatial.transform import Rotation

    one, two = cameras[k], cameras[k + 1]
    R = Rotation.from_rotvec(s * Rotation.from_matrix(two.R @ one.R.T).as_rotvec()).as_matrix() @ one.R
    centre = (1 - s) * one.centre + s * two.centre
    return Camera((1 - s) * one.K + s * two.K, R, -R @ centre)


def moments(before: NDArray[np.float64], after: NDArray[np.float64], opening: Camera, closing: Camera) -> int:
    """How many moments are to be drawn between two poses (v, 3), the ends of the shutter: odd, 1 for no motion."""
    first, second = opening.project(before), closing.project(after)
    moved = np.linalg.norm(second - first, axis=1)
    moved = moved[np.isfinite(moved)]
    if not len(moved):
        return 1
    wanted = int(np.ceil(float(np.quantile(moved, 0.98)) / APART))
    return int(np.clip(wanted + (wanted + 1) % 2, 1, MOST)) if wanted > 0 else 1


def blurred(
    renderer: Renderer,
    vertices: Sequence[NDArray[np.float64]] | NDArray[np.float64],
    frame: int,
    camera: Camera,
    lights: tuple[LightMap, LightMap] | None = None,
    *,
    shutter: float = 0.5,
    cameras: Sequence[Camera] | CameraPath | None = None,
) -> Rendering:
    """Draw a character as a shutter sees it that is open for a share of the frame time.

    Parameters
    ----------
    vertices : (n, v, 3) world, all frames. shutter : 0 (sharp) to 1 (open all the time).
    cameras : of all frames: what the camera follows stays sharp, and what it passes is blurred as the film's background
        is. None: the camera stands still while the shutter is open, so that only the character's own motion blurs.

    Returns
    -------
    Rendering
        Colours and coverage averaged over the moments; the depth of the middle one, elsewhere the nearest moment's.
    """
    if not 0 <= shutter <= 1:
        raise InputError(f"The shutter is open for 0 to 1 of the frame time, but {shutter} was asked.")
    now = np.asarray(vertices[frame], np.float64)
    ends = [pose_at(vertices, frame + side * shutter / 2) for side in (-1, 1)]
    views = [camera if cameras is None else camera_at(cameras, frame + side * shutter / 2) for side in (-1, 1)]
    count = moments(ends[0], ends[1], views[0], views[1]) if shutter > 0 else 1
    middle = renderer.draw(now, camera, lights)
    if count == 1:
        return middle
    light, cover = np.zeros((*middle.depth.shape, 3), np.float32), np.zeros(middle.depth.shape, np.float32)
    depth = np.full_like(middle.depth, np.inf)
    for k in range(count):
        time = frame + shutter * ((k + 0.5) / count - 0.5)
        drawn = middle
        if 2 * k + 1 != count:
            view = camera if cameras is None else camera_at(cameras, time)
            drawn = renderer.draw(pose_at(vertices, time), view, lights)
        alpha = drawn.rgba[..., 3].astype(np.float32) / 255
        light += alpha[..., None] * drawn.rgba[..., :3]
        cover += alpha
        depth = np.minimum(depth, drawn.depth)
    rgba = np.zeros_like(middle.rgba)
    shown = cover > 0
    rgba[shown, :3] = np.clip(np.rint(light[shown] / cover[shown, None]), 0, 255)
    rgba[..., 3] = np.clip(np.rint(255 * cover / count), 0, 255)
    return Rendering(rgba, np.where(np.isfinite(middle.depth), middle.depth, depth).astype(np.float32))
