"""What a card says of its sequence."""

from __future__ import annotations

from app.model.performance import CapturedSequence
from app.window.performance.sequence_cards import Piece
from app.window.performance.state import PerformanceState
from app.window.performance.strip_colours import kind_colour, structure_of

UNIT_WORDS = {1.0: "metres", 0.01: "centimetres", 0.001: "millimetres"}


def strip_of(state: PerformanceState, sequence: CapturedSequence) -> tuple[Piece, ...]:
    """The textons of a sequence as shares of its length, coloured by the motion; the rest of it is dim."""
    found = structure_of(state, sequence.id)
    if found is None:
        return ()
    count = max(sequence.frame_count, 1)
    pieces = []
    for cluster in found.clusters:
        colour = kind_colour(state, sequence.id, cluster.kind)
        pieces.append(Piece(cluster.first / count, (cluster.last + 1) / count, colour, dim=True))
        pieces += [Piece(first / count, (last + 1) / count, colour) for first, last in cluster.textons]
    return tuple(pieces)


def warnings_of(sequence: CapturedSequence) -> tuple[str, ...]:
    """What the program guessed or converted, one sentence each."""
    said = {
        "fps": f"{sequence.source_fps:g} fps",
        "up": f"{sequence.up.upper()} up",
        "unit": UNIT_WORDS.get(sequence.unit, f"{sequence.unit:g} m"),
    }
    words = [f"guessed: {', '.join(said[fact] for fact in sequence.guessed)}"] if sequence.guessed else []
    if sequence.fps != sequence.source_fps:
        words.append(f"filmed at {sequence.source_fps:g} fps, played at {sequence.fps:g}")
    return tuple(words)
