"""What a GLB wears: base colour pictures by texture coordinates, in and out."""

from __future__ import annotations

import base64
import re
import urllib.parse
from pathlib import Path
from typing import Any

import attrs
import numpy as np
from numpy.typing import NDArray

from app.formats.glb import base_primitive, glb_mesh, scene, surfaces
from app.formats.gltf import Gltf, GltfWriter, read_gltf
from app.formats.images import read_bytes
from app.formats.meshfile import MeshFile, check_mesh
from app.formats.sequence import vertex_normals
from app.formats.tvm.frames import FrameMesh, Texture
from app.formats.tvm.pictures import PictureRoom, picture_suffix
from imitation.errors import InputError

Array = NDArray[np.float64]


def read_dressed_glb(path: Path, data: bytes, room: PictureRoom) -> FrameMesh:
    """Read a GLB with its pictures; where it has some, corners cut apart at the seams are one vertex again.

    Raises
    ------
    InputError
        As ``read_mesh``; texture coordinates that are not there.
    """
    gltf = read_gltf(path, data)
    mesh = check_mesh(glb_mesh(gltf, path.name))
    texture = glb_texture(gltf, path, room)
    if texture is None:
        return FrameMesh(mesh.vertices, mesh.faces, mesh.colors)
    return attrs.evolve(_sewn(mesh), texture=texture)


def glb_texture(gltf: Gltf, path: Path, room: PictureRoom) -> Texture | None:
    """The pictures on a scene's faces, in the order of ``surfaces``; None where there are none.

    Raises
    ------
    InputError
        They cannot be understood.
    """
    try:
        return _texture(gltf, path, room)
    except (ValueError, KeyError, IndexError, TypeError) as error:
        raise InputError(f"The file {path.name} has textures that cannot be understood: export it again.") from error


def _texture(gltf: Gltf, path: Path, room: PictureRoom) -> Texture | None:
    coordinates: list[Array] = []
    corners, of_face = [], []
    images: list[Path] = []
    start = 0
    for surface in surfaces(gltf):
        for primitive, faces in surface.parts:
            picture, channel = _picture(gltf, primitive, path, room)
            name = f"TEXCOORD_{channel}"
            if picture is None or name not in primitive["attributes"]:
                corners.append(np.full((len(faces), 3), -1, np.int64))
                of_face.append(np.full(len(faces), -1))
                continue
            places = gltf.accessor(primitive["attributes"][name])[:, :2].astype(np.float64)
            if len(faces) and faces.max() >= len(places):
                raise ValueError("texture coordinates")
            if picture not in images:
                images.append(picture)
            # The origin is the upper left corner there, the lower left one here.
            coordinates.append(np.stack([places[:, 0], 1.0 - places[:, 1]], axis=1))
            corners.append(faces + start)
            of_face.append(np.full(len(faces), images.index(picture)))
            start += len(places)
    if not images:
        return None
    return Texture(
        np.concatenate(coordinates),
        np.concatenate(corners).astype(np.int32),
        tuple(images),
        np.concatenate(of_face).astype(np.int32),
    )


def _picture(gltf: Gltf, primitive: dict[str, Any], path: Path, room: PictureRoom) -> tuple[Path | None, int]:
    """The base colour's file, and which texture coordinates it goes by."""
    if "material" not in primitive:
        return None, 0
    surface = gltf.items("materials")[primitive["material"]].get("pbrMetallicRoughness", {})
    worn = surface.get("baseColorTexture")
    if worn is None or "source" not in gltf.items("textures")[worn["index"]]:
        return None, 0
    image = gltf.items("images")[gltf.items("textures")[worn["index"]]["source"]]
    channel = int(worn.get("texCoord", 0))
    uri = image.get("uri")
    if uri is None:
        data = gltf.view(image["bufferView"])
    elif uri.startswith("data:"):
        data = base64.b64decode(uri.split(",", 1)[1])
    else:
        beside = (path.parent / urllib.parse.unquote(uri)).resolve()
        inside = beside.is_relative_to(path.parent.resolve()) and beside.is_file()
        return (beside if inside else None), channel
    stem = re.sub(r"[^\w-]+", "_", str(image.get("name") or path.stem))[:80] or "picture"
    return room.put(data, stem), channel


def _sewn(mesh: MeshFile) -> FrameMesh:
    """Vertices of equal position made one, in the order of their first: the texture's seams are none of the surface."""
    _, first, number = np.unique(mesh.vertices, axis=0, return_index=True, return_inverse=True)
    rank = np.argsort(np.argsort(first))
    kept = np.sort(first)
    faces = rank[number.reshape(-1)][mesh.faces].astype(np.int32)
    return FrameMesh(mesh.vertices[kept], faces, None if mesh.colors is None else mesh.colors[kept])


def write_dressed_glb(file: Path, mesh: FrameMesh, texture: Texture) -> None:
    """Write a mesh with its pictures inside, PNG and JPEG byte for byte, others as PNG."""
    pairs = np.stack([mesh.faces.reshape(-1), texture.corners.reshape(-1)], axis=1)
    apart, number = np.unique(pairs, axis=0, return_inverse=True)
    faces = number.reshape(-1, 3).astype(np.int32)
    places = np.vstack([texture.coordinates, [0.0, 0.0]])[apart[:, 1]]
    places[:, 1] = np.where(apart[:, 1] < 0, 0.0, 1.0 - places[:, 1])
    normals = vertex_normals(mesh.vertices, mesh.faces)[apart[:, 0]]
    colours = None if mesh.colours is None else mesh.colours[apart[:, 0]]
    writer = GltfWriter()
    whole = base_primitive(writer, mesh.vertices[apart[:, 0]], faces, colours, normals)
    whole["attributes"]["TEXCOORD_0"] = writer.add(places.astype(np.float32), "VEC2", target=34962)
    primitives: list[dict[str, Any]] = []
    worn: list[int] = []
    for image in (*range(len(texture.images)), -1):
        mine = texture.image_of_face == image
        if not mine.any():
            continue
        indices = writer.add(faces[mine].astype(np.uint32).reshape(-1, 1), "SCALAR", target=34963)
        primitives.append({**whole, "indices": indices, "material": len(worn)})
        worn.append(image)
    scene(writer, {"primitives": primitives}, file.stem)
    plain = writer.tree["materials"][0]
    writer.tree["materials"] = [_material(plain, image, writer) for image in worn]
    writer.tree["images"] = [_embedded(writer, image) for image in texture.images]
    writer.tree["samplers"] = [{"wrapS": 10497, "wrapT": 10497}]
    writer.tree["textures"] = [{"source": k, "sampler": 0} for k in range(len(texture.images))]
    writer.write(file)


def _material(plain: dict[str, Any], image: int, writer: GltfWriter) -> dict[str, Any]:
    if image < 0:
        return plain
    surface = {**plain["pbrMetallicRoughness"], "baseColorTexture": {"index": image}}
    return {**plain, "pbrMetallicRoughness": surface}


def _embedded(writer: GltfWriter, image: Path) -> dict[str, Any]:
    data = read_bytes(image).tobytes()
    if not picture_suffix(data):
        import cv2

        from app.formats.images import read_image

        data = cv2.imencode(".png", read_image(image)[..., ::-1])[1].tobytes()
    kind = "image/png" if picture_suffix(data) == ".png" else "image/jpeg"
    return {"name": image.stem, "mimeType": kind, "bufferView": writer.add_bytes(data)}
