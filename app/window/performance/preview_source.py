"""What the preview has to open: the composed performance, or a sequence as captured."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from app.window.performance.preview_notes import Mode
from app.window.performance.state import PerformanceState

if TYPE_CHECKING:
    from app.actions.performing_playback import ShownFrame, ShownFrames

Source = tuple[Any, ...]


def wanted_source(state: PerformanceState, mode: Mode) -> Source:
    """What has to be opened, as a value that changes with it; empty for nothing."""
    project = state.project
    if project is None or not state.document.sequences:
        return ()
    if state.shows == "performance":
        if state.placed is None:
            return ()
        return (project, state.placed, state.blends if mode == "blended" else None, mode)
    found = next((each for each in state.document.sequences if each.id == state.sequence_id), None)
    if found is None:
        return ()
    motion = None if found.character is None else project.result(project.session.stages.animation(found.character))
    if found.character is not None and motion is None:
        return ()
    files = (found.id, found.media, found.up, found.unit, found.level, found.source_fps, found.source_count)
    return (project, *files, found.fps, found.frame_count, motion)


def opener(state: PerformanceState, mode: Mode, source: Source) -> Callable[[], ShownFrames] | None:
    """The call that opens it, for the thread that reads; None for nothing."""
    if not source:
        return None
    session, sequence, performing = source[0].session, state.sequence_id, state.shows == "performance"

    def make() -> ShownFrames:
        from app.actions.performing_playback import performance_shown, sequence_shown

        if performing:
            return performance_shown(session, blended=mode == "blended", aligned=mode != "filmed")
        return sequence_shown(session, sequence)

    return make


def front(state: PerformanceState, mode: Mode, place: int, frame: ShownFrame) -> float:
    """Where the performer faces in a frame, radians; 0 where it is not known yet."""
    if state.graph is None or frame.sequence >= len(state.graph.analyses):
        return 0.0
    turned = 0.0
    performance = state.performance
    if state.shows == "performance" and mode != "filmed" and performance is not None and place < len(performance):
        turned = float(performance.transforms[place][0])
    return float(state.graph.analyses[frame.sequence].headings[frame.source]) + turned
