# mypy: disable-error-code="untyped-decorator"
"""Frames that lend their colours laid over a frame to a part of a pixel, by what both show round the hole."""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from imitation.depth.colours import Lenders, nearer_before, placed, shown, straight
from imitation.geometry.projection import Array, Camera

POINTS = 2000  # of the ring that are compared
FEW = 200  # points that must be seen, or a frame is left where its camera puts it
ROUNDS = 3
SLOPE = 1.2  # pixels over which the frame's slopes are smoothed
MOST = 1.5  # pixels at a width of 960 that a frame may lie astray in the middle; twice that at a corner
LEFT = 0.99  # of the difference round the hole that must be left at most, for a shift to be believed
BURNT = 120.0  # of the three channels' sum: a larger difference is another thing
WEAK = 3e-3  # of the mean slope that holds a shift back where there is no texture


def aligned(
    picture: NDArray[np.uint8],
    ring: NDArray[np.bool_],
    inverse: NDArray[np.float32],
    camera: Camera,
    lenders: Lenders,
) -> NDArray[np.float32]:
    """Affine maps (n, 3, 3) of a frame's pixels, to those whose rays other frames show there; the identity if none.

    Where the camera jerks, its solved pose is a pixel or so wrong. Gauss and Newton's steps on the robust difference
    of brightness; the slopes are the frame's own (Baker and Matthews 2004, inverse compositional), smoothed, since
    noise in them would shorten the steps. A map is believed if it explains the ring better and moves it little.

    Parameters
    ----------
    picture : uint8 RGB (h, w, 3). ring : bool (h, w), known pixels round the hole.
    inverse : (h, w) inverse depth, above 0 on the ring. lenders : the n frames.
    """
    import cv2

    maps = np.tile(np.eye(3, dtype=np.float32), (len(lenders.poses), 1, 1))
    ringed = np.flatnonzero(ring)
    if len(ringed) < FEW or not lenders.poses:
        return maps
    rows, columns = np.divmod(ringed[:: max(1, len(ringed) // POINTS)], ring.shape[1])
    box = tuple(slice(max(at.min() - 8, 0), at.max() + 9) for at in (rows, columns))
    grey = cv2.GaussianBlur(picture[box].sum(axis=-1, dtype=np.float32), (0, 0), SLOPE)
    within = rows - box[0].start, columns - box[1].start
    across, down = (cv2.Sobel(grey, cv2.CV_32F, x, 1 - x, ksize=1, scale=0.5)[within] for x in (1, 0))
    middle = np.array([columns.mean(), rows.mean()])
    reach = np.array([columns.std(), rows.std()]) + 1
    basis = np.ones((len(rows), 3), np.float32)
    basis[:, 1:] = (np.stack([columns, rows], axis=1) - middle) / reach
    # A frame may be a little brighter there than its gain says: that is no shift.
    slopes = np.concatenate([across[:, None] * basis, down[:, None] * basis, np.ones_like(basis[:, :1])], axis=1)
    own = picture[rows, columns].sum(axis=-1, dtype=np.float32)
    shift = _found(rows, columns, inverse[rows, columns], basis, slopes, own, camera, lenders)
    most = MOST * max(picture.shape) / 960
    corners = np.array(
        [(1, x, y) for x in (basis[:, 1].min(), basis[:, 1].max()) for y in (basis[:, 2].min(), basis[:, 2].max())]
    )
    far = np.abs(shift @ corners.T).max(axis=(1, 2))
    shift[(far > 2 * most) | (np.abs(shift[:, :, 0]).max(axis=1) > most)] = 0
    maps[:, :2, :2] += shift[:, :, 1:] / reach
    maps[:, :2, 2] += shift[:, :, 0] - shift[:, :, 1:] @ (middle / reach)
    return maps


def _found(
    rows: NDArray[np.int64],
    columns: NDArray[np.int64],
    inverse: NDArray[np.float32],
    basis: NDArray[np.float32],
    slopes: NDArray[np.float32],
    own: NDArray[np.float32],
    camera: Camera,
    lenders: Lenders,
) -> Array:
    """How far each frame lies astray (n, 2, 3), by the basis, in pixels; 0 where it is not believed."""
    maps, count = lenders.maps(camera), len(lenders.poses)
    shift = np.zeros((count, 2, 3))
    best, first, least = shift, np.zeros(count), np.full(count, np.inf)
    bias, spread = np.zeros(count), np.full(count, BURNT / 4)
    weak = np.eye(slopes.shape[1])
    weak[-1, -1] = 0
    # What a point adds to the matrix, and, times what it leaves, to the side. No BLAS: its threads cost more than this.
    upper = np.triu_indices(slopes.shape[1])
    pairs = np.concatenate([slopes[:, upper[0]] * slopes[:, upper[1]], slopes], axis=1)
    half = len(upper[0])
    for turn in range(ROUNDS + 2):
        sums, cost, seen = np.zeros((count, pairs.shape[1]), np.float32), np.zeros(count), np.zeros(count, np.int64)
        _compare(
            1 if turn else 4, rows, columns, inverse, basis, pairs, own, shift.astype(np.float32), maps.A, maps.b,
            lenders.stack, lenders.hidden, lenders.scale, lenders.front, np.float32(lenders.margin),
            bias.astype(np.float32), spread.astype(np.float32), half, sums, cost, seen,
        )  # fmt: skip
        matrix, side = np.empty((count, 7, 7)), sums[:, half:].astype(np.float64)
        matrix[:, upper[0], upper[1]] = matrix[:, upper[1], upper[0]] = sums[:, :half]
        spread = np.maximum(cost, 1.0)
        if turn == 0:
            # Only how bright they are, at first: that is to explain nothing that counts for a shift.
            bias = side[:, 6] / np.maximum(matrix[:, 6, 6], 1e-9)
            continue
        if turn == 1:
            first = cost
        better = (seen >= FEW) & (cost < least)
        best, least = np.where(better[:, None, None], shift, best), np.where(better, cost, least)
        if turn <= ROUNDS:
            hold = WEAK * np.trace(matrix[:, :6, :6], axis1=1, axis2=2) / 6 + 1e-6
            step = np.linalg.solve(matrix + hold[:, None, None] * weak + 1e-9 * np.eye(7), side[..., None])[..., 0]
            shift = shift + step[:, :6].reshape(-1, 2, 3)
            bias = bias + step[:, 6]
    found: Array = np.where((least < LEFT * first)[:, None, None], best, 0.0)
    return found


@njit(cache=True, nogil=True, error_model="numpy")
def _compare(
    step: int, rows: Any, columns: Any, inverse: Any, basis: Any, pairs: Any, own: Any, shift: Any, A: Any, b: Any,
    stack: Any, hidden: Any, scale: Any, front: Any, margin: Any, bias: Any, spread: Any, half: int, sums: Any,
    cost: Any, seen: Any,
) -> None:  # fmt: skip
    """Normal equations of each frame's shift, mean difference (n,), how many points it sees (n,).

    The equations (n, ``half`` + 7): the upper half of a symmetric matrix row by row, then the side.
    """
    height, width = stack.shape[1], stack.shape[2]
    for n in range(stack.shape[0]):
        for k in range(0, len(rows), step):
            x, y = np.float32(columns[k]), np.float32(rows[k])
            for j in range(3):
                x += shift[n, 0, j] * basis[k, j]
                y += shift[n, 1, j] * basis[k, j]
            u, v, z = placed(A, b, n, x, y, inverse[k])
            if not (z > 0 and shown(hidden, n, u, v)):
                continue
            if nearer_before(front, n, u, v, width, height, inverse[k] / z, margin):
                continue
            iu, iv = int(u), int(v)
            red, green, blue = straight(stack, n, iu, iv, u - iu, v - iv)
            value = red * scale[n, 0] + green * scale[n, 1] + blue * scale[n, 2]
            rest = own[k] - value - bias[n]
            seen[n] += 1
            cost[n] += min(abs(rest), np.float32(BURNT))
            weight = spread[n] / max(spread[n], abs(rest))
            for i in range(half):
                sums[n, i] += weight * pairs[k, i]
            for i in range(half, half + 7):
                sums[n, i] += weight * rest * pairs[k, i]
        cost[n] /= max(seen[n], 1)
