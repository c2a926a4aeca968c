# mypy: disable-error-code="untyped-decorator"
"""Colours of background points in the frames that see them: exposure, agreement, and their median."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import attrs
import numpy as np
from numba import njit
from numpy.typing import NDArray

from imitation.depth.sweep import Geometry, geometry
from imitation.geometry.projection import Camera

Picture = NDArray[np.uint8]
SUPPORT = 2.5  # grey levels of disagreement that one more key frame with the same depth outweighs
AGAINST = 8.0  # grey levels that a key frame counts against a depth that it sees through
ASKED = 3000  # points of a picture that are asked how bright it is
TOLD = 40  # of them that must tell
SEEN = 4  # frames that must see a place, or else those speak too that see something nearer: depth may be wrong
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
    own = picture[rows, columns]
    scale = np.ones((len(poses), 3), np.float32)
    points = camera.lift(np.stack([columns, rows], axis=1), 1 / inverse[rows, columns].astype(np.float64))
    for n, pose in enumerate(poses):
        _brightness(own, pose.project(points), stack, hidden, n, scale)
    return scale


@njit(cache=True, nogil=True, error_model="numpy")
def _brightness(own: Any, seen: Any, stack: Any, hidden: Any, n: int, scale: Any) -> None:
    """Median ratio of colours (k, 3) to those that frame n shows at places (k, 2), where enough of them tell."""
    height, width = hidden.shape[1], hidden.shape[2]
    ratios, counts = np.empty((3, len(own))), np.zeros(3, np.int64)
    for k in range(len(own)):
        u, v = seen[k, 0], seen[k, 1]
        if not (u >= 0 and v >= 0 and u <= width - 1 and v <= height - 1):
            continue
        x, y = int(np.rint(u)), int(np.rint(v))
        if hidden[n, y, x]:
            continue
        for c in range(3):
            a, b = own[k, c], stack[n, y, x, c]
            if a > 12 and b > 12 and a < 245 and b < 245:
                ratios[c, counts[c]] = np.float64(a) / np.float64(b)
                counts[c] += 1
    for c in range(3):
        if counts[c] >= TOLD:
            scale[n, c] = min(max(np.median(ratios[c, : counts[c]]), 0.5), 2.0)


@attrs.frozen(eq=False)
class Lenders:
    """Frames that lend a frame their colours.

    Attributes
    ----------
    stack : uint8 RGB (n, h, w, 3). hidden : uint8 (n, h, w), 1 on the subject and its rim. poses : their cameras.
    scale : (n, 3) factors to the frame's exposure.
    front : (n, h', w') inverse depth of what each of them sees, at a size of its own, 0 where not known.
    margin : difference of inverse depths by which something there must be nearer to hide what is asked for.
    astray : (n, 3, 3) maps of the frame's pixels, to those whose rays each of them shows there; None: as solved.
    """

    stack: Picture
    hidden: NDArray[np.uint8]
    poses: Sequence[Camera]
    scale: NDArray[np.float32]
    front: NDArray[np.float32]
    margin: float
    astray: NDArray[np.float32] | None = None

    def maps(self, camera: Camera) -> Geometry:
        """The maps from a camera to them, without what they lie astray."""
        return geometry((camera.K, camera.R, camera.T), [(p.K, p.R, p.T) for p in self.poses])

    def of(self, use: Sequence[int]) -> Lenders:
        """Some of them, in this order."""
        return attrs.evolve(
            self, stack=self.stack[use], hidden=self.hidden[use], poses=[self.poses[k] for k in use],
            scale=self.scale[use], front=self.front[use], astray=None if self.astray is None else self.astray[use],
        )  # fmt: skip


def choose_depth(
    rows: NDArray[np.int64],
    columns: NDArray[np.int64],
    loose: NDArray[np.float32],
    firm: NDArray[np.float32],
    camera: Camera,
    lenders: Lenders,
    tolerance: float,
    known: NDArray[np.float32],
    knowing: Sequence[Camera],
) -> NDArray[np.float32]:
    """Choose for each pixel (k,) the inverse depth at which the frames that see it agree best in colour.

    All frames speak here, those too that see something nearer: what stands before the far is to be found as well.
    Where colours do not tell, on a weak texture, what key frames see through cannot be there.

    Parameters
    ----------
    loose, firm : (k, m) what key frames say, all of it and what others confirm; 0 where nothing.
    tolerance : difference of inverse depths that counts as the same.
    known, knowing : (n, h, w) inverse depths of key frames, 0 where none, and their cameras.
    """
    maps = lenders.maps(camera)
    keys = geometry((camera.K, camera.R, camera.T), [(p.K, p.R, p.T) for p in knowing])
    result = np.zeros(len(rows), np.float32)
    _choose(
        rows, columns, loose, firm, maps.A, maps.b, lenders.stack, lenders.hidden, lenders.scale, np.float32(tolerance),
        known, keys.A, keys.b, result,
    )  # fmt: skip
    return result


def gather(
    rows: NDArray[np.int64],
    columns: NDArray[np.int64],
    inverse: NDArray[np.float32],
    camera: Camera,
    lenders: Lenders,
    nearest: int,
) -> tuple[NDArray[np.float32], NDArray[np.int32]]:
    """Colour (k, 3) of background points: the median over the ``nearest`` frames that see them; how many those are.

    A frame that sees something nearer in the place shows that, not the point; where all but a few do, depth is not
    believed.
    """
    maps = lenders.maps(camera)
    A = maps.A if lenders.astray is None else np.ascontiguousarray(maps.A @ lenders.astray)
    colour = np.zeros((len(rows), 3), np.float32)
    count = np.zeros(len(rows), np.int32)
    _gather(
        rows, columns, inverse, A, maps.b, lenders.stack, lenders.hidden, lenders.scale, lenders.front,
        np.float32(lenders.margin), min(SEEN, nearest), nearest, colour, count,
    )  # fmt: skip
    return colour, count


# Frames are handed on as whole stacks and a number: a view of each would be counted, there and back, at every place.


@njit(cache=True, nogil=True, error_model="numpy")
def placed(A: Any, b: Any, n: int, x: Any, y: Any, w: Any) -> Any:
    """Where frame n shows a pixel's point of an inverse depth: x, y, and the share of its depth, above 0 in front."""
    z = A[n, 2, 0] * x + A[n, 2, 1] * y + A[n, 2, 2] + w * b[n, 2]
    return (
        (A[n, 0, 0] * x + A[n, 0, 1] * y + A[n, 0, 2] + w * b[n, 0]) / z,
        (A[n, 1, 0] * x + A[n, 1, 1] * y + A[n, 1, 2] + w * b[n, 1]) / z,
        z,
    )


@njit(cache=True, nogil=True, error_model="numpy")
def shown(hidden: Any, n: int, u: Any, v: Any) -> bool:
    """Whether all four pixels round a place lie in frame n and show background."""
    height, width = hidden.shape[1], hidden.shape[2]
    if not (u >= 0 and v >= 0 and u < width - 1.001 and v < height - 1.001):
        return False
    i, j = int(u), int(v)
    return not (hidden[n, j, i] or hidden[n, j, i + 1] or hidden[n, j + 1, i] or hidden[n, j + 1, i + 1])


@njit(cache=True, nogil=True, error_model="numpy")
def nearer_before(front: Any, n: int, u: Any, v: Any, width: int, height: int, w: Any, margin: Any) -> bool:
    """Whether frame n sees something nearer at a pixel (or right beside it: depth ends a little astray)."""
    high, wide = front.shape[1], front.shape[2]
    i = int((u + 0.5) * wide / width)
    j = int((v + 0.5) * high / height)
    for y in range(max(0, j - 1), min(high, j + 2)):
        for x in range(max(0, i - 1), min(wide, i + 2)):
            if front[n, y, x] > w + margin:
                return True
    return False


@njit(cache=True, nogil=True, error_model="numpy")
def _weights(q: Any) -> Any:
    """Catmull and Rom's weights of four neighbours, at a share of the way between the middle two."""
    return (
        0.5 * q * (-1 + q * (2 - q)), 1 + 0.5 * q * q * (3 * q - 5), 0.5 * q * (1 + q * (4 - 3 * q)),
        0.5 * q * q * (q - 1),
    )  # fmt: skip


@njit(cache=True, nogil=True, error_model="numpy")
def straight(stack: Any, n: int, x: int, y: int, q: Any, r: Any) -> Any:
    """The three channels of picture n between its pixels, along straight lines."""
    p, s = 1 - q, 1 - r
    return (
        s * (p * stack[n, y, x, 0] + q * stack[n, y, x + 1, 0])
        + r * (p * stack[n, y + 1, x, 0] + q * stack[n, y + 1, x + 1, 0]),
        s * (p * stack[n, y, x, 1] + q * stack[n, y, x + 1, 1])
        + r * (p * stack[n, y + 1, x, 1] + q * stack[n, y + 1, x + 1, 1]),
        s * (p * stack[n, y, x, 2] + q * stack[n, y, x + 1, 2])
        + r * (p * stack[n, y + 1, x, 2] + q * stack[n, y + 1, x + 1, 2]),
    )


@njit(cache=True, nogil=True, error_model="numpy")
def _bent(stack: Any, n: int, x: int, y: int, q: Any, r: Any) -> Any:
    """The same by 4 x 4 pixels: sharper than a straight line, by which fills went soft."""
    a, b, c, d = _weights(q)
    down = _weights(r)
    red, green, blue = 0.0, 0.0, 0.0
    for j in range(4):
        k = y + j - 1
        red += down[j] * (
            a * stack[n, k, x - 1, 0] + b * stack[n, k, x, 0]
            + c * stack[n, k, x + 1, 0] + d * stack[n, k, x + 2, 0]
        )  # fmt: skip
        green += down[j] * (
            a * stack[n, k, x - 1, 1] + b * stack[n, k, x, 1]
            + c * stack[n, k, x + 1, 1] + d * stack[n, k, x + 2, 1]
        )  # fmt: skip
        blue += down[j] * (
            a * stack[n, k, x - 1, 2] + b * stack[n, k, x, 2]
            + c * stack[n, k, x + 1, 2] + d * stack[n, k, x + 2, 2]
        )  # fmt: skip
    return min(max(red, 0.0), 255.0), min(max(green, 0.0), 255.0), min(max(blue, 0.0), 255.0)


@njit(cache=True, nogil=True, error_model="numpy")
def _samples(
    x: int, y: int, w: Any, A: Any, b: Any, stack: Any, hidden: Any, scale: Any, front: Any, margin: Any, tested: bool,
    fine: bool, most: int, out: Any,
) -> int:  # fmt: skip
    """Colours (m, 3) of a point in the first ``most`` frames that see it; how many.

    Tested: not in those that see something nearer there. Fine: by 4 x 4 pixels.
    """
    count = 0
    height, width = stack.shape[1], stack.shape[2]
    for n in range(stack.shape[0]):
        u, v, z = placed(A, b, n, x, y, w)
        if not (z > 0 and shown(hidden, n, u, v)):
            continue
        iu, iv = int(u), int(v)
        if tested and nearer_before(front, n, u, v, width, height, w / z, margin):
            continue
        q, r = u - iu, v - iv
        inner = iu > 0 and iv > 0 and iu < width - 2 and iv < height - 2
        red, green, blue = _bent(stack, n, iu, iv, q, r) if fine and inner else straight(stack, n, iu, iv, q, r)
        out[count, 0], out[count, 1], out[count, 2] = red * scale[n, 0], green * scale[n, 1], blue * scale[n, 2]
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
            against = _seen_through(columns[k], rows[k], middle, key_A, key_b, known, tolerance)
            worth = np.float32(SUPPORT) * min(support, np.float32(4))
            burden = np.float32(AGAINST) * min(against, np.float32(4))
            if burden - worth >= best:
                # However well colours agree, it cannot win.
                continue
            count = _samples(
                columns[k], rows[k], middle, A, b, stack, hidden, scale, known, np.float32(0), False, False, 8, values
            )  # fmt: skip
            cost = np.float32(UNSEEN)
            if count >= 2:
                cost = np.float32(0)
                for c in range(3):
                    m = _median(values, count, c, work)
                    for s in range(count):
                        cost += min(abs(values[s, c] - m), np.float32(UNSEEN))
                cost /= 3 * count
                cost *= np.float32(1) + np.float32(1) / count
            cost -= worth
            cost += burden
            if cost < best:
                best = cost
                result[k] = middle


@njit(cache=True, nogil=True, error_model="numpy")
def _gather(
    rows: Any, columns: Any, inverse: Any, A: Any, b: Any, stack: Any, hidden: Any, scale: Any, front: Any, margin: Any,
    least: int, nearest: int, colour: Any, seen: Any,
) -> None:  # fmt: skip
    values, work = np.empty((nearest, 3), np.float32), np.empty(nearest, np.float32)
    for k in range(len(rows)):
        if inverse[k] <= 0:
            continue
        here = columns[k], rows[k], inverse[k]
        count = _samples(*here, A, b, stack, hidden, scale, front, margin, True, True, nearest, values)
        if count < least:
            count = _samples(*here, A, b, stack, hidden, scale, front, margin, False, True, nearest, values)
        seen[k] = count
        for c in range(3):
            if count > 0:
                colour[k, c] = _median(values, count, c, work)
