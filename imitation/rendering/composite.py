"""Characters over the frames of a film: plate, shadow, occlusion, tracked points."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from imitation.errors import InputError
from imitation.geometry.projection import Camera
from imitation.progress import Progress, silent
from imitation.rendering.ground import Footing, Ground, Lights, Plane, ground_shadow
from imitation.rendering.light import Look
from imitation.rendering.matte import SINK, Layer, flattened
from imitation.rendering.mesh import UP, Renderer, Rendering
from imitation.rendering.motion_blur import blurred
from imitation.rendering.tone import add_grain

Picture = NDArray[np.uint8]


def composite(
    frame: Picture,
    layers: Sequence[Layer],
    *,
    background: NDArray[np.floating] | None = None,
    tolerance: float = 0.0,
    soft: bool = False,
) -> Picture:
    """Lay characters over a frame; the nearer covers the farther.

    Parameters
    ----------
    frame : uint8 RGB (h, w, 3).
    layers : in any order.
    background : (h, w) camera z of the background, NaN where unknown; what lies behind it is hidden.
    tolerance : how far behind the background still counts as before it, world units.
    soft : anti-alias the edges of what hides, see ``visibility``; estimated depth needs it.
    """
    for layer in layers:
        if layer.rendering.depth.shape != frame.shape[:2]:
            raise InputError(
                f"The layer is {layer.rendering.depth.shape[::-1]} pixels, but the frame is {frame.shape[1::-1]}."
            )
    return flattened(layers, frame.shape[:2], background=background, tolerance=tolerance, soft=soft).over(frame)


def render_sequence(
    vertices: Sequence[ArrayLike] | NDArray[np.floating],
    faces: ArrayLike,
    cameras: Sequence[Camera],
    frames: Sequence[Picture] | Picture | tuple[int, int],
    *,
    colors: ArrayLike | None = None,
    ground: Ground | Sequence[Ground] | None = None,
    background: Sequence[NDArray[np.floating]] | None = None,
    tracks: Mapping[str, NDArray[np.float64]] | None = None,
    dim: float = 0.0,
    look: Look | None = None,
    samples: int = 3,
    up: ArrayLike = UP,
    shutter: float = 0.0,
    grain: float = 0.0,
    progress: Progress | None = None,
) -> Iterator[Picture]:
    """Draw a moving character over the frames of a film, one picture after the other.

    Parameters
    ----------
    vertices : (n, v, 3) world positions in each frame.
    faces : (m, 3) vertex indices.
    cameras : n cameras (a CameraPath).
    frames : n uint8 RGB pictures (h, w, 3), or one for all (a plate), or (width, height) for a plain background.
    colors : (v, 3) uint8 sRGB.
    ground : receives the shadow: one for all frames, or one a frame; None for no shadow.
    background : n depth maps (h, w) that hide what is behind them.
    tracks : name to (n, 2) tracked points to draw, pixels.
    dim : how far the background fades towards grey, 0 to 1.
    shutter : share of the frame time that the shutter is open: blurs what moves in the picture.
    grain : noise over the character, grey levels; see ``grain_of``.
    """
    report = progress or silent
    count = len(vertices)
    if not len(cameras) == count or (not isinstance(frames, np.ndarray | tuple) and len(frames) < count):
        raise InputError(f"There are {count} poses, but {len(cameras)} cameras; give a camera and a frame for each.")
    size = (
        frames if isinstance(frames, tuple) else (frames if isinstance(frames, np.ndarray) else frames[0]).shape[1::-1]
    )
    with Renderer(faces, (size[0], size[1]), colors=colors, look=look, samples=samples, up=up) as renderer:
        report(0.0)
        for t in range(count):
            pose, camera = np.ascontiguousarray(vertices[t], np.float64), cameras[t]
            back = (
                studio(frames) if isinstance(frames, tuple) else frames if isinstance(frames, np.ndarray) else frames[t]
            )
            if dim:
                back = np.rint(back + dim * (np.float32(96) - back)).astype(np.uint8)
            floor = ground if ground is None or isinstance(ground, Plane | Footing | np.ndarray) else ground[t]
            yield over_frame(
                renderer, pose, camera, back, floor, None if background is None else background[t],
                None if tracks is None else [track[t] for track in tracks.values()],
                drawn=lambda lights, t=t, camera=camera: blurred(  # type: ignore[misc]
                    renderer, vertices, t, camera, lights, shutter=shutter, cameras=cameras  # type: ignore[arg-type]
                ),
                grain=grain, seed=t,
            )  # fmt: skip
            report((t + 1) / count)


def over_frame(
    renderer: Renderer,
    vertices: NDArray[np.float64],
    camera: Camera,
    frame: Picture,
    ground: Ground | None = None,
    background: NDArray[np.floating] | None = None,
    points: Sequence[NDArray[np.float64]] | None = None,
    *,
    drawn: Callable[[Lights], Rendering] | None = None,
    grain: float = 0.0,
    seed: int = 0,
) -> Picture:
    """Draw one pose over one frame; ``drawn`` draws the character otherwise than sharply (motion blur)."""
    lights = renderer.lights(vertices, camera)
    rendering = renderer.draw(vertices, camera, lights) if drawn is None else drawn(lights)
    shadow = None
    if ground is not None:
        shadow = ground_shadow(vertices, lights, camera, renderer.size, ground, renderer.look, renderer.up)
    if rendering.depth.shape != frame.shape[:2]:
        raise InputError(f"The layer is {renderer.size} pixels, but the frame is {frame.shape[1::-1]}.")
    matte = flattened(
        [Layer(rendering, shadow)], frame.shape[:2], background=background, tolerance=SINK * lights[0].radius, soft=True
    )
    out = matte.over(frame)
    if grain > 0:
        out = add_grain(out, matte.cover, grain, seed)
    return out if points is None else draw_points(out, points)


def draw_points(picture: Picture, points: Sequence[NDArray[np.float64]], radius: float | None = None) -> Picture:
    """Draw tracked points (x, y), pixels, as ringed discs; NaN ones are left out."""
    import cv2

    out = np.ascontiguousarray(picture).copy()
    size = radius or max(2.5, picture.shape[0] / 160)
    for number, (x, y) in enumerate(points):
        if not (np.isfinite(x) and np.isfinite(y)):
            continue
        hue = np.array([[[int(180 * (number * 0.618 % 1)), 190, 255]]], np.uint8)
        color = cv2.cvtColor(hue, cv2.COLOR_HSV2RGB)[0, 0].tolist()
        place = (round(float(x) * 16), round(float(y) * 16))
        cv2.circle(out, place, round(size * 16 + 16), (20, 20, 20), -1, cv2.LINE_AA, 4)
        cv2.circle(out, place, round(size * 16), color, -1, cv2.LINE_AA, 4)
    return out


@lru_cache(maxsize=4)
def studio(size: tuple[int, int]) -> Picture:
    """A plain background (h, w, 3) that is lighter in the middle; kept, so not to be written to."""
    x, y = np.meshgrid(np.linspace(-1, 1, size[0]), np.linspace(-1, 1, size[1]))
    light = 1 - 0.32 * np.clip(x * x * 0.55 + (y + 0.15) ** 2 * 0.7, 0, 1.6)
    shade: Picture = np.clip(light[..., None] * np.array([206, 210, 216]), 0, 255).astype(np.uint8)
    shade.setflags(write=False)
    return shade
