"""The header of a PLY file: elements and their properties, with counts that the file can hold."""

from __future__ import annotations

import attrs

from imitation.errors import InputError

TYPES = {
    "char": "i1", "int8": "i1", "uchar": "u1", "uint8": "u1", "short": "i2", "int16": "i2", "ushort": "u2",
    "uint16": "u2", "int": "i4", "int32": "i4", "uint": "u4", "uint32": "u4", "float": "f4", "float32": "f4",
    "double": "f8", "float64": "f8",
}  # fmt: skip


@attrs.frozen
class Property:
    """One value, or with ``length`` a list of values preceded by its length."""

    name: str
    kind: str
    length: str | None = None


@attrs.define
class Element:
    """A table of ``count`` rows."""

    name: str
    count: int
    properties: list[Property] = attrs.Factory(list)


@attrs.frozen
class Header:
    """What a PLY file says of itself; its body starts at byte ``start``."""

    form: str
    elements: list[Element]
    start: int


def read_header(data: bytes, name: str) -> Header:
    """Read the header of a PLY file; counts larger than the file can hold are refused before memory is asked for."""
    marker = data.find(b"end_header")
    if not data.startswith(b"ply") or marker < 0:
        raise InputError(f"The file {name} is not a PLY mesh: its header is missing.")
    end = data.find(b"\n", marker)
    start = len(data) if end < 0 else end + 1
    form, elements = "", list[Element]()
    for line in data[:marker].decode("ascii", "replace").splitlines()[1:]:
        words = line.split()
        try:
            match words:
                case ["format", given, *_]:
                    form = given
                case ["element", element, count]:
                    elements.append(Element(element, int(count)))
                case ["property", "list", length, kind, label]:
                    elements[-1].properties.append(Property(label, TYPES[kind], TYPES[length]))
                case ["property", kind, label]:
                    elements[-1].properties.append(Property(label, TYPES[kind]))
                case [] | ["comment" | "obj_info", *_]:
                    pass
                case _:
                    raise ValueError
        except (ValueError, KeyError, IndexError) as error:
            raise InputError(f"The header of the PLY file {name} cannot be understood at {line.strip()!r}.") from error
    if form not in ("ascii", "binary_little_endian", "binary_big_endian"):
        raise InputError(f"The PLY file {name} has the unknown format {form!r}: save it as binary PLY.")
    _check_counts(elements, len(data) - start, form == "ascii", name)
    return Header(form, elements, start)


def _check_counts(elements: list[Element], room: int, text: bool, name: str) -> None:
    for element in elements:
        least = 0
        for item in element.properties:
            least += 2 if text else int((item.length or item.kind)[1])
        # The last value of a text file needs no space after it.
        if element.count < 0 or element.count * max(least, 1) > room + 1:
            raise InputError(
                f"The PLY file {name} promises {element.count} rows of {element.name}, more than it holds: it is "
                "cut off or damaged."
            )
