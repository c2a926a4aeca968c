"""The background as triangles: one key frame's, or those of several without what others show already."""

from __future__ import annotations

from collections.abc import Sequence

import attrs
import numpy as np
from numpy.typing import NDArray

from imitation.depth.depthmap import DepthMap
from imitation.errors import InputError
from imitation.geometry.projection import Array
from imitation.progress import Progress, silent

STEP, CUT = 2, 0.03


@attrs.frozen(eq=False)
class BackgroundMesh:
    """A triangulated background (paper A, 3.1); where nothing is known there is a hole.

    Attributes
    ----------
    vertices : (n, 3) world. faces : int32 (m, 3), counter-clockwise as the camera sees them.
    colors : uint8 (n, 3) sRGB.
    """

    vertices: Array
    faces: NDArray[np.int32]
    colors: NDArray[np.uint8]


def background_mesh(
    depth: DepthMap,
    picture: NDArray[np.uint8] | None = None,
    *,
    step: int = STEP,
    cut: float = CUT,
    least: int = 0,
    wanted: NDArray[np.bool_] | None = None,
) -> BackgroundMesh:
    """Triangulate one frame's depth.

    Parameters
    ----------
    depth : as measured, or completed; where it was invented there are holes.
    picture : uint8 RGB (h, w, 3) to colour the vertices, grey where None.
    step : every how many pixels a vertex lies.
    cut : relative step of depth per ``step`` pixels over which no triangle is spanned.
    least : confidence that a vertex needs.
    wanted : bool (h, w), which pixels may give a vertex, or None for all.
    """
    if step < 1 or not cut > 0:
        raise InputError(f"A mesh needs a step of at least one pixel and a positive cut, but got {step} and {cut}.")
    z = depth.depth[::step, ::step].astype(np.float64)
    there = np.isfinite(z) & (depth.confidence[::step, ::step] >= least)
    if depth.invented is not None:
        there &= ~depth.invented[::step, ::step]
    if wanted is not None:
        there &= wanted[::step, ::step]
    rows, columns = np.mgrid[: depth.depth.shape[0] : step, : depth.depth.shape[1] : step]
    points = depth.camera.lift(np.stack([columns, rows], axis=-1), z)
    index = np.arange(z.size).reshape(z.shape)
    a, b, c, d = index[:-1, :-1], index[:-1, 1:], index[1:, :-1], index[1:, 1:]
    w = np.where(there, 1 / np.where(there, z, 1.0), 0.0)
    # The diagonal that joins the more equal depths follows the surface.
    falling = np.abs(w[:-1, :-1] - w[1:, 1:]) <= np.abs(w[:-1, 1:] - w[1:, :-1])
    first = np.where(falling[..., None], np.stack([a, c, d], -1), np.stack([a, c, b], -1))
    second = np.where(falling[..., None], np.stack([a, d, b], -1), np.stack([b, c, d], -1))
    faces = np.stack([first, second], axis=2).reshape(-1, 3)
    corner = w.reshape(-1)[faces]
    kept = corner.min(axis=1) * (1 + cut) >= corner.max(axis=1)
    kept &= corner.min(axis=1) > 0
    faces = faces[kept]
    used, renamed = np.unique(faces, return_inverse=True)
    if picture is None:
        colors = np.full((len(used), 3), 160, np.uint8)
    else:
        colors = np.ascontiguousarray(picture[::step, ::step].reshape(-1, 3)[used])
    return BackgroundMesh(
        np.ascontiguousarray(points.reshape(-1, 3)[used]), renamed.reshape(-1, 3).astype(np.int32), colors
    )


def joined_mesh(
    depths: Sequence[DepthMap],
    pictures: Sequence[NDArray[np.uint8]] | None = None,
    *,
    step: int = STEP,
    cut: float = CUT,
    least: int = 2,
    progress: Progress | None = None,
) -> BackgroundMesh:
    """One mesh of several frames: each adds what the ones before it did not see.

    Chosen over a volume of signed distances, whose false sheets at the rims of what is seen put a fifth of the
    vertices 100 mm off on the scene where both were tried.
    """
    if not depths:
        raise InputError("A background mesh needs the depth of at least one frame.")
    parts: list[BackgroundMesh] = []
    report = progress or silent
    for n, depth in enumerate(depths):
        report(n / len(depths))
        fresh = np.zeros(depth.depth.shape, bool)
        fresh[::step, ::step] = np.isfinite(depth.depth[::step, ::step])
        for before in depths[:n]:
            fresh[::step, ::step] &= ~_seen(depth, before, least, step)
        picture = None if pictures is None else pictures[n]
        parts.append(background_mesh(depth, picture, step=step, cut=cut, least=least, wanted=fresh))
    starts = np.cumsum([0, *(len(part.vertices) for part in parts)])
    return BackgroundMesh(
        np.concatenate([part.vertices for part in parts]),
        np.concatenate([part.faces + start for part, start in zip(parts, starts, strict=False)]).astype(np.int32),
        np.concatenate([part.colors for part in parts]),
    )


def _seen(depth: DepthMap, before: DepthMap, least: int, step: int) -> NDArray[np.bool_]:
    """Which of every ``step``-th pixel of a map show what an earlier one holds already."""
    height, width = depth.depth.shape
    rows, columns = np.mgrid[:height:step, :width:step]
    points = depth.camera.lift(np.stack([columns, rows], axis=-1), depth.depth[::step, ::step].astype(np.float64))
    pixels, z = before.camera.project(points), before.camera.depth(points)
    at = np.rint(np.nan_to_num(pixels, nan=-1.0)).astype(int)
    inside = (at >= 0).all(axis=-1) & (at[..., 0] < before.depth.shape[1]) & (at[..., 1] < before.depth.shape[0])
    x, y = np.where(inside, at[..., 0], 0), np.where(inside, at[..., 1], 0)
    held = before.depth[y, x]
    with np.errstate(invalid="ignore"):
        same = np.abs(z - held) <= 0.02 * held
    seen: NDArray[np.bool_] = inside & same & (before.confidence[y, x] >= least)
    return seen
