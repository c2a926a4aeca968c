"""What one frame asks of the mesh, as rows of a small dense system (paper A, eq. 7-9)."""

from __future__ import annotations

from collections.abc import Mapping
from math import isfinite
from typing import Any

import attrs
import numpy as np
from numpy.typing import ArrayLike, NDArray

from imitation.errors import InputError
from imitation.geometry import Camera, PreparedMesh
from imitation.geometry.projection import Array

RAY_SOFTNESS = 0.999
DEPTH_SOFTNESS = 0.01
Direction = tuple[float, float, float]
AXES: tuple[Direction, ...] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
NOWHERE = np.full(3, np.nan)


def _mapping(value: Mapping[int, Any] | None) -> dict[int, Any]:
    return {} if value is None else {int(vertex): value[vertex] for vertex in sorted(value)}


@attrs.frozen(eq=False)
class FrameConstraints:
    """What one frame asks of the mesh.

    Attributes
    ----------
    points : vertex -> world position (3,) (eq. 7).
    rays : vertex -> pixel (u, v) (eq. 8); the vertex keeps to the ray through the pixel. A vertex that has a point
        as well keeps to the point.
    camera : needed when rays are given.
    depths : vertex with a ray -> camera z, in world units, that it is weakly pulled to.
    softness : vertex -> s in (0, 1], 1 = hard. Points are hard and rays .999 if not named.
    depth_softness : s in (0, 1) of the pull of ``depths``.
    """

    points: Mapping[int, ArrayLike] = attrs.field(factory=dict, converter=_mapping)
    rays: Mapping[int, ArrayLike] = attrs.field(factory=dict, converter=_mapping)
    camera: Camera | None = None
    depths: Mapping[int, float] = attrs.field(factory=dict, converter=_mapping)
    softness: Mapping[int, float] = attrs.field(factory=dict, converter=_mapping)
    depth_softness: float = DEPTH_SOFTNESS


@attrs.frozen(eq=False)
class Rows:
    """The rows ``C u = p`` of one frame, in the solver's units.

    Attributes
    ----------
    handles : (k,) welded vertices, ascending. owner : (r,) position in ``handles``. direction : (r, 3) unit vectors.
    target : (r,) wanted coordinate along the direction. softness : (r,) in (0, 1], 1 = hard.
    pinned : (k,) whether the handle is a 3D point. place : (k, 3) its target, or NaN for rays.
    vertex : (k,) the caller's vertex of each handle. origin, axis : (3,) centre and viewing axis of the camera, or
        NaN without one.
    """

    handles: NDArray[np.int64]
    owner: NDArray[np.int64]
    direction: Array
    target: Array
    softness: Array
    pinned: NDArray[np.bool_]
    place: Array
    vertex: NDArray[np.int64]
    origin: Array
    axis: Array

    @property
    def signature(self) -> tuple[bytes, bytes, bytes, bytes]:
        """Equal for frames whose small matrix is the same."""
        return self.handles.tobytes(), self.owner.tobytes(), self.direction.tobytes(), self.softness.tobytes()


def build_rows(mesh: PreparedMesh, asked: FrameConstraints, hardness: float = 1.0) -> Rows:
    """Check one frame's constraints and turn them into rows.

    A point gives three rows along the axes. A ray gives two rows across its direction, so that the residual is the
    distance to the ray in world units and not pixels times depth as in eq. 8; a depth gives one row along the
    camera's axis. ``hardness`` is the softness of points that are not named.

    Raises
    ------
    InputError
        A vertex that does not exist, coordinates that are not finite, rays without a camera, a depth without a ray
        or behind the camera, a softness outside (0, 1], or two places for one welded vertex.
    """
    size = len(mesh.vertices)
    for name, group in (("point", asked.points), ("ray", asked.rays), ("depth", asked.depths)):
        for vertex in group:
            if not 0 <= vertex < size:
                raise InputError(f"A {name} is given for vertex {vertex}, but the mesh has {size} vertices.")
    if asked.rays and asked.camera is None:
        raise InputError("Rays are given without a camera; pass the camera of the frame.")
    for vertex, soft in asked.softness.items():
        if not 0 < soft <= 1:
            raise InputError(f"The softness of vertex {vertex} must be above 0 and at most 1, but is {soft}.")
    if not 0 < asked.depth_softness < 1:
        raise InputError(f"The softness of depths must lie between 0 and 1, but is {asked.depth_softness}.")
    found: dict[int, list[tuple[Direction, float, float]]] = {}
    place: dict[int, Array] = {}
    for vertex, wanted in zip(asked.points, _places(mesh, asked.points), strict=True):
        _point(found, place, int(mesh.index[vertex]), vertex, wanted, asked.softness, hardness)
    for vertex, value in asked.rays.items():
        if int(mesh.index[vertex]) not in place and asked.camera is not None:
            pixel = _numbers(value, 2, f"The ray of vertex {vertex}")
            found.setdefault(int(mesh.index[vertex]), []).extend(_ray(mesh, asked, vertex, pixel))
    for vertex in asked.depths:
        if vertex not in asked.rays:
            raise InputError(f"A depth is given for vertex {vertex}, which has no ray in this frame.")
    handles = sorted(found)
    names = {int(mesh.index[vertex]): vertex for vertex in (*asked.rays, *asked.points)}
    camera = asked.camera
    rows = [(position, *row) for position, handle in enumerate(handles) for row in found[handle]]
    return Rows(
        handles=np.array(handles, np.int64),
        owner=np.array([row[0] for row in rows], np.int64),
        direction=np.array([row[1] for row in rows], np.float64).reshape(-1, 3),
        target=np.array([row[2] for row in rows], np.float64),
        softness=np.array([row[3] for row in rows], np.float64),
        pinned=np.array([handle in place for handle in handles], bool),
        place=np.array([place.get(handle, NOWHERE) for handle in handles]).reshape(-1, 3),
        vertex=np.array([names[handle] for handle in handles], np.int64),
        origin=NOWHERE if camera is None else (camera.centre - mesh.centre) / mesh.diagonal,
        axis=NOWHERE if camera is None else camera.R[2],
    )


def _places(mesh: PreparedMesh, points: Mapping[int, Any]) -> Array:
    """Targets (k, 3) of all points in the solver's units."""
    try:
        world = np.array(list(points.values()), np.float64).reshape(len(points), 3)
    except ValueError:
        world = np.full((len(points), 3), np.nan)
    if not np.isfinite(world).all():
        world = np.array([_numbers(value, 3, f"The point of vertex {vertex}") for vertex, value in points.items()])
    places: Array = (world - mesh.centre) / mesh.diagonal
    return places


def _numbers(value: Any, count: int, name: str) -> Array:
    array = np.asarray(value, np.float64).reshape(-1)
    if array.size != count or not all(map(isfinite, array.tolist())):
        raise InputError(f"{name} must be {count} finite numbers, but is {np.asarray(value).tolist()}.")
    return array


def _point(
    found: dict[int, list[tuple[Direction, float, float]]],
    place: dict[int, Array],
    handle: int,
    vertex: int,
    wanted: Array,
    softness: Mapping[int, float],
    hardness: float,
) -> None:
    soft = float(softness.get(vertex, hardness))
    if handle in place:
        if float(np.abs(place[handle] - wanted).max()) > 1e-9 and soft == found[handle][0][2] == hardness:
            raise InputError(
                f"Vertex {vertex} lies in the same place as another handle at rest, but the two have different "
                f"targets; give one of them only."
            )
        if soft <= found[handle][0][2]:
            return
    place[handle] = wanted
    found[handle] = [(axis, value, soft) for axis, value in zip(AXES, wanted.tolist(), strict=True)]


def _cross(a: Array, b: Array) -> Array:
    """Cross product of two single vectors; numpy's own takes twenty times as long on them."""
    (ax, ay, az), (bx, by, bz) = a.tolist(), b.tolist()
    return np.array([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx])


def _triple(axis: Array) -> Direction:
    x, y, z = axis.tolist()
    return x, y, z


def _ray(
    mesh: PreparedMesh, asked: FrameConstraints, vertex: int, pixel: Array
) -> list[tuple[Direction, float, float]]:
    camera = asked.camera
    assert camera is not None
    across = camera.rays(pixel)
    along = across / np.linalg.norm(across)
    first = _cross(along, camera.R[int(np.argmin(np.abs(camera.R @ along)))])
    first /= np.linalg.norm(first)
    second = _cross(along, first)
    origin = (camera.centre - mesh.centre) / mesh.diagonal
    soft = float(asked.softness.get(vertex, RAY_SOFTNESS))
    rows = [(_triple(axis), float(axis @ origin), soft) for axis in (first, second)]
    if vertex in asked.depths:
        depth = float(asked.depths[vertex])
        if not np.isfinite(depth) or depth <= 0:
            raise InputError(f"The depth of vertex {vertex} must be in front of the camera (above 0), but is {depth}.")
        axis = camera.R[2]
        rows.append((_triple(axis), float(axis @ origin) + depth / mesh.diagonal, asked.depth_softness))
    return rows
