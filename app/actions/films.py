"""Films of a result: over the video, from the side, and the paper's comparisons beside each other."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any, Literal

from app.actions.compositing import Composition, SheetForm, Standing, in_order, write_sheets
from app.actions.moving import Moving, animated, floor, placed_contacts, solved_world
from app.actions.results import rate
from app.actions.session import Session
from app.formats import Picture, write_video
from app.stages.results import Array
from imitation.errors import InputError
from imitation.progress import Progress, silent

View = Literal["video", "side", "both"]
LABELS = ("camera", "side")
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
    standing: Standing | None = None,
    frames: range | None = None,
    progress: Progress | None = None,
) -> None:
    """Write a film of animated characters at the clip's frame rate.

    Parameters
    ----------
    view : "video" over the filmed frames, "side" from the side, "both" beside each other.
    dim : how far the filmed frames fade towards grey, 0 to 1.
    points : whether the tracked points are drawn.
    standing : how the characters are put into the filmed scene; a measured background must be there where it asks.
    frames : the frames to film, all where not given.

    Raises ``InputError`` when a character was not animated, or the file cannot be written.
    """
    motions = animated(session, character_ids)
    filmed = frames or range(len(motions[0].vertices))
    count, done = len(filmed), 0
    report = progress or silent

    def tick() -> None:
        report(done / count)

    def pictures() -> Iterator[Picture]:
        nonlocal done
        sources: list[Iterable[Picture]] = []
        if view in ("video", "both"):
            sources.append(_over_video(session, motions, dim, points, filmed, standing=standing, tick=tick))
        if view in ("side", "both"):
            sources.append(_from_side(session, motions[0], motions[0].vertices, filmed))
        for shown in _together(sources, LABELS if view == "both" else ()):
            yield shown
            done += 1
            report(done / count)

    write_video(target, pictures(), rate(session), count=count)


def render_sheets(
    session: Session,
    character_ids: Sequence[str],
    folder: Path,
    *,
    standing: Standing | None = None,
    frames: range | None = None,
    form: SheetForm = "png",
    progress: Progress | None = None,
) -> None:
    """Write animated characters and their shadows without the film: a folder of PNG or EXR files with alpha."""
    motions = animated(session, character_ids)
    scene = Composition.of(session, motions, standing or Standing())
    filmed = frames or range(len(scene))
    done, report = 0.0, progress or silent

    def count(fraction: float) -> None:
        nonlocal done
        done = fraction
        report(done)

    sheets = in_order(scene.sheet, filmed, lambda: report(done))
    write_sheets(folder, sheets, len(filmed), count, first=filmed.start, form=form)


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
    moving = Moving.of(session, character_id)
    columns = _columns(session, character_id, moving, variants)
    count, report = len(moving.vertices), progress or silent

    def pictures() -> Iterator[Picture]:
        for frame, shown in enumerate(_compared(session, moving, columns, range(count))):
            yield shown
            report((frame + 1) / count)

    write_video(target, pictures(), rate(session), count=count)


def comparison_frame(session: Session, character_id: str, frame: int, variants: Sequence[str]) -> Picture:
    """Give one frame of a comparison as ``compare_film`` would write it."""
    moving = Moving.of(session, character_id)
    columns = _columns(session, character_id, moving, variants)
    return next(_compared(session, moving, columns, range(frame, frame + 1)))


def film_frame(
    session: Session,
    scene: Composition,
    frame: int,
    *,
    view: View = "video",
    dim: float = 0.0,
    points: bool = False,
) -> Picture:
    """Give one frame of a film as ``render_film`` would write it."""
    from imitation.rendering import draw_points

    moving, parts = scene.motions[0], []
    if view != "side":
        picture = scene.frame(frame, dim)
        found = _tracks(session) if points else []
        parts.append(draw_points(picture, [track.positions[frame] for track in found]) if found else picture)
    if view != "video":
        parts.append(next(iter(_from_side(session, moving, moving.vertices, range(frame, frame + 1)))))
    return next(_together([[part] for part in parts], LABELS if len(parts) > 1 else ()))


def still(session: Session, character_id: str, frame: int, labels: Sequence[str] = ("camera", "side")) -> Picture:
    """Give one picture of a character over its frame and from the side."""
    moving = Moving.of(session, character_id)
    from imitation.rendering import side_by_side

    over = _over_video(session, [moving], 0.0, False, range(frame, frame + 1))
    side = _from_side(session, moving, moving.vertices, range(frame, frame + 1))
    return side_by_side([next(iter(over)), next(iter(side))], labels)


def _over_video(
    session: Session,
    motions: Sequence[Moving],
    dim: float,
    points: bool,
    frames: range | None = None,
    *,
    standing: Standing | None = None,
    tick: Callable[[], None] | None = None,
) -> Iterator[Picture]:
    from imitation.rendering import draw_points

    scene = Composition.of(session, motions, standing or Standing())
    found = _tracks(session) if points else []
    shown = frames or range(len(scene))
    for frame, picture in zip(shown, in_order(lambda frame: scene.frame(frame, dim), shown, tick), strict=True):
        yield draw_points(picture, [track.positions[frame] for track in found]) if found else picture


def _from_side(session: Session, moving: Moving, vertices: Array, frames: range | None = None) -> Iterator[Picture]:
    from imitation.rendering import Plane, side_view

    world, film, contacts = solved_world(session), session.frames(), placed_contacts(session)
    plane = Plane(world.normal * world.offset, world.normal) if world.grounded else None
    shown = frames or range(len(vertices))
    floors = [floor(world, contacts, frame) for frame in range(len(vertices))]
    return side_view(
        vertices,
        moving.faces,
        [world.cameras[frame] for frame in range(len(vertices))],
        film.size,
        ground=plane,
        footing=None if any(each is None for each in floors) else floors,
        colors=moving.colors,
        samples=2,
        up=world.normal,
        shown=shown,
    )


def _columns(session: Session, character_id: str, moving: Moving, variants: Sequence[str]) -> list[tuple[str, Array]]:
    """Our result and the comparisons, each with its name."""
    columns: list[tuple[str, Array]] = [("Motionwright", moving.vertices)]
    for variant in variants:
        made: Any = session.ready(session.stages.comparison(character_id, variant))
        if made is None:
            raise InputError(f"The comparison {variant} has not been computed yet.")
        columns.append((COMPARISONS[variant], made))
    return columns


def _compared(
    session: Session, moving: Moving, columns: Sequence[tuple[str, Array]], frames: range
) -> Iterator[Picture]:
    """Columns beside each other, each over the video and below it from the side."""
    over = [_over_video(session, [moving.with_vertices(each)], 0.25, False, frames) for _, each in columns]
    side = [_from_side(session, moving, each, frames) for _, each in columns]
    labels = [*(name for name, _ in columns), *("from the side" for _ in columns)]
    return _together([*over, *side], labels, len(columns))


def _tracks(session: Session) -> list[Any]:
    """The tracks that are solved."""
    tracks = [session.ready(session.stages.track(track.id)) for track in session.document.tracks]
    return [track for track in tracks if track is not None]


def _together(
    sources: Sequence[Iterable[Picture]], labels: Sequence[str], columns: int | None = None
) -> Iterator[Picture]:
    from imitation.rendering import side_by_side_frames

    return iter(sources[0]) if len(sources) == 1 else side_by_side_frames(sources, labels, columns=columns)
