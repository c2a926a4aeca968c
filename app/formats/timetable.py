"""The presentation times of a video, read from its packets without decoding a picture."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import attrs
import numpy as np
from numpy.typing import NDArray

from imitation.errors import InputError


@attrs.frozen(eq=False)
class TimeTable:
    """When each frame is shown, and from where it can be decoded.

    Attributes
    ----------
    ticks : (n,) int64 presentation times in units of ``time_base``, ascending.
    key : (n,) the last key frame at or before each frame.
    time_base : seconds of a tick.
    fps : frames per second, exact where the rate is constant, else the average.
    constant : whether all frames last equally long (to the precision of a tick).
    """

    ticks: NDArray[np.int64]
    key: NDArray[np.int64]
    time_base: Fraction
    fps: Fraction
    constant: bool

    @property
    def times(self) -> NDArray[np.float64]:
        """Seconds (n,) since the first frame."""
        seconds = (self.ticks - self.ticks[0]) * self.time_base.numerator / self.time_base.denominator
        return np.asarray(seconds, np.float64)


def read_timetable(container: Any, stream: Any, name: str, *, partial: bool = False) -> TimeTable:
    """Demux a whole container and tabulate one stream.

    Parameters
    ----------
    container, stream : an open PyAV container and its video stream.
    name : what to call the file in errors.
    partial : accept a file that was cut off, with the frames it still has.

    Raises
    ------
    InputError
        No frames, or the file ends before it should.
    """
    import av

    ticks: list[int] = []
    keys: list[int] = []
    unknown = corrupt = hidden = 0
    end: float | None = None
    promised = _promised(container, stream)
    try:
        for packet in container.demux():
            moment = packet.pts if packet.pts is not None else packet.dts
            if moment is not None and packet.time_base:
                reach = float((moment + (packet.duration or 0)) * packet.time_base)
                end = reach if end is None else max(end, reach)
            if packet.stream_index != stream.index or packet.size == 0:
                continue
            corrupt += packet.is_corrupt
            if packet.is_discard:
                hidden += 1
            elif packet.pts is None:
                unknown += 1
            elif not packet.is_corrupt:
                ticks.append(packet.pts)
                if packet.is_keyframe:
                    keys.append(packet.pts)
    except av.FFmpegError:
        corrupt += 1
    if unknown and not ticks:
        raise InputError(f"The video {name} states no presentation times: convert it to mp4 first.")
    if not ticks:
        raise InputError(f"The video {name} holds no frames: choose another file.")
    if not partial:
        _check_whole(container, name, promised, len(ticks) + hidden + unknown, corrupt, end)
    order = np.unique(np.array(ticks, np.int64))
    first_keys = np.unique(np.array([order[0], *keys], np.int64))
    key_frames = np.searchsorted(order, first_keys)
    key = key_frames[np.searchsorted(first_keys, order, side="right") - 1]
    fps, constant = _rate(order, stream)
    return TimeTable(order, key.astype(np.int64), stream.time_base, fps, constant)


def _promised(container: Any, stream: Any) -> int:
    """How many pictures the file says it has, 0 where it does not say."""
    if "mp4" not in container.format.name:
        return int(stream.frames)
    # An edit list may leave out samples that the sample table counts: the index has what will really be read.
    return min(int(stream.frames), len(stream.index_entries))


def _check_whole(container: Any, name: str, promised: int, found: int, corrupt: int, end: float | None) -> None:
    if corrupt or promised > found:
        count = f"{found} of {promised}" if promised > found else str(found)
        raise InputError(
            f"The video {name} is cut off or damaged ({count} frames could be read): get a whole copy of it, or "
            "convert what is left to a new file."
        )
    if container.duration and end is not None:
        lasting = container.duration / 1e6 + (container.start_time or 0) / 1e6
        # Matroska states its length to the millisecond; elsewhere it may be an estimate from the bit rate.
        slack = 0.3 if "matroska" in container.format.name else 1.0 + 0.1 * lasting
        if end < lasting - slack:
            raise InputError(
                f"The video {name} is cut off (it ends after {end:.1f} of {lasting:.1f} seconds): get a whole copy of "
                "it, or convert what is left to a new file."
            )


def _rate(ticks: NDArray[np.int64], stream: Any) -> tuple[Fraction, bool]:
    base: Fraction = stream.time_base
    nominal: Fraction | None = stream.guessed_rate or stream.average_rate
    if len(ticks) < 2:
        return nominal or Fraction(25), True
    average = (len(ticks) - 1) / (int(ticks[-1] - ticks[0]) * base)
    for rate in (nominal, stream.average_rate, average.limit_denominator(1001)):
        if rate:
            even = ticks[0] + np.arange(len(ticks)) * float(1 / (rate * base))
            if np.abs(ticks - even).max() <= 1.0:
                return Fraction(rate), True
    return average, False
