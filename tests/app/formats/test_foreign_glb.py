"""A skinned GLB put together byte by byte from the glTF 2.0 specification, against places worked out by plain sums.

Neither our writer nor our matrices are used here: interleaved vertices, sparse accessors, normalised integers, joints
as bytes, a matrix node, scales that differ by axis, one that mirrors, STEP, LINEAR and CUBICSPLINE keys.
"""

from __future__ import annotations

import base64
import json
import math
import struct
from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from app.formats import read_mesh, read_sequence
from app.formats.tvm import open_mesh_frames

Vector = tuple[float, ...]
Matrix = list[list[float]]

FPS = 20
POSITIONS = [(0, 0, 0), (1, 0, 0.2), (0.1, 1, 0), (0.9, 1.1, 0.1), (0, 2, 0.3), (1, 2.1, 0), (0.5, 2.9, 0.4)]
REPLACED = {1: (1.25, 0.0, 0.25), 6: (0.5, 3.0, 0.5)}
"""What the sparse part of the positions puts in the place of two of them."""
JOINTS = [(0, 0, 0, 0), (0, 1, 0, 0), (1, 0, 9, 0), (1, 2, 0, 0), (2, 1, 0, 0), (2, 1, 0, 9), (2, 0, 1, 0)]
WEIGHTS = [(65535, 0, 0, 0), (40000, 25535, 0, 0), (32768, 32767, 0, 0), (50000, 15535, 0, 0),
           (60000, 5535, 0, 0), (20000, 45535, 0, 0), (30000, 20000, 15535, 0)]  # fmt: skip
"""Of 65535; a joint without weight may be any number (9 is not there)."""
COLOURS = [(255, 0, 0, 255), (0, 255, 0, 255), (0, 0, 255, 255), (255, 255, 255, 0), (0, 0, 0, 255), (255, 0, 255, 9),
           (0, 255, 255, 255)]  # fmt: skip
FACES = [(0, 1, 2), (2, 1, 3), (2, 3, 4), (4, 3, 5), (4, 5, 6)]
BULGE = {2: (0.25, 0.0, 0.5), 5: (0.0, -0.5, 0.25)}
"""The first morph target: sparse over nothing, so 0 elsewhere."""
LEAN = [(0, 0, 0), (16384, 0, 0), (0, -32767, 0), (0, 0, 8192), (-32767, 0, 0), (0, 0, -32768), (100, 200, 300)]
"""The second one, normalised 16-bit integers: -32768 and -32767 both mean -1."""
FIN = [(0, 0, 0), (0.5, 0, 0), (0, 0.5, 0), (0, 0, 0.5)]
FIN_STRIP = [0, 1, 2, 3]
INVERSE = [
    [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]],
    [[1, 0, 0, 0.125], [0, 1, 0, -1], [0, 0, 1, 0], [0, 0, 0, 1]],
    [[0.5, 0, 0, 0], [0, 1, 0.25, -2], [0, 0, 2, 0], [0, 0, 0, 1]],
]
ROOT: Matrix = [[0, 0, 2, 0.5], [0, 1, 0, 0], [-1, 0, 0, 0.25], [0, 0, 0, 1]]
"""A quarter turn about y of a scale by 1, 1 and 2, moved."""
STEPS = ([0.0, 0.1, 0.25], [(0, 0, 0), (0.5, 0, 0), (0, 0, -1)])
"""Where the first joint is from when on."""
TURNS = ([0.05, 0.2, 0.3], [(0, 0, 0, 32767), (0, 16384, 0, -28378), (23170, 0, 0, 23170)])
"""Turns of the second joint: normalised 16-bit quaternions; the middle one has the other sign."""
SCALES = ([0.0, 0.3], [(1, 1, 1), (1, 2, 0.5)])
CURVE = ([0.0, 0.15, 0.3], [
    ((0, 0, 0, 0), (0, 0, 0, 1), (1, 0, 0, 0)),
    ((0, 0, 3, 0), (0, 0, 0.6, 0.8), (0, -2, 0, 1)),
    ((0, 4, 0, 0), (0, 0.6, 0, 0.8), (0, 0, 0, 0)),
])  # fmt: skip
"""In-tangent, turn and out-tangent of the third joint."""
SWELL = ([0.0, 0.1, 0.3], [
    ((0, 0), (0, 0.25), (4, -3)),
    ((1, 1), (0.75, 0.5), (-2, 0)),
    ((-5, 2), (-0.25, 1), (0, 0)),
])  # fmt: skip
"""The same of the weights of the two morph targets."""


class Blob:
    """Bytes, and the views and accessors that describe them."""

    def __init__(self) -> None:
        self.data = bytearray(b"\xee" * 12)  # nothing begins at 0
        self.views: list[dict[str, Any]] = []
        self.accessors: list[dict[str, Any]] = []

    def view(self, data: bytes, stride: int | None = None) -> int:
        self.data += b"\xee" * (-len(self.data) % 4)
        entry = {"buffer": 0, "byteOffset": len(self.data), "byteLength": len(data)}
        self.views.append(entry if stride is None else {**entry, "byteStride": stride})
        self.data += data
        return len(self.views) - 1

    def accessor(self, component: int, count: int, kind: str, view: int | None = None, **more: Any) -> int:
        entry = {"componentType": component, "count": count, "type": kind, **more}
        self.accessors.append(entry if view is None else {**entry, "bufferView": view})
        return len(self.accessors) - 1

    def floats(self, rows: Sequence[Sequence[float]], kind: str) -> int:
        flat = [value for row in rows for value in row]
        width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4, "MAT4": 16}[kind]
        return self.accessor(5126, len(flat) // width, kind, self.view(struct.pack(f"<{len(flat)}f", *flat)))

    def times(self, times: Sequence[float]) -> int:
        number = self.floats([times], "SCALAR")
        self.accessors[number] |= {"min": [times[0]], "max": [times[-1]]}
        return number


def described() -> tuple[dict[str, Any], bytes]:
    """The file's description and its one buffer."""
    blob = Blob()
    rows = b"".join(
        struct.pack("<3f4B4H4B4x", *place, *joints, *weights, *colour)
        for place, joints, weights, colour in zip(POSITIONS, JOINTS, WEIGHTS, COLOURS, strict=True)
    )
    # Rows of 32 bytes after 8 of another kind, and no filling after the last one.
    woven = blob.view(b"\x01" * 8 + rows[:-4], 32)
    count = len(POSITIONS)
    sparse = {
        "count": len(REPLACED),
        "indices": {"bufferView": blob.view(bytes(REPLACED)), "componentType": 5121},
        "values": {"bufferView": blob.view(b"".join(struct.pack("<3f", *p) for p in REPLACED.values()))},
    }
    position = blob.accessor(5126, count, "VEC3", woven, byteOffset=8, sparse=sparse, min=[0, 0, 0], max=[2, 3, 1])
    attributes = {
        "POSITION": position,
        "JOINTS_0": blob.accessor(5121, count, "VEC4", woven, byteOffset=20),
        "WEIGHTS_0": blob.accessor(5123, count, "VEC4", woven, byteOffset=24, normalized=True),
        "COLOR_0": blob.accessor(5121, count, "VEC4", woven, byteOffset=32, normalized=True),
    }
    corners = [corner for face in FACES for corner in face]
    indices = blob.accessor(5121, len(corners), "SCALAR", blob.view(b"\x63" * 3 + bytes(corners)), byteOffset=3)
    values = blob.view(b"\0" * 4 + b"".join(struct.pack("<3f", *place) for place in BULGE.values()))
    bulge = {
        "count": len(BULGE),
        "indices": {"bufferView": blob.view(struct.pack("<2H", *BULGE)), "componentType": 5123},
        "values": {"bufferView": values, "byteOffset": 4},
    }
    lean = blob.view(b"".join(struct.pack("<3h2x", *row) for row in LEAN), 8)
    targets = [
        {"POSITION": blob.accessor(5126, count, "VEC3", sparse=bulge)},
        {"POSITION": blob.accessor(5122, count, "VEC3", lean, normalized=True)},
    ]
    fin = {
        "attributes": {"POSITION": blob.floats(FIN, "VEC3")},
        "indices": blob.accessor(5123, 4, "SCALAR", blob.view(struct.pack("<4H", *FIN_STRIP))),
        "mode": 5,
    }
    columns = [[matrix[row][column] for column in range(4) for row in range(4)] for matrix in INVERSE]
    turns = struct.pack("<12h", *[value for turn in TURNS[1] for value in turn])
    samplers = [
        {"input": blob.times(STEPS[0]), "output": blob.floats(STEPS[1], "VEC3"), "interpolation": "STEP"},
        {
            "input": blob.times(TURNS[0]),
            "output": blob.accessor(5122, 3, "VEC4", blob.view(turns), normalized=True),
            "interpolation": "LINEAR",
        },
        {"input": blob.times(SCALES[0]), "output": blob.floats(SCALES[1], "VEC3")},
        {
            "input": blob.times(CURVE[0]),
            "output": blob.floats([part for key in CURVE[1] for part in key], "VEC4"),
            "interpolation": "CUBICSPLINE",
        },
        {
            "input": blob.times(SWELL[0]),
            "output": blob.floats([part for key in SWELL[1] for part in key], "SCALAR"),
            "interpolation": "CUBICSPLINE",
        },
    ]
    moved = [(2, "translation"), (3, "rotation"), (3, "scale"), (4, "rotation"), (0, "weights")]
    tree = {
        "asset": {"version": "2.0"},
        "extensionsUsed": ["KHR_mesh_quantization"],
        "extensionsRequired": ["KHR_mesh_quantization"],
        "scene": 1,
        "scenes": [{"nodes": [0]}, {"nodes": [1, 0]}],
        "nodes": [
            # Where the skinned node itself stands must not matter; its rest weights give way to the animation.
            {"mesh": 0, "skin": 0, "scale": [3, 3, 3], "weights": [9, 9]},
            {"children": [2], "matrix": [ROOT[row][column] for column in range(4) for row in range(4)]},
            {"children": [3], "scale": [1, 1.5, 1]},
            {"children": [4, 5], "translation": [0, 1, 0]},
            {"translation": [0.25, 1, 0], "scale": [2, 1, 1]},
            {"mesh": 1, "rotation": [0, 0, 0.6, 0.8], "scale": [-1, 0.5, 2], "translation": [0, 0, 1]},
        ],
        "meshes": [
            {"primitives": [{"attributes": attributes, "indices": indices, "targets": targets}], "weights": [7, 7]},
            {"primitives": [fin]},
        ],
        "skins": [{"joints": [2, 3, 4], "inverseBindMatrices": blob.floats(columns, "MAT4"), "skeleton": 1}],
        "animations": [
            {
                "samplers": samplers,
                "channels": [
                    {"sampler": k, "target": {"node": node, "path": path}} for k, (node, path) in enumerate(moved)
                ],
            }
        ],
        "accessors": blob.accessors,
        "bufferViews": blob.views,
        "buffers": [{"byteLength": len(blob.data)}],
    }
    return tree, bytes(blob.data)


def packed(tree: dict[str, Any], data: bytes, more: bytes = b"") -> bytes:
    """A binary container."""
    text = json.dumps(tree).encode()
    text += b" " * (-len(text) % 4)
    data += b"\0" * (-len(data) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(data), b"BIN\0") + data
    chunks += more
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def product(first: Matrix, second: Matrix) -> Matrix:
    """Of two matrices."""
    return [[sum(first[i][k] * second[k][j] for k in range(4)) for j in range(4)] for i in range(4)]


def applied(matrix: Matrix, place: Sequence[float]) -> list[float]:
    """Where a matrix puts a place."""
    return [sum(matrix[i][k] * (*place, 1.0)[k] for k in range(4)) for i in range(3)]


def times_quaternion(a: Sequence[float], b: Sequence[float]) -> Vector:
    """Hamilton's product of (x, y, z, w)."""
    (ax, ay, az, aw), (bx, by, bz, bw) = a, b
    return (
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    )


def posed(turn: Sequence[float], scale: Sequence[float], shift: Sequence[float]) -> Matrix:
    """Translation times rotation times scale; each axis is turned by q v q*."""
    length = math.sqrt(sum(value * value for value in turn))
    q = [value / length for value in turn]
    back = (-q[0], -q[1], -q[2], q[3])
    axes = []
    for axis in range(3):
        unit = [float(axis == k) for k in range(3)] + [0.0]
        axes.append([scale[axis] * value for value in times_quaternion(times_quaternion(q, unit), back)[:3]])
    return [[axes[0][i], axes[1][i], axes[2][i], shift[i]] for i in range(3)] + [[0, 0, 0, 1]]


def curved(keys: tuple[Sequence[float], Sequence[Any]], t: float) -> list[float]:
    """A cubic spline as Bezier curves by de Casteljau's halves."""
    times, rows = keys
    k = max(k for k in range(len(times) - 1) if times[k] <= t + 1e-9)
    step = times[k + 1] - times[k]
    u = min(max((t - times[k]) / step, 0.0), 1.0)
    found = []
    for start, out, into, end in zip(rows[k][1], rows[k][2], rows[k + 1][0], rows[k + 1][1], strict=True):
        points = [start, start + step * out / 3, end - step * into / 3, end]
        while len(points) > 1:
            points = [(1 - u) * a + u * b for a, b in pairwise(points)]
        found.append(points[0])
    return found


def turned(t: float) -> list[float]:
    """The second joint's quaternion: held before the first key, then the shorter way along the great circle."""
    times = TURNS[0]
    keys = []
    for row in TURNS[1]:
        values = [max(value / 32767, -1.0) for value in row]
        length = math.sqrt(sum(value * value for value in values))
        keys.append([value / length for value in values])
    if t <= times[0]:
        return keys[0]
    k = max(k for k in range(2) if times[k] <= t + 1e-9)
    low, high = keys[k], keys[k + 1]
    cosine = sum(a * b for a, b in zip(low, high, strict=True))
    if cosine < 0:
        high, cosine = [-value for value in high], -cosine
    u, angle = min((t - times[k]) / (times[k + 1] - times[k]), 1.0), math.acos(cosine)
    # Along the arc: the start, and the unit vector that stands square on it.
    square = [(b - cosine * a) / math.sin(angle) for a, b in zip(low, high, strict=True)]
    return [math.cos(u * angle) * a + math.sin(u * angle) * b for a, b in zip(low, square, strict=True)]


def truth(frame: int) -> np.ndarray:
    """Places (11, 3) in a frame, z up: the fin's four and the skin's seven."""
    t = frame / FPS
    shift = [row for time, row in zip(*STEPS, strict=True) if time <= t + 1e-6][-1]
    share = t / 0.3
    scale = [(1 - share) * a + share * b for a, b in zip(*SCALES[1], strict=True)]
    first = product(ROOT, posed((0, 0, 0, 1), (1, 1.5, 1), shift))
    second = product(first, posed(turned(t), scale, (0, 1, 0)))
    third = product(second, posed(curved(CURVE, t), (2, 1, 1), (0.25, 1, 0)))
    fin = product(second, posed((0, 0, 0.6, 0.8), (-1, 0.5, 2), (0, 0, 1)))
    one, two = curved(SWELL, t)
    skin = []
    for number, place in enumerate(POSITIONS):
        base = REPLACED.get(number, place)
        shape = [
            b + one * bulge + two * max(lean / 32767, -1.0)
            for b, bulge, lean in zip(base, BULGE.get(number, (0, 0, 0)), LEAN[number], strict=True)
        ]
        moved = [0.0, 0.0, 0.0]
        for joint, weight in zip(JOINTS[number], WEIGHTS[number], strict=True):
            if weight:
                at = applied((first, second, third)[joint], applied(INVERSE[joint], shape))
                moved = [m + weight / 65535 * a for m, a in zip(moved, at, strict=True)]
        skin.append(moved)
    places = [applied(fin, place) for place in FIN] + skin
    return np.array([[x, -z, y] for x, y, z in places])


@pytest.mark.parametrize("kind", ["glb", "gltf", "library"])
def test_every_frame_is_where_the_specification_puts_it(tmp_path: Path, kind: str) -> None:
    """As one container with a chunk of no known kind, as text, and as another library writes it again."""
    tree, data = described()
    path = tmp_path / f"foreign.{'gltf' if kind == 'gltf' else 'glb'}"
    if kind == "gltf":
        tree["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
        path.write_text(json.dumps(tree))
    else:
        unknown = struct.pack("<I4s", 4, b"what") + b"ever"
        path.write_bytes(packed(tree, data, unknown if kind == "glb" else b""))
    if kind == "library":
        library = pytest.importorskip("pygltflib")
        library.GLTF2().load(str(path)).save(str(tmp_path / "again.glb"))
        path = tmp_path / "again.glb"
    with open_mesh_frames(path) as frames:
        assert (len(frames), frames.fps, frames.up, frames.moving) == (7, Fraction(FPS), "z", True)
        assert frames.remark == ""
        for frame in range(7):
            assert np.abs(frames[frame].vertices - truth(frame)).max() < 3e-6
        mesh = frames[3]
    # A strip turns every second triangle; a scale that mirrors turns all of its node.
    assert mesh.faces[:2].tolist() == [[2, 1, 0], [3, 1, 2]]
    assert (mesh.faces[2:] - 4).tolist() == [list(face) for face in FACES]
    assert mesh.colours is not None
    assert mesh.colours[4:].tolist() == [list(colour[:3]) for colour in COLOURS]
    whole = read_sequence(path)
    assert np.abs(whole.vertices[5] - truth(5)).max() < 3e-6
    assert len(read_mesh(path).vertices) == 11


@pytest.mark.parametrize("way", ["LINEAR", "CUBICSPLINE"])
def test_few_keys_of_a_shape_are_not_its_frames(tmp_path: Path, way: str) -> None:
    """Three keys far apart and uneven, as people set them: the seconds between are played, 30 frames in each."""
    tree, data = described()
    tree["scene"], tree["nodes"] = 0, [{"mesh": 0}]
    entry = tree["animations"][0]
    blob = Blob()
    blob.data, blob.views, blob.accessors = bytearray(data), tree["bufferViews"], tree["accessors"]
    times, curve = [0.5, 1.0, 2.5], SWELL[1]
    rows = [part for key in curve for part in key] if way == "CUBICSPLINE" else [key[1] for key in curve]
    entry["samplers"] = [{"input": blob.times(times), "output": blob.floats(rows, "SCALAR"), "interpolation": way}]
    entry["channels"] = [{"sampler": 0, "target": {"node": 0, "path": "weights"}}]
    tree["buffers"][0]["byteLength"] = len(blob.data)
    path = tmp_path / "shape.glb"
    path.write_bytes(packed(tree, bytes(blob.data)))
    with open_mesh_frames(path) as frames:
        assert (len(frames), frames.fps) == (61, Fraction(30))
        assert "no even rate" in frames.remark
        for frame in (0, 8, 15, 37, 60):
            t = 0.5 + frame / 30
            if way == "CUBICSPLINE":
                one, two = curved((times, curve), t)
            else:
                one, two = (np.interp(t, times, [key[1][k] for key in curve]) for k in range(2))
            base = np.array([REPLACED.get(k, place) for k, place in enumerate(POSITIONS)], float)
            bulge = np.array([BULGE.get(k, (0, 0, 0)) for k in range(7)])
            x, y, z = (base + one * bulge + two * np.maximum(np.array(LEAN) / 32767, -1)).T
            assert np.abs(frames[frame].vertices - np.stack([x, -z, y], axis=1)).max() < 1e-6
    assert len(read_sequence(path)) == 61
