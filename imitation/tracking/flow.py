"""Dense optical flow of a clip, both ways in time, in half precision."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import attrs
import numpy as np
from numpy.typing import NDArray

from imitation.errors import InputError
from imitation.progress import Progress, silent

Picture = NDArray[np.uint8]
Flow16 = NDArray[np.float16]
PIXELS_AT_FULL_SIZE = 1_300_000


def single_threaded_cv2() -> Any:
    """Return OpenCV bound to one thread: its dense flow depends on the number of stripes, so on that of threads."""
    import cv2

    if cv2.getNumThreads() != 1:
        cv2.setNumThreads(1)
    return cv2


def flow_scale(height: int, width: int) -> int:
    """Picture pixels a flow pixel: 1 up to about 1.3 million pixels, then 2, 4, ... (time and memory stay bounded)."""
    scale = 1
    while (height // scale) * (width // scale) > PIXELS_AT_FULL_SIZE:
        scale *= 2
    return scale


@attrs.frozen(eq=False)
class FlowField:
    """Optical flow between neighbouring frames of a clip of n frames.

    The arrays may be memory-mapped files, and filled later or in part (``ready`` says which pairs are there).

    Attributes
    ----------
    forward : (n - 1, h, w, 2) float16, pixels of the picture: frame t to frame t + 1.
    backward : (n - 1, h, w, 2) float16: frame t + 1 to frame t.
    ready : (n - 1,) bool, the pairs that are computed.
    scale : picture pixels per pixel of the arrays (h = picture height // scale).
    """

    forward: Flow16
    backward: Flow16
    ready: NDArray[np.bool_]
    scale: int = 1

    def __attrs_post_init__(self) -> None:
        shape = self.forward.shape
        if len(shape) != 4 or shape[3] != 2 or self.backward.shape != shape or self.ready.shape != shape[:1]:
            raise InputError(
                "A flow field needs two arrays of shape (frames - 1, h, w, 2) and one flag a pair, "
                f"but got {shape}, {self.backward.shape} and {self.ready.shape}."
            )
        if self.forward.dtype != np.float16 or self.backward.dtype != np.float16:
            raise InputError(f"A flow field holds float16, but got {self.forward.dtype} and {self.backward.dtype}.")

    @classmethod
    def empty(cls, frames: int, height: int, width: int) -> FlowField:
        """Room for the flow of ``frames`` pictures of height x width, with no pair computed."""
        scale = flow_scale(height, width)
        shape = (max(frames - 1, 0), height // scale, width // scale, 2)
        return cls(np.zeros(shape, np.float16), np.zeros(shape, np.float16), np.zeros(shape[0], np.bool_), scale)

    def fits(self, frames: int, height: int, width: int) -> bool:
        """Whether the field belongs to a clip of that size."""
        return self.forward.shape[:3] == (max(frames - 1, 0), height // self.scale, width // self.scale)


class PairFlow:
    """Computes the flow of single pairs; one object serves one thread."""

    def __init__(self) -> None:
        self._cv2 = single_threaded_cv2()
        self._dis = self._cv2.DISOpticalFlow_create(self._cv2.DISOPTICAL_FLOW_PRESET_MEDIUM)

    def grey(self, frame: Picture, scale: int) -> Picture:
        """Grey picture of the size the flow is computed at."""
        grey: Picture = self._cv2.cvtColor(frame, self._cv2.COLOR_RGB2GRAY)
        if scale > 1:
            size = (frame.shape[1] // scale, frame.shape[0] // scale)
            grey = self._cv2.resize(grey, size, interpolation=self._cv2.INTER_AREA)
        return grey

    def one_way(self, first: Picture, second: Picture, scale: int) -> Flow16:
        """Flow from one grey picture to another, (h, w, 2) float16, in pixels of the full picture."""
        if min(first.shape) < 32:  # smaller than the coarsest patches of the method
            pad = [(0, max(0, 32 - side)) for side in first.shape]
            wide = [np.pad(picture, pad, mode="edge") for picture in (first, second)]
            flow = self._dis.calc(wide[0], wide[1], None)[: first.shape[0], : first.shape[1]]
        else:
            flow = self._dis.calc(first, second, None)
        half: Flow16 = np.clip(flow * scale, -60000, 60000).astype(np.float16)
        return half


def check_frames(frames: Sequence[Picture]) -> tuple[int, int, int]:
    """Number of frames, height and width; refuses what is not a sequence of RGB pictures."""
    if len(frames) == 0:
        raise InputError("The clip has no frames; choose a video with at least one picture.")
    shape, kind = np.shape(frames[0]), getattr(frames[0], "dtype", None)
    if len(shape) != 3 or shape[2] != 3 or kind != np.uint8:
        raise InputError(f"Frames must be uint8 RGB pictures of shape (h, w, 3), but frame 0 is {kind} {shape}.")
    return len(frames), shape[0], shape[1]


def compute_flow(
    frames: Sequence[Picture],
    progress: Progress | None = None,
    *,
    out: FlowField | None = None,
    pairs: Iterable[int] | None = None,
) -> FlowField:
    """Dense inverse search flow (preset MEDIUM) between neighbouring frames, both ways.

    Parameters
    ----------
    frames : sequence of uint8 RGB pictures (h, w, 3); each is read once, in order.
    progress : called after each flow of a pair; may raise ``Cancelled`` (finished pairs of ``out`` stay ready).
    out : field to fill, such as one on memory-mapped arrays; pairs that are ready are left alone.
    pairs : the pairs to compute (t means frames t and t + 1); all where omitted.

    Returns
    -------
    FlowField : ``out``, or a new field.

    Raises
    ------
    InputError : no frames, pictures of the wrong kind, or a field of another size.
    """
    count, height, width = check_frames(frames)
    field = FlowField.empty(count, height, width) if out is None else out
    if not field.fits(count, height, width):
        raise InputError(
            f"The flow field is made for another clip: it does not fit {count} frames of {width} x {height}."
        )
    report = progress or silent
    report(0.0)
    engine = PairFlow()
    wanted = [t for t in (range(count - 1) if pairs is None else sorted(set(pairs))) if not field.ready[t]]
    known: tuple[int, Picture] | None = None
    for done, t in enumerate(wanted):
        first = known[1] if known and known[0] == t else engine.grey(frames[t], field.scale)
        second = engine.grey(frames[t + 1], field.scale)
        forward = engine.one_way(first, second, field.scale)
        report((done + 0.5) / len(wanted))
        field.backward[t] = engine.one_way(second, first, field.scale)
        field.forward[t] = forward
        field.ready[t] = True
        known = (t + 1, second)
        report((done + 1) / len(wanted))
    report(1.0)
    return field
