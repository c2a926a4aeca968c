"""A clip made ready for tracking: pyramids and flow, computed once, shared by all points, in bounded memory."""

from __future__ import annotations

import threading
from collections import OrderedDict
from collections.abc import Callable, Sequence
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from imitation.errors import InputError
from imitation.tracking.flow import FlowField, PairFlow, Picture, check_frames, flow_scale, single_threaded_cv2
from imitation.tracking.subject import cut_out, plain_grey, subject_flow

LEVELS = 4
NO_MASK = np.zeros((0, 0), np.uint8)
Pyramid = tuple[Picture, ...]


class PreparedClip:
    """Frames of a clip with what trackers need of them, computed when first asked for and kept while there is room.

    Safe to use from several threads. Two of them may compute the same picture at once; both get the same bits.

    Parameters
    ----------
    frames : sequence of uint8 RGB pictures (h, w, 3).
    flow : a field (its pairs that are not ready are computed here), None (everything is computed here), or "lk" for
        a quick preview that needs no dense flow.
    masks : sequence of (h, w) bool, the subject in each frame, or None.
    memory : bytes of pyramids and flow kept here.
    """

    def __init__(
        self,
        frames: Sequence[Picture],
        *,
        flow: FlowField | Literal["lk"] | None = None,
        masks: Sequence[NDArray[np.bool_]] | None = None,
        memory: int = 1 << 30,
    ) -> None:
        self.frames = frames
        self.count, self.height, self.width = check_frames(frames)
        self.preview = isinstance(flow, str)
        if isinstance(flow, str) and flow != "lk":
            raise InputError(f'The flow must be a flow field, None or "lk", but got "{flow}".')
        self.field = None if isinstance(flow, str) else flow
        if self.field is not None and not self.field.fits(self.count, self.height, self.width):
            raise InputError(
                f"The flow field is made for another clip: it does not fit {self.count} frames "
                f"of {self.width} x {self.height}."
            )
        self.scale = self.field.scale if self.field is not None else flow_scale(self.height, self.width)
        self.masks = None if masks is None else self._checked(masks)
        self._memory, self._used = memory, 0
        self._kept: OrderedDict[tuple[str, int], tuple[Any, int]] = OrderedDict()
        self._lock = threading.Lock()
        self._engines = threading.local()
        self._plain: int | None = None

    def __len__(self) -> int:
        return self.count

    def _checked(self, masks: Sequence[NDArray[np.bool_]]) -> Sequence[NDArray[np.bool_]]:
        if len(masks) != self.count:
            raise InputError(f"There must be one mask a frame: the clip has {self.count}, but {len(masks)} were given.")
        if np.shape(masks[0]) != (self.height, self.width):
            raise InputError(
                f"Masks must have the size of the frames, ({self.height}, {self.width}), but got {np.shape(masks[0])}."
            )
        return masks

    def _get(self, kind: str, frame: int, make: Callable[[int], tuple[NDArray[Any], ...]]) -> Any:
        key = (kind, frame)
        with self._lock:
            if key in self._kept:
                self._kept.move_to_end(key)
                return self._kept[key][0]
        value = make(frame)
        size = sum(level.nbytes for level in value)
        with self._lock:
            if key not in self._kept:
                self._kept[key] = (value, size)
                self._used += size
            while self._used > self._memory and len(self._kept) > 1:
                self._used -= self._kept.popitem(last=False)[1][1]
        return value

    def _picture(self, frame: int) -> Picture:
        picture = np.ascontiguousarray(self.frames[frame])
        if picture.shape != (self.height, self.width, 3) or picture.dtype != np.uint8:
            raise InputError(
                f"Frame {frame} is {picture.dtype} {picture.shape}, but the clip is uint8 "
                f"({self.height}, {self.width}, 3)."
            )
        return picture

    def _pyramid(self, base: Picture) -> Pyramid:
        cv2, levels = single_threaded_cv2(), [base]
        for _ in range(LEVELS - 1):
            levels.append(cv2.pyrDown(levels[-1]))
        return tuple(levels)

    def colours(self, frame: int) -> Pyramid:
        """Gaussian pyramid of the RGB picture, finest first: (h, w, 3), (h / 2, w / 2, 3), ..."""
        value: Pyramid = self._get("colours", frame, lambda t: self._pyramid(self._picture(t)))
        return value

    def looks(self, frame: int) -> Pyramid:
        """Gaussian pyramid of what trackers compare: the subject on plain ground where there are masks, else all."""
        if self.masks is None:
            return self.colours(frame)
        value: Pyramid = self._get("looks", frame, lambda t: self._pyramid(self._cut_out(t)))
        return value

    def look_greys(self, frame: int) -> Pyramid:
        """Gaussian pyramid of the grey of ``looks``."""
        if self.masks is None:
            return self.greys(frame)

        def make(t: int) -> Pyramid:
            cv2 = single_threaded_cv2()
            return self._pyramid(cv2.cvtColor(self.looks(t)[0], cv2.COLOR_RGB2GRAY))

        value: Pyramid = self._get("look greys", frame, make)
        return value

    def _cut_out(self, frame: int) -> Picture:
        with self._lock:
            if self._plain is None and self.masks is not None:
                self._plain = plain_grey(self.frames, self.masks)
        return cut_out(self._picture(frame), self.mask(frame), self._plain or 0)

    @property
    def subject_scale(self) -> int:
        """Picture pixels per pixel of ``subject_flow``."""
        return self.scale if self.masks is None else 1

    def subject_flow(self, start: int, stop: int) -> NDArray[np.uint16]:
        """As ``flow``, of the subject on plain ground where there are masks (fine enough for thin limbs)."""
        if self.masks is None:
            return self.flow(start, stop)
        pair, side = min(start, stop), 0 if start < stop else 1
        both: tuple[NDArray[np.uint16], NDArray[np.uint16]] = self._get("subject flow", pair, self._subject_pair)
        return both[side]

    def _subject_pair(self, pair: int) -> tuple[NDArray[np.uint16], NDArray[np.uint16]]:
        first, second = (self.look_greys(t)[0] for t in (pair, pair + 1))
        inside = (self.mask(pair) | self.mask(pair + 1)).view(np.bool_)
        both = subject_flow(self._engine(), first, second, inside)
        return both[0].view(np.uint16), both[1].view(np.uint16)

    def _engine(self) -> PairFlow:
        if not hasattr(self._engines, "flow"):
            self._engines.flow = PairFlow()
        engine: PairFlow = self._engines.flow
        return engine

    def greys(self, frame: int) -> Pyramid:
        """Gaussian pyramid of the grey picture, finest first."""

        def make(t: int) -> Pyramid:
            cv2 = single_threaded_cv2()
            return self._pyramid(cv2.cvtColor(self._picture(t), cv2.COLOR_RGB2GRAY))

        value: Pyramid = self._get("greys", frame, make)
        return value

    def flow(self, start: int, stop: int) -> NDArray[np.uint16]:
        """Bits of the float16 flow from a frame to a neighbour, (h, w, 2): compiled code knows no float16."""
        pair, side = min(start, stop), 0 if start < stop else 1
        if self.field is not None and self.field.ready[pair]:
            stored = (self.field.forward, self.field.backward)[side][pair]
            bits: NDArray[np.uint16] = stored.view(np.uint16)
            return bits
        both: tuple[NDArray[np.uint16], NDArray[np.uint16]] = self._get("flow", pair, self._pair)
        return both[side]

    def _pair(self, pair: int) -> tuple[NDArray[np.uint16], NDArray[np.uint16]]:
        engine = self._engine()
        first, second = (engine.grey(self._picture(t), self.scale) for t in (pair, pair + 1))
        both = engine.one_way(first, second, self.scale), engine.one_way(second, first, self.scale)
        return both[0].view(np.uint16), both[1].view(np.uint16)

    def mask(self, frame: int) -> Picture:
        """Mask of the subject as (h, w) uint8 of 0 and 1, or an empty array where there is none."""
        masks = self.masks
        if masks is None:
            return NO_MASK

        def make(t: int) -> Pyramid:
            mask = np.asarray(masks[t])
            if mask.shape != (self.height, self.width):
                raise InputError(f"The mask of frame {t} is {mask.shape}, not ({self.height}, {self.width}).")
            return (np.ascontiguousarray(mask.astype(bool)).view(np.uint8),)

        value: Pyramid = self._get("mask", frame, make)
        return value[0]


def prepare_clip(
    frames: Sequence[Picture] | PreparedClip,
    *,
    flow: FlowField | Literal["lk"] | None = None,
    masks: Sequence[NDArray[np.bool_]] | None = None,
    memory: int = 1 << 30,
) -> PreparedClip:
    """Make a clip ready for tracking many points; a clip that is ready is returned as it is.

    See ``PreparedClip`` for the parameters. Nothing is computed here: pyramids and flow are made when a point
    first needs them, and shared from then on.
    """
    if isinstance(frames, PreparedClip):
        return frames
    return PreparedClip(frames, flow=flow, masks=masks, memory=memory)
