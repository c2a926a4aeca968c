"""What the preview says over its picture: which motion it is, and how well the cut nearby is hidden."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

from PySide6.QtCore import Qt
from PySide6.QtGui import QFontMetricsF, QPainter

from app.window import fonts, theme
from app.window.canvas import marks
from app.window.performance.blocks import STANDS_OUT, joint_of
from app.window.performance.state import PerformanceState

Mode = Literal["blended", "placed", "filmed"]
MODES: tuple[tuple[Mode, str, str], ...] = (
    ("blended", "Blended", "Clips in their places, cuts with in-betweens"),
    ("placed", "Placed", "Clips in their places, cuts as they are"),
    ("filmed", "As filmed", "Every clip where it was filmed"),
)
ROW = 22.0
NEAR = 0.4
"""Seconds from a cut within which it is spoken of."""
MOST = 2
"""Lines that one sentence takes at most."""


@dataclass(frozen=True)
class CutNote:
    """One joint of the performance in words.

    number : among the cuts. position : the first frame after it. away : frames from the playhead, negative before it.
    filmed, placed, blended : step at the joint over the largest step within the motions; ``blended`` near it, with
    ``between`` in-betweens. apart : whether the poses that meet are far apart with nothing between.
    """

    number: int
    position: int
    away: int
    words: str
    filmed: float
    placed: float
    between: int = 0
    blended: float = 0.0
    apart: bool = False
    reason: str = ""

    def score(self, mode: Mode) -> float:
        """The step as it is shown."""
        if mode == "filmed":
            return self.filmed
        return self.placed if mode == "placed" or not self.between else min(self.placed, self.blended)


def cut_near(state: PerformanceState, place: int) -> CutNote | None:
    """The joint nearest to a frame of the performance, within reach; wraps of a repeated motion count too."""
    if state.placed is None:
        return None
    reach = max(round(NEAR * state.fps), 2)
    cuts = state.placed.performance.cuts
    near = [(abs(cut.position - place), number) for number, cut in enumerate(cuts) if cut.kind != "loop"]
    if not near or min(near)[0] > reach:
        return None
    return cut_note(state, min(near)[1], place)


def cut_note(state: PerformanceState, number: int, place: int) -> CutNote:
    """A joint by its number."""
    placed = state.placed
    cut, seam = placed.performance.cuts[number], placed.seams[number]
    joint = joint_of(state, placed.performance, number)
    blends = {blend.cut.position: blend for blend in state.blends.blends} if state.blends is not None else {}
    blend: Any = blends.get(cut.position)
    usual = seam.usual if seam.usual > 0 else float("inf")
    source, target = joint.names
    made = blend is not None and bool(blend.shapes)
    return CutNote(
        number=number,
        position=cut.position,
        away=cut.position - place,
        words=f"{source} once more" if cut.kind == "wrap" else f"{source} to {target}",
        filmed=float(seam.before / usual),
        placed=float(seam.after / usual),
        between=len(blend.shapes) if made else 0,
        blended=float(blend.step_after / usual) if made else 0.0,
        apart=cut.kind == "cut" and joint.apart,
        reason=joint.reason,
    )


def cut_lines(note: CutNote, mode: Mode) -> list[tuple[str, str]]:
    """What is said of a joint: (text, token of its colour)."""
    count = f"{abs(note.away)} frame{'s' if abs(note.away) != 1 else ''}"
    when = "here" if note.away == 0 else f"in {count}" if note.away > 0 else f"{count} ago"
    seen = note.score(mode) > STANDS_OUT
    steps = f"Step {note.filmed:.2g} as filmed, {note.placed:.2g} placed"
    if note.between:
        steps += f", {note.blended:.2g} with {note.between} in-betweens"
    lines = [
        (f"{'Repeat' if note.words.endswith('once more') else 'Cut'} {when}: {note.words}", "text"),
        (f"{steps}: {'seen' if seen else 'hidden'}", "warn" if seen else "ok"),
    ]
    if note.apart:
        lines[1] = (steps, "warn" if seen else "text2")
        lines.append(("The poses are far apart: a limb may jump here.", "warn"))
    if note.reason:
        lines.append((note.reason, "text2"))
    return lines


def place_lines(state: PerformanceState, sequence: int, source: int, blended: bool) -> list[str]:
    """Which motion and which of its source's frames is shown; of an in-between how it got its colours."""
    sequences = state.document.sequences
    if not 0 <= sequence < len(sequences):
        return []
    shown = sequences[sequence]
    where = f"source frame {source} of {shown.frame_count - 1}"
    name = shown.name
    performance = state.performance
    if state.shows == "performance" and performance is not None and state.position < len(performance.nodes):
        node = int(performance.nodes[state.position])
        if node < len(state.motions):
            name = state.motions[node].name
    return [f"{name}, {where}", f"In-between{coloured(state, sequence)}"] if blended else [f"{name}, {where}"]


def coloured(state: PerformanceState, sequence: int) -> str:
    """How in-betweens out of a sequence get their colours: pictures cannot be laid on them."""
    shown = state.document.sequences[sequence].id
    if wears_pictures(state, shown):
        return ": colours at its vertices instead of the picture"
    statistics = _statistics(state, shown)
    return ": the colours of both clips" if statistics is not None and statistics.coloured else ""


def wears_pictures(state: PerformanceState, sequence_id: str) -> bool:
    """Whether the frames of a sequence come with pictures, as far as that is known."""
    statistics = _statistics(state, sequence_id)
    return statistics is not None and statistics.textured > 0


def _statistics(state: PerformanceState, sequence_id: str) -> Any:
    project = state.project
    found: Any = project.result(project.session.stages.features(sequence_id)) if project is not None else None
    return None if found is None else found.statistics


def paint_lines(painter: QPainter, size: tuple[int, int], top: list[str], lines: list[tuple[str, str]]) -> None:
    """Draw plates at the top left, and lines at the bottom left; what is too long goes on in another line."""
    look = theme.active()
    metrics = QFontMetricsF(fonts.font(fonts.CAPTION))
    room = size[0] - 32.0
    for row, text in enumerate(part for said in top for part in broken(said, metrics, room)):
        marks.plate(painter, 10, 20 + ROW * row, text, look.colour("#E8EBEF"))
    rows = [(part, token) for text, token in lines for part in broken(text, metrics, room)]
    y = size[1] - 18.0 - ROW * (len(rows) - 1)
    for text, token in rows:
        colour = {"text": "#E8EBEF", "text2": "#B0B8C2", "ok": "#4CC38A", "warn": "#F2B84B"}[token]
        marks.plate(painter, 10, y, text, look.colour(colour))
        y += ROW


def broken(text: str, metrics: QFontMetricsF, room: float) -> list[str]:
    """A sentence in as few lines as it needs, the last one shortened where even they do not hold it."""
    lines: list[str] = []
    for word in text.split():
        longer = f"{lines[-1]} {word}" if lines else word
        if lines and (metrics.horizontalAdvance(longer) <= room or len(lines) == MOST):
            lines[-1] = longer
        else:
            lines.append(word)
    return [metrics.elidedText(line, Qt.TextElideMode.ElideRight, room) for line in lines]
