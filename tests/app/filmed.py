"""A small project on a clip of the sample world, marked as a user would mark it."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np

from app.formats import write_mesh, write_video
from tests.support.scenes import small_clip

FRAMES = 20
CLICKED = (0, 10, 19)


def write_film(folder: Path) -> tuple[Path, Path, Path]:
    """Write clip.mp4, subject.ply and marks.json; gives their paths."""
    clip = small_clip(FRAMES)
    assert clip.walk is not None
    body = clip.walk.body
    film, mesh, marks = folder / "clip.mp4", folder / "subject.ply", folder / "marks.json"
    write_video(film, clip.frames, clip.fps, quality=12)
    write_mesh(mesh, body.vertices, body.faces)
    tracks, seen, names = clip.tracks(), clip.visibility(), list(body.key_vertices)
    clicked = {
        name: {str(t): tracks[name][t].round(2).tolist() for t in CLICKED if seen[name][t] or t == 0} for name in names
    }
    body_marks = {
        "lassos": {"0": [_box(clip.mask(0))], str(FRAMES - 1): [_box(clip.mask(FRAMES - 1))]},
        "tracks": {
            name: {
                "clicks": clicked[name],
                "contacts": [[first, last] for first, last, _ in clip.walk.contacts.get(name, []) if last > first + 1],
            }
            for name in names
        },
        "characters": {"subject": {"mesh": mesh.name, "up": "z", "pairs": dict(body.key_vertices)}},
    }
    marks.write_text(json.dumps(body_marks, default=lambda value: value.item()))
    return film, mesh, marks


def _box(mask: np.ndarray) -> list[list[float]]:
    rows, columns = np.nonzero(mask)
    left, right, top, bottom = columns.min() - 4, columns.max() + 4, rows.min() - 4, rows.max() + 4
    return [[float(x), float(y)] for x, y in ((left, top), (right, top), (right, bottom), (left, bottom))]
