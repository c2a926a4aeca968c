"""Alignment: scale, orientation and position of the character on the subject in the first frame (paper A, 3.3)."""

from __future__ import annotations

from collections.abc import Mapping

import attrs
import numpy as np
from numpy.typing import ArrayLike

from imitation.errors import InputError, NoSolution
from imitation.geometry.projection import Camera
from imitation.motion.banded import Array

KNOWN = 1e4
"""Pixels that a known size counts against, for its whole logarithm: it gives way to nothing."""


@attrs.frozen(eq=False)
class Similarity:
    """``X' = scale * rotation @ X + translation``.

    Attributes
    ----------
    scale : factor of all lengths.
    rotation : (3, 3).
    translation : (3,) world units.
    residuals : name -> distance of the fitted vertex from its pixel, pixels, or from its place, world units.
    """

    scale: float
    rotation: Array
    translation: Array
    residuals: Mapping[str, float] = attrs.field(factory=dict)

    def apply(self, points: ArrayLike) -> Array:
        """Move points (..., 3)."""
        moved: Array = self.scale * np.asarray(points, np.float64) @ self.rotation.T + self.translation
        return moved

    def then(self, scale: float, rotation: ArrayLike, translation: ArrayLike, *, about: ArrayLike) -> Similarity:
        """Manual values on top: turned and scaled about a world point (3,), then shifted by (3,)."""
        rotation, about = np.asarray(rotation, np.float64), np.asarray(about, np.float64)
        shifted = scale * rotation @ (self.translation - about) + about + np.asarray(translation, np.float64)
        return Similarity(self.scale * scale, rotation @ self.rotation, shifted, self.residuals)


def align_character(
    vertices: ArrayLike,
    pairs: Mapping[str, int],
    camera: Camera,
    pixels: Mapping[str, ArrayLike],
    places: Mapping[str, ArrayLike] | None = None,
    *,
    ground: tuple[ArrayLike, float] | None = None,
    up: ArrayLike | None = None,
    character_up: ArrayLike = (0.0, 0.0, 1.0),
    depth: float | None = None,
    scale: float | None = None,
) -> Similarity:
    """Fit a character to the subject of the first frame.

    Parameters
    ----------
    vertices : (v, 3) the character in its own frame.
    pairs : track name -> vertex.
    camera : of frame 0.
    pixels : track name -> (2,) pixel in frame 0.
    places : track name -> (3,) world place of tracks that are in contact in frame 0.
    ground : (normal (3,), offset) of the plane ``normal . X = offset`` that the character stands on; it gives the
        scale where no track is in contact.
    up : world direction (3,); where given, the character stands upright and is only turned about it. Default the
        ground's normal.
    character_up : the character's own up (3,).
    depth : camera z of the character's middle where neither ground nor contacts are known.
    scale : the size where it is known from another frame; then the picture gives the depth, and the character may be in
        the air.

    Returns
    -------
    Similarity
        From the character's frame to the world, with the residual of each pair.

    Raises
    ------
    InputError
        Fewer than three pairs, a vertex that does not exist, or nothing that says how large the character is.
    NoSolution
        No pose puts the character in front of the camera.
    """
    vertices = np.asarray(vertices, np.float64)
    names, targets = _observations(vertices, pairs, pixels, places or {})
    if ground is not None and up is None:
        up = ground[0]
    if scale is not None and not scale > 0:
        raise InputError(f"The character's scale must be positive, but is {scale}.")
    if not targets.size_known and ground is None and depth is None and scale is None:
        raise InputError(
            "The pairs leave the character's size open; mark a contact in frame 0, give the ground or a depth."
        )
    fit = _Fit(vertices, names, pairs, camera, targets, ground, depth, scale)
    best: tuple[float, Array, Array, Array | None] | None = None
    for start, axis in _starting_rotations(up, np.asarray(character_up, np.float64)):
        solved = fit.solve(start, axis)
        if solved is not None and (best is None or solved[0] < best[0]):
            best = (*solved, start, axis)
    if best is None:
        raise NoSolution("No pose puts the character in front of the camera; check the pairs and the first camera.")
    return fit.similarity(*best[1:])


@attrs.frozen(eq=False)
class _Targets:
    """Pixels (k, 2) and places (k, 3) of the pairs, NaN where not given."""

    pixels: Array
    places: Array

    @property
    def size_known(self) -> bool:
        """Whether a place in the world pins the depth."""
        return bool(np.isfinite(self.places).all(axis=1).any())


class _Fit:
    """Least squares over log scale, a rotation vector (or a turn about ``up``) and the translation."""

    def __init__(
        self,
        vertices: Array,
        names: list[str],
        pairs: Mapping[str, int],
        camera: Camera,
        targets: _Targets,
        ground: tuple[ArrayLike, float] | None,
        depth: float | None,
        scale: float | None,
    ) -> None:
        self.vertices, self.names, self.camera, self.targets = vertices, names, camera, targets
        self.points = vertices[[pairs[name] for name in names]]
        self.centre = self.points.mean(axis=0)
        self.size = float(np.linalg.norm(np.ptp(vertices, axis=0)))
        self.ground = None if ground is None else (np.asarray(ground[0], np.float64), float(ground[1]))
        self.depth, self.scale = depth, scale
        self.focal = float(np.sqrt(camera.K[0, 0] * camera.K[1, 1]))

    def solve(self, start: Array, axis: Array | None) -> tuple[float, Array] | None:
        """Cost and parameters of the best fit from one starting rotation; None where it ends behind the camera."""
        from scipy.optimize import least_squares

        initial = self._initial(start, axis)
        solved = least_squares(self._residuals, initial, args=(start, axis), method="trf", x_scale="jac", max_nfev=200)
        scale, rotation, translation = self._unpack(solved.x, start, axis)
        if self.camera.depth(scale * self.points @ rotation.T + translation).min() <= 0:
            return None
        return float(solved.cost), np.asarray(solved.x, np.float64)

    def similarity(self, parameters: Array, start: Array, axis: Array | None) -> Similarity:
        """The fitted motion with its residuals."""
        scale, rotation, translation = self._unpack(parameters, start, axis)
        moved = scale * self.points @ rotation.T + translation
        picture = np.linalg.norm(self.camera.project(moved) - self.targets.pixels, axis=1)
        space = np.linalg.norm(moved - self.targets.places, axis=1)
        left = np.where(np.isfinite(space), space, picture)
        return Similarity(scale, rotation, translation, dict(zip(self.names, left.tolist(), strict=True)))

    def _initial(self, start: Array, axis: Array | None) -> Array:
        """Size from the extent in the picture at a depth that contacts, the ground or the caller suggest."""
        pixels = np.where(
            np.isfinite(self.targets.pixels), self.targets.pixels, self.camera.project(self.targets.places)
        )
        middle = pixels.mean(axis=0)
        known = np.isfinite(self.targets.places).all(axis=1)
        if self.scale is not None:
            own = float(np.linalg.norm(np.ptp(self.points, axis=0)))
            depth = self.scale * own * self.focal / max(float(np.linalg.norm(np.ptp(pixels, axis=0))), 1e-9)
        elif known.any():
            depth = float(self.camera.depth(self.targets.places[known]).mean())
        elif self.depth is not None:
            depth = self.depth
        else:
            depth = self._ground_depth(middle)
        extent = float(np.linalg.norm(np.ptp(pixels, axis=0))) / self.focal * depth
        scale = max(extent, 1e-9) / max(float(np.linalg.norm(np.ptp(self.points, axis=0))), 1e-12)
        place = self.camera.lift(middle, np.asarray(depth))
        turn = np.zeros(1 if axis is not None else 3)
        return np.concatenate([[np.log(scale)], turn, place])

    def _ground_depth(self, pixel: Array) -> float:
        assert self.ground is not None
        normal, offset = self.ground
        slope = float(self.camera.rays(pixel) @ normal)
        depth = (offset - float(self.camera.centre @ normal)) / slope if slope else np.nan
        height = abs(float(self.camera.centre @ normal) - offset)
        return depth if np.isfinite(depth) and depth > 0 else 3 * height

    def _unpack(self, parameters: Array, start: Array, axis: Array | None) -> tuple[float, Array, Array]:
        """Scale, rotation, translation; the parameters hold the world place of the pairs' middle."""
        from scipy.spatial.transform import Rotation

        turn = parameters[1] * axis if axis is not None else parameters[1:4]
        rotation = Rotation.from_rotvec(turn).as_matrix() @ start
        scale = float(np.exp(np.clip(parameters[0], -50, 50)))
        return scale, rotation, parameters[-3:] - scale * rotation @ self.centre

    def _residuals(self, parameters: Array, start: Array, axis: Array | None) -> Array:
        scale, rotation, translation = self._unpack(parameters, start, axis)
        moved = scale * self.points @ rotation.T + translation
        local = moved @ self.camera.R.T + self.camera.T
        depth = np.maximum(local[:, 2:], 1e-3 * np.abs(local[:, 2:]).max() + 1e-12)
        image = local @ self.camera.K.T
        parts = [np.nan_to_num(image[:, :2] / depth - self.targets.pixels).ravel()]
        to_pixels = self.focal / float(np.median(depth))
        parts.append(np.nan_to_num(moved - self.targets.places).ravel() * to_pixels)
        if self.ground is not None:
            normal, offset = self.ground
            lowest = ((scale * self.vertices @ rotation.T + translation) @ normal).min()
            parts.append(np.array([(lowest - offset) * to_pixels]))
        if self.scale is not None:
            parts.append(np.array([KNOWN * (parameters[0] - np.log(self.scale))]))
        if self.depth is not None and not self.targets.size_known:
            parts.append(np.array([(float(self.camera.depth(parameters[-3:])) - self.depth) * to_pixels]))
        return np.concatenate(parts)


def _observations(
    vertices: Array, pairs: Mapping[str, int], pixels: Mapping[str, ArrayLike], places: Mapping[str, ArrayLike]
) -> tuple[list[str], _Targets]:
    names = [name for name in pairs if name in pixels or name in places]
    if len(names) < 3:
        raise InputError(f"Aligning needs at least three pairs with a position in frame 0, but there are {len(names)}.")
    picture, space = np.full((len(names), 2), np.nan), np.full((len(names), 3), np.nan)
    for row, name in enumerate(names):
        if not 0 <= pairs[name] < len(vertices):
            raise InputError(
                f'"{name}" is paired with vertex {pairs[name]}, but the character has {len(vertices)} vertices.'
            )
        if name in pixels:
            picture[row] = pixels[name]
        if name in places:
            space[row] = places[name]
    if not np.isfinite(picture).any(axis=1)[~np.isfinite(space).all(axis=1)].all():
        raise InputError("A pair has no position in frame 0; click its track there or leave it out.")
    return names, _Targets(picture, space)


def _starting_rotations(up: ArrayLike | None, own: Array) -> list[tuple[Array, Array | None]]:
    """Rotations to start from: eight turns about the vertical, or 24 orientations where up is unknown."""
    from scipy.spatial.transform import Rotation

    if up is None:
        return [(rotation.as_matrix(), None) for rotation in Rotation.create_group("O")]
    axis = np.asarray(up, np.float64)
    axis = axis / np.linalg.norm(axis)
    upright = Rotation.align_vectors(axis[None], own[None] / np.linalg.norm(own))[0]
    return [
        ((Rotation.from_rotvec(turn * axis) * upright).as_matrix(), axis)
        for turn in np.linspace(0, 2 * np.pi, 8, endpoint=False)
    ]
