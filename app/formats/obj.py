"""Reading and writing Wavefront OBJ: one vertex a ``v`` line, whatever normals and textures the corners carry."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from app.formats.meshfile import MeshFile, fan, to_int32
from imitation.errors import InputError


def read_obj(data: bytes, name: str) -> MeshFile:
    """Read an OBJ mesh; see read_mesh. Colours are the three numbers after a position, 0 to 1."""
    vertices: list[list[float]] = []
    colors: list[list[float]] = []
    polygons: list[list[int]] = []
    for number, line in enumerate(data.replace(b"\\\r\n", b" ").replace(b"\\\n", b" ").splitlines(), start=1):
        words = line.split()
        if not words:
            continue
        try:
            if words[0] == b"v":
                values = [float(word) for word in words[1:7]]
                if len(values) < 3:
                    raise ValueError
                vertices.append(values[:3])
                if len(values) == 6:
                    colors.append(values[3:])
            elif words[0] == b"f":
                corners = [int(word.split(b"/", 1)[0]) for word in words[1:] if not word.startswith(b"#")]
                # A negative number counts back from the last vertex so far.
                polygons.append([corner - 1 if corner > 0 else len(vertices) + corner for corner in corners])
                if 0 in corners:
                    raise ValueError
        except ValueError as error:
            text = line.decode("ascii", "replace").strip()[:60]
            raise InputError(f"Line {number} of the OBJ file {name} cannot be understood: {text!r}.") from error
    positions = np.array(vertices, np.float64).reshape(-1, 3)
    try:
        faces = to_int32(fan(polygons), name)
    except OverflowError as error:
        raise InputError(f"The OBJ file {name} has faces with impossible vertex numbers: it is damaged.") from error
    painted = None
    if colors and len(colors) == len(vertices):
        painted = np.clip(np.rint(np.nan_to_num(np.array(colors)) * 255), 0, 255).astype(np.uint8)
    return MeshFile(positions, faces, painted, None, name)


def write_obj(
    path: Path,
    vertices: NDArray[np.float64],
    faces: NDArray[np.int32],
    colors: NDArray[np.uint8] | None = None,
    normals: NDArray[np.float64] | None = None,
) -> None:
    """Write an OBJ mesh; positions with 9 digits, so that single precision survives."""
    lines = []
    if colors is None:
        lines += ["v {:.9g} {:.9g} {:.9g}".format(*vertex) for vertex in vertices.tolist()]
    else:
        rows = np.concatenate([vertices, colors / 255.0], axis=1).tolist()
        lines += ["v {:.9g} {:.9g} {:.9g} {:.5f} {:.5f} {:.5f}".format(*row) for row in rows]
    if normals is None:
        lines += ["f {} {} {}".format(*face) for face in (faces.astype(np.int64) + 1).tolist()]
    else:
        lines += ["vn {:.5f} {:.5f} {:.5f}".format(*normal) for normal in normals.tolist()]
        lines += [f"f {a}//{a} {b}//{b} {c}//{c}" for a, b, c in (faces.astype(np.int64) + 1).tolist()]
    path.write_text("\n".join(lines) + "\n", encoding="ascii")
