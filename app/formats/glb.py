"""Meshes from and to GLB: Y up and metres there, Z up here."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import attrs
import numpy as np
from numpy.typing import NDArray

from app.formats.gltf import Gltf, GltfWriter, read_gltf, to_linear, to_srgb
from app.formats.meshfile import MeshFile, to_int32, y_up_to_z_up, z_up_to_y_up
from imitation.errors import InputError

VERTICES, INDICES = 34962, 34963


@attrs.frozen(eq=False)
class Surface:
    """Vertices (n, 3) in the file's world, and the primitives on them with their triangles (m, 3)."""

    vertices: NDArray[np.float64]
    colors: NDArray[np.uint8] | None
    parts: list[tuple[dict[str, Any], NDArray[np.int64]]]


def read_glb(path: Path, data: bytes) -> MeshFile:
    """Read all triangles of a GLB's scene as one mesh, turned to Z up; see read_mesh."""
    return glb_mesh(read_gltf(path, data), path.name)


def glb_mesh(gltf: Gltf, name: str) -> MeshFile:
    """All surfaces of a scene one after another as one mesh, turned to Z up."""
    try:
        pieces = surfaces(gltf)
    except (ValueError, KeyError, IndexError, TypeError, AttributeError, OverflowError, MemoryError) as error:
        raise InputError(f"The file {name} is not a whole GLB or glTF file: export it again.") from error
    if not pieces:
        return MeshFile(np.zeros((0, 3)), np.zeros((0, 3)), None, "z", name)
    starts = np.cumsum([0, *(len(piece.vertices) for piece in pieces)])
    vertices = np.concatenate([piece.vertices for piece in pieces])
    parts = [part + start for piece, start in zip(pieces, starts, strict=False) for _, part in piece.parts]
    colors = None
    if any(piece.colors is not None for piece in pieces):
        white = [
            np.full((len(piece.vertices), 3), 255, np.uint8) if piece.colors is None else piece.colors
            for piece in pieces
        ]
        colors = np.concatenate(white)
    return MeshFile(y_up_to_z_up(vertices), to_int32(np.concatenate(parts), name), colors, "z", name)


def surfaces(gltf: Gltf) -> list[Surface]:
    """All surfaces of the default scene in the order of its nodes."""
    return [piece for node, matrix in nodes(gltf) for piece in node_surfaces(gltf, node, matrix)]


def write_glb(
    path: Path,
    vertices: NDArray[np.float64],
    faces: NDArray[np.int32],
    colors: NDArray[np.uint8] | None = None,
    normals: NDArray[np.float64] | None = None,
) -> None:
    """Write one still mesh (Z up here, Y up in the file)."""
    writer = GltfWriter()
    primitive = base_primitive(writer, vertices, faces, colors, normals)
    scene(writer, {"primitives": [primitive]})
    writer.write(path)


def base_primitive(
    writer: GltfWriter,
    vertices: NDArray[np.float64],
    faces: NDArray[np.int32],
    colors: NDArray[np.uint8] | None,
    normals: NDArray[np.float64] | None,
) -> dict[str, Any]:
    """Add a mesh's accessors and give its primitive."""
    places = z_up_to_y_up(vertices).astype(np.float32)
    attributes = {"POSITION": writer.add(places, "VEC3", target=VERTICES, bounds=True)}
    if normals is not None:
        turned = z_up_to_y_up(normals).astype(np.float32)
        attributes["NORMAL"] = writer.add(turned, "VEC3", target=VERTICES)
    if colors is not None:
        linear = to_linear(colors)
        attributes["COLOR_0"] = writer.add(linear, "VEC3", target=VERTICES, normalized=True)
    indices = writer.add(faces.astype(np.uint32).reshape(-1, 1), "SCALAR", target=INDICES)
    return {"attributes": attributes, "indices": indices, "material": 0, "mode": 4}


def scene(writer: GltfWriter, mesh: dict[str, Any], name: str = "character") -> None:
    """Make a scene of one mesh with a plain material."""
    material = {
        "name": name, "doubleSided": True,
        "pbrMetallicRoughness": {"metallicFactor": 0.0, "roughnessFactor": 0.8},
    }  # fmt: skip
    writer.tree |= {
        "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0, "name": name}],
        "meshes": [{"name": name, **mesh}], "materials": [material],
    }  # fmt: skip


def nodes(gltf: Gltf) -> list[tuple[dict[str, Any], NDArray[np.float64]]]:
    """All nodes of the default scene with their matrices (4, 4) to the file's world."""
    every = gltf.items("nodes")
    matrices = {-1: np.eye(4)}
    for index, parent in (order := node_order(gltf)):
        matrices[index] = matrices[parent] @ node_matrix(every[index])
    return [(every[index], matrices[index]) for index, _ in order]


def node_order(gltf: Gltf) -> list[tuple[int, int]]:
    """Numbers of all nodes of the default scene, each after its parent, with that parent's, -1 for none."""
    every = gltf.items("nodes")
    scenes = gltf.items("scenes")
    children = {child for node in every for child in node.get("children", [])}
    roots = scenes[gltf.tree.get("scene", 0)].get("nodes", []) if scenes else []
    stack = [(index, -1) for index in (roots or [k for k in range(len(every)) if k not in children])][::-1]
    found, seen = [], set[int]()
    while stack:
        index, parent = stack.pop()
        if index in seen or not 0 <= index < len(every):
            raise ValueError("nodes in a circle, or not there")
        seen.add(index)
        found.append((index, parent))
        stack += [(child, index) for child in every[index].get("children", [])][::-1]
    return found


def node_matrix(node: dict[str, Any]) -> NDArray[np.float64]:
    """The matrix (4, 4) of a node to its parent."""
    if "matrix" in node:
        return np.array(node["matrix"], np.float64).reshape(4, 4).T
    x, y, z, w = np.array(node.get("rotation", (0, 0, 0, 1)), np.float64)
    turn = np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ])  # fmt: skip
    matrix = np.eye(4)
    matrix[:3, :3] = turn * np.array(node.get("scale", (1, 1, 1)), np.float64)
    matrix[:3, 3] = node.get("translation", (0, 0, 0))
    return matrix


def node_surfaces(gltf: Gltf, node: dict[str, Any], matrix: NDArray[np.float64]) -> list[Surface]:
    """The surfaces of a node's mesh, placed by a matrix to the file's world; none where it has no mesh."""
    if "mesh" not in node:
        return []
    # Exporters cut one surface into materials that share their vertices: it stays one surface.
    pieces: dict[int, Surface] = {}
    # A skinned mesh is placed by its joints; in rest that is where its own coordinates are.
    place = np.eye(4) if "skin" in node else matrix
    for primitive in gltf.items("meshes")[node["mesh"]]["primitives"]:
        if primitive.get("mode", 4) not in (4, 5, 6):
            continue
        key = primitive["attributes"]["POSITION"]
        if key not in pieces:
            local = gltf.accessor(key).astype(np.float64)
            placed = local @ place[:3, :3].T + place[:3, 3]
            pieces[key] = Surface(placed, _colors(gltf, primitive, len(local)), [])
        count = len(pieces[key].vertices)
        indices = gltf.accessor(primitive["indices"]) if "indices" in primitive else np.arange(count)
        faces = _triangles(indices.reshape(-1).astype(np.int64), primitive.get("mode", 4))
        if len(faces) and faces.max() >= count:
            raise ValueError("index")
        if np.linalg.det(place[:3, :3]) < 0:
            faces = faces[:, ::-1]
        pieces[key].parts.append((primitive, faces))
    return list(pieces.values())


def _triangles(indices: NDArray[np.int64], mode: int) -> NDArray[np.int64]:
    if mode == 4:
        return indices[: len(indices) // 3 * 3].reshape(-1, 3)
    if mode == 5:
        strip = np.stack([indices[:-2], indices[1:-1], indices[2:]], axis=1)
        strip[1::2] = strip[1::2][:, [1, 0, 2]]
        return strip
    rim = np.stack([indices[1:-1], indices[2:]], axis=1)
    return np.concatenate([np.full((len(rim), 1), indices[0]), rim], axis=1)


def _colors(gltf: Gltf, primitive: dict[str, Any], count: int) -> NDArray[np.uint8] | None:
    factor = np.ones(3)
    if "material" in primitive:
        surface = gltf.items("materials")[primitive["material"]].get("pbrMetallicRoughness", {})
        factor = np.array(surface.get("baseColorFactor", (1, 1, 1, 1))[:3], np.float64)
    if "COLOR_0" not in primitive["attributes"]:
        return None if (factor == 1).all() else to_srgb(np.tile(factor, (count, 1)))
    values = gltf.accessor(primitive["attributes"]["COLOR_0"])[:, :3]
    if values.shape != (count, 3):
        raise ValueError("colours")
    return to_srgb(values * factor)
