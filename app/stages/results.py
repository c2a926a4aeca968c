"""Results that stages hand on where no engine type fits."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import attrs
import numpy as np
from numpy.typing import NDArray

from imitation import Camera, CameraPath

Array = NDArray[np.float64]


@attrs.frozen(eq=False)
class Masks(Sequence[NDArray[np.bool_]]):
    """The subject's mask in every frame, one bit a pixel.

    Attributes
    ----------
    bits : (n, ceil(h * w / 8)) uint8. height, width : of the picture.
    """

    bits: NDArray[np.uint8]
    height: int
    width: int

    @classmethod
    def pack(cls, masks: NDArray[np.bool_]) -> Masks:
        """Pack masks (n, h, w)."""
        count, height, width = masks.shape
        return cls(np.packbits(masks.reshape(count, -1), axis=1), height, width)

    def __len__(self) -> int:
        return len(self.bits)

    def __getitem__(self, frame: int) -> NDArray[np.bool_]:  # type: ignore[override]
        flat = np.unpackbits(self.bits[frame], count=self.height * self.width)
        return flat.view(np.bool_).reshape(self.height, self.width)


@attrs.frozen(eq=False)
class World:
    """The scene in the user's world: Z up, metres where the scale is known.

    Attributes
    ----------
    cameras : the camera path in this world.
    scale, rotation, translation : from the camera solution's own units to this world.
    normal, offset : the ground plane ``normal . x = offset`` in this world, normal up.
    metric : whether lengths are metres. levelled : whether up is known. grounded : whether the plane was found.
    depth : camera z of the subject where no ground is known, None otherwise.
    note : one sentence that says how ground, up and scale were found, and what is unknown.
    """

    cameras: CameraPath
    scale: float
    rotation: Array
    translation: Array
    normal: Array
    offset: float
    metric: bool
    levelled: bool
    grounded: bool
    depth: float | None
    note: str

    def camera(self, frame: int) -> Camera:
        """Give one frame's camera."""
        return self.cameras[frame]


@attrs.frozen(eq=False)
class PlacedContact:
    """A contact with its place.

    Attributes
    ----------
    first, last : frames, both included. place : (3,) world. ground : how it was found.
    residual : distance of the ground's points from the fitted ground, world units, NaN where there is none.
    support : share of the recovered points nearby that speak for the ground; 1 where it does not rest on points.
    """

    first: int
    last: int
    place: Array
    ground: str
    residual: float
    support: float = 1.0


@attrs.frozen(eq=False)
class AlignedCharacter:
    """A character as it stands on the subject in the first frame.

    Attributes
    ----------
    vertices : (v, 3) world. faces : (m, 3).
    scale, rotation, translation : from the mesh file to the world.
    note : one sentence on how well the pairs fit, empty where nothing is to be said.
    """

    vertices: Array
    faces: NDArray[np.int32]
    scale: float
    rotation: Array
    translation: Array
    note: str


@attrs.frozen(eq=False)
class Animation:
    """A character's motion.

    Attributes
    ----------
    vertices : (n, v, 3) world. key_points : (n, k, 3) places of the paired vertices, in the order of ``tracks``.
    tracks : ids of the paired tracks.
    report : the statistics of paper A, Table 1, as plain values.
    """

    vertices: Array
    key_points: Array
    tracks: tuple[str, ...]
    report: dict[str, Any]

    def __len__(self) -> int:
        return len(self.vertices)
