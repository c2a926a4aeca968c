"""A small walker, its base solution and two edits, shared by the tests of propagation."""

from __future__ import annotations

import attrs
import numpy as np
import pytest

from imitation.cameras import CameraPath
from imitation.deformation import Deformer
from imitation.propagation import Base, commit_edit, solve_base
from resources.world import Walk, make_body, make_camera, walk


@attrs.frozen(eq=False)
class Walker:
    """A filmed walk: everything a user would have, and the truth."""

    walk: Walk
    cameras: CameraPath
    tracks: dict[str, np.ndarray]
    deformer: Deformer

    @property
    def rest(self) -> np.ndarray:
        return self.walk.vertices[0]

    @property
    def faces(self) -> np.ndarray:
        return self.walk.body.faces

    @property
    def pairs(self) -> dict[str, int]:
        return self.walk.body.key_vertices

    @property
    def arguments(self) -> tuple:
        return self.rest, self.faces, self.cameras, self.tracks, self.pairs, self.walk.contacts

    def place(self, frame: int, vertex: int) -> np.ndarray:
        """Where a vertex truly is."""
        return self.walk.vertices[frame, vertex]

    def error(self, vertices: np.ndarray, frames: slice | list[int] = slice(None)) -> float:
        """Mean distance from the truth, percent of the diagonal."""
        distance = np.linalg.norm(vertices[frames] - self.walk.vertices[frames], axis=-1)
        return float(100 * distance.mean() / np.linalg.norm(np.ptp(self.rest, axis=0)))


def film(kind: str, frames: int, terrain: str, azimuth: float, *, seed: int, vertices: int = 900, noise: float = 0.0):
    """A walk of a small body and its tracks in a handheld camera."""
    body = make_body(kind, vertices=vertices)
    made = walk(body, frames, terrain, seed=seed)
    cameras = make_camera(made.centre, body.diagonal, azimuth=azimuth, seed=seed)
    random = np.random.default_rng(seed)
    tracks = {
        name: np.stack([cameras[t].project(points[t]) for t in range(frames)]) + noise * random.normal(size=(frames, 2))
        for name, points in made.key_points.items()
    }
    return Walker(made, cameras, tracks, Deformer(made.vertices[0], body.faces))


@pytest.fixture(scope="session")
def walker() -> Walker:
    """A quadruped on stairs, 31 frames."""
    return film("quadruped", 31, "stairs", 50.0, seed=4)


@pytest.fixture(scope="session")
def base(walker: Walker) -> Base:
    """Its base solution."""
    return solve_base(*walker.arguments, deformer=walker.deformer)


@pytest.fixture(scope="session")
def free_vertices(walker: Walker) -> list[int]:
    """Four vertices that are no key points, far from each other and from these."""
    chosen = list(walker.pairs.values())
    for _ in range(4):
        distance = np.linalg.norm(walker.rest[:, None] - walker.rest[chosen], axis=2).min(axis=1)
        chosen.append(int(np.argmax(distance)))
    return chosen[-4:]


@pytest.fixture(scope="session")
def edits(walker: Walker, base: Base, free_vertices: list[int]) -> dict[int, dict[int, np.ndarray]]:
    """Three edited frames: one free vertex in each, another in the last two."""
    moved = {8: free_vertices[:1], 16: free_vertices[:2], 24: free_vertices[1:2]}
    return {
        frame: commit_edit(
            base, frame, {vertex: walker.place(frame, vertex) for vertex in vertices}, deformer=walker.deformer
        )
        for frame, vertices in moved.items()
    }
