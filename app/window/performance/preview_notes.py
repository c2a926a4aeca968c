"""What the preview says over its picture: which motion it is, and how well the cut nearby is hidden."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QFontMetricsF, QPainter

from app.window import fonts, theme
from app.window.canvas import marks
from app.window.performance.state import PerformanceState

Mode = Literal["blended", "placed", "filmed"]
MODES: tuple[tuple[Mode, str, str], ...] = (
    ("blended", "Blended", "Clips in their places, cuts with in-betweens"),
    ("placed", "Placed", "Clips in their places, cuts as they are"),
    ("filmed", "As filmed", "Every clip where it was filmed"),
)
NEAR = 0.4
"""Seconds from a cut within which it is spoken of."""
STANDS_OUT = 1.2
"""Step over the largest within the motions from which a cut is seen."""


@dataclass(frozen=True)
class CutNote:
    """One joint of the performance in words.

    number : among the cuts. position : the first frame after it. away : frames from the playhead, negative before it.
    filmed, placed : step at the joint over the largest step within the motions.
    between : how many in-betweens. around, blended : the largest such step near the joint without and with them.
    """

    number: int
    position: int
    away: int
    words: str
    filmed: float
    placed: float
    between: int = 0
    around: float = 0.0
    blended: float = 0.0
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
    blends = {blend.cut.position: blend for blend in state.blends.blends} if state.blends is not None else {}
    blend: Any = blends.get(cut.position)
    usual = seam.usual if seam.usual > 0 else float("inf")
    source, target = (state.motions[node].name for node in (cut.source, cut.target))
    words = f"{source} once more" if cut.kind == "wrap" else f"{source} to {target}"
    made = blend is not None and bool(blend.shapes)
    return CutNote(
        number=number,
        position=cut.position,
        away=cut.position - place,
        words=words,
        filmed=float(seam.before / usual),
        placed=float(seam.after / usual),
        between=len(blend.shapes) if made else 0,
        around=float(blend.step_before / usual) if made else 0.0,
        blended=float(blend.step_after / usual) if made else 0.0,
        reason=blend.reason if blend is not None else "",
    )


def cut_lines(note: CutNote, mode: Mode) -> list[tuple[str, str]]:
    """What is said of a joint: (text, token of its colour)."""
    count = f"{abs(note.away)} frame{'s' if abs(note.away) != 1 else ''}"
    when = "here" if note.away == 0 else f"in {count}" if note.away > 0 else f"{count} ago"
    token = "warn" if note.score(mode) > STANDS_OUT else "ok"
    lines = [
        (f"{'Repeat' if note.words.endswith('once more') else 'Cut'} {when}: {note.words}", "text"),
        (f"Step {note.filmed:.2g} as filmed, {note.placed:.2g} placed (1 is usual)", token),
    ]
    if note.between:
        lines.append(
            (f"{note.between} in-betweens: at most {note.around:.2g} without, {note.blended:.2g} with", "text2")
        )
    if note.reason:
        lines.append((note.reason, "text2"))
    return lines


def place_line(state: PerformanceState, sequence: int, source: int, blended: bool) -> str:
    """Which motion and which of its source's frames is shown."""
    sequences = state.document.sequences
    if not 0 <= sequence < len(sequences):
        return ""
    shown = sequences[sequence]
    where = f"source frame {source} of {shown.frame_count - 1}"
    name = shown.name
    performance = state.performance
    if state.shows == "performance" and performance is not None and state.position < len(performance.nodes):
        node = int(performance.nodes[state.position])
        if node < len(state.motions):
            name = state.motions[node].name
    return f"{name}, {where}{', in-between' if blended else ''}"


def paint_lines(painter: QPainter, size: tuple[int, int], top: str, lines: list[tuple[str, str]]) -> None:
    """Draw a plate at the top left, and lines at the bottom left, shortened where they do not fit."""
    look = theme.active()
    metrics = QFontMetricsF(fonts.font(fonts.CAPTION))
    room = size[0] - 32.0

    def fitted(text: str) -> str:
        return metrics.elidedText(text, Qt.TextElideMode.ElideRight, room)

    if top:
        marks.plate(painter, 10, 20, fitted(top), look.colour("#E8EBEF"))
    y = size[1] - 18.0 - 22.0 * (len(lines) - 1)
    for text, token in lines:
        colour = {"text": "#E8EBEF", "text2": "#B0B8C2", "ok": "#4CC38A", "warn": "#F2B84B"}[token]
        box: QRectF = marks.plate(painter, 10, y, fitted(text), look.colour(colour))
        y += box.height() + 2
