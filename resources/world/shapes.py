"""Geometry of the scene: boxes, turned shapes, clumps of leaves, sheets, and their union."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import attrs
import numpy as np
from numpy.typing import ArrayLike, NDArray

from resources.world.skeleton import Array

Ints = NDArray[np.int32]


@attrs.frozen(eq=False)
class Geometry:
    """Triangles to be drawn.

    Attributes
    ----------
    vertices : (n, 3) world. faces : (m, 3). normals : (n, 3) for shading.
    coords : (n, 3) where the texture is read: the place itself, or the rest pose of what moves.
    shades : (n, 3) numbers that a material may use.
    materials : (m,) which material (see ``materials``).
    """

    vertices: Array
    faces: Ints
    normals: Array
    coords: Array
    shades: Array
    materials: Ints


def sheet(
    corner: ArrayLike, along: ArrayLike, up: ArrayLike, material: int, cells: tuple[int, int] = (1, 1)
) -> Geometry:
    """A flat rectangle from a corner (3,) along two sides (3,); its front is where their cross product points."""
    corner, along, up = (np.asarray(a, np.float64) for a in (corner, along, up))
    u, v = np.meshgrid(np.linspace(0, 1, cells[0] + 1), np.linspace(0, 1, cells[1] + 1), indexing="ij")
    points = corner + u.reshape(-1, 1) * along + v.reshape(-1, 1) * up
    normal = np.cross(along, up)
    return _of(
        points, _grid(cells[0], cells[1]), np.broadcast_to(normal / np.linalg.norm(normal), points.shape), material
    )


def _grid(nu: int, nv: int) -> Ints:
    i, j = np.meshgrid(np.arange(nu), np.arange(nv), indexing="ij")
    a = (i * (nv + 1) + j).ravel()
    b, c, d = a + nv + 1, a + nv + 2, a + 1
    return np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)]).astype(np.int32)


def _of(points: Array, faces: Ints, normals: ArrayLike, material: int) -> Geometry:
    points = np.ascontiguousarray(points, np.float64)
    normals = np.ascontiguousarray(normals, np.float64)
    return Geometry(points, faces, normals, points, np.zeros_like(points), np.full(len(faces), material, np.int32))


def box(low: ArrayLike, high: ArrayLike, material: int, turn: float = 0.0) -> Geometry:
    """A box between two corners (3,), turned about its upright middle by ``turn`` radians."""
    low, high = np.asarray(low, np.float64), np.asarray(high, np.float64)
    size = high - low
    x, y, z = np.diag(size)
    sides = [
        sheet(low, y, x, material),
        sheet(low + z, x, y, material),
        sheet(low, x, z, material),
        sheet(low + y, z, x, material),
        sheet(low, z, y, material),
        sheet(low + x, y, z, material),
    ]
    solid = union(sides)
    return solid if not turn else turned(solid, (low + high) / 2, turn)


def turned(solid: Geometry, about: ArrayLike, angle: float) -> Geometry:
    """A solid turned about the upright line through a point; its texture turns with it."""
    c, s = np.cos(angle), np.sin(angle)
    matrix = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1.0]])
    about = np.asarray(about, np.float64)
    points = (solid.vertices - about) @ matrix.T + about
    return attrs.evolve(solid, vertices=points, normals=solid.normals @ matrix.T)


def lathe(foot: ArrayLike, profile: Sequence[tuple[float, float]], material: int, sides: int = 24) -> Geometry:
    """A turned shape on ``foot`` (3,): a profile of (radius, height) turned about the upright axis."""
    outline = np.asarray(profile, np.float64)
    angle = np.linspace(0, 2 * np.pi, sides + 1)
    ring = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    points = np.zeros((len(outline), sides + 1, 3))
    points[..., :2] = outline[:, None, :1] * ring
    points[..., 2] = outline[:, 1:]
    slope = np.gradient(outline, axis=0)
    normals = np.zeros_like(points)
    normals[..., :2] = slope[:, None, 1:] * ring
    normals[..., 2] = -slope[:, :1]
    normals /= np.maximum(np.linalg.norm(normals, axis=-1, keepdims=True), 1e-9)
    return _of(
        points.reshape(-1, 3) + np.asarray(foot), _grid(len(outline) - 1, sides), normals.reshape(-1, 3), material
    )


def rod(start: ArrayLike, end: ArrayLike, radius: float, material: int, sides: int = 10) -> Geometry:
    """A round rod between two points (3,)."""
    start, end = np.asarray(start, np.float64), np.asarray(end, np.float64)
    axis = (end - start) / np.linalg.norm(end - start)
    helper = np.array([0.0, 0, 1]) if abs(axis[2]) < 0.9 else np.array([1.0, 0, 0])
    e = np.cross(axis, helper)
    e /= np.linalg.norm(e)
    f = np.cross(axis, e)
    angle = np.linspace(0, 2 * np.pi, sides + 1)
    ring = np.cos(angle)[:, None] * e + np.sin(angle)[:, None] * f
    points = np.stack([start + radius * ring, end + radius * ring])
    return _of(points.reshape(-1, 3), _grid(1, sides), np.concatenate([ring, ring]), material)


def rope(start: ArrayLike, end: ArrayLike, sag: float, radius: float, material: int, pieces: int = 10) -> Geometry:
    """A rope that hangs between two points (3,) and sags in its middle."""
    u = np.linspace(0, 1, pieces + 1)[:, None]
    line = (1 - u) * np.asarray(start, np.float64) + u * np.asarray(end, np.float64)
    line[:, 2] -= 4 * sag * (u * (1 - u))[:, 0]
    return union([rod(a, b, radius, material, 8) for a, b in pairwise(line)])


def leaves(
    middle: ArrayLike, radii: ArrayLike, count: int, size: float, material: int, seed: int, *, shell: float = 0.55
) -> Geometry:
    """A bush: ``count`` small leaves, each two triangles, scattered in the outer part of an ellipsoid."""
    rng = np.random.default_rng([seed, 3])
    way = rng.standard_normal((count, 3))
    way /= np.linalg.norm(way, axis=1, keepdims=True)
    lump = (
        1 + 0.16 * np.sin(5 * way[:, 0] + seed) * np.sin(4 * way[:, 1] + 2 * way[:, 2]) + 0.08 * np.sin(11 * way[:, 2])
    )
    depth = (shell + (1 - shell) * rng.uniform(0, 1, count)) * lump
    places = np.asarray(middle, np.float64) + way * depth[:, None] * np.asarray(radii, np.float64)
    e = np.cross(way, rng.standard_normal((count, 3)))
    e /= np.linalg.norm(e, axis=1, keepdims=True)
    f = np.cross(way, e) + 0.6 * way * rng.uniform(-1, 1, (count, 1))
    long = size * rng.uniform(0.7, 1.3, (count, 1))
    corners = np.stack(
        [places - long * e, places - 0.45 * long * f, places + long * e, places + 0.45 * long * f], axis=1
    )
    first = 4 * np.arange(count)[:, None]
    faces = np.concatenate([first + np.array([0, 1, 2]), first + np.array([0, 2, 3])]).astype(np.int32)
    leaf = np.cross(e, f)
    leaf /= np.linalg.norm(leaf, axis=1, keepdims=True)
    leaf *= np.sign(np.sum(leaf * way, axis=1, keepdims=True))
    normal = 0.75 * way + 0.5 * leaf
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    solid = _of(corners.reshape(-1, 3), faces, np.repeat(normal, 4, axis=0), material)
    shades = np.stack([rng.uniform(0, 1, count), np.clip(depth, 0, 1), rng.uniform(0, 1, count)], axis=1)
    return attrs.evolve(solid, shades=np.repeat(shades, 4, axis=0))


def union(parts: Sequence[Geometry]) -> Geometry:
    """All parts as one."""
    offsets = np.cumsum([0] + [len(part.vertices) for part in parts[:-1]])
    return Geometry(
        np.concatenate([p.vertices for p in parts]),
        np.concatenate([p.faces + o for p, o in zip(parts, offsets, strict=True)]).astype(np.int32),
        np.concatenate([p.normals for p in parts]),
        np.concatenate([p.coords for p in parts]),
        np.concatenate([p.shades for p in parts]),
        np.concatenate([p.materials for p in parts]).astype(np.int32),
    )


def vertex_normals(vertices: Array, faces: Ints) -> Array:
    """Normals (n, 3) of a mesh's vertices, weighted by area."""
    a, b, c = (vertices[faces[:, i]] for i in range(3))
    face = np.cross(b - a, c - a)
    total = np.zeros_like(vertices)
    for i in range(3):
        for axis in range(3):
            total[:, axis] += np.bincount(faces[:, i], face[:, axis], len(vertices))
    unit: Array = total / np.maximum(np.linalg.norm(total, axis=1, keepdims=True), 1e-12)
    return unit
