"""What a GLB wears: base colour pictures by texture coordinates, in and out."""

from __future__ import annotations

import base64
import re
import urllib.parse
from fractions import Fraction
from pathlib import Path
from typing import Any

import attrs
import numpy as np
from numpy.typing import NDArray

from app.formats.animated_glb import write_animated_glb
from app.formats.atomic import replacing
from app.formats.glb import base_primitive, glb_mesh, scene, surfaces
from app.formats.gltf import Gltf, GltfWriter, read_gltf
from app.formats.images import read_bytes
from app.formats.meshfile import MeshFile, check_mesh
from app.formats.sequence import mesh_sequence, vertex_normals
from app.formats.tvm.frames import FrameMesh, Texture
from app.formats.tvm.pictures import PictureRoom, picture_suffix
from imitation.errors import InputError
from imitation.progress import Progress

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
    except (ValueError, KeyError, IndexError, TypeError, AttributeError, OverflowError, MemoryError) as error:
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
    apart, faces, places = _cut_at_seams(mesh.faces, texture)
    normals = vertex_normals(mesh.vertices, mesh.faces)[apart]
    colours = None if mesh.colours is None else mesh.colours[apart]
    writer = GltfWriter()
    scene(writer, {"primitives": [base_primitive(writer, mesh.vertices[apart], faces, colours, normals)]}, file.stem)
    _wear(writer, faces, places, texture)
    writer.write(file)


def write_dressed_animation(
    file: Path,
    vertices: NDArray[np.floating],
    faces: NDArray[np.int32],
    fps: Fraction,
    texture: Texture,
    colours: NDArray[np.uint8] | None = None,
    *,
    name: str = "character",
    progress: Progress | None = None,
) -> None:
    """Write a moving mesh (n, v, 3) of one connectivity with its pictures as one animated GLB; whole or not at all."""
    apart, cut, places = _cut_at_seams(faces, texture)
    sequence = mesh_sequence(vertices[:, apart], cut, fps, None if colours is None else colours[apart], name)
    with replacing(file) as temporary:
        write_animated_glb(temporary, sequence, progress, dress=lambda writer: _wear(writer, cut, places, texture))


def same_texture(first: Texture, second: Texture | None) -> bool:
    """Whether two meshes of the same faces wear the same pictures in the same way."""
    if second is None or len(first.images) != len(second.images):
        return False
    arrays = ("coordinates", "corners", "image_of_face")
    return all(np.array_equal(getattr(first, each), getattr(second, each)) for each in arrays) and all(
        one == other or one.read_bytes() == other.read_bytes()
        for one, other in zip(first.images, second.images, strict=True)
    )


def _cut_at_seams(
    faces: NDArray[np.int32], texture: Texture
) -> tuple[NDArray[np.int64], NDArray[np.int32], NDArray[np.float32]]:
    """Vertices with one place in the picture each: of which they are, faces of them, and those places."""
    pairs = np.stack([faces.reshape(-1), texture.corners.reshape(-1)], axis=1)
    apart, number = np.unique(pairs, axis=0, return_inverse=True)
    places = np.vstack([texture.coordinates, [0.0, 0.0]])[apart[:, 1]]
    places[:, 1] = np.where(apart[:, 1] < 0, 0.0, 1.0 - places[:, 1])
    return apart[:, 0].astype(np.int64), number.reshape(-1, 3).astype(np.int32), places.astype(np.float32)


def _wear(writer: GltfWriter, faces: NDArray[np.int32], places: NDArray[np.float32], texture: Texture) -> None:
    """Split a scene's only primitive by its pictures, and put them on."""
    mesh = writer.tree["meshes"][0]
    (whole,) = mesh["primitives"]
    whole["attributes"]["TEXCOORD_0"] = writer.add(places, "VEC2", target=34962)
    primitives: list[dict[str, Any]] = []
    worn: list[int] = []
    for image in (*range(len(texture.images)), -1):
        mine = texture.image_of_face == image
        if not mine.any():
            continue
        indices = writer.add(faces[mine].astype(np.uint32).reshape(-1, 1), "SCALAR", target=34963)
        primitives.append({**whole, "indices": indices, "material": len(worn)})
        worn.append(image)
    mesh["primitives"] = primitives
    plain = writer.tree["materials"][0]
    writer.tree["materials"] = [_material(plain, image) for image in worn]
    writer.tree["images"] = [_embedded(writer, image) for image in texture.images]
    writer.tree["samplers"] = [{"wrapS": 10497, "wrapT": 10497}]
    writer.tree["textures"] = [{"source": k, "sampler": 0} for k in range(len(texture.images))]


def _material(plain: dict[str, Any], image: int) -> dict[str, Any]:
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
