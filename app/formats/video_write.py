"""Writing videos: H.264 in mp4, every frame at its exact time."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sized
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.formats.atomic import replacing
from app.formats.source import FrameSource, Picture
from imitation.errors import InputError
from imitation.progress import Progress, silent

# The number of encoder threads changes x264's output, so it does not follow the number of cores.
_THREADS = 4
_BT709 = 1


def write_video(
    path: str | Path,
    frames: Iterable[Picture],
    fps: Fraction | float,
    progress: Progress | None = None,
    *,
    count: int | None = None,
    quality: int = 17,
    gop: int = 48,
) -> None:
    """Write frames as H.264, yuv420p, which every player opens; whole or not at all.

    Parameters
    ----------
    path : ends in .mp4, .mov or .mkv.
    frames : uint8 RGB (h, w, 3), all of one size; may be an iterator. An odd width or height is filled up by one
        repeated column or row, because the format has none.
    fps : frames per second, kept exactly (30000/1001 too).
    count : the number of frames where ``frames`` does not know it; for progress only.
    quality : x264's constant rate factor, smaller is better (0 to 51).
    gop : frames from key frame to key frame.

    Raises
    ------
    InputError
        No frames, frames of different shapes, a suffix that is not a video's, or the disk is full.
    """
    path, rate = Path(path), _rate(fps)
    if path.suffix.lower() not in (".mp4", ".mov", ".mkv"):
        raise InputError(f"A video cannot be written as {path.name}: use the suffix .mp4.")
    report = progress or silent
    total = count or (len(frames) if isinstance(frames, Sized) else 0)
    report(0.0)
    with replacing(path) as temporary:
        _encode(temporary, iter(frames), rate, report, total, {"crf": str(quality), "g": str(gop)})
    report(1.0)


def write_working_copy(
    source: FrameSource, path: str | Path, progress: Progress | None = None, *, long_side: int = 1280, gop: int = 12
) -> NDArray[np.int64]:
    """Write a copy that is quick to jump in: constant rate, a key frame every ``gop`` frames, at most ``long_side``.

    A varying rate becomes constant by showing each frame as long as before (to the nearest new frame).

    Returns
    -------
    (m,) the source's frame shown in each frame of the copy.
    """
    import cv2

    fps = _even_rate(source)
    last = float(source.times[-1])
    moments = np.arange(round(last * float(fps)) + 1) / float(fps)
    shown = np.searchsorted(source.times, moments + 0.5 / float(fps), side="left") - 1
    if getattr(source, "constant_rate", False):
        shown = np.arange(len(source))
    width, height = source.size
    scale = min(1.0, long_side / max(width, height))
    size = (max(2, round(width * scale / 2) * 2), max(2, round(height * scale / 2) * 2))

    def scaled() -> Iterator[Picture]:
        for frame in shown:
            picture = source[int(frame)]
            yield (
                picture
                if scale == 1.0
                else np.asarray(cv2.resize(picture, size, interpolation=cv2.INTER_AREA), np.uint8)
            )

    write_video(path, scaled(), fps, progress, count=len(shown), gop=gop)
    return shown.astype(np.int64)


def _even_rate(source: FrameSource) -> Fraction:
    if getattr(source, "constant_rate", False) or len(source) < 2:
        return source.fps
    return Fraction(1 / float(np.median(np.diff(source.times)))).limit_denominator(1001)


def _rate(fps: Fraction | float) -> Fraction:
    rate = Fraction(fps).limit_denominator(100_000) if np.isfinite(float(fps)) else Fraction(0)
    if not 0 < rate <= 1000:
        raise InputError(f"The frame rate must be above 0 and at most 1000, but got {fps}.")
    return rate


def _encode(
    path: Path, frames: Iterator[Picture], fps: Fraction, report: Progress, total: int, options: dict[str, str]
) -> None:
    import av

    first = next(frames, None)
    if first is None:
        raise InputError("A video of no frames cannot be written: give at least one.")
    shape = _checked(first, 0, None)
    muxing = {} if path.suffix.lower() == ".mkv" else {"movflags": "+faststart"}
    with av.open(str(path), "w", options=muxing) as container:
        # Measured: with the macroblock tree, the encoder's choices hang on memory that nobody has set, so that each
        # process writes other bytes for the same frames.
        stream: Any = container.add_stream("libx264", rate=fps, options={"preset": "medium", "mbtree": "0", **options})
        height, width = shape[0] + shape[0] % 2, shape[1] + shape[1] % 2
        context = stream.codec_context
        context.width, context.height, context.pix_fmt = width, height, "yuv420p"
        context.time_base, context.thread_count = 1 / fps, _THREADS
        context.color_primaries = context.color_trc = context.colorspace = context.color_range = _BT709
        picture: Picture | None = first
        number = 0
        while picture is not None:
            _checked(picture, number, shape)
            even = np.pad(picture, ((0, height - shape[0]), (0, width - shape[1]), (0, 0)), mode="edge")
            frame = av.VideoFrame.from_ndarray(np.ascontiguousarray(even), format="rgb24").reformat(
                format="yuv420p", dst_colorspace="ITU709", interpolation="BICUBIC", threads=1
            )
            frame.pts, frame.time_base = number, 1 / fps
            container.mux(stream.encode(frame))
            number += 1
            report(min(number / total, 1.0) if total else 0.0)
            picture = next(frames, None)
        container.mux(stream.encode(None))


def _checked(picture: Any, number: int, shape: tuple[int, ...] | None) -> tuple[int, ...]:
    array = np.asarray(picture)
    if array.dtype != np.uint8 or array.ndim != 3 or array.shape[2] != 3 or not array.size:
        raise InputError(f"Frame {number} must be uint8 (h, w, 3), but is {array.dtype} {array.shape}.")
    if shape is not None and array.shape != shape:
        raise InputError(f"Frame {number} has the shape {array.shape}, but the first one has {shape}: give one size.")
    return array.shape
