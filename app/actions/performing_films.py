"""Pictures of sequences and performances: thumbnails, films from a chosen side or going round."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.actions.compositing import in_order
from app.actions.performing_frames import PerformanceFrames, performance_frames, sequence_footage
from app.actions.session import Session
from app.formats import Picture, write_video
from app.formats.tvm import FrameMesh, painted
from imitation.errors import InputError
from imitation.progress import Progress, silent

HALF_VIEW = float(np.radians(14))
TILT = 0.16
SIZE = (960, 540)


def film_performance(
    session: Session,
    target: Path,
    *,
    view: float = 60.0,
    turntable: bool = False,
    blended: bool = True,
    size: tuple[int, int] = SIZE,
    samples: int = 2,
    marks: bool = False,
    progress: Progress | None = None,
) -> None:
    """Write a film of the composed performance at its frame rate; the camera follows the performer.

    Parameters
    ----------
    view : where the camera stands, degrees from +x towards +y, seen from the performer.
    turntable : go once round, from ``view`` on.
    blended : with in-betweens at the cuts.
    marks : name the motion, and cuts with their score.

    Raises ``InputError`` when it has not been composed, or the file cannot be written.
    """
    frames = performance_frames(session, blended=blended)
    report = progress or silent
    turns = np.full(len(frames), np.radians(view))
    if turntable:
        turns = turns + 2 * np.pi * np.arange(len(frames)) / len(frames)
    words = _words(session, frames) if marks else [""] * len(frames)

    def pictures() -> Iterator[Picture]:
        for position, picture in enumerate(_followed(frames, turns, size, samples, words)):
            yield picture
            report((position + 1) / len(frames))

    write_video(target, pictures(), frames.fps, count=len(frames))


def still(mesh: FrameMesh, *, view: float = 60.0, size: tuple[int, int] = SIZE, samples: int = 2) -> Picture:
    """Give a picture of one mesh, z up; ``view`` in degrees as in ``film_performance``."""
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    radius = 0.5 * float(np.linalg.norm(high - low))
    return _picture(mesh, 0.5 * (low + high), radius, np.radians(view), float(low[2]), size, samples)


def thumbnail(session: Session, sequence_id: str, frame: int | None = None, *, size: int = 96) -> Picture:
    """Give a small square picture of a frame of a sequence, by default of its middle; the performer is in front view.

    Raises ``InputError`` when the files cannot be read.
    """
    sequence = session.document.sequence(sequence_id)
    at = sequence.frame_count // 2 if frame is None else frame
    analysis: Any = session.ready(session.stages.analysis(sequence_id))
    facing = float(np.degrees(analysis.headings[at])) if analysis is not None else (sequence.front or 0.0)
    mesh = painted(sequence_footage(session, sequence_id)[at])
    return still(mesh, view=facing + 40.0, size=(size, size))


def _followed(
    frames: PerformanceFrames, turns: NDArray[np.float64], size: tuple[int, int], samples: int, words: Sequence[str]
) -> Iterator[Picture]:
    from scipy.ndimage import gaussian_filter1d

    from imitation.rendering import label

    ends = np.empty((len(frames), 2, 3))
    for position, mesh in enumerate(frames):
        ends[position] = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    if not np.isfinite(ends).all():
        raise InputError("The performance has frames that are not finite: check its sequences.")
    ground = float(np.median(ends[:, 0, 2]))
    centres = gaussian_filter1d(ends.mean(axis=1), max(1.0, 0.4 * frames.fps), axis=0, mode="nearest")
    centres[:, 2] = np.median(centres[:, 2])
    reach = np.linalg.norm(np.maximum(ends[:, 1] - centres, centres - ends[:, 0]), axis=1)
    radius = float(reach.max())

    def drawn(given: tuple[int, FrameMesh]) -> Picture:
        position, mesh = given
        picture = _picture(painted(mesh), centres[position], radius, turns[position], ground, size, samples)
        return label(picture, words[position]) if words[position] else picture

    yield from in_order(drawn, enumerate(frames))


def _picture(
    mesh: FrameMesh,
    centre: NDArray[np.float64],
    radius: float,
    turn: float,
    ground: float,
    size: tuple[int, int],
    samples: int,
) -> Picture:
    from imitation.rendering import Plane, Renderer, look_at, studio
    from imitation.rendering.composite import over_frame
    from imitation.rendering.side import grid

    focal = min(size) / 2 / np.tan(HALF_VIEW)
    K = np.array([[focal, 0, (size[0] - 1) / 2], [0, focal, (size[1] - 1) / 2], [0, 0, 1.0]])
    away = np.array([np.cos(turn) * np.cos(TILT), np.sin(turn) * np.cos(TILT), np.sin(TILT)])
    up = np.array([0.0, 0.0, 1.0])
    camera = look_at(centre + away * radius / np.sin(HALF_VIEW), centre, up, K)
    plane = Plane(np.array([0.0, 0.0, ground]), up)
    back = grid(studio(size), camera, plane, step=0.5 if radius > 0.6 else 0.1, reach=4 * radius, centre=centre)
    with Renderer(mesh.faces, size, colors=mesh.colours, samples=samples) as renderer:
        return over_frame(renderer, np.ascontiguousarray(mesh.vertices, np.float64), camera, back, plane)


def _words(session: Session, frames: PerformanceFrames) -> list[str]:
    from app.actions.performing import motions
    from app.stages.performance.results import Assembled

    graph: Any = session.result(session.stages.graph)
    placed = session.ready(session.stages.performance)
    assert isinstance(placed, Assembled)
    named = motions(session.document, graph)
    words = [named[node].name for node in frames.performance.nodes]
    near = max(1, round(0.2 * frames.fps))
    for seam in placed.seams:
        if seam.kind == "cut":
            for position in range(max(0, seam.position - near), min(len(words), seam.position + near)):
                words[position] += f"  | cut {seam.score:.2f}"
    return [text + ("  blended" if frames.blended(k) else "") for k, text in enumerate(words)]
