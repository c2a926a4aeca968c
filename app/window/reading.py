"""What is known of results at this moment, put together from what is finished; nothing is computed here."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.model.tracks import Track
from app.window.moment import Moment
from app.window.project import Project

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class KnownTrack:
    """A track as far as it is solved.

    positions : (n, 2) picture pixels, NaN where nothing is known. confidence : (n,). state : (n,) of "visible",
    "occluded", "outside" or "" where it is not solved. complete : whether all spans are.
    """

    positions: Array
    confidence: Array
    state: NDArray[np.str_]
    complete: bool


class Reading:
    """Reads tracks of a project; what did not change is kept."""

    def __init__(self, project: Project) -> None:
        self.project = project
        self._kept: dict[str, tuple[tuple[object, ...], KnownTrack]] = {}
        self._moment: Moment | None = None
        self._read: dict[str, Track] = {}

    def last(self, track_id: str) -> KnownTrack | None:
        """What was read of a track last."""
        kept = self._kept.get(track_id)
        return None if kept is None else kept[1]

    def track(self, track: Track) -> KnownTrack:
        """The track as far as it is solved."""
        now = Moment.of(self.project.session)
        if now != self._moment:
            self._moment, self._read = now, {}
        if self._read.get(track.id) is not track:
            self._kept[track.id] = self._found(track)
            self._read[track.id] = track
        return self._kept[track.id][1]

    def _found(self, track: Track) -> tuple[tuple[object, ...], KnownTrack]:
        spans = self.project.session.stages.spans(track.id)
        found = [self.project.result(stage) for stage in spans]
        signature = (
            track.clicks,
            track.occluded,
            *(stage.key for stage, span in zip(spans, found, strict=True) if span is not None),
        )
        kept = self._kept.get(track.id)
        if kept is not None and kept[0] == signature:
            return kept
        count = self.project.frame_count
        positions, confidence = np.full((count, 2), np.nan), np.zeros(count)
        state = np.full(count, "", dtype="<U8")
        for span in found:
            if span is None:
                continue
            here = slice(span.plan.first, span.plan.last + 1)
            positions[here], confidence[here], state[here] = span.positions, span.confidence, span.state
        for frame, place in track.clicks.items():
            if frame < count:
                positions[frame], confidence[frame], state[frame] = place, 1.0, "visible"
        for interval in track.occluded:
            hidden = state[interval.first : interval.last + 1]
            hidden[hidden == "visible"] = "occluded"
        return signature, KnownTrack(positions, confidence, state, all(span is not None for span in found))
