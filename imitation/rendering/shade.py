# mypy: disable-error-code="untyped-decorator"
"""The colour of each pixel: lit samples, averaged in linear light."""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit


@njit(cache=True, nogil=True)
def shade(
    z: Any, face: Any, weights: Any, samples: int, faces: Any, vertices: Any, normals: Any, albedo: Any, lit: Any,
    open_key: Any, eye: Any, key: Any, key_light: Any, gloss: float, rgba: Any, depth: Any,
) -> None:  # fmt: skip
    """Fill ``rgba`` (h, w, 4) and ``depth`` (h, w) from samples (samples h, samples w).

    Parameters
    ----------
    z, face, weights : what each sample sees, see raster.Seen.
    vertices, normals, albedo, lit : (v, 3) place, normal, linear colour, and light from all but the key light.
    open_key : (v,) share of the key light that arrives.
    eye, key : (3,) camera centre, and direction to the key light.
    """
    height, width = depth.shape
    for row in range(height):
        for column in range(width):
            red, green, blue = 0.0, 0.0, 0.0
            hits = 0
            for dy in range(samples):
                for dx in range(samples):
                    y, x = row * samples + dy, column * samples + dx
                    f = face[y, x]
                    if f < 0:
                        continue
                    hits += 1
                    depth[row, column] = min(depth[row, column], z[y, x])
                    i, j, k = faces[f, 0], faces[f, 1], faces[f, 2]
                    a, b = weights[y, x, 0], weights[y, x, 1]
                    c = 1.0 - a - b
                    nx = a * normals[i, 0] + b * normals[j, 0] + c * normals[k, 0]
                    ny = a * normals[i, 1] + b * normals[j, 1] + c * normals[k, 1]
                    nz = a * normals[i, 2] + b * normals[j, 2] + c * normals[k, 2]
                    vx = eye[0] - (a * vertices[i, 0] + b * vertices[j, 0] + c * vertices[k, 0])
                    vy = eye[1] - (a * vertices[i, 1] + b * vertices[j, 1] + c * vertices[k, 1])
                    vz = eye[2] - (a * vertices[i, 2] + b * vertices[j, 2] + c * vertices[k, 2])
                    size = 1.0 / (np.sqrt(vx * vx + vy * vy + vz * vz) + 1e-30)
                    vx, vy, vz = vx * size, vy * size, vz * size
                    size = 1.0 / (np.sqrt(nx * nx + ny * ny + nz * nz) + 1e-30)
                    if _behind(vertices, i, j, k, vx, vy, vz):
                        # A surface seen from behind is lit from the side it is seen from.
                        size = -size
                    nx, ny, nz = nx * size, ny * size, nz * size
                    facing = max(nx * vx + ny * vy + nz * vz, 0.0)
                    # Wrapped a little, so that the edge of the shade is soft.
                    toward = (nx * key[0] + ny * key[1] + nz * key[2] + 0.12) / 1.12
                    toward = max(0.0, toward) * (a * open_key[i] + b * open_key[j] + c * open_key[k])
                    hx, hy, hz = key[0] + vx, key[1] + vy, key[2] + vz
                    half = (nx * hx + ny * hy + nz * hz) / (np.sqrt(hx * hx + hy * hy + hz * hz) + 1e-30)
                    shine = max(0.0, half) ** 28 * gloss * toward
                    rim = (1.0 - facing) ** 4 * 0.10
                    around = a * lit[i, 0] + b * lit[j, 0] + c * lit[k, 0]
                    body = a * albedo[i, 0] + b * albedo[j, 0] + c * albedo[k, 0]
                    red += body * (around + toward * key_light[0]) + shine * key_light[0] + around * rim
                    around = a * lit[i, 1] + b * lit[j, 1] + c * lit[k, 1]
                    body = a * albedo[i, 1] + b * albedo[j, 1] + c * albedo[k, 1]
                    green += body * (around + toward * key_light[1]) + shine * key_light[1] + around * rim
                    around = a * lit[i, 2] + b * lit[j, 2] + c * lit[k, 2]
                    body = a * albedo[i, 2] + b * albedo[j, 2] + c * albedo[k, 2]
                    blue += body * (around + toward * key_light[2]) + shine * key_light[2] + around * rim
            if hits == 0:
                continue
            rgba[row, column, 0] = _encoded(red / hits)
            rgba[row, column, 1] = _encoded(green / hits)
            rgba[row, column, 2] = _encoded(blue / hits)
            rgba[row, column, 3] = np.uint8(255.0 * hits / samples**2 + 0.5)


@njit(cache=True, nogil=True)
def _behind(vertices: Any, i: int, j: int, k: int, vx: float, vy: float, vz: float) -> Any:
    """Whether a triangle turns its back on the viewer."""
    px, py, pz = (
        vertices[j, 0] - vertices[i, 0],
        vertices[j, 1] - vertices[i, 1],
        vertices[j, 2] - vertices[i, 2],
    )
    qx, qy, qz = (
        vertices[k, 0] - vertices[i, 0],
        vertices[k, 1] - vertices[i, 1],
        vertices[k, 2] - vertices[i, 2],
    )
    return (py * qz - pz * qy) * vx + (pz * qx - px * qz) * vy + (px * qy - py * qx) * vz < 0.0


@njit(cache=True, nogil=True)
def _encoded(value: float) -> Any:
    """SRGB byte of linear light; highlights roll off instead of clipping."""
    if value > 0.7:
        value = 0.7 + 0.3 * (1.0 - np.exp(-(value - 0.7) / 0.3))
    encoded = 12.92 * value if value <= 0.0031308 else 1.055 * value ** (1 / 2.4) - 0.055
    return np.uint8(min(max(encoded, 0.0), 1.0) * 255 + 0.5)
