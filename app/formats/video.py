"""Reading videos: any frame exactly, upright, decoded on demand in bounded memory."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from app.formats.cache import ByteCache
from app.formats.fingerprint import file_fingerprint
from app.formats.source import FrameSource, Picture
from app.formats.timetable import read_timetable
from imitation.errors import InputError

MEMORY = 192 << 20
"""Default budget of decoded frames, bytes."""


def open_video(path: str | Path, *, memory: int = MEMORY, partial: bool = False) -> VideoFrames:
    """Open a video as a sequence of RGB frames.

    Parameters
    ----------
    path : the file; any container and codec that FFmpeg reads.
    memory : budget of decoded frames, bytes.
    partial : open a file that was cut off, with the frames it still has.

    Raises
    ------
    InputError
        No such file, not a video, no frames, or (unless ``partial``) cut off.
    """
    return VideoFrames(Path(path), memory=memory, partial=partial)


class VideoFrames(FrameSource):
    """The frames of a video file.

    Frame numbers are positions in the table of presentation times, so they are exact at variable rates, with
    B-frames and edit lists. Pictures are turned upright and have square pixels.

    Attributes
    ----------
    rotation : degrees by which the file asks its pictures to be turned counter-clockwise (already done).
    constant_rate : whether all frames last equally long.
    path : the file.
    """

    def __init__(self, path: Path, *, memory: int = MEMORY, partial: bool = False) -> None:
        self.path, self._memory, self._partial = path, memory, partial
        self._lock = threading.RLock()
        self._decoded: ByteCache[Any] = ByteCache(memory - memory // 8)
        self._shown: ByteCache[Picture] = ByteCache(memory // 8)
        self._container: Any = None
        self._pictures: Iterator[Any] | None = None
        self._next = -1
        self.fingerprint = file_fingerprint(_existing(path))
        self._open()
        try:
            self._table = read_timetable(self._container, self._stream, path.name, partial=partial)
            self.times = self._table.times
            self.times.setflags(write=False)
            self.fps, self.constant_rate = self._table.fps, self._table.constant
            self._position = {int(tick): frame for frame, tick in enumerate(self._table.ticks)}
            first = self._decode(0)
            self.rotation = int(first.rotation) % 360
            self._aspect = float(self._stream.sample_aspect_ratio or 1) or 1.0
            height, width = self._upright(first).shape[:2]
            self.size = (width, height)
        except BaseException:
            self.close()
            raise

    def __reduce__(self) -> tuple[Any, ...]:
        # Another process opens the file itself.
        return VideoFrames._again, (self.path, self._memory, self._partial)

    @staticmethod
    def _again(path: Path, memory: int, partial: bool) -> VideoFrames:
        return VideoFrames(path, memory=memory, partial=partial)

    def close(self) -> None:
        """Let go of the file and of all decoded frames."""
        with self._lock:
            self._pictures = None
            if self._container is not None:
                self._container.close()
                self._container = None
            self._decoded.clear()
            self._shown.clear()

    @property
    def memory_used(self) -> int:
        """Bytes of decoded frames held now."""
        return self._decoded.used + self._shown.used

    def _picture(self, frame: int) -> Picture:
        with self._lock:
            shown = self._shown.get(frame)
            if shown is None:
                shown = self._upright(self._decode(frame))
                shown.setflags(write=False)
                self._shown.put(frame, shown, shown.nbytes)
            return shown

    def _open(self) -> None:
        import av

        if self._container is not None:
            self._container.close()
        try:
            self._container = av.open(str(self.path), options={"fflags": "+genpts"}, metadata_errors="replace")
        except av.FFmpegError as error:
            raise InputError(
                f"The file {self.path.name} is not a video that can be read: choose another file, or convert it to mp4."
            ) from error
        if not self._container.streams.video:
            self._container.close()
            raise InputError(f"The file {self.path.name} holds no pictures: choose a video.")
        self._stream = self._container.streams.video[0]
        # Frame threads would hold back pictures and make every jump decode more than it needs.
        self._stream.thread_type = "SLICE"

    def _decode(self, frame: int) -> Any:
        found = self._decoded.get(frame)
        if found is not None:
            return found
        if self._container is None:
            raise InputError(f"The video {self.path.name} is closed: open it again.")
        key = int(self._table.key[frame])
        if self._pictures is not None and key <= self._next <= frame:
            found = self._advance(frame)
        for start in (key, int(self._table.key[max(key - 1, 0)]), None):
            if found is None:
                self._jump(start)
                found = self._advance(frame)
        if found is None:
            self._pictures = None
            raise InputError(
                f"Frame {frame} of the video {self.path.name} is damaged and cannot be decoded: get a whole copy of "
                "it, or convert it to a new file."
            )
        return found

    def _jump(self, key: int | None) -> None:
        """Start decoding at a key frame, or from the very start of the file where that fails or is asked for."""
        import av

        try:
            if key is None:
                self._open()
            else:
                self._container.seek(int(self._table.ticks[key]), stream=self._stream, backward=True)
        except av.FFmpegError:
            self._open()
        self._pictures = self._container.decode(self._stream)
        self._next = key or 0

    def _advance(self, frame: int) -> Any:
        """Decode on to a frame; None where the decoder passes it by, ends, or fails."""
        import av

        assert self._pictures is not None
        wanted = int(self._table.ticks[frame])
        try:
            for picture in self._pictures:
                if picture.pts is None:
                    continue
                position = self._position.get(picture.pts)
                if position is not None:
                    self._next = position + 1
                    self._decoded.put(position, picture, sum(plane.buffer_size for plane in picture.planes))
                if picture.pts == wanted:
                    return picture
                if picture.pts > wanted:
                    break
        except av.FFmpegError:
            pass
        self._pictures = None
        return None

    def _upright(self, picture: Any) -> Picture:
        width = round(picture.width * self._aspect)
        full = picture.color_range if picture.color_range == 2 else None
        rgb: Picture = picture.reformat(
            width=width, format="rgb24", src_color_range=full, interpolation="BICUBIC", threads=1
        ).to_ndarray()
        if self.rotation:
            rgb = np.ascontiguousarray(np.rot90(rgb, self.rotation // 90))
        return rgb


def _existing(path: Path) -> Path:
    if not path.is_file():
        what = "is a folder, not a video" if path.is_dir() else "does not exist"
        raise InputError(f"The video {path} {what}: choose another file.")
    if path.stat().st_size == 0:
        raise InputError(f"The video {path} is empty: choose another file.")
    return path
