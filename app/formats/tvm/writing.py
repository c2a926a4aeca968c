"""Writing sequences of meshes with faces of their own: folders, or one .npz."""

from __future__ import annotations

import io
import re
import shutil
import zipfile
from collections.abc import Iterable
from fractions import Fraction
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from app.formats.atomic import replacing, replacing_numbered
from app.formats.glb import write_glb
from app.formats.obj import write_obj
from app.formats.off import write_off
from app.formats.ply import write_ply
from app.formats.sequence import vertex_normals
from app.formats.tvm.frames import FrameMesh, Texture
from app.formats.tvm.glb_dress import write_dressed_glb
from app.formats.tvm.painting import painted
from app.formats.tvm.ply_dress import write_dressed_ply
from app.formats.tvm.usd_frames import write_usd_frames
from app.formats.usd import USD_SUFFIXES
from imitation.errors import InputError
from imitation.progress import Progress, silent

FrameForm = Literal["ply", "obj", "off", "glb", "npz", "usd"]
FRAME_FORMS: tuple[FrameForm, ...] = ("ply", "obj", "off", "glb", "npz", "usd")


def write_mesh_frames(
    target: Path,
    frames: Iterable[FrameMesh],
    *,
    form: FrameForm,
    fps: Fraction | float,
    count: int,
    name: str = "performance",
    progress: Progress | None = None,
) -> None:
    """Write frames one after another; whole or not at all.

    "ply", "obj", "off" and "glb" make a folder of files ``name_0000.ply``; "npz" and "usd" make one file. PLY, OBJ and
    GLB keep texture coordinates and the pictures as they are; OFF, npz and USD have the texture's colours at the
    vertices.

    Parameters
    ----------
    target : folder, or file for "npz" and "usd" (.usd, .usda, .usdc).
    frames : Z up, metres; taken one at a time.
    count : how many there are.
    """
    if form not in FRAME_FORMS:
        raise InputError(f"A sequence cannot be written as {form}: choose {', '.join(FRAME_FORMS)}.")
    report = progress or silent
    stem = re.sub(r"[^\w-]+", "_", name) or "performance"
    if form == "npz":
        with replacing(target) as temporary:
            _write_npz(temporary, frames, Fraction(fps).limit_denominator(100_000), count, report)
        return
    if form == "usd":
        if target.suffix.lower() not in USD_SUFFIXES:
            raise InputError(f"A USD stage cannot be written as {target.name}: use .usd, .usda or .usdc.")
        with replacing(target) as temporary:
            write_usd_frames(temporary, map(painted, frames), fps=fps, count=count, name=stem, progress=report)
        return
    digits = max(4, len(str(count - 1)))
    with replacing_numbered(target, stem, "." + form) as folder:
        for number, mesh in enumerate(frames):
            file = folder / f"{stem}_{number:0{digits}d}.{form}"
            _write_one(file, mesh, form)
            report((number + 1) / count)


def _write_one(file: Path, mesh: FrameMesh, form: FrameForm) -> None:
    vertices, faces = np.asarray(mesh.vertices, np.float64), mesh.faces
    if form == "obj":
        if mesh.texture is not None:
            _write_textured(file, mesh, mesh.texture)
        else:
            write_obj(file, vertices, faces, mesh.colours)
        return
    if mesh.texture is not None and form == "glb":
        write_dressed_glb(file, mesh, mesh.texture)
        return
    if mesh.texture is not None and form == "ply":
        names = [_copied(image, file.parent) for image in mesh.texture.images]
        write_dressed_ply(file, vertices, faces, mesh.colours, mesh.texture, names)
        return
    colours = painted(mesh).colours
    if form == "ply":
        write_ply(file, vertices, faces, colours)
    elif form == "off":
        write_off(file, vertices, faces, colours)
    else:
        write_glb(file, vertices, faces, colours, vertex_normals(vertices, faces))


def _write_textured(file: Path, mesh: FrameMesh, texture: Texture) -> None:
    """An OBJ with its material library; every picture is copied once, byte for byte."""
    names = [_copied(image, file.parent) for image in texture.images]
    materials, lines = [], [f"mtllib {file.stem}.mtl"]
    lines += ["v {:.9g} {:.9g} {:.9g}".format(*vertex) for vertex in mesh.vertices.tolist()]
    lines += ["vt {:.9g} {:.9g}".format(*place) for place in texture.coordinates.tolist()]
    for number in (*range(len(names)), -1):
        worn = np.flatnonzero(texture.image_of_face == number)
        if not len(worn):
            continue
        material = f"picture_{number}" if number >= 0 else "plain"
        materials.append(f"newmtl {material}\nKd 1 1 1\n" + (f"map_Kd {names[number]}\n" if number >= 0 else ""))
        lines.append(f"usemtl {material}")
        for corners, places in zip(mesh.faces[worn].tolist(), texture.corners[worn].tolist(), strict=True):
            words = [f"{v + 1}/{t + 1}" if t >= 0 else f"{v + 1}" for v, t in zip(corners, places, strict=True)]
            lines.append("f " + " ".join(words))
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")
    file.with_suffix(".mtl").write_text("\n".join(materials), encoding="utf-8")


def _copied(image: Path, folder: Path) -> str:
    """Copy a picture, under a name of its own where another one is called the same."""
    data = image.read_bytes()
    for number in range(10_000):
        target = folder / (image.name if not number else f"{image.stem}-{number}{image.suffix}")
        if not target.exists():
            target.write_bytes(data)
            return target.name
        if target.stat().st_size == len(data) and target.read_bytes() == data:
            return target.name
    raise InputError(f"Too many pictures are called {image.name}: rename some of them.")


def _write_npz(path: Path, frames: Iterable[FrameMesh], fps: Fraction, count: int, report: Progress) -> None:
    """Large arrays are spooled beside the file, so that memory stays that of a frame."""
    room = path.with_name(path.name + ".arrays")
    room.mkdir()
    try:
        starts, face_starts = [0], [0]
        coloured = True
        with (room / "v").open("wb") as places, (room / "f").open("wb") as faces, (room / "c").open("wb") as colours:
            for number, mesh in enumerate(map(painted, frames)):
                places.write(np.ascontiguousarray(mesh.vertices, "<f4").tobytes())
                faces.write(np.ascontiguousarray(mesh.faces, "<i4").tobytes())
                coloured &= mesh.colours is not None
                if mesh.colours is not None:
                    colours.write(np.ascontiguousarray(mesh.colours, np.uint8).tobytes())
                starts.append(starts[-1] + len(mesh.vertices))
                face_starts.append(face_starts[-1] + len(mesh.faces))
                report(0.5 * (number + 1) / count)
        small: dict[str, NDArray[Any]] = {
            "vertex_offsets": np.array(starts, np.int64),
            "face_offsets": np.array(face_starts, np.int64),
            "fps": np.array([fps.numerator, fps.denominator], np.int64),
            "up": np.array("z"),
            "unit": np.array([1.0]),
        }
        with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=4, allowZip64=True) as archive:
            for name, array in small.items():
                with archive.open(_entry(name), "w") as stream:
                    np.lib.format.write_array(stream, array, allow_pickle=False)
            large = [("vertices", "v", "<f4", starts[-1]), ("faces", "f", "<i4", face_starts[-1])]
            large += [("colors", "c", "|u1", starts[-1])] if coloured else []
            for number, (name, file, kind, rows) in enumerate(large):
                header = {"descr": kind, "fortran_order": False, "shape": (rows, 3)}
                memory = io.BytesIO()
                np.lib.format.write_array_header_1_0(memory, header)
                with archive.open(_entry(name), "w", force_zip64=True) as stream, (room / file).open("rb") as raw:
                    stream.write(memory.getvalue())
                    shutil.copyfileobj(raw, stream, 1 << 20)
                report(0.5 + 0.5 * (number + 1) / len(large))
    finally:
        shutil.rmtree(room, ignore_errors=True)


def _entry(name: str) -> zipfile.ZipInfo:
    # A fixed date, so that the same frames give the same bytes.
    entry = zipfile.ZipInfo(f"{name}.npy", (1980, 1, 1, 0, 0, 0))
    entry.compress_type = zipfile.ZIP_DEFLATED
    return entry
