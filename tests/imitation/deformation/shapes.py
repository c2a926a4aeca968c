"""Meshes and handles for the deformation's tests and figures; no random file is needed."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

Mesh = tuple[NDArray[np.float64], NDArray[np.int64]]


def read_character(folder: Path, name: str) -> Mesh:
    """One of the shared characters, vertices and faces as in the file."""
    import trimesh

    mesh = trimesh.load(folder / "characters" / f"{name}.ply", process=False)
    return np.asarray(mesh.vertices, np.float64), np.asarray(mesh.faces, np.int64)


def subdivided(vertices: ArrayLike, faces: ArrayLike) -> Mesh:
    """Loop subdivision, once."""
    import trimesh

    finer, triangles = trimesh.remesh.subdivide_loop(np.asarray(vertices), np.asarray(faces), 1)
    return np.asarray(finer, np.float64), np.asarray(triangles, np.int64)


def ball(times: int = 3) -> Mesh:
    """A bumpy ball without symmetry: 642 vertices at three subdivisions."""
    import trimesh

    mesh = trimesh.creation.icosphere(subdivisions=times)
    v = np.asarray(mesh.vertices, np.float64)
    bumps = 1 + 0.15 * np.sin(3 * v[:, :1] + 1) + 0.1 * np.cos(4 * v[:, 1:2]) + 0.05 * v[:, 2:] ** 3
    return v * bumps * [1.0, 1.3, 0.8], np.asarray(mesh.faces, np.int64)


def cylinder(around: int = 32, along: int = 75, radius: float = 0.5, length: float = 4.0) -> Mesh:
    """A closed cylinder along z, centred, both ends capped, every second ring turned by half a step: 2,402 vertices.

    The exact arc of 90 degrees stretches its longest edge by 1.11.
    """
    z = np.linspace(-length / 2, length / 2, along)
    turn = (np.arange(around)[None] + 0.5 * (np.arange(along)[:, None] % 2)) * 2 * np.pi / around
    rings = np.stack([radius * np.cos(turn).ravel(), radius * np.sin(turn).ravel(), np.repeat(z, around)], axis=1)
    vertices = np.concatenate([rings, [[0, 0, -length / 2], [0, 0, length / 2]]])
    faces = []
    for ring in range(along - 1):
        for k in range(around):
            a, b = ring * around + k, ring * around + (k + 1) % around
            c, d = a + around, b + around
            faces += [[a, b, c], [b, d, c]] if ring % 2 == 0 else [[a, b, d], [a, d, c]]
    low, high, last = around * along, around * along + 1, around * (along - 1)
    for k in range(around):
        faces += [[low, (k + 1) % around, k], [high, last + k, last + (k + 1) % around]]
    return vertices, np.array(faces)


def bent(vertices: ArrayLike, angle: float, length: float = 4.0) -> NDArray[np.float64]:
    """The exact arc: the cylinder's axis becomes a circle's arc of the given angle, sections stay flat."""
    v = np.asarray(vertices, np.float64)
    radius = length / angle
    turn = v[:, 2] / radius
    arm = radius - v[:, 0]
    return np.stack([radius - arm * np.cos(turn), v[:, 1], arm * np.sin(turn)], axis=1)


def farthest(vertices: ArrayLike, count: int, first: int = 0) -> list[int]:
    """Vertices far from each other, the first one left out."""
    v = np.asarray(vertices, np.float64)
    chosen, distance = [first], np.full(len(v), np.inf)
    for _ in range(count):
        distance = np.minimum(distance, np.linalg.norm(v - v[chosen[-1]], axis=1))
        chosen.append(int(distance.argmax()))
    return chosen[1:]


def pulled(vertices: ArrayLike, handles: list[int], seed: int, count: int = 4) -> dict[int, NDArray[np.float64]]:
    """Handles at rest, some of them pulled by .10 to .18 diagonals in random directions."""
    v = np.asarray(vertices, np.float64)
    diagonal = float(np.linalg.norm(np.ptp(v, axis=0)))
    random = np.random.default_rng(seed)
    points = {vertex: v[vertex].copy() for vertex in handles}
    for vertex in random.choice(handles, count, replace=False):
        direction = random.normal(size=3)
        points[int(vertex)] += direction / np.linalg.norm(direction) * random.uniform(0.10, 0.18) * diagonal
    return points


def moving(
    vertices: ArrayLike, handles: list[int], frames: int, seed: int, amount: float = 0.04
) -> NDArray[np.float64]:
    """Handles (frames, k, 3) that swing smoothly about a body that turns and travels."""
    from imitation.geometry import axis_rotation

    v = np.asarray(vertices, np.float64)
    diagonal = float(np.linalg.norm(np.ptp(v, axis=0)))
    random = np.random.default_rng(seed)
    swing = random.normal(size=(len(handles), 3))
    swing *= (amount * diagonal * random.uniform(0.3, 1, len(handles)) / np.linalg.norm(swing, axis=1))[:, None]
    phase, period = random.uniform(0, 2 * np.pi, len(handles)), random.choice([40, 60, 80], len(handles))
    centre = v.mean(axis=0)
    result = np.empty((frames, len(handles), 3))
    for frame in range(frames):
        turn = axis_rotation([0, 1, 0], np.radians(40) * np.sin(2 * np.pi * frame / 240))
        wave = np.sin(2 * np.pi * frame / period + phase) - np.sin(phase)
        shift = np.array([0.5, 0, 0]) * diagonal * frame / 240
        result[frame] = (v[handles] + swing * wave[:, None] - centre) @ turn.T + centre + shift
    return result


def bad_meshes(vertices: ArrayLike, faces: ArrayLike) -> dict[str, Mesh]:
    """The broken variants of a good mesh that loaders meet."""
    v, f = np.asarray(vertices, np.float64), np.asarray(faces, np.int64)
    diagonal = float(np.linalg.norm(np.ptp(v, axis=0)))
    chosen = np.random.default_rng(0).choice(len(f), 60, replace=False)
    needles, points = f.copy(), [v]
    zero, zeros = f.copy(), [v]
    total = len(v)
    extra, wide = [], []
    for number, face in enumerate(chosen):
        a, b, c = f[face]
        middle = (v[a] + v[b]) / 2
        points.append((middle + (v[c] - middle) * 2e-4)[None])
        needles[face] = [a, total + number, c]
        extra += [[total + number, b, c], [a, b, total + number]]
        zeros.append(v[[a]])
        zero[face] = [total + number, b, c]
        wide += [[a, b, total + number], [a, total + number, c]]
    loose = v[f[chosen]].reshape(-1, 3) + 0.01 * diagonal
    return {
        "needles": (np.concatenate(points), np.concatenate([needles, extra])),
        "edges of no length": (np.concatenate(zeros), np.concatenate([zero, wide])),
        "loose triangles": (np.concatenate([v, loose]), np.concatenate([f, len(v) + np.arange(180).reshape(-1, 3)])),
        "unreferenced vertex": (np.concatenate([v, v[:1] + 0.3 * diagonal]), f),
        "triangle soup": (v[f].reshape(-1, 3), np.arange(3 * len(f)).reshape(-1, 3)),
        "holes": (v, np.delete(f, chosen, axis=0)),
        "edges of three faces": (
            np.concatenate([v, v[f[chosen]].mean(axis=1) + 0.02 * diagonal]),
            np.concatenate([f, np.stack([f[chosen, 0], f[chosen, 1], len(v) + np.arange(60)], axis=1)]),
        ),
        "far from the origin": (v + 1e4 * diagonal, f),
    }
