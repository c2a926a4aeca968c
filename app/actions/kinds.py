"""What a file or folder from outside is, told quickly: from names and a few first bytes, without reading it."""

from __future__ import annotations

import itertools
import json
import os
from collections import Counter
from pathlib import Path
from typing import Literal

from app.storage.folder import SUFFIX

Kind = Literal["project", "clip", "mesh", "sequence", "cameras", ""]

VIDEOS = frozenset({".mp4", ".mov", ".avi", ".mkv", ".webm", ".m4v", ".mpg", ".mpeg", ".mts", ".wmv"})
MESHES = frozenset({".ply", ".obj", ".off", ".stl"})
PICTURES = frozenset({".png", ".jpg", ".jpeg", ".bmp", ".tif", ".tiff", ".webp"})
PACKED = frozenset({".npz", ".usd", ".usda", ".usdc"})
GLTF = frozenset({".glb", ".gltf"})
CAMERAS = frozenset({"cameras.bin", "cameras.txt", "transforms.json"})
LOOKED_AT = 2000
"""Names of a folder that are looked at: enough to tell what it is full of."""
JSON_HEAD = 1 << 20
"""Bytes of a GLB's description that are looked at for an animation."""


def kind_of(path: Path) -> Kind:
    """Say what a path may be used as; empty where it is nothing that is known."""
    try:
        if path.is_dir():
            return _folder(path)
        if not path.is_file():
            return ""
    except OSError:
        return ""
    suffix = path.suffix.lower()
    if path.name == "project.json" or suffix == SUFFIX:
        return "project" if path.name == "project.json" else ""
    if path.name in CAMERAS:
        return "cameras"
    if suffix in MESHES:
        return "mesh"
    if suffix in VIDEOS:
        return "clip"
    if suffix in PACKED:
        return "sequence"
    if suffix in GLTF:
        return "sequence" if _animated(path) else "mesh"
    return ""


def _folder(path: Path) -> Kind:
    """A project, cameras of another program, pictures of a clip, or meshes of a sequence: what it is mostly full of."""
    try:
        with os.scandir(path) as entries:
            names = [entry.name for entry in itertools.islice(entries, LOOKED_AT) if not entry.name.startswith(".")]
    except OSError:
        return ""
    if path.suffix == SUFFIX or {"project.json", "autosave.json"} & set(names):
        return "project"
    counts = Counter(os.path.splitext(name)[1].lower() for name in names)  # noqa: PTH122 - a path object each is slow
    meshes = max((counts[suffix] for suffix in MESHES | GLTF), default=0)
    pictures = max((counts[suffix] for suffix in PICTURES), default=0)
    if meshes >= 2 and meshes >= pictures:
        return "sequence"  # pictures beside the meshes are their textures
    if CAMERAS & set(names):
        return "cameras"
    return "clip" if pictures >= 2 else ""


def _animated(path: Path) -> bool:
    """Whether a GLB or glTF says that something in it moves."""
    try:
        with path.open("rb") as file:
            data = file.read(20)
            if data[:4] == b"glTF":
                length = int.from_bytes(data[12:16], "little")
                data = file.read(min(length, JSON_HEAD))
                return b'"animations"' in data
            data += file.read(JSON_HEAD)
        return bool(json.loads(data).get("animations"))
    except (OSError, ValueError, AttributeError):
        return False
