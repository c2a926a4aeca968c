"""``path.json``: what was composed, and how, so that it can be read, kept and composed again."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import attrs
import numpy as np

from app.actions.performing import MotionName, motions, sequence_named
from app.actions.session import Session
from app.formats.atomic import replacing
from app.formats.images import read_bytes
from app.model.edits import Edit
from app.model.performance import KeyMotion, Motion, PerformanceChoice
from app.stages.performance.results import Assembled, Blended
from imitation.errors import InputError

FORMAT, VERSION = "motionwright path", 1


def path_values(session: Session) -> dict[str, Any]:
    """Give all of a composed performance but its meshes, as plain values.

    Raises ``InputError`` when it has not been composed.
    """
    placed = session.ready(session.stages.performance)
    graph: Any = session.ready(session.stages.graph)
    if not isinstance(placed, Assembled) or graph is None:
        raise InputError("The performance has not been composed yet: run perform compose first.")
    document, performance = session.document, placed.performance
    named = motions(document, graph)
    blended = session.ready(session.stages.blends)
    blends = {blend.cut.position: blend for blend in (blended.blends if isinstance(blended, Blended) else ())}
    cuts = []
    for cut, seam in zip(performance.cuts, placed.seams, strict=True):
        blend = blends.get(cut.position)
        cuts.append(
            {
                "position": cut.position,
                "kind": cut.kind,
                "from": named[cut.source].name,
                "to": named[cut.target].name,
                "leave": cut.leave,
                "enter": cut.enter,
                "weight": _number(cut.weight),
                "poor": bool(cut.source != cut.target and graph.poor[cut.source, cut.target]),
                "step_as_filmed": _number(seam.before),
                "step_placed": _number(seam.after),
                "usual_step": _number(seam.usual),
                "score": _number(seam.score),
                "turned_degrees": _number(np.degrees(seam.turned)),
                "blended_frames": sorted(blend.shapes) if blend is not None else [],
                "blend_note": blend.reason if blend is not None else "",
            }
        )
    return {
        "format": FORMAT,
        "version": VERSION,
        "fps": document.sequences[0].fps,
        "frame_count": len(performance),
        "sequences": [_sequence(session, sequence) for sequence in document.sequences],
        "choice": _choice(session, document.performance),
        "cost": _number(performance.cost),
        "note": performance.note,
        "path": [_stop(named[node]) for node in performance.path],
        "keys": list(performance.keys),
        "frames": performance.frames.tolist(),
        "transforms": [[_number(value) for value in row] for row in performance.transforms],
        "cuts": cuts,
    }


def write_path(session: Session, target: Path) -> None:
    """Write ``path.json``."""
    data = json.dumps(path_values(session), indent=1, allow_nan=False).encode()
    with replacing(target) as temporary:
        temporary.write_bytes(data + b"\n")


def choice_from_path(session: Session, source: Path) -> Edit:
    """Take key motions and all other choices from a ``path.json``; sequences are found by their names."""
    try:
        values = json.loads(read_bytes(source).tobytes())
        if values.get("format") != FORMAT or not isinstance(values["version"], int):
            raise InputError(f"{source.name} is no path that Motionwright wrote.")
        if values["version"] > VERSION:
            raise InputError(f"{source.name} was written by a newer Motionwright: update the program to use it.")
        made = _read_choice(session, values["choice"])
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(f"{source.name} is damaged: write it again with perform export --path.") from error
    return Edit(attrs.evolve(session.document, performance=made), f"Take the choices of {source.name}")


def _sequence(session: Session, sequence: Any) -> dict[str, Any]:
    return {
        "name": sequence.name,
        "fingerprint": sequence.media.fingerprint if sequence.media is not None else None,
        "character": None if sequence.character is None else session.document.character(sequence.character).name,
        "frame_count": sequence.frame_count,
        "fps": sequence.fps,
        "up": sequence.up,
        "unit": sequence.unit,
    }


def _choice(session: Session, choice: PerformanceChoice) -> dict[str, Any]:
    def at(motion: Motion) -> list[Any]:
        return [session.document.sequence(motion.sequence).name, motion.frame]

    return {
        "graph": choice.graph,
        "features": choice.features,
        "mu": choice.mu,
        "keys": [{"motion": at(key.motion), "repeats": key.repeats} for key in choice.keys],
        "forbidden": [at(motion) for motion in choice.forbidden],
        "length": choice.length,
        "loop": choice.loop,
        "alternative": choice.alternative,
        "align": choice.align,
        "blend": choice.blend,
        "blend_seconds": choice.blend_seconds,
    }


def _read_choice(session: Session, values: dict[str, Any]) -> PerformanceChoice:
    from app.model.edits import performance as edits

    def at(given: Any) -> Motion:
        name, frame = given
        return Motion(sequence_named(session.document, str(name)).id, int(frame))

    document = session.document
    document = edits.set_methods(document, features=values["features"], graph=values["graph"]).document
    document = edits.set_mu(document, float(values["mu"])).document
    keys = [KeyMotion(at(key["motion"]), int(key["repeats"])) for key in values["keys"]]
    document = edits.set_keys(document, keys).document
    document = edits.clear_forbidden(document).document
    for motion in values["forbidden"]:
        document = edits.set_forbidden(document, at(motion), True).document
    document = edits.set_length(document, values["length"]).document
    document = edits.set_loop(document, bool(values["loop"])).document
    document = edits.set_alternative(document, int(values["alternative"])).document
    return edits.set_smoothing(
        document, align=values["align"], blend=values["blend"], seconds=float(values["blend_seconds"])
    ).document.performance


def _stop(motion: MotionName) -> dict[str, Any]:
    return {"motion": motion.name, "first": motion.texton[0], "last": motion.texton[1], "cyclic": motion.cyclic}


def _number(value: Any) -> float | None:
    """JSON has no NaN and no infinity."""
    return float(value) if np.isfinite(value) else None
