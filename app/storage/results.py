"""Results on disk: nested values of arrays, one folder a key. No pickles: opening a stranger's project runs no code."""

from __future__ import annotations

import importlib
import json
import os
import shutil
import time
from pathlib import Path
from typing import Any
from urllib.parse import quote

import attrs
import numpy as np

from app.formats.atomic import explained

MAPPED = 1 << 22
"""Bytes from which on a file is mapped and not read."""
ABANDONED = 600.0
"""Seconds after which a half-written result is nobody's any more: its writer was killed."""
_TRUSTED = ("imitation.", "tvmedit.", "app.")


class ResultStore:
    """Reads and writes results by key; large arrays come back memory-mapped."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def __contains__(self, key: str) -> bool:
        return (self._at(key) / "value.json").is_file()

    def knows(self, name: str) -> bool:
        """Whether a result of this name was ever stored, under whatever key."""
        return self._mark(name).is_file()

    def sweep(self) -> None:
        """Remove what a killed process left half written."""
        for part in self.folder.glob("*/.*.part"):
            if time.time() - part.stat().st_mtime > ABANDONED:
                shutil.rmtree(part, ignore_errors=True)

    def save(self, key: str, value: Any, name: str = "") -> None:
        """Write a result; a result that is there already is left alone, for the same key means the same bits."""
        final = self._at(key)
        if name and not self.knows(name):
            with explained(final):
                self._mark(name).parent.mkdir(parents=True, exist_ok=True)
                self._mark(name).touch()
        if key in self:
            return
        beside = final.with_name(f".{final.name}.{os.getpid()}.part")
        try:
            with explained(final):
                shutil.rmtree(beside, ignore_errors=True)
                beside.mkdir(parents=True)
                arrays: list[np.ndarray[Any, Any]] = []
                body = _encode(value, arrays)
                for index, array in enumerate(arrays):
                    np.save(beside / f"{index}.npy", array, allow_pickle=False)
                (beside / "value.json").write_text(json.dumps(body))
                shutil.rmtree(final, ignore_errors=True)
                beside.rename(final)
        finally:
            shutil.rmtree(beside, ignore_errors=True)

    def load(self, key: str) -> Any:
        """Read a result; raises ``KeyError`` when it is not there or damaged."""
        folder = self._at(key)
        try:
            body = json.loads((folder / "value.json").read_text())
            return _decode(body, folder)
        except (OSError, ValueError, TypeError, AttributeError, ImportError) as error:
            raise KeyError(key) from error

    def share(self, other: ResultStore) -> None:
        """Take the results of another store without copying them: a result is never written again under its key.

        Where the file system cannot give one file two names they are left out, and computed again when wanted.
        """
        for source in other.folder.glob("*/*"):
            if source.name.startswith("."):
                continue
            target = self.folder / source.relative_to(other.folder)
            if source.is_dir() and not target.exists():
                beside = target.with_name(f".{target.name}.{os.getpid()}.part")
                try:
                    shutil.copytree(source, beside, copy_function=os.link)
                    beside.rename(target)
                except OSError:
                    shutil.rmtree(beside, ignore_errors=True)
                    return
            elif source.is_file() and source.parent.name == "names":
                target.parent.mkdir(parents=True, exist_ok=True)
                target.touch()

    def size(self) -> int:
        """Bytes of all results."""
        return sum(file.stat().st_size for file in self.folder.rglob("*") if file.is_file())

    def clear(self) -> None:
        """Delete all results; they can be computed again."""
        shutil.rmtree(self.folder, ignore_errors=True)

    def _mark(self, name: str) -> Path:
        return self.folder / "names" / quote(name, safe="")

    def _at(self, key: str) -> Path:
        return self.folder / key[:2] / key


def _encode(value: Any, arrays: list[np.ndarray[Any, Any]]) -> Any:
    if value is None or isinstance(value, bool | int | str):
        return value
    if isinstance(value, float):
        return {"float": repr(value)}
    if isinstance(value, np.ndarray):
        arrays.append(value)
        return {"array": len(arrays) - 1}
    if isinstance(value, np.generic):
        return _encode(value.item(), arrays)
    if isinstance(value, tuple):
        return {"tuple": [_encode(item, arrays) for item in value]}
    if isinstance(value, list):
        return {"list": [_encode(item, arrays) for item in value]}
    if isinstance(value, dict):
        return {"dict": [[_encode(key, arrays), _encode(item, arrays)] for key, item in value.items()]}
    kind = type(value)
    name = f"{kind.__module__}:{kind.__qualname__}"
    if attrs.has(kind) and name.startswith(_TRUSTED):
        fields = {field.name: _encode(getattr(value, field.name), arrays) for field in attrs.fields(kind)}
        return {"class": name, "fields": fields}
    raise TypeError(f"a result of type {name} cannot be stored")


def _decode(body: Any, folder: Path) -> Any:
    if not isinstance(body, dict):
        return body
    if "float" in body:
        return float(body["float"])
    if "array" in body:
        path = folder / f"{int(body['array'])}.npy"
        if path.stat().st_size >= MAPPED:
            return np.load(path, mmap_mode="r", allow_pickle=False)
        array = np.load(path, allow_pickle=False)
        array.setflags(write=False)
        return array
    if "tuple" in body:
        return tuple(_decode(item, folder) for item in body["tuple"])
    if "list" in body:
        return [_decode(item, folder) for item in body["list"]]
    if "dict" in body:
        return {_decode(key, folder): _decode(item, folder) for key, item in body["dict"]}
    name: str = body["class"]
    if not name.startswith(_TRUSTED):
        raise ValueError(f"{name} is not a result of this program")
    module, _, qualified = name.partition(":")
    kind: Any = importlib.import_module(module)
    for part in qualified.split("."):
        kind = getattr(kind, part)
    if not attrs.has(kind):
        raise ValueError(f"{name} is not a result of this program")
    fields = {field: _decode(item, folder) for field, item in body["fields"].items()}
    aliases = {field.name: field.alias or field.name for field in attrs.fields(kind)}
    return kind(**{aliases[field]: item for field, item in fields.items()})
