"""A project on a real clip, made as a user makes it, and figures of its result."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from app.actions import bringing, marks, masking, posing
from app.actions.session import Session
from app.stages.results import AlignedCharacter, Animation, World

MARKS = Path(__file__).parent
Array = NDArray[np.float64]


class Solved:
    """One clip, one character, solved.

    Attributes
    ----------
    world, aligned, motion : results of the stages.
    """

    def __init__(self, folder: Path, data: Path, clip: str, mesh: str, marked: str) -> None:
        self.session = Session.new(folder / "real.motionwright")
        bringing.add_clip(self.session, data / clip / "clip.mp4")
        bringing.add_character(self.session, data / "characters" / f"{mesh}.ply", up="y")
        marks.apply_marks(self.session, MARKS / marked)
        masking.import_masks(self.session, data / clip / "masks", every=5)
        stages, (self.character,) = self.session.stages, self.session.document.characters
        motion = self.session.result(stages.animation(self.character.id))
        world, aligned = self.session.result(stages.world), self.session.result(stages.alignment(self.character.id))
        assert isinstance(world, World)
        assert isinstance(aligned, AlignedCharacter)
        assert isinstance(motion, Animation)
        self.world, self.aligned, self.motion = world, aligned, motion
        self.diagonal = float(np.linalg.norm(np.ptp(aligned.vertices, axis=0)))

    def pose_first_frame(self) -> None:
        """Drag the key points of frame 0 onto their tracks, planted ones to their contact, and solve again."""
        stages, camera = self.session.stages, self.world.cameras[0]
        start = self.session.result(stages.start(self.character.id))
        pose = start.vertices[0]  # type: ignore[attr-defined]
        places = {}
        for track in self.session.document.tracks:
            vertex = self.character.pairs[track.id]
            placed = self.session.result(stages.contacts(track.id))
            if placed and placed[0].first == 0:  # type: ignore[index]
                places[vertex] = placed[0].place  # type: ignore[index]
            else:
                seen = self.session.result(stages.track(track.id)).positions[0]  # type: ignore[attr-defined]
                places[vertex] = camera.lift(seen, camera.depth(pose[vertex]))
        drag = posing.PoseDrag(self.session, self.character.id, 0, before=pose)
        drag.move(places)
        self.session.apply(posing.release(self.session, drag, places))
        motion = self.session.result(self.session.stages.animation(self.character.id))
        assert isinstance(motion, Animation)
        self.motion = motion

    def slide(self) -> float:
        """How far planted key points move a frame on average, % of the diagonal."""
        moved = []
        for track in self.session.document.tracks:
            places = self.motion.vertices[:, self.character.pairs[track.id]]
            for contact in track.contacts:
                planted = places[contact.span.first : contact.span.last + 1]
                moved.append(np.linalg.norm(np.diff(planted, axis=0), axis=1))
        return 100 * float(np.concatenate(moved).mean()) / self.diagonal

    def stretch(self) -> float:
        """Length of the edges against rest that 99 % stay under, in the worst frame."""
        faces, rest = self.aligned.faces, self.aligned.vertices
        first, second = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]).T
        length = np.linalg.norm(rest[first] - rest[second], axis=1)
        sound = length > 1e-3 * self.diagonal
        ratios = [
            np.percentile(np.linalg.norm(pose[first] - pose[second], axis=1)[sound] / length[sound], 99)
            for pose in self.motion.vertices
        ]
        return float(max(ratios))

    def apart(self) -> float:
        """Mean distance, in pixels, of all key points from their tracks where these are seen."""
        found = [distance for distance, _ in self._distances()]
        return float(np.concatenate(found).mean())

    def sunk(self) -> float:
        """How deep the lowest vertex of any frame lies under the ground, % of the diagonal."""
        return 100 * float(-(self.motion.vertices @ self.world.normal - self.world.offset).min()) / self.diagonal

    def deviation(self) -> float:
        """Median distance, in pixels, of free key points from their tracks, less where they were apart in frame 0."""
        return float(np.median(np.concatenate([moved for _, moved in self._distances(free=True)])))

    def _distances(self, *, free: bool = False) -> list[tuple[Array, Array]]:
        """Of each track: distance in its seen frames, and how much it differs from that in frame 0, pixels."""
        found = []
        for track in self.session.document.tracks:
            if free and track.contacts:
                continue
            positions = self.session.result(self.session.stages.track(track.id)).positions  # type: ignore[attr-defined]
            vertex = self.character.pairs[track.id]
            offset = np.stack([camera.project(pose[vertex]) for camera, pose in self._frames()]) - positions
            here = np.isfinite(offset).all(axis=1)
            for gap in track.occluded:
                here[gap.first : gap.last + 1] = False
            moved = np.linalg.norm(offset - offset[0], axis=1)
            found.append((np.linalg.norm(offset, axis=1)[here], moved[here]))
        return found

    def _frames(self) -> list[tuple[object, Array]]:
        return [(self.world.cameras[frame], pose) for frame, pose in enumerate(self.motion.vertices)]
