"""Media for stages: frames and meshes, opened once and shared."""

from __future__ import annotations

import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

from app.formats import FrameSource, MeshFile, open_images, open_video, read_mesh
from app.formats.tvm import MeshFrames, open_mesh_frames
from app.model.values import Clip, MediaRef
from app.stages.deformers import Deformers
from imitation.errors import InputError

PYRAMIDS = 512 << 20
Locate = Callable[[MediaRef], Path]


class Media:
    """Opens what the document refers to and keeps what stages share; safe to use from several threads.

    Attributes
    ----------
    memory : what one run may leave for the next to be quicker; it never changes a result.
    """

    def __init__(self, locate: Locate) -> None:
        self.locate = locate
        self._frames: dict[str, FrameSource] = {}
        self._meshes: dict[str, MeshFile] = {}
        self._sequences: dict[str, MeshFrames] = {}
        self._rooms: dict[str, Any] = {}
        self._prepared: tuple[tuple[str, int, int], Any] | None = None
        self._solver: tuple[tuple[Any, ...], Any] | None = None
        self._deformers = Deformers()
        self.memory: dict[Any, Any] = {}
        self._lock = threading.Lock()

    def frames(self, clip: Clip) -> FrameSource:
        """Give the clip's frames; refuses a file that is not the one the project was made with."""
        with self._lock:
            source = self._frames.get(clip.media.fingerprint)
            if source is None:
                path = self.locate(clip.media)
                source = open_images(path, fps=clip.fps) if path.is_dir() else open_video(path)
                if (len(source), *source.size) != (clip.frame_count, clip.width, clip.height):
                    has = f"{len(source)} frames of {source.size[0]} x {source.size[1]}"
                    source.close()
                    raise InputError(
                        f"{Path(clip.media.path).name} is another clip now: it has {has}, the project was made with "
                        f"{clip.frame_count} of {clip.width} x {clip.height}; put the old file back."
                    )
                self._frames[clip.media.fingerprint] = source
            return source

    def mesh(self, media: MediaRef) -> MeshFile:
        """Give a character's mesh."""
        with self._lock:
            mesh = self._meshes.get(media.fingerprint)
            if mesh is None:
                mesh = self._meshes[media.fingerprint] = read_mesh(self.locate(media))
            return mesh

    def mesh_frames(self, media: MediaRef, animation: str | None = None) -> MeshFrames:
        """Give the frames of a captured sequence; of a file with several animations, those of the one named."""
        with self._lock:
            key = media.fingerprint if animation is None else f"{media.fingerprint} {animation}"
            frames = self._sequences.get(key)
            if frames is None:
                frames = self._sequences[key] = self._open_sequence(media, animation)
            return frames

    def _open_sequence(self, media: MediaRef, animation: str | None) -> MeshFrames:
        from app.stages.foreign import is_project, open_motion

        path = self.locate(media)
        return open_motion(path, media.fingerprint) if is_project(path) else open_mesh_frames(path, animation=animation)

    def flow_room(self, clip: Clip) -> Any:
        """Give the flow field of this clip that a cancelled computation left, or an empty one."""
        from imitation.tracking import FlowField

        with self._lock:
            key = clip.media.fingerprint
            if key not in self._rooms:
                self._rooms = {key: FlowField.empty(clip.frame_count, clip.height, clip.width)}
            return self._rooms[key]

    def leave_flow_room(self) -> None:
        """Forget the flow fields: they are results now."""
        with self._lock:
            self._rooms.clear()

    def prepared(self, clip: Clip, flow: Any, masks: Any) -> Any:
        """Give the clip made ready for tracking; the spans of one clip share its pyramids."""
        from imitation.tracking import prepare_clip

        frames, key = self.frames(clip), (clip.media.fingerprint, id(flow), id(masks))
        with self._lock:
            if self._prepared is None or self._prepared[0] != key:
                ready = prepare_clip(frames, flow=flow, masks=masks, memory=PYRAMIDS)
                self._prepared = (key, ready)
            return self._prepared[1]

    def depth_solver(self, key: tuple[Any, ...], make: Callable[[], Any]) -> Any:
        """Give the depth solver of a clip, made where it is another one: the key frames of one clip share its pictures.

        ``key`` may name by ``id`` only what the solver holds.
        """
        with self._lock:
            if self._solver is None or self._solver[0] != key:
                self._solver = (key, make())
            return self._solver[1]

    def leave_depth_solver(self) -> None:
        """Forget the depth solver: the maps are results now."""
        with self._lock:
            self._solver = None

    def deformer(self, vertices: Any, faces: Any, keep_volume: bool = False) -> Any:
        """Give a deformer of this rest mesh; all that move the mesh share it."""
        return self._deformers.get(vertices, faces, keep_volume)

    def close(self) -> None:
        """Close all files."""
        with self._lock:
            for source in self._frames.values():
                source.close()
            self._frames.clear()
            self._meshes.clear()
            for frames in self._sequences.values():
                frames.close()
            self._sequences.clear()
            self._rooms.clear()
            self._prepared = None
            self._solver = None
            self._deformers.clear()
            self.memory.clear()
