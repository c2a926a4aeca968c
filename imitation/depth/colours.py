# mypy: disable-error-code="untyped-decorator"
"""Colours of background points in the frames that see them: exposure, agreement, and their median."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from imitation.depth.sweep import geometry
from imitation.geometry.projection import Camera

Picture = NDArray[np.uint8]
SUPPORT = 2.5  # grey levels of disagreement that one more key frame with the same depth outweighs
AGAINST = 8.0  # grey levels that a key frame counts against a depth that it sees through
ASKED = 3000  # points of a picture that are asked how bright it is
UNSEEN = 40.0  # disagreement of a depth that fewer than two frames can judge


def gains(
    picture: Picture,
    hole: NDArray[np.bool_],
    inverse: NDArray[np.float32],
    camera: Camera,
    stack: Picture,
    hidden: Picture,
    poses: Sequence[Camera],
) -> NDArray[np.float32]:
    """Factors (k, 3) that bring the colours of other frames to a frame's exposure.

    The median ratio over background points that both show, of which neither is nearly black or burnt out.
    """
    step = max(7, round(np.sqrt(hole.size / ASKED)))
    rows, columns = np.mgrid[3 : hole.shape[0] : step, 3 : hole.shape[1] : step]
    rows, columns = rows.ravel(), columns.ravel()
    use = ~hole[rows, columns] & (inverse[rows, columns] > 0)
    rows, columns = rows[use], columns[use]
    own = picture[rows, columns].astype(np.float64)
    scale = np.ones((len(poses), 3), np.float32)
    points = camera.lift(np.stack([columns, rows], axis=1), 1 / inverse[rows, columns].astype(np.float64))
    for n, pose in enumerate(poses):
        seen = pose.project(points)
        with np.errstate(invalid="ignore"):
            inside = (seen >= 0).all(axis=1) & (seen[:, 0] <= hole.shape[1] - 1) & (seen[:, 1] <= hole.shape[0] - 1)
        at = np.rint(np.nan_to_num(seen)).astype(int)
        at = np.clip(at, 0, [hole.shape[1] - 1, hole.shape[0] - 1])
        other = stack[n, at[:, 1], at[:, 0]].astype(np.float64)
        for channel in range(3):
            a, b = own[:, channel], other[:, channel]
            good = inside & (hidden[n, at[:, 1], at[:, 0]] == 0) & (a > 12) & (b > 12) & (a < 245) & (b < 245)
            if good.sum() >= 40:
                scale[n, channel] = np.clip(np.median(a[good] / b[good]), 0.5, 2.0)
    return scale


def choose_depth(
    rows: NDArray[np.int64],
    columns: NDArray[np.int64],
    loose: NDArray[np.float32],
    firm: NDArray[np.float32],
    camera: Camera,
    stack: Picture,
    hidden: Picture,
    poses: Sequence[Camera],
    scale: NDArray[np.float32],
    tolerance: float,
    known: NDArray[np.float32],
    knowing: Sequence[Camera],
) -> NDArray[np.float32]:
    """Choose for each pixel (k,) the inverse depth at which the frames that see it agree best in colour.

    Where colours do not tell, on a weak texture, what key frames see through cannot be there.

    Parameters
    ----------
    loose, firm : (k, m) what key frames say, all of it and what others confirm; 0 where nothing.
    tolerance : difference of inverse depths that counts as the same.
    known, knowing : (n, h, w) inverse depths of key frames, 0 where none, and their cameras.
    """
    maps = geometry((camera.K, camera.R, camera.T), [(p.K, p.R, p.T) for p in poses])
    keys = geometry((camera.K, camera.R, camera.T), [(p.K, p.R, p.T) for p in knowing])
    result = np.zeros(len(rows), np.float32)
    _choose(
        rows, columns, loose, firm, maps.A, maps.b, stack, hidden, scale, np.float32(tolerance), known, keys.A, keys.b,
        result,
    )  # fmt: skip
    return result


def gather(
    rows: NDArray[np.int64],
    columns: NDArray[np.int64],
    inverse: NDArray[np.float32],
    camera: Camera,
    stack: Picture,
    hidden: Picture,
    poses: Sequence[Camera],
    scale: NDArray[np.float32],
    nearest: int,
) -> tuple[NDArray[np.float32], NDArray[np.int32]]:
    """Colour (k, 3) of background points: the median over the ``nearest`` frames that see them; how many those are."""
    maps = geometry((camera.K, camera.R, camera.T), [(p.K, p.R, p.T) for p in poses])
    colour = np.zeros((len(rows), 3), np.float32)
    count = np.zeros(len(rows), np.int32)
    _gather(rows, columns, inverse, maps.A, maps.b, stack, hidden, scale, nearest, colour, count)
    return colour, count


@njit(cache=True, nogil=True, error_model="numpy")
def _samples(x: int, y: int, w: Any, A: Any, b: Any, stack: Any, hidden: Any, scale: Any, most: int, out: Any) -> int:
    """Colours (m, 3) of a point in the first ``most`` frames that see it; how many."""
    count = 0
    height, width = stack.shape[1], stack.shape[2]
    for n in range(stack.shape[0]):
        z = A[n, 2, 0] * x + A[n, 2, 1] * y + A[n, 2, 2] + w * b[n, 2]
        if z <= 0:
            continue
        u = (A[n, 0, 0] * x + A[n, 0, 1] * y + A[n, 0, 2] + w * b[n, 0]) / z
        v = (A[n, 1, 0] * x + A[n, 1, 1] * y + A[n, 1, 2] + w * b[n, 1]) / z
        if not (u >= 0 and v >= 0 and u < width - 1.001 and v < height - 1.001):
            continue
        iu, iv = int(u), int(v)
        if hidden[n, iv, iu] or hidden[n, iv, iu + 1] or hidden[n, iv + 1, iu] or hidden[n, iv + 1, iu + 1]:
            continue
        q, r = u - iu, v - iv
        for c in range(3):
            top = (1 - q) * stack[n, iv, iu, c] + q * stack[n, iv, iu + 1, c]
            low = (1 - q) * stack[n, iv + 1, iu, c] + q * stack[n, iv + 1, iu + 1, c]
            out[count, c] = ((1 - r) * top + r * low) * scale[n, c]
        count += 1
        if count == most:
            break
    return count


@njit(cache=True, nogil=True, error_model="numpy")
def _median(values: Any, count: int, channel: int, work: Any) -> Any:
    for i in range(count):
        v = values[i, channel]
        j = i
        while j > 0 and work[j - 1] > v:
            work[j] = work[j - 1]
            j -= 1
        work[j] = v
    half = count // 2
    return work[half] if count % 2 else (work[half - 1] + work[half]) / 2


@njit(cache=True, nogil=True, error_model="numpy")
def _seen_through(x: int, y: int, w: Any, A: Any, b: Any, known: Any, tolerance: Any) -> Any:
    """How many key frames see something farther at a point, all round its place."""
    count = np.float32(0)
    height, width = known.shape[1], known.shape[2]
    for n in range(known.shape[0]):
        z = A[n, 2, 0] * x + A[n, 2, 1] * y + A[n, 2, 2] + w * b[n, 2]
        if z <= 0:
            continue
        u = int(np.rint((A[n, 0, 0] * x + A[n, 0, 1] * y + A[n, 0, 2] + w * b[n, 0]) / z))
        v = int(np.rint((A[n, 1, 0] * x + A[n, 1, 1] * y + A[n, 1, 2] + w * b[n, 1]) / z))
        if u < 1 or v < 1 or u >= width - 1 or v >= height - 1:
            continue
        nearest, whole = np.float32(0), True
        for j in range(v - 1, v + 2):
            for i in range(u - 1, u + 2):
                whole = whole and known[n, j, i] > 0
                nearest = max(nearest, known[n, j, i])
        if whole and nearest < w / z - 2 * tolerance:
            count += np.float32(1)
    return count


@njit(cache=True, nogil=True, error_model="numpy")
def _choose(
    rows: Any, columns: Any, loose: Any, firm: Any, A: Any, b: Any, stack: Any, hidden: Any, scale: Any,
    tolerance: Any, known: Any, key_A: Any, key_b: Any, result: Any,
) -> None:  # fmt: skip
    sources = loose.shape[1]
    values, work = np.empty((8, 3), np.float32), np.empty(8, np.float32)
    for k in range(len(rows)):
        best = np.float32(1e9)
        for i in range(2 * sources):
            w = firm[k, i] if i < sources else loose[k, i - sources]
            if w <= 0:
                continue
            # The same depth need not be judged twice; it is worth what supports it.
            support, total, number = np.float32(0), np.float32(0), 0
            earlier = False
            for j in range(sources):
                if firm[k, j] > 0 and abs(firm[k, j] - w) <= tolerance:
                    support += np.float32(1)
                if loose[k, j] > 0 and abs(loose[k, j] - w) <= tolerance:
                    support += np.float32(0.5)
                    total += loose[k, j]
                    number += 1
            for j in range(i):
                before = firm[k, j] if j < sources else loose[k, j - sources]
                if before > 0 and abs(before - w) <= 0.2 * tolerance:
                    earlier = True
            if earlier:
                continue
            middle = total / number if number > 0 else w
            count = _samples(columns[k], rows[k], middle, A, b, stack, hidden, scale, 8, values)
            cost = np.float32(UNSEEN)
            if count >= 2:
                cost = np.float32(0)
                for c in range(3):
                    m = _median(values, count, c, work)
                    for s in range(count):
                        cost += min(abs(values[s, c] - m), np.float32(UNSEEN))
                cost /= 3 * count
                cost *= np.float32(1) + np.float32(1) / count
            cost -= np.float32(SUPPORT) * min(support, np.float32(4))
            against = _seen_through(columns[k], rows[k], middle, key_A, key_b, known, tolerance)
            cost += np.float32(AGAINST) * min(against, np.float32(4))
            if cost < best:
                best = cost
                result[k] = middle


@njit(cache=True, nogil=True, error_model="numpy")
def _gather(
    rows: Any, columns: Any, inverse: Any, A: Any, b: Any, stack: Any, hidden: Any, scale: Any, nearest: int,
    colour: Any, seen: Any,
) -> None:  # fmt: skip
    values, work = np.empty((nearest, 3), np.float32), np.empty(nearest, np.float32)
    for k in range(len(rows)):
        if inverse[k] <= 0:
            continue
        count = _samples(columns[k], rows[k], inverse[k], A, b, stack, hidden, scale, nearest, values)
        seen[k] = count
        for c in range(3):
            if count > 0:
                colour[k, c] = _median(values, count, c, work)
