# mypy: disable-error-code="untyped-decorator"
"""A view from the side: what depth does, which the film's own camera cannot show."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import ArrayLike, NDArray

from imitation.errors import InputError
from imitation.geometry.projection import Camera
from imitation.progress import Progress, silent
from imitation.rendering.composite import Picture, over_frame, studio
from imitation.rendering.ground import Ground, Plane
from imitation.rendering.light import Look, look_at
from imitation.rendering.mesh import UP, Renderer

_HALF_VIEW = float(np.radians(14))
_FLOOR = np.array([150, 155, 163], np.float32)


def side_cameras(
    vertices: Sequence[ArrayLike] | NDArray[np.floating],
    cameras: Sequence[Camera],
    size: tuple[int, int],
    *,
    up: ArrayLike = UP,
    turn: float = np.pi / 2,
    tilt: float = 0.16,
    smoothing: float = 8.0,
) -> list[Camera]:
    """Cameras that look at the subject turned about the up axis, and follow it smoothly.

    Parameters
    ----------
    vertices : (n, v, 3) world positions in each frame.
    cameras : n cameras of the film; their mean direction is what is turned.
    size : (width, height) of the pictures.
    up : direction of the sky, world.
    turn : angle about ``up``, radians.
    tilt : how far the view looks down, radians.
    smoothing : frames over which the subject's place is averaged (standard deviation).
    """
    above = np.asarray(up, np.float64) / np.linalg.norm(up)
    poses = [np.asarray(pose, np.float64) for pose in vertices]
    centres = np.array([(pose.min(axis=0) + pose.max(axis=0)) / 2 for pose in poses])
    radius = max(float(np.linalg.norm(pose - place, axis=1).max()) for pose, place in zip(poses, centres, strict=True))
    followed = _followed(centres, smoothing)
    drift = float(np.linalg.norm(followed - centres, axis=1).max())
    ahead = sum((camera.R[2] for camera in cameras), np.zeros(3))
    level = ahead - above * (ahead @ above)
    if float(np.linalg.norm(level)) < 1e-6 * max(float(np.linalg.norm(ahead)), 1e-12):
        level = cameras[0].R[1] - above * (cameras[0].R[1] @ above)
    level = level / np.linalg.norm(level)
    across = level * np.cos(turn) + np.cross(above, level) * np.sin(turn)
    forward = across * np.cos(tilt) - above * np.sin(tilt)
    focal = min(size) / 2 / np.tan(_HALF_VIEW)
    K = np.array([[focal, 0, (size[0] - 1) / 2], [0, focal, (size[1] - 1) / 2], [0, 0, 1.0]])
    away = (radius + drift) / np.sin(_HALF_VIEW)
    return [look_at(centre - forward * away, centre, above, K) for centre in followed]


def _followed(centres: NDArray[np.float64], smoothing: float) -> NDArray[np.float64]:
    """Places (n, 3) smoothed over time; the steady part of the path is kept as it is, to its very ends."""
    from scipy.ndimage import gaussian_filter1d

    if len(centres) < 3:
        return centres
    times = np.linspace(-1, 1, len(centres))
    steady = np.polynomial.polynomial.polyfit(times, centres, 1)
    line = steady[0] + times[:, None] * steady[1]
    smooth: NDArray[np.float64] = line + gaussian_filter1d(centres - line, smoothing, axis=0, mode="nearest")
    return smooth


def side_view(
    vertices: Sequence[ArrayLike] | NDArray[np.floating],
    faces: ArrayLike,
    cameras: Sequence[Camera],
    size: tuple[int, int],
    *,
    ground: Plane | None = None,
    footing: Sequence[Ground] | None = None,
    points: ArrayLike | None = None,
    colors: ArrayLike | None = None,
    look: Look | None = None,
    samples: int = 3,
    up: ArrayLike = UP,
    turn: float = np.pi / 2,
    shown: Sequence[int] | None = None,
    progress: Progress | None = None,
) -> Iterator[Picture]:
    """Draw a moving character from the side over a grid on the ground, one picture after the other.

    Parameters
    ----------
    vertices, faces, cameras, colors, look, samples, up : see render_sequence.
    size : (width, height) of the pictures.
    ground : the plane of the grid; where it is not given, level with the lowest vertex of all frames.
    footing : what receives the shadow in each frame, where that is not the plane of the grid (stairs).
    points : (p, 3) background points to show, world.
    turn : how far the view is turned about ``up``, radians.
    shown : the frames to draw, all where not given; the view follows the whole motion all the same.
    """
    if not len(vertices) or len(vertices) != len(cameras):
        raise InputError(f"There are {len(vertices)} poses and {len(cameras)} cameras: give one camera for each pose.")
    report = progress or silent
    above = np.asarray(up, np.float64) / np.linalg.norm(up)
    views = side_cameras(vertices, cameras, size, up=above, turn=turn)
    if ground is None:
        ground = Plane(above * min(float((np.asarray(pose) @ above).min()) for pose in vertices), above)
    cloud = None if points is None else np.asarray(points, np.float64).reshape(-1, 3)
    with Renderer(faces, size, colors=colors, look=look, samples=samples, up=above) as renderer:
        report(0.0)
        drawn = range(len(views)) if shown is None else shown
        for done, t in enumerate(drawn, start=1):
            view = views[t]
            pose = np.ascontiguousarray(vertices[t], np.float64)
            reach = float(np.linalg.norm(np.ptp(pose, axis=0)))
            back = grid(studio(size), view, ground, step=_nice(reach / 4), reach=3.0 * reach, centre=pose.mean(axis=0))
            if cloud is not None:
                back = _dots(back, view, cloud)
            yield over_frame(renderer, pose, view, back, ground if footing is None else footing[t])
            report(done / len(drawn))


def grid(
    picture: Picture, camera: Camera, plane: Plane, *, step: float, reach: float, centre: NDArray[np.float64]
) -> Picture:
    """Draw a square grid of lines on a plane, ``step`` world units apart, fading out ``reach`` from ``centre``."""
    first = np.cross(plane.normal, [0.0, 1.0, 0.0] if abs(plane.normal[0]) > 0.6 else [1.0, 0.0, 0.0])
    first = first / np.linalg.norm(first)
    axes = np.stack([first, np.cross(plane.normal, first)])
    offset = float((plane.point - camera.centre) @ plane.normal)
    below = centre - plane.normal * ((centre - plane.point) @ plane.normal)
    # Everything a pixel's ray needs is linear in the pixel: across = rays @ axis and steepness = rays @ normal.
    toward = camera.R.T @ np.linalg.inv(camera.K)
    parts = np.stack([axes[0] @ toward, axes[1] @ toward, plane.normal @ toward])
    starts = np.array([axes[0] @ camera.centre, axes[1] @ camera.centre])
    drawn: Picture = picture.copy()
    _lines(parts, starts, axes @ below, offset, step, reach, _FLOOR, drawn)
    return drawn


@njit(cache=True, nogil=True)
def _lines(
    parts: Any, starts: Any, middle: Any, offset: float, step: float, reach: float, colour: Any, picture: Any
) -> None:
    """Lines of a colour over a picture (h, w, 3), written to it."""
    height, width = picture.shape[:2]
    for y in range(height):
        for x in range(width):
            steep = parts[2, 0] * x + parts[2, 1] * y + parts[2, 2]
            if steep == 0.0 or offset / steep <= 0.0:
                continue
            z = offset / steep
            along = (
                (starts[0] + z * (parts[0, 0] * x + parts[0, 1] * y + parts[0, 2])) / step,
                (starts[1] + z * (parts[1, 0] * x + parts[1, 1] * y + parts[1, 2])) / step,
            )
            away = (along[0] * step - middle[0]) ** 2 + (along[1] * step - middle[1]) ** 2
            if away >= reach * reach:
                continue
            best = 0.0
            for k in range(2):
                ray = parts[k, 0] * x + parts[k, 1] * y + parts[k, 2]
                # The width of a pixel on the ground, so that far lines thin out instead of flickering.
                dx = z * (parts[k, 0] - ray * parts[2, 0] / steep) / step
                dy = z * (parts[k, 1] - ray * parts[2, 1] / steep) / step
                pixel = np.sqrt(dx * dx + dy * dy) + 1e-12
                line = min(max(1.1 - abs(along[k] - np.rint(along[k])) / pixel, 0.0), 1.0)
                best = max(best, line * min(max(0.6 / pixel - 1.0, 0.0), 1.0))
            strength = np.float32(0.8) * np.float32(best * max(1.0 - np.sqrt(away) / reach, 0.0))
            if strength > 0:
                for c in range(3):
                    under = np.float32(picture[y, x, c])
                    picture[y, x, c] = np.uint8(np.rint(under + strength * (colour[c] - under)))


def _nice(length: float) -> float:
    """The largest of 1, 2, 5 times a power of ten that is not above a length."""
    power = 10.0 ** np.floor(np.log10(max(length, 1e-12)))
    fitting = [factor for factor in (1.0, 2.0, 5.0) if factor * power <= length * 1.0000001]
    return float(power) * fitting[-1]


def _dots(picture: Picture, camera: Camera, points: NDArray[np.float64]) -> Picture:
    pixels = camera.project(points)
    shown = np.isfinite(pixels).all(axis=1)
    places = np.rint(pixels[shown]).astype(int)
    height, width = picture.shape[:2]
    inside = (places[:, 0] >= 0) & (places[:, 1] >= 0) & (places[:, 0] < width - 1) & (places[:, 1] < height - 1)
    out = picture.copy()
    for dy in (0, 1):
        for dx in (0, 1):
            out[places[inside, 1] + dy, places[inside, 0] + dx] = (116, 124, 138)
    return out
