"""Masks drawn in a few frames, carried to all others by optical flow and shape interpolation."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from imitation.errors import InputError
from imitation.progress import Progress, silent
from imitation.tracking.clip import PreparedClip, prepare_clip
from imitation.tracking.flow import FlowField, Picture, single_threaded_cv2
from imitation.tracking.outlines import FAR, KeyMask, Mask, key_mask, signed_distance

LOST = 0.15  # a carried mask that overlaps the next key less than this is not to be believed alone


class _Carrier:
    """Carries a mask away from its frame: keeps, for every pixel, where in the key frame it came from.

    One look-up in the key's mask at the end blurs less than passing the mask itself from frame to frame.
    """

    def __init__(self, clip: PreparedClip, frame: int, mask: Mask) -> None:
        self._cv2, self._clip, self._frame = single_threaded_cv2(), clip, frame
        self._shape = (clip.height // clip.scale, clip.width // clip.scale)
        small = self._resized(signed_distance(mask) / clip.scale, self._shape)
        self._distance = np.clip(small, -1000, 1000)
        rows, columns = np.indices(self._shape, dtype=np.float32)
        self._rows, self._columns = rows, columns
        self._from_x, self._from_y = columns, rows

    def _resized(self, field: NDArray[Any], shape: tuple[int, int]) -> NDArray[np.float32]:
        field = field.astype(np.float32)
        if field.shape == shape:
            return field
        resized: NDArray[np.float32] = self._cv2.resize(field, shape[::-1], interpolation=self._cv2.INTER_LINEAR)
        return resized

    def step(self, frame: int) -> Mask:
        """Go on to a neighbouring frame and give the mask there, at the size of the picture."""
        flow = self._clip.flow(frame, self._frame).view(np.float16).astype(np.float32) / self._clip.scale
        x, y = self._columns + flow[..., 0], self._rows + flow[..., 1]
        cv2 = self._cv2
        self._from_x = cv2.remap(self._from_x, x, y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
        self._from_y = cv2.remap(self._from_y, x, y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
        self._frame = frame
        carried = cv2.remap(
            self._distance, self._from_x, self._from_y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE
        )
        mask: Mask = self._resized(carried, (self._clip.height, self._clip.width)) > 0
        return mask


def _blend(first: Mask, second: Mask, weight: float) -> NDArray[np.float32]:
    a, b = signed_distance(first), signed_distance(second)
    if a.flat[0] <= -FAR or b.flat[0] <= -FAR:
        return a if weight >= 0.5 else b
    return weight * a + (1 - weight) * b


def blend_masks(first: Mask, second: Mask, weight: float) -> Mask:
    """Shape between two masks (signed distances weighted); beside an empty one the nearer of the two decides."""
    mixed: Mask = _blend(first, second, weight) > 0
    return mixed


def carry_masks(
    frames: Sequence[Picture] | PreparedClip,
    key_masks: Mapping[int, KeyMask],
    *,
    flow: FlowField | None = None,
    progress: Progress | None = None,
) -> NDArray[np.bool_]:
    """Masks of all frames from those of a few (paper A, 3.1: features on the subject are left out).

    Between two key frames each one's mask is carried by optical flow, and the two shapes are blended by their
    signed distances; before the first and after the last key the flow alone carries the mask.

    Parameters
    ----------
    frames : n uint8 RGB pictures (h, w, 3), or a ``PreparedClip``.
    key_masks : frame -> outlines in drawing order (``Outline``, or (k, 2) arrays), or a bool mask (h, w).
        An empty list says that the subject is not to be seen.
    flow : dense flow from ``compute_flow``; missing pairs are computed.
    progress : called at least once a frame; may raise ``Cancelled``.

    Returns
    -------
    (n, h, w) bool. In key frames it is exactly what was given.

    Raises
    ------
    InputError : no key masks, a key outside the clip, a mask of another size, an outline with fewer than 3 points.
    """
    clip = prepare_clip(frames, flow=flow)
    if not key_masks:
        raise InputError("Carrying masks needs a mask in at least one frame; draw an outline around the subject.")
    for frame in key_masks:
        if not 0 <= frame < clip.count:
            raise InputError(f"A mask lies in frame {frame}, but the clip has frames 0 to {clip.count - 1}; remove it.")
    keys = sorted(key_masks)
    out = np.zeros((clip.count, clip.height, clip.width), np.bool_)
    for frame in keys:
        out[frame] = key_mask(key_masks[frame], frame, clip.height, clip.width)
    report, steps = progress or silent, _count_steps(keys, clip.count)
    report(0.0)
    for done, _ in enumerate(_carry(clip, keys, out), start=1):
        report(min(done / max(steps, 1), 1.0))
    report(1.0)
    return out


def _count_steps(keys: Sequence[int], count: int) -> int:
    between = sum(3 * (right - left) for left, right in pairwise(keys) if right > left + 1)
    return between + keys[0] + count - 1 - keys[-1]


def _carry(clip: PreparedClip, keys: Sequence[int], out: NDArray[np.bool_]) -> Iterator[None]:
    """Fill ``out`` step by step."""
    head = _Carrier(clip, keys[0], out[keys[0]])
    for frame in range(keys[0] - 1, -1, -1):
        out[frame] = head.step(frame)
        yield
    tail = _Carrier(clip, keys[-1], out[keys[-1]])
    for frame in range(keys[-1] + 1, clip.count):
        out[frame] = tail.step(frame)
        yield
    for left, right in pairwise(keys):
        if right > left + 1:
            yield from _between(clip, left, right, out)


def _between(clip: PreparedClip, left: int, right: int, out: NDArray[np.bool_]) -> Iterator[None]:
    ahead, back = _Carrier(clip, left, out[left]), _Carrier(clip, right, out[right])
    forward, backward = {}, {}
    for frame in range(left + 1, right + 1):
        forward[frame] = ahead.step(frame)
        yield
    for frame in range(right - 1, left - 1, -1):
        backward[frame] = back.step(frame)
        yield
    # A subject that passed behind something is lost by the flow: it does not arrive at the other key.
    arrived = (_overlap(forward[right], out[right]) + _overlap(backward[left], out[left])) / 2
    trust = min(arrived / LOST, 1.0)
    for frame in range(left + 1, right):
        weight = (right - frame) / (right - left)
        shape = _blend(forward[frame], backward[frame], weight)
        if trust < 1:
            still = _blend(*_brought_together(out[left], out[right], weight), weight)
            shape = trust * np.clip(shape, -50, 50) + (1 - trust) * np.clip(still, -50, 50)
        out[frame] = shape > 0
        yield


def _overlap(first: Mask, second: Mask) -> float:
    union = np.count_nonzero(first | second)
    return np.count_nonzero(first & second) / union if union else 1.0


def _brought_together(first: Mask, second: Mask, weight: float) -> tuple[Mask, Mask]:
    """Both masks moved to where the subject's centre would be if it went straight."""
    if not first.any() or not second.any():
        return first, second
    cv2 = single_threaded_cv2()
    centres = [np.array([np.median(axis) for axis in np.nonzero(mask)[::-1]]) for mask in (first, second)]
    middle, moved = weight * centres[0] + (1 - weight) * centres[1], []
    for mask, centre in zip((first, second), centres, strict=True):
        shift = np.column_stack([np.eye(2), middle - centre])
        moved.append(cv2.warpAffine(mask.astype(np.uint8), shift, mask.shape[::-1]) > 0)
    return moved[0], moved[1]
