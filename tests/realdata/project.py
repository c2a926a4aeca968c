"""A project on a real clip, made as a user makes it, and figures of its result."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from app.actions import bringing, marks, masking
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

    def deviation(self) -> float:
        """Median distance, in pixels, of free key points from their tracks, less where they were apart in frame 0."""
        apart = []
        for track in self.session.document.tracks:
            if track.contacts:
                continue
            found = self.session.result(self.session.stages.track(track.id))
            vertex = self.character.pairs[track.id]
            seen = np.stack([camera.project(pose[vertex]) for camera, pose in self._frames()])
            offset = seen - found.positions  # type: ignore[attr-defined]
            here = np.ones(len(offset), bool)
            for gap in track.occluded:
                here[gap.first : gap.last + 1] = False
            apart.append(np.linalg.norm(offset - offset[0], axis=1)[here])
        return float(np.median(np.concatenate(apart)))

    def _frames(self) -> list[tuple[object, Array]]:
        return [(self.world.cameras[frame], pose) for frame, pose in enumerate(self.motion.vertices)]
