"""The built-in sample: a clip of a hound that climbs stairs, what a user would mark on it, and its exact truth.

``load()`` reads the files in ``resources/sample``; ``python -m resources.world`` makes them again. Nothing here needs
the packages that only the making does.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from fractions import Fraction
from functools import cached_property
from pathlib import Path
from typing import Any

import attrs
import numpy as np
from numpy.typing import NDArray

from imitation.cameras.path import CameraPath
from imitation.errors import InputError
from resources.world import ply, truth
from resources.world.skeleton import Array
from resources.world.truth import Moving, Truth

FOLDER = Path(__file__).resolve().parent.parent / "sample"


@attrs.frozen(eq=False)
class Character:
    """A mesh that the motion is put on.

    Attributes
    ----------
    path : its PLY file. vertices : (v, 3), faces : (m, 3), colours : (v, 3) uint8, as in the file.
    pairs : track name -> vertex.
    scale, rotation, translation : from the file to the world, so that it stands on the subject in frame 0.
    moving : its true motion in the subject's footsteps; in frame 0 it is exactly the aligned file.
    """

    name: str
    path: Path
    vertices: Array
    faces: NDArray[np.int32]
    colours: NDArray[np.uint8]
    pairs: dict[str, int]
    scale: float
    rotation: Array
    translation: Array
    moving: Moving

    @property
    def aligned(self) -> Array:
        """The character on the subject in frame 0, (v, 3), world."""
        placed: Array = self.scale * self.vertices @ self.rotation.T + self.translation
        return placed


@attrs.define(eq=False, slots=False)
class Sample:
    """The sample clip, the user's marks on it, and the truth.

    Attributes
    ----------
    video : path of clip.mp4. fps : exact. size : (width, height).
    clicks : track -> {frame: (x, y)}. lassos : frame -> closed line [(x, y), ...] round the subject.
    contacts : track -> [(first, last), ...], marked, frames both included.
    length : two clicked points in frame 0 and their known distance: ((x, y), (x, y), metres).
    truth : cameras, bodies, visibility. characters : name -> Character.
    """

    video: Path
    fps: Fraction
    size: tuple[int, int]
    clicks: dict[str, dict[int, tuple[float, float]]]
    lassos: dict[int, list[tuple[float, float]]]
    contacts: dict[str, list[tuple[int, int]]]
    length: tuple[tuple[float, float], tuple[float, float], float]
    truth: Truth
    characters: dict[str, Character]

    def __len__(self) -> int:
        return len(self.truth.cameras)

    @property
    def cameras(self) -> CameraPath:
        """The true cameras."""
        return self.truth.cameras

    @property
    def subject(self) -> Moving:
        """The filmed hound."""
        return self.truth.movers["subject"]

    def frames(self) -> Iterator[NDArray[np.uint8]]:
        """Decode the clip: (h, w, 3) uint8 RGB, one after another."""
        import av

        with av.open(str(self.video)) as container:
            for picture in container.decode(video=0):
                yield picture.to_ndarray(format="rgb24")

    def tracks(self) -> dict[str, Array]:
        """True pixels (n, 2) of every point that the clicks name, hidden or not."""
        names = self.subject.key_vertices | self.subject.extra_vertices
        points = self.subject.points({name: names[name] for name in self.clicks})
        return {
            name: np.stack([self.cameras[t].project(track[t]) for t in range(len(track))])
            for name, track in points.items()
        }

    def world_contacts(self) -> dict[str, list[tuple[int, int, Array]]]:
        """The marked contacts with the true places (3,) of the subject's soles."""
        track = self.subject.points({name: self.subject.key_vertices[name] for name in self.contacts})
        return {n: [(a, b, track[n][(a + b) // 2]) for a, b in spans] for n, spans in self.contacts.items()}

    @cached_property
    def _stage(self) -> Any:
        from resources.world.render import Look, Stage
        from resources.world.scene import garden
        from resources.world.terrain import STAIRS

        return Stage(garden(STAIRS), None, Look(size=self.size, sky=1))

    def depth(self, frame: int) -> Array:
        """Exact camera z (h, w) of the background, NaN in the sky; drawn on request."""
        depth: Array = self._stage.depth(frame, self.cameras[frame])
        return depth


def load(folder: Path = FOLDER) -> Sample:
    """Read the sample; raises InputError where its files are not there."""
    marks = folder / "sample.json"
    if not marks.is_file():
        raise InputError(f"The sample is not in {folder}: make it with `python -m resources.world`.")
    data = json.loads(marks.read_text())
    true = truth.load(folder / "truth.npz")
    characters = {}
    for name, of in data["characters"].items():
        path = folder / of["file"]
        vertices, faces, colours = ply.read(path)
        characters[name] = Character(
            name, path, vertices, faces, colours, of["pairs"],
            of["scale"], np.array(of["rotation"]), np.array(of["translation"]), true.movers[name],
        )  # fmt: skip
    (ax, ay), (bx, by), metres = data["length"]
    return Sample(
        folder / data["clip"],
        Fraction(data["fps"]),
        (data["size"][0], data["size"][1]),
        {name: {int(t): (x, y) for t, (x, y) in of.items()} for name, of in data["clicks"].items()},
        {int(t): [(x, y) for x, y in line] for t, line in data["lassos"].items()},
        {name: [(a, b) for a, b in spans] for name, spans in data["contacts"].items()},
        ((ax, ay), (bx, by), metres),
        true,
        characters,
    )
