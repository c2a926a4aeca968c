"""The document: everything that the user made or decided, and nothing that is computed."""

from __future__ import annotations

import attrs

from app.model.character import Character
from app.model.frozen import FrozenMap
from app.model.performance import CapturedSequence, PerformanceChoice
from app.model.tracks import Track
from app.model.values import Clip, Interval, KeyMask, ModelError, Unknown
from app.model.world import CameraChoice, WorldChoice


@attrs.frozen
class Document:
    """One project.

    Attributes
    ----------
    range : the in and out frame of work; None is the whole clip.
    sequences : meshes over time, whose motions are the database of performances.
    performance : what shall be composed of them.
    next_id : number of the next track, character or sequence; never used twice, so that undo cannot confuse two.
    """

    name: str = "Untitled"
    clip: Clip | None = None
    range: Interval | None = None
    masks: FrozenMap[int, KeyMask] = attrs.field(factory=FrozenMap)
    tracks: tuple[Track, ...] = ()
    camera: CameraChoice = attrs.field(factory=CameraChoice)
    world: WorldChoice = attrs.field(factory=WorldChoice)
    characters: tuple[Character, ...] = ()
    sequences: tuple[CapturedSequence, ...] = ()
    performance: PerformanceChoice = attrs.field(factory=PerformanceChoice)
    next_id: int = 1
    unknown: Unknown = attrs.field(factory=FrozenMap, repr=False)

    def track(self, track_id: str) -> Track:
        """Give a track by its id."""
        for track in self.tracks:
            if track.id == track_id:
                return track
        raise ModelError(f"There is no track {track_id!r} in this project.")

    def character(self, character_id: str) -> Character:
        """Give a character by its id."""
        for character in self.characters:
            if character.id == character_id:
                return character
        raise ModelError(f"There is no character {character_id!r} in this project.")

    def sequence(self, sequence_id: str) -> CapturedSequence:
        """Give a sequence by its id."""
        for sequence in self.sequences:
            if sequence.id == sequence_id:
                return sequence
        raise ModelError(f"There is no sequence {sequence_id!r} in this project.")

    def with_track(self, track: Track) -> Document:
        """Give a document in which this track replaces the one of its id."""
        self.track(track.id)
        return attrs.evolve(self, tracks=tuple(track if t.id == track.id else t for t in self.tracks))

    def with_character(self, character: Character) -> Document:
        """Give a document in which this character replaces the one of its id."""
        self.character(character.id)
        return attrs.evolve(self, characters=tuple(character if c.id == character.id else c for c in self.characters))

    def with_sequence(self, sequence: CapturedSequence) -> Document:
        """Give a document in which this sequence replaces the one of its id."""
        self.sequence(sequence.id)
        return attrs.evolve(self, sequences=tuple(sequence if s.id == sequence.id else s for s in self.sequences))
