"""Stages of a character: alignment, base solution, animation with edits, comparisons."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from app.model.character import Alignment, Character, PoseEdit
from app.model.document import Document
from app.model.tracks import Track
from app.model.values import Point3
from app.stages import scene, tracking
from app.stages.context import Context
from app.stages.once import once
from app.stages.results import AlignedCharacter, Animation, PlacedContact, World
from app.stages.stage import Stage

NO_PAIRS = "Pair at least three tracks with vertices of the character first."


@once
def alignment(document: Document, character: Character) -> Stage:
    """The character on the subject in the first frame."""
    label = f"Placing {character.name}"
    paired = _paired(document, character)
    needs = (scene.world(document), *_tracks(document, paired), *_contacts(document, paired))
    inputs = (character.mesh, _vertices(character, paired), character.alignment)
    blocked = NO_PAIRS if len(paired) < 3 and character.alignment.fitted else None
    return Stage(f"alignment/{character.id}", label, _alignment, inputs, needs, blocked=blocked, weight=0.1)


@once
def start(document: Document, character: Character) -> Stage:
    """The character in frame 0 as the user posed it: part of placing it, before anything is solved."""
    paired = _paired(document, character)
    needs = (scene.world(document), alignment(document, character), *_contacts(document, paired))
    committed = _start_places(character)
    inputs = (_vertices(character, paired), committed, character.solve.keep_volume)
    label = f"Posing {character.name} in the first frame"
    return Stage(f"start/{character.id}", label, _start, inputs, needs, weight=0.1)


@once
def base(document: Document, character: Character) -> Stage:
    """The character's motion before any edit but that of frame 0, which it begins with."""
    paired = _paired(document, character)
    mirrors = _mirrors(document, paired) if character.solve.symmetry else ()
    needs = (
        scene.world(document),
        start(document, character),
        *_tracks(document, paired),
        *_contacts(document, paired),
    )
    hidden = tuple(_hidden(track) for track in paired)
    inputs = (_vertices(character, paired), character.solve.method, character.solve.keep_volume, mirrors, hidden)
    label = f"Moving {character.name}"
    blocked = NO_PAIRS if len(paired) < 3 else None
    seconds = 0.05 * (document.clip.frame_count if document.clip else 1)
    return Stage(f"base/{character.id}", label, _base, inputs, needs, blocked=blocked, version=2, weight=seconds)


@once
def animation(document: Document, character: Character) -> Stage:
    """The character's motion with all edits."""
    edits = counting_edits(character)
    following = tuple((vertex, track) for vertex, track in character.following.items())
    inputs: tuple[Any, ...] = (
        character.id,
        edits,
        following,
        character.solve.smooth,
        character.solve.reach,
        character.solve.keep_volume,
    )
    needs: tuple[Stage, ...] = (base(document, character),)
    if character.solve.lift_feet:
        planted = tuple(
            (track.id, character.pairs[track.id]) for track in _paired(document, character) if track.contacts
        )
        inputs += (planted,)
        needs += (scene.world(document), *(scene.contacts(document, document.track(each)) for each, _ in planted))
    label = f"Propagating edits of {character.name}" if edits else f"Moving {character.name}"
    return Stage(f"animation/{character.id}", label, _animation, inputs, needs, weight=0.5 + len(edits))


def ambiguous(document: Document, character: Character) -> Stage:
    """Limbs and frames that the video explains in two ways, and the frame where one edit decides."""
    label = f"Looking for ambiguous limbs of {character.name}"
    needs = (base(document, character),)
    return Stage(f"ambiguous/{character.id}", label, _ambiguous, (), needs, weight=3.0)


def comparison(document: Document, character: Character, variant: str) -> Stage:
    """One of the paper's comparisons, from the same edits."""
    needs = (base(document, character),)
    inputs = (variant, counting_edits(character), character.solve.keep_volume)
    name, label = f"compare/{character.id}/{variant}", f"Comparing {character.name} with {variant.replace('_', ' ')}"
    return Stage(name, label, _comparison, inputs, needs, weight=2.0)


def counting_edits(character: Character) -> tuple[Any, ...]:
    """Give (frame, committed places, end of the correction) of the edits that count, in the order of their frames."""
    paired = set(character.pairs.values())
    return tuple(
        (frame, committed, edit.until)
        for frame, edit in sorted(character.edits.items())
        if (committed := _counting(edit, paired))
    )


def _start_places(character: Character) -> tuple[tuple[int, Point3], ...]:
    """Give the committed places of frame 0; none where the user set how far that edit counts: then it is no start."""
    edit = character.edits.get(0)
    if edit is None or edit.until is not None or character.solve.reach is not None:
        return ()
    return _counting(edit, set(character.pairs.values()))


def _paired(document: Document, character: Character) -> list[Track]:
    return [track for track in document.tracks if track.id in character.pairs]


def _mirrors(document: Document, paired: list[Track]) -> tuple[tuple[str, tuple[str, int | None]], ...]:
    """Give (hidden, (seen, lag)): of two mirrors the one with fewer clicks in sight follows the other."""
    ids = {track.id for track in paired}
    found = []
    for track in paired:
        if track.mirror in ids:
            other = document.track(track.mirror)
            if (_in_sight(track), track.id) < (_in_sight(other), other.id):
                found.append((track.id, (other.id, track.mirror_lag)))
    return tuple(found)


def _in_sight(track: Track) -> int:
    return sum(not any(frame in gap for gap in track.occluded) for frame in track.clicks)


def _hidden(track: Track) -> tuple[int, ...]:
    """Frames in which the point is said to be hidden; where it is clicked all the same, its place is known."""
    return tuple(
        frame for gap in track.occluded for frame in range(max(gap.first, 1), gap.last + 1) if frame not in track.clicks
    )


def _seen(positions: Any, hidden: tuple[int, ...]) -> Any:
    """What the tracker guessed behind something else is no observation: the body's motion bridges it."""
    if not hidden:
        return positions
    seen = np.array(positions)
    seen[[frame for frame in hidden if frame < len(seen)]] = np.nan
    return seen


def _vertices(character: Character, paired: list[Track]) -> tuple[tuple[str, int], ...]:
    return tuple((track.id, character.pairs[track.id]) for track in paired)


def _tracks(document: Document, paired: list[Track]) -> tuple[Stage, ...]:
    return tuple(tracking.track(document, track) for track in paired)


def _contacts(document: Document, paired: list[Track]) -> tuple[Stage, ...]:
    return tuple(scene.contacts(document, track) for track in paired)


def _counting(edit: PoseEdit, paired: set[int]) -> tuple[tuple[int, Point3], ...]:
    """Give the committed places that count: none without an unmuted move, none of a muted control vertex."""
    muted = {vertex for vertex, move in edit.moves.items() if move.muted}
    if len(muted) == len(edit.moves):
        return ()
    places = edit.committed or {vertex: move.place for vertex, move in edit.moves.items()}
    return tuple((vertex, place) for vertex, place in places.items() if vertex not in muted - paired)


def _alignment(context: Context, inputs: tuple[Any, Any, Alignment], world: World, *needs: Any) -> AlignedCharacter:
    from app.stages.placing import place_character

    mesh, paired, choice = inputs
    tracks, contacts = needs[: len(needs) // 2], needs[len(needs) // 2 :]
    return place_character(context.media.mesh(mesh), dict(paired), choice, world, tracks, contacts)


def _start(context: Context, inputs: Any, world: World, aligned: AlignedCharacter, *contacts: Any) -> Any:
    from imitation.propagation import placed_frame, start_pose

    paired, committed, keep_volume = inputs
    planted = [name for (name, _), placed in zip(paired, contacts, strict=True) if placed and placed[0].first == 0]
    placed = placed_frame(aligned.vertices, aligned.faces, world.camera(0), dict(paired), planted)
    if not committed:
        return placed
    deformer = context.media.deformer(aligned.vertices, aligned.faces, keep_volume)
    return start_pose(placed, {vertex: np.array(place) for vertex, place in committed}, deformer=deformer)


def _base(context: Context, inputs: Any, world: World, placed: Any, *needs: Any) -> Any:
    from imitation.propagation import solve_base

    paired, method, keep_volume, mirrors, hidden = inputs
    tracks, contacts = needs[: len(needs) // 2], needs[len(needs) // 2 :]
    names = [name for name, _ in paired]
    deformer = context.media.deformer(placed.rest, placed.faces, keep_volume)
    return solve_base(
        placed.rest,
        placed.faces,
        world.cameras,
        {name: _seen(track.positions, gaps) for name, track, gaps in zip(names, tracks, hidden, strict=True)},
        dict(paired),
        {name: _intervals(placed) for name, placed in zip(names, contacts, strict=True) if placed},
        method=method,
        confidence={name: track.confidence for name, track in zip(names, tracks, strict=True)},
        symmetry=dict(mirrors) or None,
        start=placed.vertices[0],
        deformer=deformer,
        progress=context.progress,
        on_frame=lambda frame, vertices: context.emit((frame, vertices)),
    )


def _intervals(placed: list[PlacedContact]) -> list[tuple[int, int, Any]]:
    return [(contact.first, contact.last, contact.place) for contact in placed]


def _animation(
    context: Context, inputs: Any, solved: Any, world: World | None = None, *contacts: list[PlacedContact]
) -> Animation:
    from imitation.propagation import propagate

    character, edits, following, smooth, reach, keep_volume, *planted = inputs
    committed: dict[int, Mapping[int, Any]] = {
        frame: {vertex: np.array(place) for vertex, place in places} for frame, places, _ in edits
    }
    limits = {frame: (reach.first, reach.last) for frame, _, _ in edits} if reach is not None else None
    # An earlier result on the same base lends the spans that have not changed; the bits are the same either way.
    memory = context.media.memory
    deformer = context.media.deformer(solved.rest, solved.faces, keep_volume)
    result = propagate(
        solved,
        committed,
        smooth=smooth,
        follow=dict(following),
        end=edits[-1][2] if edits else None,
        reach=limits,
        origin=memory.get(("origin", character)),
        previous=memory.get(("imitation", character)),
        deformer=deformer,
        on_frame=lambda frame, vertices: context.emit((frame, vertices)),
        progress=context.progress,
    )
    memory[("imitation", character)] = result
    vertices, keys = result.vertices, result.key_points
    if world is not None:
        from imitation.motion import lifted_feet

        feet = {vertex: _intervals(placed) for (_, vertex), placed in zip(planted[0], contacts, strict=True)}
        vertices = lifted_feet(vertices, solved.rest, feet, world.normal)
        keys = vertices[:, solved.keys.vertices]
    return Animation(vertices, keys, result.names, result.report.as_dict())


def _ambiguous(context: Context, inputs: tuple[()], solved: Any) -> Any:
    from imitation.propagation import ambiguous_spans

    return ambiguous_spans(solved, progress=context.progress)


def _comparison(context: Context, inputs: Any, solved: Any) -> Any:
    from imitation.propagation import compare

    variant, edits, keep_volume = inputs
    committed = {frame: {vertex: np.array(place) for vertex, place in places} for frame, places, _ in edits}
    deformer = context.media.deformer(solved.rest, solved.faces, keep_volume)
    return compare(solved, committed, variant, deformer=deformer, progress=context.progress)
