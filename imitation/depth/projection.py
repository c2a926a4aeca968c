# mypy: disable-error-code="untyped-decorator"
"""Depth of one frame as another frame's camera sees it."""

from __future__ import annotations

from typing import Any

import attrs
import numpy as np
from numba import njit
from numpy.typing import NDArray

from imitation.depth.depthmap import DepthMap
from imitation.depth.sweep import geometry
from imitation.geometry.projection import Camera

FRONT = 0.03  # relative depth within which splats belong to one surface
TILE = 32  # pixels: what falls into no tile that is wanted is passed over together


def projected(
    source: DepthMap,
    camera: Camera,
    size: tuple[int, int],
    least: int = 0,
    wanted: NDArray[np.bool_] | None = None,
) -> NDArray[np.float32]:
    """Inverse depth (h, w) that a map gives to the pixels of another camera, 0 where none.

    Every pixel of the map covers the four pixels round its place; the nearest surface wins, and what belongs to it is
    averaged by nearness.

    Parameters
    ----------
    camera, size : of the picture wanted, (width, height) pixels.
    least : confidence that a pixel of the map needs to count.
    wanted : (h, w) the pixels that are needed: only these are right, which is quicker.
    """
    asked = None if wanted is None else Wanted.of(wanted)
    return projected_inverse(inverse_of(source, least), source.camera, camera, size, asked)


def inverse_of(source: DepthMap, least: int = 0) -> NDArray[np.float32]:
    """Inverse depth (h, w) of a map, 0 where it has none of this confidence."""
    known = np.isfinite(source.depth) & (source.confidence >= least)
    inverse = np.zeros(source.depth.shape, np.float32)
    np.divide(np.float32(1), source.depth, out=inverse, where=known)
    return inverse


@attrs.frozen(eq=False)
class Wanted:
    """Pixels of a picture that are needed of projections, made ready once for several maps.

    Attributes
    ----------
    pixels : bool (h, w). box : first row and column that hold one, and those after the last.
    tiles : bool, which tiles of the picture hold one. touched : bool, of the box (h + 1, w + 1), which fours of pixels
        do, by their lower right one.
    """

    pixels: NDArray[np.bool_]
    box: tuple[int, int, int, int]
    tiles: NDArray[np.bool_]
    touched: NDArray[np.bool_]

    @classmethod
    def of(cls, pixels: NDArray[np.bool_]) -> Wanted:
        """Of a picture (h, w)."""
        rows, columns = np.flatnonzero(pixels.any(axis=1)), np.flatnonzero(pixels.any(axis=0))
        if not len(rows):
            return cls(pixels, (0, 0, 0, 0), np.zeros((1, 1), np.bool_), np.zeros((1, 1), np.bool_))
        top, left, bottom, right = int(rows[0]), int(columns[0]), int(rows[-1]) + 1, int(columns[-1]) + 1
        down = np.logical_or.reduceat(pixels, np.arange(0, pixels.shape[0], TILE), axis=0)
        tiles = np.logical_or.reduceat(down, np.arange(0, pixels.shape[1], TILE), axis=1)
        padded = np.zeros((bottom - top + 2, right - left + 2), np.bool_)
        padded[1:-1, 1:-1] = pixels[top:bottom, left:right]
        either = padded[1:] | padded[:-1]
        return cls(pixels, (top, left, bottom, right), tiles, either[:, 1:] | either[:, :-1])


def projected_inverse(
    inverse: NDArray[np.float32],
    source: Camera,
    camera: Camera,
    size: tuple[int, int],
    wanted: Wanted | None = None,
) -> NDArray[np.float32]:
    """The same for inverse depths (h, w), 0 where none, that a camera ``source`` sees."""
    made = np.zeros(size[::-1], np.float32)
    top, left, bottom, right = (0, 0, size[1], size[0]) if wanted is None else wanted.box
    if bottom <= top:
        return made
    maps = geometry((source.K, source.R, source.T), [(camera.K, camera.R, camera.T)])
    A, b = maps.A[0], maps.b[0]
    # A border of a pixel takes what falls beside the picture.
    shape = bottom - top + 2, right - left + 2
    front, total, weight = np.zeros(shape, np.float32), np.zeros(shape, np.float32), np.zeros(shape, np.float32)
    useful = np.ones((inverse.shape[0], -(-inverse.shape[1] // TILE)), np.bool_)
    touched, tiles = (useful, useful) if wanted is None else (wanted.touched, wanted.tiles)
    for collect in (False, True):
        _splat(
            inverse, A, b, top, left, front, total, weight, collect, touched, tiles, wanted is not None, useful
        )  # fmt: skip
    part = slice(top, bottom), slice(left, right)
    total, weight = total[1:-1, 1:-1], weight[1:-1, 1:-1]
    there = weight > 0 if wanted is None else wanted.pixels[part] & (weight > 0)
    np.divide(total, weight, out=made[part], where=there)
    return made


@njit(cache=True, nogil=True, error_model="numpy")
def _falls(inverse: Any, y: int, first: int, last: int, A: Any, b: Any, tiles: Any) -> bool:
    """Whether pixels ``first`` to ``last`` - 1 of a row may fall into a wanted tile.

    Along a row and along a ray, places in the other picture move one way only as long as they lie before its camera:
    the four ends of both bound all of them.
    """
    low, high = np.float32(np.inf), np.float32(0)
    for x in range(first, last):
        w = inverse[y, x]
        if w > 0:
            low, high = min(low, w), max(high, w)
    if high <= 0:
        return False
    left, right, top, bottom = np.inf, -np.inf, np.inf, -np.inf
    for x in (first, last - 1):
        for w in (low, high):
            z = A[2, 0] * x + A[2, 1] * y + A[2, 2] + w * b[2]
            if z <= 1e-6:
                return True
            u = (A[0, 0] * x + A[0, 1] * y + A[0, 2] + w * b[0]) / z
            v = (A[1, 0] * x + A[1, 1] * y + A[1, 2] + w * b[1]) / z
            left, right, top, bottom = min(left, u), max(right, u), min(top, v), max(bottom, v)
    rows, columns = tiles.shape
    for j in range(max(0, int(np.floor((top - 1) / TILE))), min(rows - 1, int(np.floor((bottom + 2) / TILE))) + 1):
        for i in range(
            max(0, int(np.floor((left - 1) / TILE))), min(columns - 1, int(np.floor((right + 2) / TILE))) + 1
        ):
            if tiles[j, i]:
                return True
    return False


@njit(cache=True, nogil=True, error_model="numpy")
def _splat(
    inverse: Any, A: Any, b: Any, top: int, left: int, front: Any, total: Any, weight: Any, collect: bool,
    touched: Any, tiles: Any, some: bool, useful: Any,
) -> None:  # fmt: skip
    """One pass over a map: what is in front in a box of the picture (h + 2, w + 2), or sums of what belongs to it."""
    above, beside, below, beyond = top - 1, left - 1, top + front.shape[0] - 2, left + front.shape[1] - 2
    # Held in local names: what is written might otherwise be them, as far as the compiler knows.
    a00, a01, a02, b0 = A[0, 0], A[0, 1], A[0, 2], b[0]
    a10, a11, a12, b1 = A[1, 0], A[1, 1], A[1, 2], b[1]
    a20, a21, a22, b2 = A[2, 0], A[2, 1], A[2, 2], b[2]
    us, vs, nears = np.empty(TILE), np.empty(TILE), np.empty(TILE)
    for y in range(inverse.shape[0]):
        for tile in range(useful.shape[1]):
            first = tile * TILE
            count = min(TILE, inverse.shape[1] - first)
            if some and not collect:
                useful[y, tile] = _falls(inverse, y, first, first + count, A, b, tiles)
            if not useful[y, tile]:
                continue
            # All places first, without a branch: they are worked out several at once.
            for k in range(count):
                x, w = np.int32(first + k), inverse[y, first + k]
                z = a20 * x + a21 * y + a22 + w * b2
                us[k] = (a00 * x + a01 * y + a02 + w * b0) / z
                vs[k] = (a10 * x + a11 * y + a12 + w * b1) / z
                nears[k] = w / z
            for k in range(count):
                u, v, there = us[k], vs[k], nears[k]
                if not (
                    inverse[y, first + k] > 0 and there > 0 and u > beside and v > above and u < beyond and v < below
                ):
                    continue
                iu, iv = np.floor(u), np.floor(v)
                i, j = np.uint64(np.int64(iu - beside)), np.uint64(np.int64(iv - above))
                if some and not touched[j, i]:
                    continue
                ii, jj = i + np.uint64(1), j + np.uint64(1)
                west, east, north, south = 1 - (u - iu), 1 - ((iu + 1) - u), 1 - (v - iv), 1 - ((iv + 1) - v)
                if not collect:
                    # A splat that hardly touches a pixel must not hide what lies behind it.
                    near = np.float32(there)
                    front[j, i] = max(front[j, i], near if west * north > 0.1 else np.float32(0))
                    front[j, ii] = max(front[j, ii], near if east * north > 0.1 else np.float32(0))
                    front[jj, i] = max(front[jj, i], near if west * south > 0.1 else np.float32(0))
                    front[jj, ii] = max(front[jj, ii], near if east * south > 0.1 else np.float32(0))
                    continue
                if there >= front[j, i] * (1 - FRONT):
                    total[j, i] += np.float32(west * north * there)
                    weight[j, i] += np.float32(west * north)
                if there >= front[j, ii] * (1 - FRONT):
                    total[j, ii] += np.float32(east * north * there)
                    weight[j, ii] += np.float32(east * north)
                if there >= front[jj, i] * (1 - FRONT):
                    total[jj, i] += np.float32(west * south * there)
                    weight[jj, i] += np.float32(west * south)
                if there >= front[jj, ii] * (1 - FRONT):
                    total[jj, ii] += np.float32(east * south * there)
                    weight[jj, ii] += np.float32(east * south)


def consensus(
    layers: NDArray[np.float32], tolerance: float, rank: NDArray[np.float32] | None = None
) -> tuple[NDArray[np.float32], NDArray[np.uint8]]:
    """The inverse depth (h, w) that most layers (k, h, w) support, 0 where none has one, and how many do.

    Parameters
    ----------
    layers : 0 where a layer has nothing. tolerance : difference that still counts as support.
    rank : (k,) worth of each layer's support, 1 each where None; of equal supports the nearer surface wins.
    """
    best = np.zeros(layers.shape[1:], np.float32)
    support = np.zeros(layers.shape[1:], np.uint8)
    worth = np.ones(len(layers), np.float32) if rank is None else rank.astype(np.float32)
    _vote(layers, np.float32(tolerance), worth, best, support)
    return best, support


@njit(cache=True, nogil=True, error_model="numpy")
def _vote(layers: Any, tolerance: Any, worth: Any, best: Any, support: Any) -> None:
    count, height, width = layers.shape
    there, its = np.empty(count, np.float32), np.empty(count, np.float32)
    for y in range(height):
        for x in range(width):
            known, low, high = 0, np.float32(np.inf), np.float32(0)
            for i in range(count):
                w = layers[i, y, x]
                if w > 0:
                    there[known], its[known] = w, worth[i]
                    known += 1
                    low, high = min(low, w), max(high, w)
            top = np.float32(-1)
            # Where all support each other, the first has as many votes as any, and the same mean.
            for i in range(min(known, 1) if high - low <= tolerance else known):
                w = there[i]
                votes, total, weight, number = np.float32(0), np.float32(0), np.float32(0), 0
                for j in range(known):
                    if abs(there[j] - w) <= tolerance:
                        votes += its[j]
                        total += its[j] * there[j]
                        weight += its[j]
                        number += 1
                if votes > top + 1e-6 or (votes > top - 1e-6 and w > best[y, x]):
                    top = votes
                    best[y, x] = total / weight
                    support[y, x] = min(number, 255)
