"""Random documents and random edits: what a person might do, in any order."""

from __future__ import annotations

from collections.abc import Callable

from hypothesis import strategies as st

from app.model.document import Document
from app.model.edits import Edit, characters, contacts, performance, poses, scene, sequences, tracks
from app.model.performance import Motion
from app.model.values import Clip, MediaRef, ModelError
from app.model.world import SeenLength

CLIP = Clip(MediaRef("media/clip.mp4", "c0ffee", linked=False), 320, 180, 30, 25.0)
EditMaker = Callable[[Document], Edit]

frames = st.integers(0, CLIP.frame_count - 1)
pixels = st.tuples(st.floats(0, 319, width=32), st.floats(0, 179, width=32))
places = st.tuples(*[st.floats(-5, 5)] * 3)
vertices = st.integers(0, 50)


def start() -> Document:
    """A document with a clip."""
    return scene.set_clip(Document(), CLIP).document


@st.composite
def edit_makers(draw: st.DrawFn) -> EditMaker:
    """One edit of any kind; it may not fit the document, then it raises ``ModelError``."""
    frame, other, pixel, place, vertex = draw(frames), draw(frames), draw(pixels), draw(places), draw(vertices)
    number, flag = draw(st.integers(0, 20)), draw(st.booleans())

    def track(document: Document) -> str:
        if not document.tracks:
            raise ModelError("no track")
        return document.tracks[number % len(document.tracks)].id

    def character(document: Document) -> str:
        if not document.characters:
            raise ModelError("no character")
        return document.characters[number % len(document.characters)].id

    def sequence(document: Document) -> str:
        if not document.sequences:
            raise ModelError("no sequence")
        return document.sequences[number % len(document.sequences)].id

    def motion(document: Document) -> Motion:
        return Motion(sequence(document), frame)

    size, facts = draw(st.floats(0.01, 100)), {"source_fps": 10.0 + number, "up": "y" if flag else "z"}
    mesh = MediaRef(f"{number}.ply", f"{number:x}")
    triangle = [(1.0, 2.0), (30.0, 2.0), pixel]
    makers: list[EditMaker] = [
        lambda d: tracks.add_track(d, frame, pixel, name="paw" if flag else ""),
        lambda d: tracks.add_track(d, frame, pixel),
        lambda d: tracks.set_click(d, track(d), frame, pixel),
        lambda d: tracks.remove_click(d, track(d), frame),
        lambda d: tracks.delete_track(d, track(d)),
        lambda d: tracks.end_track(d, track(d), frame),
        lambda d: tracks.restart_track(d, track(d), frame, pixel),
        lambda d: tracks.set_occluded(d, track(d), frame, other, flag),
        lambda d: tracks.rename_track(d, track(d), f"name {number}"),
        lambda d: tracks.set_track_mode(d, track(d), "paper" if flag else "robust"),
        lambda d: tracks.set_track_masked(d, track(d), flag),
        lambda d: tracks.set_track_look(d, track(d), colour=number, visible=flag),
        lambda d: tracks.set_mirror(d, track(d), d.tracks[0].id if flag else None),
        lambda d: contacts.add_contact(d, track(d), frame, other, accepted=flag),
        lambda d: contacts.trim_contact(d, track(d), frame, frame, other),
        lambda d: contacts.place_contact(d, track(d), frame, place if flag else None),
        lambda d: contacts.remove_contact(d, track(d), frame),
        lambda d: scene.add_lasso(d, frame, triangle, subtract=flag),
        lambda d: scene.move_lasso_point(d, frame, 0, 1, pixel),
        lambda d: scene.remove_mask(d, frame),
        lambda d: scene.set_range(d, frame, other),
        lambda d: scene.set_camera(d, "static" if flag else "solve", focal=100.0 + number),
        lambda d: scene.set_ground(d, "depth" if flag else "plane", depth_tracks=[track(d)] if flag else []),
        lambda d: scene.set_horizon(d, number if flag else None, number / 2),
        lambda d: scene.set_camera_height(d, 1.0 + abs(number) if flag else None),
        lambda d: scene.set_length(d, SeenLength(frame, pixel, (0.0, 0.0), 2.0, (track(d), track(d)) if flag else ())),
        lambda d: scene.rename(d, f"film {number}"),
        lambda d: characters.add_character(d, mesh, name="cat"),
        lambda d: characters.delete_character(d, character(d)),
        lambda d: characters.set_pair(d, character(d), track(d), vertex),
        lambda d: characters.remove_pair(d, character(d), track(d)),
        lambda d: characters.set_alignment(d, character(d), scale=0.5 + number, translation=place),
        lambda d: characters.set_solve(d, character(d), smooth=flag, reach=(frame, other)),
        lambda d: poses.move_vertices(d, character(d), frame, {vertex: place}, {vertex: place, vertex + 1: place}),
        lambda d: poses.mute_move(d, character(d), frame, vertex, flag),
        lambda d: poses.delete_move(d, character(d), frame, vertex),
        lambda d: poses.delete_edit(d, character(d), frame),
        lambda d: poses.delete_control_vertex(d, character(d), vertex),
        lambda d: poses.follow_track(d, character(d), vertex, track(d) if flag else None),
        lambda d: poses.set_edit_end(d, character(d), frame, other),
        lambda d: sequences.add_sequence(
            d, name="run", frame_count=number + 2, fps=25.0, media=mesh, guessed=("fps", "up")
        ),
        lambda d: sequences.add_sequence(d, name="walk", frame_count=frame, fps=25.0, character=character(d)),
        lambda d: sequences.delete_sequence(d, sequence(d)),
        lambda d: sequences.rename_sequence(d, sequence(d), f"take {number}"),
        lambda d: sequences.relink_sequence(d, sequence(d), mesh),
        lambda d: sequences.show_sequence(d, sequence(d), flag),
        lambda d: sequences.set_facts(d, sequence(d), unit=size, **facts),
        lambda d: sequences.set_facts(d, sequence(d), fps=size),
        lambda d: sequences.set_front(d, sequence(d), size if flag else None),
        lambda d: sequences.set_level(d, sequence(d), flag),
        lambda d: sequences.set_structure(d, sequence(d), sensitivity=size, method="paper" if flag else "optimal"),
        lambda d: sequences.set_boundaries(d, sequence(d), (frame, other) if flag else None),
        lambda d: sequences.move_boundary(d, sequence(d), (frame,), frame if flag else 0, other),
        lambda d: sequences.set_representative(d, sequence(d), frame),
        lambda d: sequences.forget_representatives(d, sequence(d)),
        lambda d: performance.add_key(d, motion(d), repeats=number),
        lambda d: performance.remove_key(d, number),
        lambda d: performance.move_key(d, number, 0),
        lambda d: performance.set_repeats(d, 0, number),
        lambda d: performance.set_forbidden(d, motion(d), flag),
        lambda d: performance.set_mu(d, size),
        lambda d: performance.set_length(d, number if flag else None),
        lambda d: performance.set_loop(d, flag),
        lambda d: performance.set_alternative(d, number),
        lambda d: performance.set_methods(d, features="paper" if flag else "robust"),
        lambda d: performance.set_height(d, size if flag else None),
        lambda d: performance.set_smoothing(d, blend=flag, seconds=size),
        lambda d: performance.set_hard_cut(d, motion(d), Motion(sequence(d), other), flag),
    ]
    return draw(st.sampled_from(makers))


def grown(makers: list[EditMaker]) -> Document:
    """A document after these edits, without those that do not fit."""
    document = start()
    for maker in makers:
        try:
            document = maker(document).document
        except ModelError:
            continue
    return document


documents = st.lists(edit_makers(), max_size=40).map(grown)
