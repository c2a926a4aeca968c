"""An animated scene of a GLB, frame by frame: moving nodes, morph targets and skins on joints."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import attrs
import numpy as np
from numpy.typing import NDArray

from app.formats.glb import Surface, node_matrix, node_order, node_surfaces
from app.formats.gltf import Gltf
from app.formats.gltf_animation import Animation, read_animation
from app.formats.meshfile import to_int32, y_up_to_z_up
from imitation.errors import InputError

Array = NDArray[np.float64]
MOST = 20_000_000
"""Displaced vertices of all morph targets of a node together, half a gigabyte."""
DAMAGE = (ValueError, KeyError, IndexError, TypeError, AttributeError, OverflowError, MemoryError)
"""What reading a damaged file comes to."""


@attrs.frozen(eq=False)
class Skin:
    """How vertices hang on joints.

    Attributes
    ----------
    nodes : (j,) numbers of the joints' nodes.
    inverse : (j, 4, 4) from the mesh's coordinates to the joint's in rest.
    joints : (n, k) which joints. weights : (n, k), each row's sum 1.
    """

    nodes: NDArray[np.int64]
    inverse: Array
    joints: NDArray[np.int64]
    weights: Array


@attrs.frozen(eq=False)
class Piece:
    """The surfaces of one node: base (n, 3), displacements (t, n, 3) of its morph targets, and its skin, if any."""

    node: int
    base: Array
    targets: Array
    rest_weights: Array
    skin: Skin | None


class PosedGltf:
    """A GLB's scene at each frame of its first animation; nothing is kept between two frames.

    A skinned vertex is at sum of w_j G_j B_j p, with the joints' transforms G_j, inverse bind matrices B_j and the
    morphed place p; any other at G p of its node. Vertices that are equal in place, colour and all that moves them
    are one: exporters cut surfaces at the seams of textures, normals and materials.

    Attributes
    ----------
    gltf : the file. animation : what is played. faces : (m, 3). colors : (v, 3) uint8 sRGB, or None.

    Raises
    ------
    InputError
        No animation, no surface, joints that are not there, key times that do not ascend, a damaged file.
    """

    def __init__(self, gltf: Gltf) -> None:
        self.gltf = gltf
        try:
            animation = read_animation(gltf)
            if animation is None:
                raise InputError(f"The file {gltf.name} has no animation: give one that has, or a folder of PLY files.")
            self.animation: Animation = animation
            self._order = node_order(gltf)
            self._pieces, self._kept, self.faces, self.colors = _pieces(gltf, self._order)
        except InputError:
            raise
        except DAMAGE as error:
            raise InputError(f"The file {gltf.name} is not a whole GLB or glTF file: export it again.") from error

    def __len__(self) -> int:
        return self.animation.count

    def vertices(self, frame: int) -> Array:
        """Places (v, 3) in a frame, Z up; raises ``InputError`` where they are no numbers."""
        try:
            with np.errstate(all="ignore"):
                placed = self._placed(self.animation.seconds(frame))
        except DAMAGE as error:
            raise InputError(f"Frame {frame} of {self.gltf.name} cannot be posed: the file is damaged.") from error
        if not np.isfinite(placed).all():
            raise InputError(f"Frame {frame} of {self.gltf.name} has vertices that are NaN or infinite.")
        return y_up_to_z_up(placed)

    def _placed(self, seconds: float) -> Array:
        matrices, weights = self._pose(seconds)
        places = []
        for piece, kept in zip(self._pieces, self._kept, strict=True):
            shape = piece.base
            for target in np.flatnonzero(by := weights.get(piece.node, piece.rest_weights)):
                shape = shape + by[target] * piece.targets[target]
            placed = (
                _moved(shape, matrices[piece.node]) if piece.skin is None else _skinned(shape, piece.skin, matrices)
            )
            places.append(placed[kept])
        return np.concatenate(places)

    def _pose(self, seconds: float) -> tuple[dict[int, Array], dict[int, Array]]:
        """Matrices of all nodes to the file's world, and morph weights of those that are animated."""
        every = self.gltf.items("nodes")
        local: dict[int, dict[str, Any]] = {}
        weights: dict[int, Array] = {}
        for channel in self.animation.channels:
            value = channel.at(seconds)
            if channel.path == "weights":
                weights[channel.node] = value
                continue
            if channel.node not in local:
                local[channel.node] = {key: each for key, each in every[channel.node].items() if key != "matrix"}
            local[channel.node][channel.path] = value
        matrices: dict[int, Array] = {-1: np.eye(4)}
        for index, parent in self._order:
            matrices[index] = matrices[parent] @ node_matrix(local.get(index, every[index]))
        return matrices, weights


def _moved(places: Array, matrix: Array) -> Array:
    moved: Array = places @ matrix[:3, :3].T + matrix[:3, 3]
    return moved


def _skinned(places: Array, skin: Skin, matrices: dict[int, Array]) -> Array:
    """Linear blend skinning (n, 3)."""
    joints = (np.stack([matrices[int(node)] for node in skin.nodes]) @ skin.inverse)[:, :3].reshape(-1, 12)
    blended = np.zeros((len(places), 12))
    for column in range(skin.joints.shape[1]):
        blended += skin.weights[:, column, None] * joints[skin.joints[:, column]]
    by = blended.reshape(-1, 3, 4)
    moved: Array = np.einsum("nij,nj->ni", by[:, :, :3], places) + by[:, :, 3]
    return moved


def _pieces(
    gltf: Gltf, order: Sequence[tuple[int, int]]
) -> tuple[list[Piece], list[NDArray[np.int64]], NDArray[np.int32], NDArray[np.uint8] | None]:
    """What is drawn, which of each piece's vertices stay when equal ones are one, faces and colours of all."""
    every = gltf.items("nodes")
    pieces, kept, faces, colors = [], [], [], []
    start, coloured = 0, False
    matrices: dict[int, Array] = {-1: np.eye(4)}
    for index, parent in order:
        matrices[index] = matrices[parent] @ node_matrix(every[index])
        surfaces = node_surfaces(gltf, every[index], matrices[index])
        if not surfaces:
            continue
        piece = _piece(gltf, index, surfaces)
        coloured |= any(surface.colors is not None for surface in surfaces)
        colour = np.concatenate([_colours(surface) for surface in surfaces])
        first, number = _sewn(piece, colour)
        offset = 0
        for surface in surfaces:
            faces += [number[part + offset] + start for _, part in surface.parts]
            offset += len(surface.vertices)
        pieces.append(piece)
        kept.append(first)
        colors.append(colour[first])
        start += len(first)
    if not sum(map(len, faces)):
        raise InputError(f"The file {gltf.name} has no faces: give a surface that moves.")
    return pieces, kept, to_int32(np.concatenate(faces), gltf.name), np.concatenate(colors) if coloured else None


def _colours(surface: Surface) -> NDArray[np.uint8]:
    return np.full((len(surface.vertices), 3), 255, np.uint8) if surface.colors is None else surface.colors


def _piece(gltf: Gltf, index: int, surfaces: list[Surface]) -> Piece:
    node = gltf.items("nodes")[index]
    primitives = [surface.parts[0][0] for surface in surfaces]
    base = [gltf.accessor(each["attributes"]["POSITION"]).astype(np.float64) for each in primitives]
    counts = {len(each.get("targets", ())) for each in primitives}
    if len(counts) != 1:
        raise ValueError("morph targets")
    number = counts.pop()
    if number * sum(map(len, base)) > MOST:
        raise InputError(f"The file {gltf.name} has more morph targets than can be held: give a folder of PLY files.")
    targets = [
        np.concatenate([_target(gltf, each["targets"][k], len(b)) for each, b in zip(primitives, base, strict=True)])
        for k in range(number)
    ]
    whole = np.concatenate(base)
    rest = node.get("weights", gltf.items("meshes")[node["mesh"]].get("weights", np.zeros(number)))
    skin = _skin(gltf, gltf.items("skins")[node["skin"]], primitives, base) if "skin" in node else None
    stacked = np.array(targets).reshape(number, len(whole), 3)
    return Piece(index, whole, stacked, np.array(rest, np.float64).reshape(number), skin)


def _target(gltf: Gltf, target: dict[str, Any], count: int) -> Array:
    if "POSITION" not in target:
        return np.zeros((count, 3))
    return gltf.accessor(target["POSITION"]).astype(np.float64).reshape(count, 3)


def _skin(gltf: Gltf, entry: dict[str, Any], primitives: list[dict[str, Any]], base: list[Array]) -> Skin:
    nodes = np.array(entry["joints"], np.int64).reshape(-1)
    inverse = np.tile(np.eye(4), (len(nodes), 1, 1))
    if "inverseBindMatrices" in entry:
        inverse = gltf.accessor(entry["inverseBindMatrices"]).astype(np.float64)[: len(nodes)]
        inverse = inverse.reshape(len(nodes), 4, 4).transpose(0, 2, 1)
    found = [_influences(gltf, each["attributes"], len(b)) for each, b in zip(primitives, base, strict=True)]
    width = max(joints.shape[1] for joints, _ in found)
    joints = np.concatenate([np.pad(each, ((0, 0), (0, width - each.shape[1]))) for each, _ in found])
    weights = np.concatenate([np.pad(each, ((0, 0), (0, width - each.shape[1]))) for _, each in found])
    if not len(nodes) or joints.max() >= len(nodes) or nodes.min() < 0 or nodes.max() >= len(gltf.items("nodes")):
        raise InputError(f"The file {gltf.name} hangs vertices on joints that are not there: export it again.")
    if not np.isfinite(weights).all() or (weights < 0).any():
        raise InputError(f"The file {gltf.name} has skin weights that are negative or no numbers: export it again.")
    # A vertex without weights hangs on its first joint, as viewers have it.
    weights[weights.sum(axis=1) <= 0, 0] = 1.0
    return Skin(nodes, inverse, joints, weights / weights.sum(axis=1, keepdims=True))


def _influences(gltf: Gltf, attributes: dict[str, int], count: int) -> tuple[NDArray[np.int64], Array]:
    """Joints and weights (n, 4 k) of a primitive."""
    joints: list[NDArray[np.int64]] = []
    weights: list[Array] = []
    while f"JOINTS_{len(joints)}" in attributes:
        number = len(joints)
        joints.append(gltf.accessor(attributes[f"JOINTS_{number}"]).astype(np.int64).reshape(count, 4))
        weights.append(gltf.accessor(attributes[f"WEIGHTS_{number}"]).astype(np.float64).reshape(count, 4))
    if not joints:
        raise InputError(f"The file {gltf.name} has a skin, but its vertices have no joints: export it again.")
    stacked, by = np.concatenate(joints, axis=1), np.concatenate(weights, axis=1)
    # What has no weight may name any joint.
    return np.where(by != 0, stacked, 0), by


def _sewn(piece: Piece, colors: NDArray[np.uint8]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Which vertices stay, in the order of the file, and the new number of each."""
    rows = [piece.base, *piece.targets, colors.astype(np.float64)]
    if piece.skin is not None:
        rows += [piece.skin.joints.astype(np.float64), piece.skin.weights]
    table = np.ascontiguousarray(np.concatenate(rows, axis=1) + 0.0)
    keys = table.view(np.dtype((np.void, table.dtype.itemsize * table.shape[1]))).reshape(-1)
    _, first, number = np.unique(keys, return_index=True, return_inverse=True)
    rank = np.argsort(np.argsort(first))
    return np.sort(first), rank[number.reshape(-1)]
