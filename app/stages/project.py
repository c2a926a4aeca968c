"""All stages of a document, by what they give."""

from __future__ import annotations

from collections.abc import Iterator

from app.model.character import Character
from app.model.document import Document
from app.model.tracks import Track
from app.stages import animation, collision, depth, performance, scene, tracking
from app.stages.stage import Stage


class Stages:
    """The stages of one version of a document; made once a version, each stage once."""

    def __init__(self, document: Document) -> None:
        self.document = document
        self._made: dict[str, Stage | tuple[Stage, ...]] = {}

    @property
    def flow(self) -> Stage:
        """Dense optical flow."""
        return self._once("flow", lambda: tracking.flow(self.document))

    @property
    def masks(self) -> Stage:
        """The subject's mask in every frame."""
        return self._once("masks", lambda: tracking.masks(self.document))

    @property
    def cameras(self) -> Stage:
        """The camera path in its own units."""
        return self._once("cameras", lambda: scene.cameras(self.document))

    @property
    def world(self) -> Stage:
        """The camera path with Z up and in metres, as far as they are known."""
        return self._once("world", lambda: scene.world(self.document))

    @property
    def depth(self) -> Stage:
        """Depth of the background in key frames."""
        return self._once("depth", lambda: depth.depth(self.document))

    def plate(self, frame: int) -> Stage:
        """One frame without the subject."""
        return self._once(f"plate/{frame}", lambda: depth.plate(self.document, str(frame)))

    def spans(self, track_id: str) -> tuple[Stage, ...]:
        """The spans of a track."""
        return tracking.spans(self.document, self._track(track_id))

    def track(self, track_id: str) -> Stage:
        """A track."""
        return self._once(f"track/{track_id}", lambda: tracking.track(self.document, self._track(track_id)))

    def contacts(self, track_id: str) -> Stage:
        """The contacts of a track with their places."""
        return self._once(f"contacts/{track_id}", lambda: scene.contacts(self.document, self._track(track_id)))

    def alignment(self, character_id: str) -> Stage:
        """A character on the subject in the first frame."""
        return self._once(
            f"alignment/{character_id}", lambda: animation.alignment(self.document, self._character(character_id))
        )

    def start(self, character_id: str) -> Stage:
        """A character in the first frame as the user posed it."""
        return self._once(
            f"start/{character_id}", lambda: animation.start(self.document, self._character(character_id))
        )

    def base(self, character_id: str) -> Stage:
        """A character's motion before any edit."""
        return self._once(f"base/{character_id}", lambda: animation.base(self.document, self._character(character_id)))

    def animation(self, character_id: str) -> Stage:
        """A character's motion with all edits."""
        return self._once(
            f"animation/{character_id}", lambda: animation.animation(self.document, self._character(character_id))
        )

    def ambiguous(self, character_id: str) -> Stage:
        """Limbs and frames that the video explains in two ways."""
        return self._once(
            f"ambiguous/{character_id}", lambda: animation.ambiguous(self.document, self._character(character_id))
        )

    def penetration(self, character_id: str) -> Stage:
        """How far a character goes into the measured background."""
        return self._once(
            f"penetration/{character_id}", lambda: collision.penetration(self.document, self._character(character_id))
        )

    def comparison(self, character_id: str, variant: str) -> Stage:
        """One of the paper's comparisons."""
        return self._once(
            f"compare/{character_id}/{variant}",
            lambda: animation.comparison(self.document, self._character(character_id), variant),
        )

    def features(self, sequence_id: str) -> Stage:
        """What one pass over a sequence leaves."""
        return self._of_sequence("features", sequence_id)

    def distances(self, sequence_id: str) -> Stage:
        """Frame and atom distances of a sequence."""
        return self._of_sequence("distances", sequence_id)

    def structure(self, sequence_id: str) -> Stage:
        """The motions of a sequence."""
        return self._of_sequence("structure", sequence_id)

    def analysis(self, sequence_id: str) -> Stage:
        """All that the motion graph needs to know of a sequence."""
        return self._of_sequence("analysis", sequence_id)

    @property
    def database(self) -> Stage:
        """Motions and transitions of all sequences, before pruning."""
        return self._once("database", lambda: performance.database(self.document))

    @property
    def graph(self) -> Stage:
        """The motion graph."""
        return self._once("graph", lambda: performance.graph(self.document))

    @property
    def paths(self) -> Stage:
        """The best path through the key motions and the next best."""
        return self._once("paths", lambda: performance.paths(self.document))

    @property
    def performance(self) -> Stage:
        """The chosen path with every clip in its place."""
        return self._once("performance", lambda: performance.assembled(self.document))

    @property
    def blends(self) -> Stage:
        """In-betweens at the cuts of the performance."""
        return self._once("blends", lambda: performance.blended(self.document))

    def all(self) -> Iterator[Stage]:
        """Yield every stage that a person thinks of as a step of the project."""
        yield self.masks
        yield self.cameras
        yield self.world
        for track in self.document.tracks:
            yield self.track(track.id)
        for character in self.document.characters:
            yield self.alignment(character.id)
            yield self.start(character.id)
            yield self.base(character.id)
            yield self.animation(character.id)
        for sequence in self.document.sequences:
            yield self.structure(sequence.id)
        if self.document.sequences:
            yield self.database
        if self.document.performance.keys:
            yield self.performance
            yield self.blends

    def _track(self, track_id: str) -> Track:
        return self.document.track(track_id)

    def _character(self, character_id: str) -> Character:
        return self.document.character(character_id)

    def _of_sequence(self, kind: str, sequence_id: str) -> Stage:
        sequence = self.document.sequence(sequence_id)
        return self._once(f"{kind}/{sequence_id}", lambda: getattr(performance, kind)(self.document, sequence))

    def _once(self, name: str, make: object) -> Stage:
        if name not in self._made:
            self._made[name] = make()  # type: ignore[operator]
        stage = self._made[name]
        assert isinstance(stage, Stage)
        return stage
