"""Compiled measures of one mesh: areas, the centroid, the foot cue, and points spread over the surface."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tvmedit.compiled import compiled

Array = NDArray[np.float64]
Faces = NDArray[np.int32]


@compiled
def mesh_areas(vertices: Array, faces: Faces) -> tuple[Array, Array, float]:
    """A third of its triangles' areas for each vertex, the running sum of areas, and the mean edge length.

    Faces as ``check_faces`` lets them through: none names a vertex that is not there.

    Returns
    -------
    (v,) float64, squared unit
    (m,) float64, squared unit
        Twice the area of the triangles up to each one.
    float, unit
        Mean length of the first edge of every eighth triangle.
    """
    areas = np.zeros(len(vertices))
    running = np.empty(len(faces))
    edges, counted, total = 0.0, 0, 0.0
    for f in range(len(faces)):
        # Unsigned: a negative number would have to be looked for at the end of the array.
        i, j, k = np.uint32(faces[f, 0]), np.uint32(faces[f, 1]), np.uint32(faces[f, 2])
        px, py, pz = vertices[i, 0], vertices[i, 1], vertices[i, 2]
        ax, ay, az = vertices[j, 0] - px, vertices[j, 1] - py, vertices[j, 2] - pz
        bx, by, bz = vertices[k, 0] - px, vertices[k, 1] - py, vertices[k, 2] - pz
        cx, cy, cz = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
        twice = np.sqrt(cx * cx + cy * cy + cz * cz)
        total += twice
        running[f] = total
        third = twice / 6.0
        areas[i] += third
        areas[j] += third
        areas[k] += third
        if f % 8 == 0:
            edges += np.sqrt(ax * ax + ay * ay + az * az)
            counted += 1
    return areas, running, edges / max(counted, 1)


def vertex_areas(vertices: Array, faces: Faces) -> tuple[Array, float]:
    """A third of its triangles' areas for each vertex (v,), and the mean edge length."""
    areas, _, edge = mesh_areas(vertices, faces)
    return areas, edge


@compiled
def extent(vertices: Array) -> tuple[Array, Array]:
    """Least and largest coordinates (3,) each of vertices (v, 3), at least one."""
    ax, ay, az = vertices[0, 0], vertices[0, 1], vertices[0, 2]
    bx, by, bz = ax, ay, az
    for i in range(1, len(vertices)):
        x, y, z = vertices[i, 0], vertices[i, 1], vertices[i, 2]
        ax, ay, az = min(ax, x), min(ay, y), min(az, z)
        bx, by, bz = max(bx, x), max(by, y), max(bz, z)
    return np.array([ax, ay, az]), np.array([bx, by, bz])


@compiled
def ground_centroid(vertices: Array, weights: Array) -> tuple[float, float, float]:
    """Weighted mean of x and of y, and the sum of the weights; (0, 0, 0) where that is not positive.

    Not by BLAS, whose threads would only wait for each other on so little, and whose sums depend on their number.
    """
    x, y, total = 0.0, 0.0, 0.0
    for i in range(len(vertices)):
        x += weights[i] * vertices[i, 0]
        y += weights[i] * vertices[i, 1]
        total += weights[i]
    if not total > 0.0:
        return 0.0, 0.0, 0.0
    return x / total, y / total, total


@compiled
def foot_cue(vertices: Array, areas: Array, lowest: float, height: float) -> Array:
    """Where the feet point: from the ankles to the soles, summed over the feet on the ground.

    Soles are the vertices less than 0.035 body heights over the lowest, ankles those at 0.06 to 0.14; two feet are
    told apart by two means on the ankles, and a sole belongs to the ankle less than 0.13 away.

    Returns
    -------
    (2,) float64
        Horizontal vector in body heights, about 0.05 long for a shoe on the ground; (0, 0) where nothing is seen.
    """
    # The few vertices that count, once: the feet are a small part of a body.
    n = len(vertices)
    ankles, soles_of = np.empty(n, np.int64), np.empty(n, np.int64)
    ankle_count, sole_count = 0, 0
    low_x, low_y, high_x, high_y, total = 0.0, 0.0, 0.0, 0.0, 0.0
    sole, from_, to = lowest + 0.035 * height, lowest + 0.06 * height, lowest + 0.14 * height
    for i in range(n):
        z = vertices[i, 2]
        if z >= to:
            continue
        if z >= from_:
            low_x += areas[i] * vertices[i, 0]
            low_y += areas[i] * vertices[i, 1]
            total += areas[i]
            ankles[ankle_count] = i
            ankle_count += 1
        elif z < sole:
            soles_of[sole_count] = i
            sole_count += 1
    cue = np.zeros(2)
    if total <= 0.0:
        return cue
    mean_x, mean_y = low_x / total, low_y / total
    # The first guess of the two feet: the ankle point furthest from the ankles' mean, and the one furthest from that.
    for turn in range(2):
        from_x, from_y = (mean_x, mean_y) if turn == 0 else (low_x, low_y)
        span = -1.0
        for i in ankles[:ankle_count]:
            square = (vertices[i, 0] - from_x) ** 2 + (vertices[i, 1] - from_y) ** 2
            if square > span:
                span = square
                if turn == 0:
                    low_x, low_y = vertices[i, 0], vertices[i, 1]
                else:
                    high_x, high_y = vertices[i, 0], vertices[i, 1]
    for _ in range(8):
        ax, ay, aw, bx, by, bw = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
        for i in ankles[:ankle_count]:
            x, y = vertices[i, 0], vertices[i, 1]
            if (x - low_x) ** 2 + (y - low_y) ** 2 < (x - high_x) ** 2 + (y - high_y) ** 2:
                ax, ay, aw = ax + areas[i] * x, ay + areas[i] * y, aw + areas[i]
            else:
                bx, by, bw = bx + areas[i] * x, by + areas[i] * y, bw + areas[i]
        if aw > 0.0:
            low_x, low_y = ax / aw, ay / aw
        if bw > 0.0:
            high_x, high_y = bx / bw, by / bw
    sx, sy, sw = np.zeros(2), np.zeros(2), np.zeros(2)
    near = (0.13 * height) ** 2
    for i in soles_of[:sole_count]:
        x, y = vertices[i, 0], vertices[i, 1]
        first = (x - low_x) ** 2 + (y - low_y) ** 2
        second = (x - high_x) ** 2 + (y - high_y) ** 2
        foot = 0 if first < second else 1
        if min(first, second) < near:
            sx[foot] += areas[i] * x
            sy[foot] += areas[i] * y
            sw[foot] += areas[i]
    soles = sw[0] + sw[1]
    if soles <= 0.0:
        return cue
    if sw[0] > 0.0:
        cue[0] += sw[0] / soles * (sx[0] / sw[0] - low_x) / height
        cue[1] += sw[0] / soles * (sy[0] / sw[0] - low_y) / height
    if sw[1] > 0.0:
        cue[0] += sw[1] / soles * (sx[1] / sw[1] - high_x) / height
        cue[1] += sw[1] / soles * (sy[1] / sw[1] - high_y) / height
    return cue


def surface_samples(vertices: Array, faces: Faces, count: int) -> NDArray[np.float32]:
    """Points (count, 3) float32 spread evenly over the surface, the same for the same mesh."""
    return samples_by_area(vertices, faces, mesh_areas(vertices, faces)[1], count)


@compiled
def samples_by_area(vertices: Array, faces: Faces, running: Array, count: int) -> NDArray[np.float32]:
    """Points spread evenly over the surface; ``running`` (m,) is the running sum of ``mesh_areas``.

    One point in each of ``count`` equal parts of the area, taken in the order of the triangles.

    Returns
    -------
    (count, 3) float32
    """
    total = running[-1]
    points = np.empty((count, 3), np.float32)
    face = 0
    for s in range(count):
        # A golden-ratio sequence places the point inside its part and inside its triangle without a random generator.
        first, second, third = (s * 0.6180339887) % 1.0, (s * 0.7548776662) % 1.0, (s * 0.5698402910) % 1.0
        target = total * (s + first) / count
        # The first triangle up to which there is so much: steps that double, then halves.
        step = 1
        while face + step < len(faces) and running[face + step - 1] < target:
            face += step
            step *= 2
        end = min(face + step, len(faces) - 1)
        while face < end:
            half = (face + end) // 2
            if running[half] < target:
                face = half + 1
            else:
                end = half
        root = np.sqrt(second)
        p, q, r = 1.0 - root, root * (1.0 - third), root * third
        for k in range(3):
            points[s, k] = (
                p * vertices[faces[face, 0], k] + q * vertices[faces[face, 1], k] + r * vertices[faces[face, 2], k]
            )
    return points
