"""Reading and writing PLY, text and binary, every vertex kept in its place."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.formats.meshfile import MeshFile, fan, to_int32
from app.formats.ply_header import Element, Header, read_header
from imitation.errors import InputError

Columns = dict[str, Any]


def read_ply(data: bytes, name: str) -> MeshFile:
    """Read a PLY mesh; see read_mesh."""
    tables = read_tables(data, name)
    vertex = tables.get("vertex", {})
    if not all(axis in vertex for axis in "xyz"):
        raise InputError(f"The PLY file {name} has no vertices with x, y and z.")
    try:
        vertices = _columns(vertex, ("x", "y", "z"), np.float64)
    except (ValueError, TypeError) as error:
        raise InputError(f"The PLY file {name} has positions that are lists: it is damaged.") from error
    face = tables.get("face", {})
    lists = face.get("vertex_indices", face.get("vertex_index"))
    if lists is None:
        faces = np.zeros((0, 3), np.int64)
    elif isinstance(lists, np.ndarray):
        # Triangles of whole numbers, which nearly every file has, are the faces already.
        ready = lists.ndim == 2 and lists.shape[1] == 3 and lists.dtype.kind == "i"
        faces = _together(lists).astype(np.int32, copy=False) if ready else fans(lists.astype(np.int64))
    else:
        try:
            faces = fan(lists)
        except (OverflowError, ValueError, TypeError) as error:
            raise InputError(f"The PLY file {name} has faces with impossible vertex numbers: it is damaged.") from error
    return MeshFile(vertices, to_int32(faces, name), _colors(vertex), None, name)


def read_tables(data: bytes, name: str) -> dict[str, Columns]:
    """All elements of a PLY by name, each with its properties by name: a column, or a list where they are lists."""
    header = read_header(data, name)
    try:
        return _text(data, header) if header.form == "ascii" else _binary(data, header)
    except (ValueError, IndexError, OverflowError) as error:
        raise InputError(f"The PLY file {name} is cut off or damaged: get a whole copy of it.") from error


def write_ply(
    path: Path,
    vertices: NDArray[np.float64],
    faces: NDArray[np.int32],
    colors: NDArray[np.uint8] | None = None,
    normals: NDArray[np.float64] | None = None,
    *,
    exact: bool = False,
) -> None:
    """Write a binary little-endian PLY; positions as float32, or with ``exact`` as float64."""
    real, kind = ("double", "<f8") if exact else ("float", "<f4")
    fields: list[tuple[str, str]] = [(axis, kind) for axis in "xyz"]
    lines = ["ply", "format binary_little_endian 1.0", f"element vertex {len(vertices)}"]
    lines += [f"property {real} {axis}" for axis in "xyz"]
    if normals is not None:
        fields += [(axis, "<f4") for axis in ("nx", "ny", "nz")]
        lines += [f"property float {axis}" for axis in ("nx", "ny", "nz")]
    if colors is not None:
        fields += [(channel, "u1") for channel in ("red", "green", "blue")]
        lines += [f"property uchar {channel}" for channel in ("red", "green", "blue")]
    lines += [f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header", ""]
    table = np.zeros(len(vertices), fields)
    columns: list[NDArray[Any]] = [
        vertices,
        *([] if normals is None else [normals]),
        *([] if colors is None else [colors]),
    ]
    values = [column[:, k] for column in columns for k in range(3)]
    for (field, _), value in zip(fields, values, strict=True):
        table[field] = value
    triangles = np.zeros(len(faces), [("n", "u1"), ("v", "<i4", (3,))])
    triangles["n"], triangles["v"] = 3, faces
    with path.open("wb") as file:
        file.write("\n".join(lines).encode("ascii"))
        file.write(table.tobytes())
        file.write(triangles.tobytes())


def fans(polygons: NDArray[np.int64]) -> NDArray[np.int64]:
    """Triangles (m, 3) of polygons of equally many corners (k, n), each split into a fan from its first corner."""
    corners = polygons.shape[1]
    if corners < 3:
        return np.zeros((0, 3), np.int64)
    fans = [polygons[:, [0, k, k + 1]] for k in range(1, corners - 1)]
    return np.stack(fans, axis=1).reshape(-1, 3)


def _columns(table: Columns, names: tuple[str, ...], kind: Any = None) -> NDArray[Any]:
    """Columns of a table side by side (n, k), each copied once."""
    first = np.asarray(table[names[0]])
    together = np.empty((len(first), len(names)), first.dtype if kind is None else kind)
    for k, name in enumerate(names):
        column = np.asarray(table[name])
        if column.shape != first.shape or column.ndim != 1:
            raise ValueError(name)
        together[:, k] = column
    return together


def _together(lists: NDArray[Any]) -> NDArray[Any]:
    """Lists (m, k) out of the rows of a file, side by side: a whole list is copied at once, not value by value."""
    whole = np.ascontiguousarray(lists.view(f"V{lists.shape[1] * lists.dtype.itemsize}"))
    return whole.view(lists.dtype).reshape(lists.shape)


def _colors(vertex: Columns) -> NDArray[np.uint8] | None:
    for names in (("red", "green", "blue"), ("r", "g", "b"), ("diffuse_red", "diffuse_green", "diffuse_blue")):
        if all(channel in vertex for channel in names):
            columns = [np.asarray(vertex[channel]) for channel in names]
            if all(column.dtype == np.uint8 and column.ndim == 1 for column in columns):
                return _columns(vertex, names)
            values = np.stack(columns, axis=1)
            if values.dtype.kind == "f":
                values = np.rint(np.nan_to_num(values) * 255)
            elif values.dtype.itemsize == 2:
                values = values // 257
            painted: NDArray[np.uint8] = np.clip(values, 0, 255).astype(np.uint8)
            return painted
    return None


def _text(data: bytes, header: Header) -> dict[str, Columns]:
    lines = [line for line in data[header.start :].splitlines() if line.strip()]
    tables: dict[str, Columns] = {}
    done = 0
    for element in header.elements:
        rows = [line.split() for line in lines[done : done + element.count]]
        done += element.count
        if len(rows) < element.count:
            raise ValueError(element.name)
        tables[element.name] = _text_columns(rows, element)
    return tables


def _text_columns(rows: list[list[bytes]], element: Element) -> Columns:
    if not any(item.length for item in element.properties):
        width = len(element.properties)
        # Rows of another length than the width make an array that cannot take the shape.
        table = np.array([row[:width] for row in rows], dtype=object).astype(np.float64).reshape(len(rows), width)
        return {
            item.name: table[:, k].astype(item.kind if item.kind[0] != "f" else "f8")
            for k, item in enumerate(element.properties)
        }
    columns: Columns = {item.name: [] for item in element.properties}
    for row in rows:
        place = 0
        for item in element.properties:
            if item.length is None:
                columns[item.name].append(float(row[place]))
                place += 1
                continue
            count = int(row[place])
            values = row[place + 1 : place + 1 + count]
            if count < 0 or len(values) < count:
                raise ValueError(item.name)
            columns[item.name].append([float(value) if item.kind[0] == "f" else int(float(value)) for value in values])
            place += 1 + count
    return columns


def _binary(data: bytes, header: Header) -> dict[str, Columns]:
    order = "<" if header.form == "binary_little_endian" else ">"
    tables: dict[str, Columns] = {}
    place = header.start
    for element in header.elements:
        columns, place = _even_rows(data, place, element, order)
        if columns is None:
            columns, place = _uneven_rows(data, place, element, order)
        tables[element.name] = columns
    return tables


def _even_rows(data: bytes, place: int, element: Element, order: str) -> tuple[Columns | None, int]:
    """All rows at once, if every list is as long as in the first row."""
    fields: list[tuple[Any, ...]] = []
    at = place
    for k, item in enumerate(element.properties):
        if item.length is None:
            fields.append((f"v{k}", order + item.kind))
            at += int(item.kind[1])
            continue
        count = int(np.frombuffer(data, order + item.length, 1, at)[0]) if element.count else 0
        if count < 0 or count * int(item.kind[1]) > len(data) - at:
            raise ValueError(item.name)
        fields += [(f"n{k}", order + item.length), (f"v{k}", order + item.kind, (count,))]
        at += int(item.length[1]) + count * int(item.kind[1])
    rows_type = np.dtype(fields)
    end = place + element.count * rows_type.itemsize
    lists = any(item.length for item in element.properties)
    if end > len(data):
        if lists:
            return None, place
        raise ValueError(element.name)
    rows = np.frombuffer(data, rows_type, element.count, place)
    for k, item in enumerate(element.properties):
        if item.length is not None and len(rows) and (rows[f"n{k}"] != rows[f"n{k}"][0]).any():
            return None, place
    return {item.name: rows[f"v{k}"] for k, item in enumerate(element.properties)}, end


def _uneven_rows(data: bytes, place: int, element: Element, order: str) -> tuple[Columns, int]:
    columns: Columns = {item.name: [] for item in element.properties}
    for _ in range(element.count):
        for item in element.properties:
            count = 1
            if item.length is not None:
                count = int(np.frombuffer(data, order + item.length, 1, place)[0])
                place += int(item.length[1])
            size = int(item.kind[1])
            if count < 0 or place + count * size > len(data):
                raise ValueError(item.name)
            values = np.frombuffer(data, order + item.kind, count, place).tolist() if count else []
            place += count * size
            columns[item.name].append(values if item.length is not None else values[0])
    return columns, place
