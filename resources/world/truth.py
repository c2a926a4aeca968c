"""The truth of the sample in one small file: cameras, bodies and the motions of their bones, from which all follows."""

from __future__ import annotations

from pathlib import Path

import attrs
import numpy as np
from numpy.typing import NDArray

from imitation.cameras.path import CameraPath
from resources.world.body import Body
from resources.world.gait import Interval, Walk
from resources.world.skeleton import Array

Ints = NDArray[np.int32]


@attrs.frozen(eq=False)
class Moving:
    """A body and its motion.

    Attributes
    ----------
    rest : (v, 3) vertices in the rest pose. faces : (m, 3). bones : (v, 4) and shares : (v, 4), the skin.
    rotations : (n, b, 3, 3), translations : (n, b, 3), the motion of each bone from the rest pose, world metres.
    key_vertices : name -> vertex, the 16 key points. extra_vertices : further named points.
    contacts : key point of a sole -> [(first, last, place (3,))].
    """

    rest: Array
    faces: Ints
    bones: Ints
    shares: Array
    rotations: Array
    translations: Array
    key_vertices: dict[str, int]
    extra_vertices: dict[str, int]
    contacts: dict[str, list[Interval]]

    def __len__(self) -> int:
        return len(self.rotations)

    def vertices(self, frame: int) -> Array:
        """World vertices (v, 3) in a frame."""
        R, t = self.rotations[frame], self.translations[frame]
        posed = np.zeros_like(self.rest)
        for k in range(self.bones.shape[1]):
            bone = self.bones[:, k]
            posed += self.shares[:, k, None] * (np.einsum("vij,vj->vi", R[bone], self.rest) + t[bone])
        return posed

    def sequence(self) -> Array:
        """World vertices (n, v, 3) in all frames."""
        return np.stack([self.vertices(t) for t in range(len(self))])

    def points(self, names: dict[str, int] | None = None) -> dict[str, Array]:
        """World tracks (n, 3) of the key points, or of the vertices named."""
        names = self.key_vertices if names is None else names
        sequence = self.sequence()
        return {name: sequence[:, vertex].copy() for name, vertex in names.items()}


@attrs.frozen(eq=False)
class Truth:
    """All that is true of the sample clip.

    Attributes
    ----------
    cameras : the true path. movers : "subject" and each character, who walk in the same footsteps.
    visible : name -> (n,) whether a key or extra point of the subject is in the picture and not hidden.
    """

    cameras: CameraPath
    movers: dict[str, Moving]
    visible: dict[str, NDArray[np.bool_]]


def moving(walk: Walk) -> Moving:
    """What a walk is made of, in the precision of the file, so that what is stored and what is rendered are one."""
    body = walk.body
    order = np.argsort(-body.weights, axis=1, kind="stable")[:, :4].astype(np.int32)
    shares = np.take_along_axis(body.weights, order, axis=1).astype(np.float32).astype(np.float64)
    return Moving(
        body.vertices.astype(np.float32).astype(np.float64),
        body.faces,
        order,
        shares / shares.sum(axis=1, keepdims=True),
        walk.rotations,
        walk.translations,
        body.key_vertices,
        extra_vertices(body),
        walk.contacts,
    )


def extra_vertices(body: Body) -> dict[str, int]:
    """The vertex nearest to each of the further named points of a body."""
    places = body.skeleton.extras
    return {name: int(np.argmin(np.sum((body.vertices - at) ** 2, axis=1))) for name, at in places.items()}


def save(path: Path, truth: Truth) -> None:
    """Write the truth as one compressed file of plain arrays."""
    arrays: dict[str, object] = {f"camera {name}": getattr(truth.cameras, name) for name in "KRT"}
    arrays["movers"] = np.array(list(truth.movers))
    for mover, of in truth.movers.items():
        arrays |= {
            f"{mover} rest": of.rest.astype(np.float32),
            f"{mover} faces": of.faces.astype(np.uint16),
            f"{mover} bones": of.bones.astype(np.uint8),
            f"{mover} shares": of.shares.astype(np.float32),
            f"{mover} rotations": of.rotations,
            f"{mover} translations": of.translations,
            f"{mover} key names": np.array(list(of.key_vertices)),
            f"{mover} key vertices": np.array(list(of.key_vertices.values()), np.int32),
            f"{mover} extra names": np.array(list(of.extra_vertices)),
            f"{mover} extra vertices": np.array(list(of.extra_vertices.values()), np.int32),
        }
        spans = [(name, *span) for name, found in of.contacts.items() for span in found]
        arrays[f"{mover} contact names"] = np.array([name for name, *_ in spans])
        arrays[f"{mover} contact frames"] = np.array([[first, last] for _, first, last, _ in spans], np.int32)
        arrays[f"{mover} contact places"] = np.array([place for *_, place in spans])
    arrays["visible names"] = np.array(list(truth.visible))
    arrays["visible"] = np.stack(list(truth.visible.values()))
    np.savez_compressed(path, **arrays)  # type: ignore[arg-type]


def load(path: Path) -> Truth:
    """Read what ``save`` wrote."""
    with np.load(path) as file:
        cameras = CameraPath(K=file["camera K"], R=file["camera R"], T=file["camera T"])
        movers = {}
        for mover in map(str, file["movers"]):
            part = {key[len(mover) + 1 :]: file[key] for key in file.files if key.startswith(mover + " ")}
            contacts: dict[str, list[Interval]] = {}
            rows = zip(part["contact names"], part["contact frames"], part["contact places"], strict=True)
            for name, (first, last), place in rows:
                contacts.setdefault(str(name), []).append((int(first), int(last), place))
            shares = part["shares"].astype(np.float64)
            movers[mover] = Moving(
                part["rest"].astype(np.float64),
                part["faces"].astype(np.int32),
                part["bones"].astype(np.int32),
                shares / shares.sum(axis=1, keepdims=True),
                part["rotations"],
                part["translations"],
                {str(n): int(v) for n, v in zip(part["key names"], part["key vertices"], strict=True)},
                {str(n): int(v) for n, v in zip(part["extra names"], part["extra vertices"], strict=True)},
                contacts,
            )
        visible = {str(name): row for name, row in zip(file["visible names"], file["visible"], strict=True)}
    return Truth(cameras, movers, visible)
