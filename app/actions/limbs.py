"""Limbs that the video explains in two ways: which, in what frames, and where one edit decides."""

from __future__ import annotations

from typing import Any

from app.actions.session import Session

SHOWN = 8
"""Lines for people; the values hold all."""


def ambiguous_limbs(session: Session, character_id: str) -> list[dict[str, Any]] | None:
    """Give the spans found, the longest first, None where nobody has looked yet.

    Each holds ``limb`` (the track's name), ``frames`` (first and last), ``decide`` (the frame whose edit settles most)
    and ``other`` (how much farther from the camera the other place is there, world units).
    """
    spans: Any = session.ready(session.stages.ambiguous(character_id))
    if spans is None:
        return None
    names = {track.id: track.name for track in session.document.tracks}
    found = [
        {
            "limb": names.get(span.name, span.name),
            "frames": [int(span.first), int(span.last)],
            "decide": int(span.decide),
            "other": float(span.other),
        }
        for span in spans
    ]
    return sorted(found, key=lambda limb: (limb["frames"][0] - limb["frames"][1], limb["limb"], limb["frames"][0]))


def limb_lines(limbs: list[dict[str, Any]]) -> list[str]:
    """Say the same for people."""
    lines = []
    for limb in limbs[:SHOWN]:
        first, last = limb["frames"]
        way = "farther" if limb["other"] > 0 else "nearer"
        lines.append(
            f"  {limb['limb']}, frames {first}-{last}: the video fits a place {abs(limb['other']):.2g} {way} as well; "
            f"an edit of frame {limb['decide']} decides"
        )
    if len(limbs) > SHOWN:
        lines.append(f"  and {len(limbs) - SHOWN} shorter spans (--json lists all)")
    return lines
