"""A filmed world of known depth: ground, walls, stairs, boxes and a post, in part weakly textured, behind a blob.

Of the kind on which the recipe was developed (40 frames, 1.3 m sideways at 3.4 to 9.4 m, focal 0.9 of the width, hand
jitter, drifting gain, noise of 1.5 levels), from other seeds.
"""

from __future__ import annotations

import attrs
import numpy as np
from numpy.typing import NDArray

from imitation.cameras import CameraPath
from imitation.geometry.projection import Camera
from resources.world.camera import lateral_camera
from tests.imitation.cameras.scenes import Film, Rectangle, film

Floats = NDArray[np.float64]


@attrs.frozen(eq=False)
class World:
    """A film of textured rectangles with its truth."""

    film: Film
    parts: list[Rectangle]
    weak: list[Rectangle]
    size: tuple[int, int]

    @property
    def frames(self) -> NDArray[np.uint8]:
        return self.film.frames

    @property
    def cameras(self) -> CameraPath:
        return self.film.cameras

    @property
    def masks(self) -> NDArray[np.bool_]:
        assert self.film.masks is not None
        return self.film.masks

    def depth(self, frame: int, finer: int = 1) -> Floats:
        """Exact camera z (h, w) of the background at pixel centres, or of ``finer`` samples a pixel and direction."""
        return ray_cast(self.parts, self.cameras[frame], self.size, finer)[0]

    def weakly_textured(self, frame: int) -> NDArray[np.bool_]:
        """Which pixels (h, w) show a weakly textured surface."""
        index = ray_cast(self.parts, self.cameras[frame], self.size)[1]
        return np.isin(index, [i for i, part in enumerate(self.parts) if any(part is w for w in self.weak)])


def ray_cast(
    parts: list[Rectangle], camera: Camera, size: tuple[int, int], finer: int = 1
) -> tuple[Floats, NDArray[np.int64]]:
    """Camera z (h, w) of the nearest rectangle, inf where none, and which one."""
    columns, rows = np.meshgrid(
        (np.arange(size[0] * finer) + 0.5) / finer - 0.5, (np.arange(size[1] * finer) + 0.5) / finer - 0.5
    )
    rays = camera.rays(np.stack([columns, rows], axis=-1))
    depth = np.full(rows.shape, np.inf)
    index = np.full(rows.shape, -1)
    for i, part in enumerate(parts):
        normal = np.cross(part.right, part.down)
        with np.errstate(divide="ignore", invalid="ignore"):
            z = ((part.corner - camera.centre) @ normal) / (rays @ normal)
        local = camera.centre + z[..., None] * rays - part.corner
        a, b = local @ part.right / (part.right @ part.right), local @ part.down / (part.down @ part.down)
        nearer = (z > 0) & (a >= 0) & (a <= 1) & (b >= 0) & (b <= 1) & (z < depth)
        depth[nearer], index[nearer] = z[nearer], i
    return depth, index


def distance_to(parts: list[Rectangle], points: Floats) -> Floats:
    """Distances (n,) of points (n, 3) from the nearest rectangle."""
    nearest = np.full(len(points), np.inf)
    for part in parts:
        local = points - part.corner
        a = np.clip(local @ part.right / (part.right @ part.right), 0, 1)
        b = np.clip(local @ part.down / (part.down @ part.down), 0, 1)
        away = np.linalg.norm(local - a[:, None] * part.right - b[:, None] * part.down, axis=1)
        nearest = np.minimum(nearest, away)
    return nearest


def _grain(random: np.random.Generator, width: int, height: int, contrast: float) -> NDArray[np.uint8]:
    """A picture (h, w, 3) of noise in octaves from 2.5 to 60 texels, the colour less strong than the light."""
    import cv2

    picture = np.zeros((height, width, 3))
    for step in (2.5, 5, 12, 28, 60):
        grid = (int(height / step) + 3, int(width / step) + 3)
        noise = random.normal(size=(*grid, 1)) + 0.4 * random.normal(size=(*grid, 3))
        picture += 15 * cv2.resize(noise.astype(np.float32), (width, height), interpolation=cv2.INTER_CUBIC)
    base = 100 + 50 * random.random(3)
    return np.clip(np.rint(base + contrast * picture), 0, 255).astype(np.uint8)


def _sheet(
    random: np.random.Generator, corner: object, right: object, down: object, density: float, contrast: float = 1.0
) -> Rectangle:
    corner, right, down = (np.asarray(v, np.float64) for v in (corner, right, down))
    width, height = (max(16, round(float(np.linalg.norm(v)) * density)) for v in (right, down))
    return Rectangle(corner, right, down, _grain(random, width, height, contrast))


def _box(
    random: np.random.Generator, low: object, high: object, density: float, contrast: float = 1.0
) -> list[Rectangle]:
    """The faces of a box that a camera in front of it and above may see, far to near."""
    (x0, y0, z0), (x1, y1, z1) = np.asarray(low, float), np.asarray(high, float)
    faces = [
        ((x0, y1, z1), (x1 - x0, 0, 0), (0, y0 - y1, 0)),
        ((x0, y1, z1), (0, y0 - y1, 0), (0, 0, z0 - z1)),
        ((x1, y0, z1), (0, y1 - y0, 0), (0, 0, z0 - z1)),
        ((x0, y0, z1), (x1 - x0, 0, 0), (0, 0, z0 - z1)),
    ]
    return [_sheet(random, *face, density, contrast) for face in faces]


@attrs.frozen
class Textures:
    """How strongly the room is textured.

    Attributes
    ----------
    strong, weak : contrast of most surfaces and of the weakly textured ones. wide : metres of the back wall of these.
    """

    strong: float = 1.0
    weak: float = 0.12
    wide: float = 8.8


PLAIN = Textures()
HARD = Textures(1.33, 0.035, 1.6)
"""As hard as the scene on which the recipe was developed, by what needs no prior: the sweep of one pass finds 93 % of
the pixels within 1 % there, inpainting alone 15 to 17 dB."""


def parts_of(seed: int, textures: Textures = PLAIN) -> tuple[list[Rectangle], list[Rectangle]]:
    """All rectangles from far to near, and the weakly textured ones."""
    random = np.random.default_rng(seed)
    a, b, c, d = random.uniform(-0.08, 0.08, 4)
    strong, weak, wide = textures.strong, textures.weak, textures.wide
    weak_wall = _sheet(random, (1.2, 6.0, 6), (wide, 0, 0), (0, 0, -6), 90, weak)
    parts = [_sheet(random, (-8, 6.0, 6), (9.2, 0, 0), (0, 0, -6), 90, strong), weak_wall]
    if wide < PLAIN.wide:
        parts.append(_sheet(random, (1.2 + wide, 6.0, 6), (8.8 - wide, 0, 0), (0, 0, -6), 90, strong))
    parts += [
        _sheet(random, (-8, 6.0, 0), (16, 0, 0), (0, -9.0, 0), 70, strong),
        _sheet(random, (-4.4, 4.9, 4), (1.4, 1.0, 0), (0, 0, -4), 90, strong),
    ]
    for step in range(5):  # the farthest, highest first: tread, then riser
        y, z, deep = 4.2 - 0.34 * step, 0.85 - 0.17 * step, 1.8 if step == 0 else 0.34
        parts.append(_sheet(random, (1.9 + d, y + deep, z), (2.3, 0, 0), (0, -deep, 0), 90, strong))
        parts.append(_sheet(random, (1.9 + d, y, z), (2.3, 0, 0), (0, 0, -0.17), 90, strong))
    parts += _box(random, (-1.6 + a, 1.6, 0), (-0.7 + a, 2.4, 0.95), 110, strong)
    weak_box = _box(random, (0.75 + b, 1.2, 0), (1.65 + b, 2.0, 0.8), 110, weak)
    parts += weak_box
    parts += _box(random, (0.22 + c, 0.5, 0), (0.29 + c, 0.57, 2.6), 160, strong)
    return parts, [weak_wall, *weak_box]


def filmed_room(
    seed: int = 0,
    size: tuple[int, int] = (480, 270),
    frames: int = 40,
    *,
    blob: bool = True,
    textures: Textures = PLAIN,
) -> World:
    """Film the room from the side; a textured blob passes in front of it."""
    parts, weakly = parts_of(seed, textures)
    cameras = lateral_camera(frames, seed=seed, size=size)
    return World(film(parts, cameras, size, blob=blob, seed=seed, one_sided=True), parts, weakly, size)
