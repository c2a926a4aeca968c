"""Edits of the performance: key motions, what is forbidden, length, graph size, smoothing."""

from __future__ import annotations

import math
from collections.abc import Iterable

import attrs

from app.model.document import Document
from app.model.edits.edit import Edit
from app.model.performance import FeatureMethod, HardCut, KeyMotion, Motion, PerformanceChoice
from app.model.values import ModelError

LONGEST = 1_000_000
"""Frames."""


def add_key(document: Document, motion: Motion, *, place: int | None = None, repeats: int = 1) -> Edit:
    """Add a key motion at the end, or before the one at ``place``."""
    keys = list(document.performance.keys)
    where = len(keys) if place is None else place
    if not 0 <= where <= len(keys):
        raise ModelError(f"There is no place {where} among {len(keys)} key motions.")
    keys.insert(where, KeyMotion(_checked(document, motion), _repeats(repeats)))
    return _with_keys(document, keys, f"Add key motion {_name(document, motion)}")


def set_keys(document: Document, keys: Iterable[KeyMotion]) -> Edit:
    """Set all key motions at once."""
    given = [KeyMotion(_checked(document, key.motion), _repeats(key.repeats)) for key in keys]
    return _with_keys(document, given, "Set the key motions")


def replace_key(document: Document, place: int, motion: Motion) -> Edit:
    """Put another motion in the place of a key motion; it is played once."""
    former = _key(document, place)
    keys = list(document.performance.keys)
    keys[place] = KeyMotion(_checked(document, motion))
    label = f"Replace key motion {_name(document, former.motion)} by {_name(document, motion)}"
    return _with_keys(document, keys, label)


def remove_key(document: Document, place: int) -> Edit:
    """Take a key motion away."""
    key = _key(document, place)
    keys = [other for k, other in enumerate(document.performance.keys) if k != place]
    return _with_keys(document, keys, f"Remove key motion {_name(document, key.motion)}")


def move_key(document: Document, place: int, to: int) -> Edit:
    """Move a key motion to another place in the order."""
    key = _key(document, place)
    keys = list(document.performance.keys)
    if not 0 <= to < len(keys):
        raise ModelError(f"There is no place {to} among {len(keys)} key motions.")
    keys.insert(to, keys.pop(place))
    return _with_keys(document, keys, f"Move key motion {_name(document, key.motion)}")


def set_repeats(document: Document, place: int, repeats: int) -> Edit:
    """Say how often a key motion is played at least."""
    key = _key(document, place)
    keys = list(document.performance.keys)
    keys[place] = attrs.evolve(key, repeats=_repeats(repeats))
    return _with_keys(document, keys, f"Play {_name(document, key.motion)} {repeats} times")


def set_forbidden(document: Document, motion: Motion, forbidden: bool) -> Edit:
    """Forbid a motion, or allow it again."""
    motion = _checked(document, motion)
    kept = [other for other in document.performance.forbidden if other != motion]
    if forbidden:
        kept.append(motion)
    order = tuple(sorted(kept, key=lambda other: (other.sequence, other.frame)))
    label = f"{'Forbid' if forbidden else 'Allow'} {_name(document, motion)}"
    return _changed(document, label, forbidden=order)


def clear_forbidden(document: Document) -> Edit:
    """Allow all motions."""
    return _changed(document, "Allow all motions", forbidden=())


def set_mu(document: Document, mu: float) -> Edit:
    """Set the size of the motion graph."""
    if not (math.isfinite(mu) and mu >= 0):
        raise ModelError(f"mu must be a number of 0 or more, not {mu}.")
    return _changed(document, f"Set mu to {mu:.4g}", mu=float(mu))


def set_length(document: Document, frames: int | None) -> Edit:
    """Want a number of frames, or take the best path as long as it is."""
    if frames is not None and not 1 <= frames <= LONGEST:
        raise ModelError(f"The wanted length must be 1 to {LONGEST:,} frames, not {frames}.")
    label = "Take any length" if frames is None else f"Want {frames} frames"
    return _changed(document, label, length=None if frames is None else int(frames), alternative=0)


def set_loop(document: Document, loop: bool) -> Edit:
    """Lead the end back to the start, or not."""
    return _changed(document, "Make it a loop" if loop else "Make it end", loop=bool(loop), alternative=0)


def set_alternative(document: Document, number: int) -> Edit:
    """Take the best path (0) or one of the next best."""
    if not 0 <= number <= 100:
        raise ModelError(f"The alternative must be 0 to 100, not {number}.")
    return _changed(document, f"Take path {number + 1}" if number else "Take the best path", alternative=int(number))


def set_methods(
    document: Document, *, features: FeatureMethod | None = None, graph: FeatureMethod | None = None
) -> Edit:
    """Choose the robust or the printed features and distances, and the robust or the printed graph."""
    choice = document.performance
    features, graph = features or choice.features, graph or choice.graph
    for value in (features, graph):
        if value not in ("robust", "paper"):
            raise ModelError(f"The method is robust or paper, not {value!r}.")
    return _changed(document, f"Use {features} features, {graph} graph", features=features, graph=graph)


def set_height(document: Document, metres: float | None) -> Edit:
    """Say how tall the performer is; None measures it."""
    if metres is not None and not (math.isfinite(metres) and metres > 0):
        raise ModelError(f"The performer's height must be a positive number of metres, not {metres}.")
    return _changed(document, "Set the performer's height", height=metres)


def set_smoothing(
    document: Document, *, align: bool | None = None, blend: bool | None = None, seconds: float | None = None
) -> Edit:
    """Choose whether clips are placed one after another, and cuts blended, and for how long."""
    choice = document.performance
    if seconds is not None and not (math.isfinite(seconds) and 0 < seconds <= 5):
        raise ModelError(f"A blend lasts more than 0 and at most 5 seconds, not {seconds}.")
    aligned = choice.align if align is None else bool(align)
    blended = choice.blend if blend is None else bool(blend)
    words = ("aligned" if aligned else "not aligned") + (", blended" if blended and aligned else ", not blended")
    return _changed(
        document,
        f"Leave cuts {words}",
        align=aligned,
        blend=blended,
        blend_seconds=choice.blend_seconds if seconds is None else float(seconds),
    )


def set_hard_cut(document: Document, leave: Motion, enter: Motion, hard: bool) -> Edit:
    """Leave one cut as it is, or blend it again."""
    cut = HardCut(_checked(document, leave), _checked(document, enter))
    kept = [other for other in document.performance.hard_cuts if other != cut]
    if hard:
        kept.append(cut)
    order = tuple(sorted(kept, key=attrs.astuple))
    label = f"{'Leave' if hard else 'Blend'} the cut from {_name(document, leave)} to {_name(document, enter)}"
    return _changed(document, label, hard_cuts=order)


def _with_keys(document: Document, keys: list[KeyMotion], label: str) -> Edit:
    return _changed(document, label, keys=tuple(keys), alternative=0)


def _changed(document: Document, label: str, **changes: object) -> Edit:
    choice: PerformanceChoice = attrs.evolve(document.performance, **changes)  # type: ignore[arg-type]
    return Edit(attrs.evolve(document, performance=choice), label)


def _key(document: Document, place: int) -> KeyMotion:
    keys = document.performance.keys
    if not 0 <= place < len(keys):
        raise ModelError(f"There is no key motion number {place}: there are {len(keys)}.")
    return keys[place]


def _repeats(count: int) -> int:
    if not 1 <= count <= 10_000:
        raise ModelError(f"A motion is played 1 to 10,000 times, not {count}.")
    return int(count)


def _checked(document: Document, motion: Motion) -> Motion:
    sequence = document.sequence(motion.sequence)
    if not 0 <= motion.frame < sequence.frame_count:
        raise ModelError(f"{sequence.name} has no frame {motion.frame}: it has frames 0 to {sequence.frame_count - 1}.")
    return motion


def _name(document: Document, motion: Motion) -> str:
    return f"{document.sequence(motion.sequence).name} at frame {motion.frame}"
