"""Sequences into a project, motions by name, and why a motion is out of reach."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import attrs

from app.actions.session import Session
from app.formats.tvm import MeshFrames, guess_facts, open_mesh_frames
from app.model.document import Document
from app.model.edits import sequences
from app.model.performance import CapturedSequence, Fact, Motion, SequenceUp
from app.model.values import MediaRef
from app.stages.foreign import ProjectMotion, finished, foreign_motions, is_project, open_motion
from app.stages.results import Animation
from imitation.errors import InputError, NoSolution
from imitation.progress import Progress, silent


@attrs.frozen
class MotionName:
    """A motion of the graph as people see it.

    Attributes
    ----------
    node : number in the graph. name : "walk/2", the second motion of the sequence walk.
    sequence : id. first, last : frames of the cluster. texton : first and last frame of what is played.
    """

    node: int
    name: str
    sequence: str
    first: int
    last: int
    texton: tuple[int, int]
    cyclic: bool
    period: float
    reason: str

    @property
    def motion(self) -> Motion:
        """How the document refers to it."""
        return Motion(self.sequence, self.texton[0])


@attrs.frozen
class FoundSequence:
    """A sequence of files that was read and is not in the project yet; fields as in ``CapturedSequence``.

    Attributes
    ----------
    notes : sentences on what was guessed; empty if nothing.
    """

    name: str
    media: MediaRef
    source_count: int
    source_fps: float
    up: SequenceUp
    unit: float
    guessed: tuple[Fact, ...]
    notes: str
    animation: str | None = None


def read_sequence(
    session: Session,
    path: Path,
    *,
    name: str | None = None,
    fps: float | None = None,
    up: SequenceUp | None = None,
    unit: float | None = None,
    copy: bool = False,
    character: str | None = None,
    animation: str | None = None,
    progress: Progress | None = None,
) -> FoundSequence:
    """Look what a sequence of meshes is and bring it in, without changing the document: safe in any thread.

    Of another project it is the finished motion of a ``character``, which is linked and never solved here; of a file
    with several animations the one named, or numbered from 1.

    Raises ``InputError`` when it cannot be read.
    """
    report = progress or silent
    report(0.0)
    with _opened(session, path, character, animation) as frames:
        report(0.2)
        guess = guess_facts(frames, fps=fps, up=up, unit=unit)
        count = len(frames)
    report(0.5)
    if isinstance(frames, ProjectMotion):
        if copy:
            raise InputError(f"{path.name} is a project, whose motion is linked: add it without copying.")
        media, own = _linked(path, frames), frames.character
    else:
        media, own = session.bring_in(path, copy=copy), path.name if path.is_dir() else path.stem
        own = own if animation is None else f"{own} {animation}"
    chosen = name or own
    return FoundSequence(chosen, media, count, guess.fps, guess.up, guess.unit, guess.guessed, guess.why, animation)


def read_sequences(session: Session, path: Path, *, progress: Progress | None = None) -> tuple[FoundSequence, ...]:
    """Look at all that a path gives: one sequence, or every finished motion of another project."""
    names = characters_of(path) or (None,)
    return tuple(read_sequence(session, path, character=name, progress=progress) for name in names)


def characters_of(path: Path) -> tuple[str, ...]:
    """Give the ids of another project's characters with a finished motion; none for a path that is no project.

    Raises ``InputError`` when a project has no finished motion.
    """
    return tuple(each.character.id for each in finished(path)) if is_project(path) else ()


def _opened(session: Session, path: Path, character: str | None, animation: str | None) -> MeshFrames:
    if not is_project(path):
        return open_mesh_frames(path, animation=animation)
    if animation is not None:
        raise InputError(f"{path.name} is a project, whose motions go by their characters: name no animation.")
    if path.resolve() == session.folder.path.resolve():
        raise InputError(f"{path.name} is this project itself: add the motion of its character instead.")
    if character is None:
        (only, *others) = characters_of(path)
        if others:
            raise InputError(f"Several characters of {path.name} have a motion: name one of them.")
        character = only
    return open_motion(path, character=character)


def _motion_again(sequence: CapturedSequence, mark: str, path: Path) -> MediaRef:
    """The motion a sequence was made of, or what has become of it where that was animated again."""
    motions = foreign_motions(path)
    same = [each for each in motions if each.mark == mark]
    done = [each for each in motions if each.done]
    named = [each for each in done if each.character.name == sequence.name] or done
    found = same or named
    if len(found) != 1:
        raise InputError(f"It is not clear which motion of {path.name} was {sequence.name}: add the right one anew.")
    with open_motion(path, character=found[0].character.id) as motion:
        if len(motion) != sequence.source_count:
            raise InputError(
                f"{motion.name} has {len(motion)} frames, but {sequence.name} was made of {sequence.source_count}: "
                "add it anew."
            )
        return _linked(path, motion)


def _linked(path: Path, motion: ProjectMotion) -> MediaRef:
    return MediaRef(str(path.resolve()), motion.mark, linked=True)


def take_sequence(session: Session, found: FoundSequence) -> tuple[str, str]:
    """Add a sequence that was read; gives its id, and a sentence on what was guessed or converted."""
    rate, shown, converted = _played(session.document, found.name, found.source_count, found.source_fps)
    edit = sequences.add_sequence(
        session.document,
        name=found.name,
        media=found.media,
        frame_count=shown,
        fps=rate,
        source_count=found.source_count,
        source_fps=found.source_fps,
        up=found.up,
        unit=found.unit,
        guessed=found.guessed,
        animation=found.animation,
    )
    return session.apply(edit).sequences[-1].id, f"{found.notes} {converted}".strip()


def add_sequence(
    session: Session,
    path: Path,
    *,
    name: str | None = None,
    fps: float | None = None,
    up: SequenceUp | None = None,
    unit: float | None = None,
    copy: bool = False,
    character: str | None = None,
    animation: str | None = None,
) -> tuple[str, str]:
    """Add a sequence of meshes; gives its id, and a sentence on what was guessed or converted (empty if nothing).

    Where the project has sequences already, it is played at their rate: at each time the nearest frame.

    Raises ``InputError`` when it cannot be read.
    """
    facts: dict[str, Any] = {"fps": fps, "up": up, "unit": unit, "character": character, "animation": animation}
    found = read_sequence(session, path, name=name, copy=copy, **facts)
    return take_sequence(session, found)


def find_again(session: Session, sequence_id: str, path: Path, *, progress: Progress | None = None) -> MediaRef:
    """Look whether a sequence's files lie at a place, and give the reference to them; the document stays as it is.

    Raises ``InputError`` when something else lies there.
    """
    sequence = session.document.sequence(sequence_id)
    (progress or silent)(0.0)
    if is_project(path) and sequence.media is not None:
        return _motion_again(sequence, sequence.media.fingerprint, path)
    with open_mesh_frames(path, animation=sequence.animation) as frames:
        if len(frames) != sequence.source_count:
            raise InputError(
                f"{path.name} has {len(frames)} frames, but {sequence.name} was made of {sequence.source_count}: "
                "choose where its own files lie."
            )
    return session.bring_in(path)


def add_character_motion(session: Session, character_id: str, *, name: str | None = None) -> tuple[str, str]:
    """Add a character's animated motion as a sequence; see ``add_sequence``."""
    document = session.document
    character = document.character(character_id)
    animated = session.ready(session.stages.animation(character_id))
    if isinstance(animated, Animation):
        count = len(animated)
    elif document.clip is not None:
        count = document.clip.frame_count
    else:
        raise InputError(f"{character.name} has no motion: the project has no clip.")
    fps = document.clip.fps if document.clip is not None else 25.0
    chosen = name or f"{character.name} as filmed"
    rate, shown, converted = _played(document, chosen, count, fps)
    edit = sequences.add_sequence(
        document, name=chosen, character=character_id, frame_count=shown, fps=rate, source_count=count, source_fps=fps
    )
    return session.apply(edit).sequences[-1].id, converted


def _played(document: Document, name: str, count: int, fps: float) -> tuple[float, int, str]:
    """Rate and number of frames at which a new sequence is played, and a sentence where that is not its own."""
    if not document.sequences or abs(document.sequences[0].fps - fps) <= 1e-6 * fps:
        return fps, count, ""
    rate = document.sequences[0].fps
    shown = sequences.frames_at(count, fps, rate)
    return rate, shown, f"{name} has {fps:g} frames a second and is played at {rate:g}: at each time the nearest frame."


def sequence_named(document: Document, name: str | None) -> CapturedSequence:
    """Give the sequence of this name or id; without a name the only one."""
    if name is None and len(document.sequences) == 1:
        return document.sequences[0]
    for sequence in document.sequences:
        if name in (sequence.name, sequence.id):
            return sequence
    known = ", ".join(sequence.name for sequence in document.sequences) or "none yet"
    asked = "Which sequence?" if name is None else f"There is no sequence called {name}."
    raise InputError(f"{asked} The sequences are {known}.")


def motions(document: Document, graph: Any) -> list[MotionName]:
    """Give all motions of the graph with their names."""
    named = []
    for number, node in enumerate(graph.nodes):
        sequence = document.sequences[node.sequence]
        cluster = graph.analyses[node.sequence].structure.clusters[node.cluster]
        named.append(
            MotionName(
                node=number,
                name=f"{sequence.name}/{node.cluster + 1}",
                sequence=sequence.id,
                first=cluster.first,
                last=cluster.last,
                texton=(node.first, node.last),
                cyclic=cluster.cyclic,
                period=cluster.period,
                reason=cluster.reason,
            )
        )
    return named


def motion_named(document: Document, named: Sequence[MotionName], text: str) -> MotionName:
    """Give the motion called "walk/2", the one at "walk@17" (a frame), or the only one of "walk".

    Raises ``InputError`` with what there is.
    """
    for motion in named:
        if text == motion.name:
            return motion
    at = re.fullmatch(r"(.+)@(\d+)", text)
    if at is not None:
        sequence = sequence_named(document, at[1])
        for motion in named:
            if motion.sequence == sequence.id and motion.first <= int(at[2]) <= motion.last:
                return motion
        raise InputError(f"{sequence.name} has no frame {at[2]}: it has frames 0 to {sequence.frame_count - 1}.")
    alone = [motion for motion in named if motion.name.rsplit("/", 1)[0] == text]
    if len(alone) == 1:
        return alone[0]
    known = ", ".join(motion.name for motion in named) or "none"
    raise InputError(f"There is no motion called {text}: the motions are {known}.")


def explained(error: Any, named: Sequence[MotionName]) -> NoSolution:
    """Say with names which key motion is out of reach, the smallest mu that reaches it, and which edges that adds."""
    start, goal = named[error.start].name, named[error.goal].name
    if error.mu is None:
        return NoSolution(
            f"{goal} cannot be reached from {start} whatever mu is: allow what is forbidden, or choose another key "
            "motion."
        )
    edges = " and ".join(f"{named[a].name} to {named[b].name}" for a, b in error.edges)
    # The limit is exclusive, so what is named lies a little above it.
    return NoSolution(
        f"{goal} cannot be reached from {start}: the smallest mu that reaches it is {above(error.mu):.4g}, "
        f"which adds {edges or 'nothing'}."
    )


def above(mu: float) -> float:
    """Give a mu of four digits that is larger."""
    import math

    step = 10.0 ** (math.floor(math.log10(mu)) - 3) if mu > 0 else 1e-4
    return math.floor(mu / step + 1) * step
