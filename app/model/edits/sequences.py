"""Edits of captured sequences: which there are, what is known of them, how they are cut into motions."""

from __future__ import annotations

import math
from typing import Any

import attrs

from app.model.document import Document
from app.model.edits.edit import Edit, checked_name
from app.model.performance import CapturedSequence, Fact, SequenceUp, StructureChoice
from app.model.values import MediaRef, ModelError


def add_sequence(
    document: Document,
    *,
    name: str,
    frame_count: int,
    fps: float,
    media: MediaRef | None = None,
    character: str | None = None,
    source_count: int | None = None,
    source_fps: float | None = None,
    up: SequenceUp = "z",
    unit: float = 1.0,
    guessed: tuple[Fact, ...] = (),
    animation: str | None = None,
) -> Edit:
    """Add a sequence of files, or the motion of a character of this project."""
    if (media is None) == (character is None):
        raise ModelError("A sequence is made of files or of a character's motion: give one of them.")
    if character is not None:
        document.character(character)
    if frame_count < 2:
        raise ModelError(f"A sequence needs at least 2 frames, but has {frame_count}.")
    number = document.next_id
    made = CapturedSequence(
        id=f"s{number}",
        name=_free_name(document, checked_name(name)),
        media=media,
        character=character,
        frame_count=int(frame_count),
        fps=_positive(fps, "frame rate"),
        source_count=int(source_count or frame_count),
        source_fps=_positive(fps if source_fps is None else source_fps, "frame rate"),
        up=_axis(up),
        unit=_positive(unit, "unit"),
        guessed=tuple(fact for fact in ("fps", "up", "unit") if fact in guessed),
        animation=animation,
    )
    grown = attrs.evolve(document, sequences=(*document.sequences, made), next_id=number + 1)
    return Edit(grown, f"Add {made.name}")


def delete_sequence(document: Document, sequence_id: str) -> Edit:
    """Delete a sequence, and its motions from what is composed."""
    sequence = document.sequence(sequence_id)
    kept = tuple(other for other in document.sequences if other.id != sequence_id)
    choice = document.performance
    choice = attrs.evolve(
        choice,
        keys=tuple(key for key in choice.keys if key.motion.sequence != sequence_id),
        forbidden=tuple(motion for motion in choice.forbidden if motion.sequence != sequence_id),
        hard_cuts=tuple(cut for cut in choice.hard_cuts if sequence_id not in (cut.leave.sequence, cut.enter.sequence)),
    )
    return Edit(attrs.evolve(document, sequences=kept, performance=choice), f"Delete {sequence.name}")


def rename_sequence(document: Document, sequence_id: str, name: str) -> Edit:
    """Give a sequence another name."""
    sequence, name = document.sequence(sequence_id), checked_name(name)
    if any(other.name == name and other.id != sequence_id for other in document.sequences):
        raise ModelError(f"Another sequence is already called {name}: choose another name.")
    return Edit(document.with_sequence(attrs.evolve(sequence, name=name)), f"Rename {sequence.name} to {name}")


def relink_sequence(document: Document, sequence_id: str, media: MediaRef) -> Edit:
    """Say where the files lie now."""
    sequence = document.sequence(sequence_id)
    if sequence.media is None:
        raise ModelError(f"{sequence.name} is a character's motion: there are no files to find.")
    return Edit(document.with_sequence(attrs.evolve(sequence, media=media)), f"Find {sequence.name} again")


def show_sequence(document: Document, sequence_id: str, visible: bool) -> Edit:
    """Show a sequence's motions in the window, or hide them; nothing that is computed depends on it."""
    sequence = document.sequence(sequence_id)
    label = f"{'Show' if visible else 'Hide'} {sequence.name}"
    return Edit(document.with_sequence(attrs.evolve(sequence, visible=bool(visible))), label)


def set_facts(
    document: Document,
    sequence_id: str,
    *,
    source_fps: float | None = None,
    up: SequenceUp | None = None,
    unit: float | None = None,
    fps: float | None = None,
) -> Edit:
    """Say what was guessed: the files' frame rate, up axis and unit in metres; or at which rate they are played.

    Frames that the user marked keep their time where the rate changes.
    """
    sequence = document.sequence(sequence_id)
    said: set[str] = set()
    changed = sequence
    if up is not None:
        changed, said = attrs.evolve(changed, up=_axis(up)), said | {"up"}
    if unit is not None:
        changed, said = attrs.evolve(changed, unit=_positive(unit, "unit")), said | {"unit"}
    if source_fps is not None:
        # Where nothing is converted the files go on to be played one by one.
        plain = changed.fps == changed.source_fps
        changed = attrs.evolve(changed, source_fps=_positive(source_fps, "frame rate"))
        said |= {"fps"}
        if plain and fps is None:
            changed = attrs.evolve(changed, fps=changed.source_fps)
    if fps is not None:
        changed = attrs.evolve(changed, fps=_positive(fps, "frame rate"))
    count = frames_at(changed.source_count, changed.source_fps, changed.fps)
    if count < 2:
        raise ModelError(f"At {changed.fps:g} frames a second {sequence.name} has fewer than 2 frames: choose more.")
    factor = count / sequence.frame_count
    changed = attrs.evolve(
        changed, frame_count=count, guessed=tuple(fact for fact in changed.guessed if fact not in said)
    )
    document = document.with_sequence(changed)
    if count != sequence.frame_count:
        document = _retimed(document, changed, factor)
    what = ", ".join(sorted(said | ({"played rate"} if fps is not None else set()))) or "nothing"
    return Edit(document, f"Set {what} of {sequence.name}")


def set_front(document: Document, sequence_id: str, degrees: float | None) -> Edit:
    """Say where the performer faces in frame 0, degrees from +x towards +y; None finds it."""
    sequence = document.sequence(sequence_id)
    if degrees is not None and not math.isfinite(degrees):
        raise ModelError(f"The front of {sequence.name} must be a finite angle, not {degrees}.")
    turned = None if degrees is None else (float(degrees) + 180.0) % 360.0 - 180.0
    return Edit(document.with_sequence(attrs.evolve(sequence, front=turned)), f"Turn the front of {sequence.name}")


def set_level(document: Document, sequence_id: str, level: bool) -> Edit:
    """Take out what the performer climbs, or leave it."""
    sequence = document.sequence(sequence_id)
    label = f"{'Level the ground' if level else 'Keep the slope'} of {sequence.name}"
    return Edit(document.with_sequence(attrs.evolve(sequence, level=bool(level))), label)


def set_structure(document: Document, sequence_id: str, **changes: Any) -> Edit:
    """Change how motions are found: method, beta, longest_period, sensitivity, force_cyclic."""
    sequence = document.sequence(sequence_id)
    known = {"method", "beta", "longest_period", "sensitivity", "force_cyclic"}
    if not changes or not set(changes) <= known:
        raise ModelError(f"A structure has {', '.join(sorted(known))}, not {', '.join(sorted(set(changes) - known))}.")
    if changes.get("method", "optimal") not in ("optimal", "paper"):
        raise ModelError(f"The method is optimal or paper, not {changes['method']!r}.")
    for name in ("longest_period", "sensitivity", "beta"):
        if changes.get(name) is not None:
            changes[name] = _positive(changes[name], name.replace("_", " "))
        elif name in changes and name != "beta":
            raise ModelError(f"The {name.replace('_', ' ')} must be a positive number.")
    if "force_cyclic" in changes:
        changes["force_cyclic"] = bool(changes["force_cyclic"])
    structure: StructureChoice = attrs.evolve(sequence.structure, **changes)
    what = ", ".join(f"{name.replace('_', ' ')} {value}" for name, value in sorted(changes.items()))
    return Edit(
        document.with_sequence(attrs.evolve(sequence, structure=structure)),
        f"Find motions of {sequence.name} by {what}",
    )


def set_boundaries(document: Document, sequence_id: str, frames: tuple[int, ...] | None) -> Edit:
    """Set the first frames of the motions by hand; None finds them again."""
    sequence = document.sequence(sequence_id)
    if frames is None:
        structure = attrs.evolve(sequence.structure, boundaries=None)
        label = f"Find the boundaries of {sequence.name}"
        return Edit(document.with_sequence(attrs.evolve(sequence, structure=structure)), label)
    given = tuple(sorted({int(frame) for frame in frames} - {0}))
    if given and not 0 < given[0] <= given[-1] < sequence.frame_count:
        raise ModelError(
            f"The boundaries of {sequence.name} must be frames 1 to {sequence.frame_count - 1}, not {list(given)}."
        )
    structure = attrs.evolve(sequence.structure, boundaries=given)
    label = f"Set the boundaries of {sequence.name}"
    return Edit(document.with_sequence(attrs.evolve(sequence, structure=structure)), label)


def move_boundary(document: Document, sequence_id: str, present: tuple[int, ...], old: int, new: int | None) -> Edit:
    """Move one boundary of those that are there now, or take it away (None); an ``old`` of 0 adds ``new``."""
    sequence = document.sequence(sequence_id)
    if old and old not in present:
        raise ModelError(f"{sequence.name} has no boundary at frame {old}.")
    frames = set(present) - {old}
    if new is not None:
        frames |= {int(new)}
    edit = set_boundaries(document, sequence_id, tuple(frames))
    if not old:
        label = f"Add a boundary at frame {new} of {sequence.name}"
    elif new is None:
        label = f"Remove the boundary at frame {old} of {sequence.name}"
    else:
        label = f"Move a boundary of {sequence.name}, frame {old} to {new}"
    return Edit(edit.document, label, new if new is not None else old)


def set_representative(document: Document, sequence_id: str, frame: int, others: tuple[int, ...] = ()) -> Edit:
    """Let the texton of a frame stand for its cluster; ``others`` are frames of that cluster chosen before."""
    sequence = document.sequence(sequence_id)
    if not 0 <= frame < sequence.frame_count:
        raise ModelError(f"{sequence.name} has no frame {frame}: it has frames 0 to {sequence.frame_count - 1}.")
    frames = tuple(sorted((set(sequence.representatives) - set(others)) | {int(frame)}))
    return Edit(
        document.with_sequence(attrs.evolve(sequence, representatives=frames)),
        f"Choose the texton at frame {frame} of {sequence.name}",
        frame,
    )


def forget_representatives(document: Document, sequence_id: str) -> Edit:
    """Let eq. 9 choose all textons of a sequence."""
    sequence = document.sequence(sequence_id)
    return Edit(
        document.with_sequence(attrs.evolve(sequence, representatives=())),
        f"Choose the textons of {sequence.name} anew",
    )


def frames_at(count: int, source_fps: float, fps: float) -> int:
    """How many frames files of one rate are when they are played at another."""
    return count if fps == source_fps else int((count - 1) * fps / source_fps + 1e-9) + 1


def _retimed(document: Document, sequence: CapturedSequence, factor: float) -> Document:
    """Move what the user marked to the same times of the new frames."""
    last = sequence.frame_count - 1

    def at(frame: int) -> int:
        return min(last, round(frame * factor))

    structure = sequence.structure
    if structure.boundaries is not None:
        structure = attrs.evolve(structure, boundaries=tuple(sorted({at(f) for f in structure.boundaries} - {0})))
    chosen = tuple(sorted({at(frame) for frame in sequence.representatives}))
    document = document.with_sequence(attrs.evolve(sequence, structure=structure, representatives=chosen))
    choice = document.performance

    def moved(motion: Any) -> Any:
        return attrs.evolve(motion, frame=at(motion.frame)) if motion.sequence == sequence.id else motion

    keys = tuple(attrs.evolve(key, motion=moved(key.motion)) for key in choice.keys)
    cuts = tuple(attrs.evolve(cut, leave=moved(cut.leave), enter=moved(cut.enter)) for cut in choice.hard_cuts)
    choice = attrs.evolve(choice, keys=keys, forbidden=tuple(map(moved, choice.forbidden)), hard_cuts=cuts)
    return attrs.evolve(document, performance=choice)


def _free_name(document: Document, name: str) -> str:
    taken = {sequence.name for sequence in document.sequences}
    chosen, count = name, 2
    while chosen in taken:
        chosen, count = f"{name} {count}", count + 1
    return chosen


def _positive(value: float, what: str) -> float:
    if not (math.isfinite(value) and value > 0):
        raise ModelError(f"The {what} must be a positive number, not {value}.")
    return float(value)


def _axis(up: str) -> SequenceUp:
    if up == "y":
        return "y"
    if up == "z":
        return "z"
    raise ModelError(f"The up axis is y or z, not {up!r}.")
