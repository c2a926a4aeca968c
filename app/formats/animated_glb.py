"""One animated GLB: a morph target a frame after the first, whose weights an animation moves from frame to frame."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from app.formats.glb import VERTICES, base_primitive, nodes, scene
from app.formats.gltf import Gltf, GltfWriter, read_gltf, to_srgb
from app.formats.gltf_animation import keys_are_frames
from app.formats.meshfile import to_int32, y_up_to_z_up, z_up_to_y_up
from app.formats.posed_glb import PosedGltf
from app.formats.sequence import MeshSequence, mesh_sequence, vertex_normals
from imitation.errors import InputError
from imitation.progress import Progress, silent

Interpolation = Literal["linear", "step"]
Dress = Callable[[GltfWriter], None]


def write_animated_glb(
    path: Path,
    sequence: MeshSequence,
    progress: Progress | None = None,
    *,
    interpolation: Interpolation = "linear",
    quantize: bool = False,
    normals: bool = True,
    dress: Dress | None = None,
) -> None:
    """Write a sequence as one GLB (Z up here, Y up in the file).

    Frame 0 is the base shape; frame k > 0 is morph target k - 1 with weight 1 at k / fps seconds, all others 0, so
    that every frame is exact (in single precision) at its time.

    Parameters
    ----------
    interpolation : between frames, "linear" moves on evenly, "step" holds the frame.
    quantize : displacements as 16-bit integers and normals as bytes (KHR_mesh_quantization): half the size,
        positions within 1/32767 of the largest displacement.
    normals : also write normals that move with the shape; without, viewers make flat or still ones.
    dress : puts pictures on the finished scene.
    """
    report = progress or silent
    writer = GltfWriter()
    first = sequence.vertices[0].astype(np.float64)
    base_normals = vertex_normals(first, sequence.faces) if normals else None
    count = len(sequence)
    # The size of an integer step is the node's scale; a power of two, so that dividing by it loses nothing.
    scale = _step(sequence) if quantize else 1.0
    primitive = base_primitive(writer, first / scale, sequence.faces, sequence.colors, base_normals)
    # Differences from the single-precision base, so that base + displacement rounds to the frame itself.
    base = (z_up_to_y_up(first) / scale).astype(np.float32).astype(np.float64)
    targets = []
    for frame in range(1, count):
        moved = z_up_to_y_up(sequence.vertices[frame].astype(np.float64)) / scale - base
        target = {"POSITION": _displacements(writer, moved, quantize)}
        if base_normals is not None:
            turned = z_up_to_y_up(vertex_normals(sequence.vertices[frame], sequence.faces) - base_normals)
            target["NORMAL"] = _normals(writer, turned, quantize)
        targets.append(target)
        report(frame / count)
    if not targets:
        scene(writer, {"primitives": [primitive]}, sequence.name)
    else:
        mesh = {"primitives": [{**primitive, "targets": targets}], "weights": [0.0] * (count - 1)}
        mesh["extras"] = {"targetNames": [f"frame_{frame:04d}" for frame in range(1, count)]}
        scene(writer, mesh, sequence.name)
        _animate(writer, sequence, interpolation)
    if quantize and targets:
        writer.tree["nodes"][0]["scale"] = [scale] * 3
        writer.tree["extensionsUsed"] = writer.tree["extensionsRequired"] = ["KHR_mesh_quantization"]
    if dress is not None:
        dress(writer)
    writer.tree["asset"]["extras"] = {"fps": str(sequence.fps), "frames": count}
    writer.write(path)
    report(1.0)


def read_animated_glb(path: Path, data: bytes) -> MeshSequence:
    """Evaluate the first animation: morph weights at each of its key times, joints and nodes at each frame.

    Raises
    ------
    InputError
        The file has no animated mesh.
    """
    gltf = read_gltf(path, data)
    if is_shape_animation(gltf):
        return shape_animation(gltf)
    posed = PosedGltf(gltf)
    first = posed.vertices(0)
    frames = np.empty((len(posed), *first.shape), np.float32)
    for frame in range(len(posed)):
        frames[frame] = posed.vertices(frame)
    return mesh_sequence(frames, posed.faces, posed.animation.fps, posed.colors, path.name)


def is_shape_animation(gltf: Gltf) -> bool:
    """Whether all that moves are the morph targets of one mesh of one primitive, key by key, which no joint holds."""
    try:
        channels = [channel for entry in gltf.items("animations")[:1] for channel in entry["channels"]]
        targets = {(channel["target"].get("node"), channel["target"]["path"]) for channel in channels}
        drawn = [node for node, _ in nodes(gltf) if "mesh" in node]
        if len(targets) != 1 or len(drawn) != 1 or "skin" in drawn[0]:
            return False
        (node, path), primitives = targets.pop(), gltf.items("meshes")[drawn[0]["mesh"]]["primitives"]
        whole = path == "weights" and len(primitives) == 1 and gltf.items("nodes")[node] is drawn[0]
        entry = gltf.items("animations")[0]
        # A few keys far apart, which others write, say nothing of the frames between them.
        return whole and keys_are_frames(gltf, entry["samplers"][entry["channels"][0]["sampler"]])
    except (ValueError, KeyError, IndexError, TypeError, AttributeError):
        return False


def shape_animation(gltf: Gltf) -> MeshSequence:
    """Evaluate morph weights at each of their key times; see ``is_shape_animation``."""
    try:
        found = _weights(gltf)
        if found is None:
            raise KeyError("weights")
        node_index, times, weights = found
        node = gltf.items("nodes")[node_index]
        matrix = next(matrix for each, matrix in nodes(gltf) if each is node)
        primitive = gltf.items("meshes")[node["mesh"]]["primitives"][0]
        base = gltf.accessor(primitive["attributes"]["POSITION"]).astype(np.float64)
        targets = [gltf.accessor(target["POSITION"]).astype(np.float64) for target in primitive["targets"]]
        frames = np.empty((len(times), *base.shape))
        for frame, row in enumerate(weights):
            shape = base + sum((row[k] * targets[k] for k in np.flatnonzero(row)), np.zeros(()))
            frames[frame] = y_up_to_z_up(shape @ matrix[:3, :3].T + matrix[:3, 3])
        faces = to_int32(gltf.accessor(primitive["indices"]).astype(np.int64).reshape(-1, 3), gltf.name)
        colors = None
        if "COLOR_0" in primitive["attributes"]:
            colors = to_srgb(gltf.accessor(primitive["attributes"]["COLOR_0"])[:, :3])
    except InputError:
        raise
    except (ValueError, KeyError, IndexError, TypeError, AttributeError, OverflowError, StopIteration) as error:
        raise InputError(f"The file {gltf.name} is not a whole GLB or glTF file: export it again.") from error
    asset = gltf.tree.get("asset")
    stated = asset.get("extras") if isinstance(asset, dict) else None
    fps = stated.get("fps") if isinstance(stated, dict) else None
    step = float(np.median(np.diff(times))) if len(times) > 1 else 1 / 25
    return mesh_sequence(frames, faces, _fraction(fps, step), colors, gltf.name)


def _fraction(stated: Any, step: float) -> Any:
    from fractions import Fraction

    try:
        return Fraction(stated)
    except (TypeError, ValueError):
        return Fraction(1 / step).limit_denominator(1001)


def _step(sequence: MeshSequence) -> float:
    first = sequence.vertices[0].astype(np.float64)
    largest = max(float(np.abs(frame - first).max()) for frame in sequence.vertices)
    return float(2.0 ** np.ceil(np.log2(max(largest, 1e-12) / 32766)))


def _displacements(writer: GltfWriter, moved: NDArray[np.float64], quantize: bool) -> int:
    values = np.rint(moved).astype(np.int16) if quantize else moved.astype(np.float32)
    return writer.add(values, "VEC3", target=VERTICES, bounds=True)


def _normals(writer: GltfWriter, turned: NDArray[np.float64], quantize: bool) -> int:
    if not quantize:
        return writer.add(turned.astype(np.float32), "VEC3", target=VERTICES)
    # Differences of unit vectors reach 2, normalised bytes only 1: what is beyond is cut.
    small = np.rint(np.clip(turned, -1, 1) * 127).astype(np.int8)
    return writer.add(small, "VEC3", target=VERTICES, normalized=True)


def _animate(writer: GltfWriter, sequence: MeshSequence, interpolation: Interpolation) -> None:
    count = len(sequence)
    times = np.array([float(frame / sequence.fps) for frame in range(count)], np.float32)
    weights = np.eye(count, count - 1, k=-1, dtype=np.float32)
    samples = writer.add(weights.reshape(-1, 1), "SCALAR")
    sampler = {
        "input": writer.add(times.reshape(-1, 1), "SCALAR", bounds=True),
        "output": samples,
        "interpolation": interpolation.upper(),
    }
    writer.tree["animations"] = [
        {
            "name": "motion",
            "samplers": [sampler],
            "channels": [{"sampler": 0, "target": {"node": 0, "path": "weights"}}],
        }
    ]


def _weights(gltf: Gltf) -> tuple[int, NDArray[np.float64], NDArray[np.float64]] | None:
    for animation in gltf.items("animations"):
        for channel in animation["channels"]:
            if channel["target"]["path"] != "weights":
                continue
            sampler = animation["samplers"][channel["sampler"]]
            times = gltf.accessor(sampler["input"])[:, 0].astype(np.float64)
            values = gltf.accessor(sampler["output"]).astype(np.float64)
            if sampler.get("interpolation") == "CUBICSPLINE":
                rows = values.reshape(len(times), 3, -1)[:, 1]
            else:
                rows = values.reshape(len(times), -1)
            return int(channel["target"]["node"]), times, rows
    return None
