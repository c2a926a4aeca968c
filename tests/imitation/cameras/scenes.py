"""Small filmed worlds with exact cameras: textured rectangles, painted from far to near by homographies."""

from __future__ import annotations

import attrs
import cv2
import numpy as np
from numpy.typing import NDArray

from imitation.cameras import CameraPath
from imitation.geometry.projection import Camera

Floats = NDArray[np.float64]
Pixels = NDArray[np.uint8]


@attrs.frozen(eq=False)
class Rectangle:
    """A textured rectangle: corner, two edge vectors (world), and its picture."""

    corner: Floats
    right: Floats
    down: Floats
    texture: Pixels


@attrs.frozen(eq=False)
class Film:
    """A clip with its truth: frames (n, h, w, 3), the cameras and, where a blob hides the scene, its masks."""

    frames: Pixels
    cameras: CameraPath
    masks: NDArray[np.bool_] | None = None


def texture(random: np.random.Generator, width: int, height: int) -> Pixels:
    """A picture with corners at many scales: octaves of noise under random boxes and discs."""
    picture = np.zeros((height, width, 3), np.float32)
    for step in (64, 24, 9, 4):
        small = random.normal(size=(height // step + 2, width // step + 2, 3)).astype(np.float32)
        picture += cv2.resize(small, (width, height), interpolation=cv2.INTER_CUBIC) * (6 + 0.25 * step)
    picture += 90 + 60 * random.random(3).astype(np.float32)
    for _ in range(width * height // 1400):
        x, y = int(random.integers(width)), int(random.integers(height))
        size = int(random.integers(3, 18))
        colour = tuple(float(c) for c in random.integers(30, 226, 3))
        if random.random() < 0.6:
            cv2.rectangle(picture, (x, y), (x + size, y + int(random.integers(3, 18))), colour, -1)
        else:
            cv2.circle(picture, (x, y), size // 2 + 1, colour, -1)
    return np.clip(cv2.GaussianBlur(picture, (0, 0), 0.8), 0, 255).astype(np.uint8)


def _rectangle(random: np.random.Generator, corner: object, right: object, down: object, density: float) -> Rectangle:
    corner, right, down = (np.asarray(v, np.float64) for v in (corner, right, down))
    width, height = (max(32, int(np.linalg.norm(v) * density)) for v in (right, down))
    return Rectangle(corner, right, down, texture(random, width, height))


def room(seed: int = 0, density: float = 150.0) -> list[Rectangle]:
    """Wall, slanted wall, ground, three stairs and two boxes, sorted from far to near; Z up, metres."""
    random = np.random.default_rng(seed)
    parts = [
        _rectangle(random, (-8, 9, 6), (16, 0, 0), (0, 0, -6), density),
        _rectangle(random, (2.5, 8.5, 4), (4, -2.5, 0), (0, 0, -4), density),
        _rectangle(random, (-8, 9, 0), (16, 0, 0), (0, -8.2, 0), density),
    ]
    for step in range(3):  # the farthest, highest first: tread, then riser
        y, z = 6.0 - 0.7 * step, 0.9 - 0.3 * step
        parts.append(_rectangle(random, (-3.2, y + 0.7, z), (2.6, 0, 0), (0, -0.7, 0), density))
        parts.append(_rectangle(random, (-3.2, y, z), (2.6, 0, 0), (0, 0, -0.3), density))
    for x, y, size in ((0.9, 5.4, 0.9), (-0.2, 4.2, 0.5)):
        parts.append(_rectangle(random, (x, y + size, size), (size, 0, 0), (0, -size, 0), density))
        parts.append(_rectangle(random, (x, y, size), (size, 0, 0), (0, 0, -size), density))
    return parts


def wall(seed: int = 0, density: float = 150.0) -> list[Rectangle]:
    """One slanted flat wall: a planar scene."""
    random = np.random.default_rng(seed)
    return [_rectangle(random, (-9, 4, 7), (18, 5, 0), (0, 0.5, -11), density)]


def look(centre: Floats, target: Floats, roll: float = 0.0) -> tuple[Floats, Floats]:
    """Rotation and translation of a camera at a place, looking at another; Z is up."""
    forward = (target - centre) / np.linalg.norm(target - centre)
    right = np.cross(forward, (0.0, 0.0, 1.0))
    right /= np.linalg.norm(right)
    down = np.cross(forward, right)
    turn = np.array([[np.cos(roll), np.sin(roll), 0], [-np.sin(roll), np.cos(roll), 0], [0, 0, 1]])
    R = turn @ np.stack([right, down, forward])
    return R, -R @ centre


def handheld(
    frames: int,
    size: tuple[int, int] = (480, 270),
    *,
    focal: float = 0.9,
    travel: float = 1.4,
    turn: float = 0.4,
    shake: float = 1.0,
    seed: int = 0,
) -> CameraPath:
    """A person walks sideways with a camera: ``travel`` metres, ``turn`` metres of the target, shaking hands."""
    random = np.random.default_rng(seed + 1000)
    time = np.linspace(0, 1, frames) if frames > 1 else np.zeros(1)
    waves = [random.normal(size=(4, 6)) * np.array([0.35, 0.5, 0.3, 0.2])[:, None], random.random((4, 6)) * 6.3]
    beat = np.array([1.3, 2.9, 6.1, 11.3])[:, None, None] * time[None, :, None] * 6.3 * frames / 80
    motion = (waves[0][:, None, :] * np.sin(beat + waves[1][:, None, :])).sum(0)
    Ks, Rs, Ts = [], [], []
    width, height = size
    K = np.array([[focal * width, 0, (width - 1) / 2], [0, focal * width, (height - 1) / 2], [0, 0, 1]])
    moving = 1.0 if travel else 0.0
    for t in range(frames):
        centre = np.array([-0.7 * travel + 1.4 * travel * time[t] / 1.4, -0.4 + 0.25 * travel * time[t], 1.5])
        centre += motion[t, :3] * 0.012 * shake * moving
        target = np.array([-0.3 + turn * (time[t] - 0.5), 6.0, 1.1]) + motion[t, 3:] * 0.03 * shake * np.array(
            [1, 0, 1]
        )
        R, T = look(centre, target, 0.01 * shake * motion[t, 4])
        Ks.append(K)
        Rs.append(R)
        Ts.append(T)
    return CameraPath(K=Ks, R=Rs, T=Ts)


def paint(parts: list[Rectangle], camera: Camera, size: tuple[int, int], *, one_sided: bool = False) -> Pixels:
    """The picture of the rectangles, two samples a pixel and direction.

    ``one_sided`` leaves out those that turn their back to the camera: the inside of a box's farther face is painted
    after its top, and would stand before it.
    """
    width, height = size
    double = np.array([[2.0, 0, 0.5], [0, 2.0, 0.5], [0, 0, 1.0]])  # pixel centres stay at integers
    canvas = np.full((2 * height, 2 * width, 3), 128, np.uint8)
    for part in parts:
        if one_sided and (part.corner - camera.centre) @ np.cross(part.right, part.down) <= 0:
            continue
        rows, columns = part.texture.shape[:2]
        edges = np.stack([part.right / columns, part.down / rows, part.corner], axis=1)
        edges[:, 2] += 0.5 * (edges[:, 0] + edges[:, 1])
        homography = double @ camera.K @ (camera.R @ edges + np.outer(camera.T, (0, 0, 1)))
        layer = cv2.warpPerspective(part.texture, homography, (2 * width, 2 * height), flags=cv2.INTER_LINEAR)
        inside = cv2.warpPerspective(
            np.full((rows, columns), 255, np.uint8), homography, (2 * width, 2 * height), flags=cv2.INTER_NEAREST
        )
        canvas[inside > 0] = layer[inside > 0]
    return cv2.resize(canvas, (width, height), interpolation=cv2.INTER_AREA)


def film(
    parts: list[Rectangle],
    cameras: CameraPath,
    size: tuple[int, int] = (480, 270),
    *,
    noise: float = 1.5,
    gain: float = 0.004,
    blob: bool = False,
    seed: int = 0,
    one_sided: bool = False,
) -> Film:
    """Frames with sensor noise, a slowly drifting brightness and, where asked, a moving textured blob with masks."""
    random = np.random.default_rng(seed + 2000)
    width, height = size
    level = 1.0
    pictures, masks = [], []
    fur = texture(random, width // 3, height // 2)
    yy, xx = np.mgrid[: fur.shape[0], : fur.shape[1]]
    round_ = ((xx / fur.shape[1] - 0.5) ** 2 + (yy / fur.shape[0] - 0.5) ** 2) < 0.25
    for t in range(len(cameras)):
        picture = paint(parts, cameras[t], size, one_sided=one_sided)
        mask = np.zeros((height, width), bool)
        if blob:
            left = int(width * (0.1 + 0.5 * t / max(1, len(cameras) - 1)))
            top = int(height * (0.4 + 0.06 * np.sin(t * 0.5)))
            window = (slice(top, top + fur.shape[0]), slice(left, left + fur.shape[1]))
            shown = round_[: height - top, : width - left]
            mask[window] |= shown
            picture[window][shown] = fur[: height - top, : width - left][shown]
        level += random.normal() * gain
        noisy = picture * level + random.normal(size=picture.shape) * noise
        pictures.append(np.clip(np.rint(noisy), 0, 255).astype(np.uint8))
        masks.append(mask)
    return Film(np.stack(pictures), cameras, np.stack(masks) if blob else None)
