"""Films of a result: over the video, from the side, and the paper's comparisons beside each other."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any, Literal

import numpy as np

from app.actions.results import animation_of, rate
from app.actions.session import Session
from app.formats import Picture, write_video
from app.stages.results import Array, World
from imitation.errors import InputError
from imitation.progress import Progress, silent

View = Literal["video", "side", "both"]
COMPARISONS = {
    "naive_tracks": "tracks interpolated (Fig. 5)",
    "first_pass": "first pass only (Fig. 9)",
    "key_poses": "key poses interpolated (Fig. 12)",
    "anchors_only": "anchors without 2D tracks (Fig. 14)",
}


def render_film(
    session: Session,
    character_ids: Sequence[str],
    target: Path,
    *,
    view: View = "both",
    dim: float = 0.0,
    points: bool = False,
    progress: Progress | None = None,
) -> None:
    """Write a film of animated characters at the clip's frame rate.

    Parameters
    ----------
    view : "video" over the filmed frames, "side" from the side, "both" beside each other.
    dim : how far the filmed frames fade towards grey, 0 to 1.
    points : whether the tracked points are drawn.

    Raises ``InputError`` when a character was not animated, or the file cannot be written.
    """
    motions = [_Moving.of(session, character_id) for character_id in character_ids]
    if not motions:
        raise InputError("There is no character to film: add one and animate it.")
    count = len(motions[0].vertices)
    report = progress or silent

    def pictures() -> Iterator[Picture]:
        sources: list[Iterable[Picture]] = []
        if view in ("video", "both"):
            sources.append(_over_video(session, motions, dim, points))
        if view in ("side", "both"):
            sources.append(_from_side(session, motions[0], motions[0].vertices))
        for frame, shown in enumerate(_together(sources, ("camera", "side") if view == "both" else ())):
            yield shown
            report((frame + 1) / count)

    write_video(target, pictures(), rate(session), count=count)


def compare_film(
    session: Session,
    character_id: str,
    target: Path,
    variants: Sequence[str] = tuple(COMPARISONS),
    *,
    progress: Progress | None = None,
) -> None:
    """Write a film of our result and the paper's comparisons, each over the video and from the side.

    The comparisons must have been computed.
    """
    moving = _Moving.of(session, character_id)
    columns: list[tuple[str, Array]] = [("Motionwright", moving.vertices)]
    for variant in variants:
        made: Any = session.ready(session.stages.comparison(character_id, variant))
        if made is None:
            raise InputError(f"The comparison {variant} has not been computed yet.")
        columns.append((COMPARISONS[variant], made))
    count, report = len(moving.vertices), progress or silent

    def pictures() -> Iterator[Picture]:
        sources: list[Iterable[Picture]] = []
        labels = []
        for name, vertices in columns:
            sources.append(_over_video(session, [moving.with_vertices(vertices)], 0.25, False))
            labels.append(name)
        for _, vertices in columns:
            sources.append(_from_side(session, moving, vertices))
            labels.append("from the side")
        for frame, shown in enumerate(_together(sources, labels, len(columns))):
            yield shown
            report((frame + 1) / count)

    write_video(target, pictures(), rate(session), count=count)


def still(session: Session, character_id: str, frame: int, labels: Sequence[str] = ("camera", "side")) -> Picture:
    """Give one picture of a character over its frame and from the side."""
    moving = _Moving.of(session, character_id)
    from imitation.rendering import side_by_side

    over = _over_video(session, [moving], 0.0, False, range(frame, frame + 1))
    side = _from_side(session, moving, moving.vertices, range(frame, frame + 1))
    return side_by_side([next(iter(over)), next(iter(side))], labels)


class _Moving:
    """A character with what drawing needs."""

    def __init__(self, vertices: Array, faces: Any, colors: Any) -> None:
        self.vertices, self.faces, self.colors = vertices, faces, colors

    @classmethod
    def of(cls, session: Session, character_id: str) -> _Moving:
        animated, aligned = animation_of(session, character_id)
        mesh = session.media.mesh(session.document.character(character_id).mesh)
        return cls(animated.vertices, aligned.faces, mesh.colors)

    def with_vertices(self, vertices: Array) -> _Moving:
        return _Moving(vertices, self.faces, self.colors)


def _over_video(
    session: Session, motions: Sequence[_Moving], dim: float, points: bool, frames: range | None = None
) -> Iterator[Picture]:
    from imitation.rendering import Layer, Renderer, composite, draw_points, ground_shadow

    world, film = _world(session), session.frames()
    contacts = _contacts(session)
    renderers = [Renderer(m.faces, film.size, colors=m.colors, samples=2, up=world.normal) for m in motions]
    tracks = [session.ready(session.stages.track(track.id)) for track in session.document.tracks] if points else []
    for frame in frames or range(len(motions[0].vertices)):
        camera, layers = world.cameras[frame], []
        floor = _floor(world, contacts, frame)
        for moving, renderer in zip(motions, renderers, strict=True):
            pose = np.ascontiguousarray(moving.vertices[frame], np.float64)
            lights = renderer.lights(pose, camera)
            shadow = None
            if floor is not None:
                shadow = ground_shadow(pose, lights, camera, renderer.size, floor, renderer.look, renderer.up)
            layers.append(Layer(renderer.draw(pose, camera, lights), shadow))
        back = film[frame]
        if dim:
            back = np.rint(back + dim * (np.float32(96) - back)).astype(np.uint8)
        shown = composite(back, layers)
        found: list[Any] = [track for track in tracks if track is not None]
        yield draw_points(shown, [track.positions[frame] for track in found]) if found else shown


def _from_side(session: Session, moving: _Moving, vertices: Array, frames: range | None = None) -> Iterator[Picture]:
    from imitation.rendering import Plane, side_view

    world, film, contacts = _world(session), session.frames(), _contacts(session)
    plane = Plane(world.normal * world.offset, world.normal) if world.grounded else None
    shown = frames or range(len(vertices))
    floors = [_floor(world, contacts, frame) for frame in shown]
    return side_view(
        vertices[shown.start : shown.stop],
        moving.faces,
        [world.cameras[frame] for frame in shown],
        film.size,
        ground=plane,
        footing=None if any(floor is None for floor in floors) else floors,
        colors=moving.colors,
        samples=2,
        up=world.normal,
    )


def _contacts(session: Session) -> dict[str, list[tuple[int, int, Array]]]:
    """Give the placed contacts by track; what was not kept from an earlier opening is placed again, quickly."""
    marked = [track for track in session.document.tracks if track.contacts]
    found = {track.id: session.result(session.stages.contacts(track.id)) for track in marked}
    return {
        name: [(contact.first, contact.last, contact.place) for contact in placed]
        for name, placed in found.items()
        if isinstance(placed, list) and placed
    }


def _floor(world: World, contacts: dict[str, list[tuple[int, int, Array]]], frame: int) -> Any:
    """Give what takes the shadow in a frame: the steps under the feet, else the ground plane, else nothing."""
    from imitation.rendering import Plane, footing_at

    if world.depth is not None:
        return None
    footing = footing_at(contacts, frame, world.normal)
    if footing is not None:
        return footing
    return Plane(world.normal * world.offset, world.normal) if world.grounded else None


def _together(
    sources: Sequence[Iterable[Picture]], labels: Sequence[str], columns: int | None = None
) -> Iterator[Picture]:
    from imitation.rendering import side_by_side_frames

    return iter(sources[0]) if len(sources) == 1 else side_by_side_frames(sources, labels, columns=columns)


def _world(session: Session) -> World:
    world = session.ready(session.stages.world)
    if not isinstance(world, World):
        raise InputError("The cameras have not been solved yet: run animate first.")
    return world
