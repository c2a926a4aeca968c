"""Pictures of one mesh: lit, anti-aliased, with depth."""

from __future__ import annotations

from typing import Self

import attrs
import numpy as np
from numpy.typing import ArrayLike, NDArray

from imitation.errors import InputError
from imitation.geometry.projection import Camera
from imitation.rendering.light import LightMap, Look, blocked, key_direction, light_map
from imitation.rendering.raster import rasterise
from imitation.rendering.shade import shade

UP = (0.0, 0.0, 1.0)
_BAND = 1 << 22
"""Samples rasterised at once: bounds the memory of large pictures."""


@attrs.frozen(eq=False)
class Rendering:
    """A picture of a mesh before nothing.

    Attributes
    ----------
    rgba : uint8 (h, w, 4) sRGB, colours not multiplied by alpha.
    depth : float32 (h, w) camera z of the nearest surface in each pixel, inf where there is none.
    """

    rgba: NDArray[np.uint8]
    depth: NDArray[np.float32]


class Renderer:
    """Draws one mesh of fixed connectivity again and again.

    Parameters
    ----------
    faces : (m, 3) vertex indices.
    size : (width, height) of the pictures, pixels.
    colors : (v, 3) uint8 sRGB a vertex, or None for the look's base colour.
    look : lights and strengths.
    samples : samples along each side of a pixel; 2 for previews, 3 for films.
    up : direction of the sky, world.
    """

    def __init__(
        self,
        faces: ArrayLike,
        size: tuple[int, int],
        *,
        colors: ArrayLike | None = None,
        look: Look | None = None,
        samples: int = 2,
        up: ArrayLike = UP,
    ) -> None:
        self.faces = np.ascontiguousarray(faces, np.int32)
        if self.faces.ndim != 2 or self.faces.shape[1] != 3 or not len(self.faces):
            raise InputError(f"A mesh to draw needs faces (m, 3), but got {self.faces.shape}.")
        if min(size) < 1 or size[0] * size[1] > 1 << 27 or not 1 <= samples <= 8:
            raise InputError(f"A picture of {size[0]} x {size[1]} pixels with {samples} samples cannot be drawn.")
        self.size, self.samples, self.look = (int(size[0]), int(size[1])), samples, look or Look()
        self.up = np.asarray(up, np.float64) / np.linalg.norm(up)
        self._colors = None if colors is None else linear(np.asarray(colors, np.uint8))
        self.key: NDArray[np.float64] | None = None

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *reason: object) -> None:
        self.close()

    def close(self) -> None:
        """Let go of what is kept between pictures."""
        self._colors, self.key = None, None

    def lights(self, vertices: NDArray[np.float64], camera: Camera) -> tuple[LightMap, LightMap]:
        """What the key light and the sky straight above see of the mesh; the key stays where it first stood."""
        if self.key is None:
            self.key = key_direction(self.look, camera, self.up)
        return light_map(vertices, self.faces, self.key), light_map(vertices, self.faces, self.up, 192)

    def draw(self, vertices: ArrayLike, camera: Camera, lights: tuple[LightMap, LightMap] | None = None) -> Rendering:
        """Draw the mesh with vertices (v, 3), world, as the camera sees it."""
        v = np.ascontiguousarray(vertices, np.float64)
        if v.ndim != 2 or v.shape[1] != 3 or self.faces.max() >= len(v) or not np.isfinite(v).all():
            raise InputError(f"A mesh to draw needs finite vertices (v, 3) for all its faces, but got {v.shape}.")
        key, sky = lights or self.lights(v, camera)
        normals = smooth_normals(v, self.faces)
        radius = key.radius
        covered = blocked(
            v + 0.02 * radius * normals, sky, surface=True, least=0.30 * radius, bias=0.02 * radius, count=48
        )
        hidden = blocked(
            v + 0.015 * radius * normals, key, surface=True, least=0.02 * radius, spread=0.08, bias=0.02 * radius
        )
        lit = self._vertex_light(v, normals, covered, camera)
        albedo = (
            self._colors if self._colors is not None else linear(np.tile(np.array(self.look.base) * 255, (len(v), 1)))
        )
        if len(albedo) != len(v):
            raise InputError(f"There are colours for {len(albedo)} vertices, but the mesh has {len(v)}.")
        key_now = self.key if self.key is not None else key_direction(self.look, camera, self.up)
        rgba = np.zeros((self.size[1], self.size[0], 4), np.uint8)
        depth = np.full((self.size[1], self.size[0]), np.inf, np.float32)
        left, top, right, bottom = self._span(v, camera)
        rows = max(1, _BAND // (max(1, right - left) * self.samples**2))
        for first in range(top, bottom if right > left else top, rows):
            last = min(first + rows, bottom)
            band = Camera(camera.K - np.array([[0, 0, left], [0, 0, first], [0, 0, 0.0]]), camera.R, camera.T)
            seen = rasterise(v, self.faces, band, (right - left, last - first), self.samples)
            shade(
                seen.depth, seen.face, seen.weights, self.samples, self.faces, v, normals, albedo, lit, 1.0 - hidden,
                camera.centre, key_now, np.array(self.look.key_light), self.look.gloss,
                rgba[first:last, left:right], depth[first:last, left:right],
            )  # fmt: skip
        return Rendering(rgba, depth)

    def _span(self, vertices: NDArray[np.float64], camera: Camera) -> tuple[int, int, int, int]:
        """First column and row, last column + 1 and row + 1 that the mesh may reach."""
        width, height = self.size
        if (camera.depth(vertices) <= 0).any():
            return 0, 0, width, height
        pixels = camera.project(vertices)
        left, top = np.maximum(np.floor(pixels.min(axis=0)), 0)
        right, bottom = np.minimum(np.ceil(pixels.max(axis=0)) + 2, self.size)
        return int(left), int(top), int(right), int(bottom)

    def _vertex_light(
        self, vertices: NDArray[np.float64], normals: NDArray[np.float64], covered: NDArray[np.float64], camera: Camera
    ) -> NDArray[np.float64]:
        """Light (v, 3) from sky, ground and fill."""
        height = vertices @ self.up
        low = (height - height.min()) / max(float(np.ptp(height)), 1e-9)
        tilt = (0.5 + 0.5 * normals @ self.up)[:, None]
        open_sky = (1 - 0.75 * covered)[:, None]
        # Near the ground the bounce is weaker: the character shades its own floor.
        near_ground = (0.45 + 0.55 * np.clip(low / 0.5, 0, 1))[:, None]
        assert self.key is not None
        across = self.key - 2 * self.up * (self.key @ self.up)
        fill = np.clip(normals @ -across, 0, None)[:, None]
        sky, bounce, side = (np.array(each) for each in (self.look.sky, self.look.bounce, self.look.fill_light))
        light: NDArray[np.float64] = open_sky * tilt * sky + near_ground * (1 - tilt) * bounce + fill * side
        return light


def render_mesh(
    vertices: ArrayLike,
    faces: ArrayLike,
    camera: Camera,
    size: tuple[int, int],
    *,
    colors: ArrayLike | None = None,
    look: Look | None = None,
    samples: int = 2,
    up: ArrayLike = UP,
) -> Rendering:
    """Draw one mesh once; see Renderer."""
    with Renderer(faces, size, colors=colors, look=look, samples=samples, up=up) as renderer:
        return renderer.draw(vertices, camera)


def smooth_normals(vertices: NDArray[np.float64], faces: NDArray[np.int32]) -> NDArray[np.float64]:
    """Unit normals (v, 3), weighted by area."""
    corners = vertices[faces]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals = np.stack(
        [np.bincount(faces.reshape(-1), np.repeat(across[:, axis], 3), len(vertices)) for axis in range(3)], axis=1
    )
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    unit: NDArray[np.float64] = normals / np.where(lengths > 0, lengths, 1.0)
    return unit


def linear(colors: NDArray[np.number]) -> NDArray[np.float64]:
    """Linear light of sRGB colours 0 to 255."""
    s = colors / 255.0
    values: NDArray[np.float64] = np.where(s <= 0.04045, s / 12.92, ((s + 0.055) / 1.055) ** 2.4)
    return values
