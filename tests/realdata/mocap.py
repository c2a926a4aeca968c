"""Motion capture driving the generator's body: BVH read, joints by name, capsules, a mesh of its own a frame."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import attrs
import numpy as np

from resources.performer import body_capsules, body_mesh

Mesh = tuple[np.ndarray, np.ndarray, np.ndarray]
SIDES = ("L", "R")
LIMBS = ("UpperArm", "LowerArm", "Hand", "UpperLeg", "LowerLeg", "Foot", "Toes")


@attrs.frozen(eq=False)
class Mocap:
    """Joints (n, 17, 3) of the generator's body, metres, z up, the lowest point at 0, and the frame rate."""

    name: str
    joints: np.ndarray
    fps: float

    def __len__(self) -> int:
        return len(self.joints)

    def mesh(self, frame: int) -> Mesh:
        """Vertices, faces, colours of a frame, meshed on a grid of its own."""
        offset = np.random.default_rng([len(self), frame]).random(3)
        return body_mesh(body_capsules(self.joints[frame]), cell=0.028, offset=offset)

    def meshes(self) -> Iterator[tuple[np.ndarray, np.ndarray]]:
        """Vertices and faces of every frame."""
        for frame in range(len(self)):
            yield self.mesh(frame)[:2]


def read_bvh(path: Path) -> tuple[dict[str, np.ndarray], float]:
    """World positions (n, 3) of every named joint as the file has them, and the frame rate."""
    head, _, body = path.read_text().partition("MOTION")
    names: list[str] = []
    parents: list[int] = []
    offsets: list[list[float]] = []
    channels: list[list[str]] = []
    stack: list[int] = []
    inside_end = False
    for line in head.splitlines():
        words = line.split()
        if not words:
            continue
        if words[0] in ("ROOT", "JOINT"):
            names.append(words[1])
            parents.append(stack[-1] if stack else -1)
        elif words[0] == "End":
            inside_end = True
        elif words[0] == "{" and not inside_end:
            stack.append(len(names) - 1)
        elif words[0] == "}":
            if inside_end:
                inside_end = False
            else:
                stack.pop()
        elif words[0] == "OFFSET" and not inside_end:
            offsets.append([float(word) for word in words[1:4]])
        elif words[0] == "CHANNELS":
            channels.append(words[2:])
    rows = body.strip().splitlines()
    count, step = int(rows[0].split()[1]), float(rows[1].split()[2])
    table = np.array([[float(word) for word in row.split()] for row in rows[2 : 2 + count]])
    places: list[np.ndarray] = []
    turns: list[np.ndarray] = []
    at = 0
    for number, parent in enumerate(parents):
        place = np.tile(np.array(offsets[number]), (count, 1))
        turn = np.tile(np.eye(3), (count, 1, 1))
        if any("position" in channel for channel in channels[number]):
            place = np.zeros((count, 3))
        for channel in channels[number]:
            axis = "XYZ".index(channel[0])
            if "position" in channel:
                place[:, axis] += table[:, at]
            else:
                turn = turn @ _turns(axis, np.radians(table[:, at]))
            at += 1
        if parent < 0:
            places.append(place)
            turns.append(turn)
        else:
            places.append(places[parent] + np.einsum("nij,nj->ni", turns[parent], place))
            turns.append(turns[parent] @ turn)
    return dict(zip(names, places, strict=True)), 1.0 / step


def _turns(axis: int, angles: np.ndarray) -> np.ndarray:
    c, s = np.cos(angles), np.sin(angles)
    turn = np.tile(np.eye(3), (len(angles), 1, 1))
    a, b = (axis + 1) % 3, (axis + 2) % 3
    turn[:, a, a], turn[:, a, b], turn[:, b, a], turn[:, b, b] = c, -s, s, c
    return turn


def performed(path: Path) -> Mocap:
    """A take of the database with joints named UpperArm_L and so on (y up, centimetres) on the generator's body."""
    found, fps = read_bvh(path)
    at = {name: np.stack([p[:, 0], -p[:, 2], p[:, 1]], axis=1) / 100.0 for name, p in found.items()}
    joints = np.zeros((len(at["Hips"]), 17, 3))
    joints[:, 0] = 0.5 * (at["UpperLeg_L"] + at["UpperLeg_R"])
    joints[:, 1] = 0.5 * (at["UpperArm_L"] + at["UpperArm_R"])
    neck = at["Head"] - joints[:, 1]
    joints[:, 2] = joints[:, 1] + 0.24 * neck / np.linalg.norm(neck, axis=1, keepdims=True)
    for side, letter in enumerate(SIDES):
        for k, limb in enumerate(LIMBS):
            joints[:, 3 + 7 * side + k] = at[f"{limb}_{letter}"]
    joints[:, :, 2] -= joints[:, [8, 9, 15, 16], 2].min() - 0.035
    return Mocap(path.stem, joints, fps)
