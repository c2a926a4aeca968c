"""Two-pass propagation of a set of edits over the base solution (paper A, 3.6)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import attrs
import numpy as np
from numpy.typing import ArrayLike

from imitation.errors import InputError
from imitation.motion.banded import Array
from imitation.progress import Progress, silent
from imitation.propagation.base import Base, Clock, OnFrame, make_deformer
from imitation.propagation.edits import check_places, edited_pose, typical_modes
from imitation.propagation.report import Report, make_report
from imitation.propagation.runs import Places
from imitation.propagation.spans import Span, SpanSolver, cut_spans, sorted_outward

if TYPE_CHECKING:
    from imitation.deformation import Deformer
    from imitation.deformation.pose import Pose


@attrs.frozen(eq=False)
class Imitation:
    """A character that moves as the filmed subject does.

    Attributes
    ----------
    vertices : (n, v, 3) world.
    key_points : (n, k, 3) places of the paired vertices, world, in the order of ``names``.
    names : the paired tracks.
    report : the statistics of the paper's Table 1 and what was found on the way.
    base : the solution before any edit.
    edits : frame -> committed positions.
    """

    vertices: Array
    key_points: Array
    names: tuple[str, ...]
    report: Report
    base: Base
    edits: Mapping[int, Places]
    _solved: Mapping[int, tuple[bytes, range]]
    """First frame of a span -> what its frames were made from, and which they are."""


def propagate(
    base: Base,
    edits: Mapping[int, Mapping[int, ArrayLike]],
    *,
    smooth: bool | None = None,
    follow: Mapping[int, str] | None = None,
    end: int | None = None,
    reach: Mapping[int, tuple[int | None, int | None]] | None = None,
    origin: int | None = None,
    previous: Imitation | None = None,
    two_pass: bool = True,
    deformer: Deformer | None = None,
    on_frame: OnFrame | None = None,
    progress: Progress | None = None,
) -> Imitation:
    """Spread edits over the clip. The result is a function of the base solution and the set of edits.

    Every key point has a boundary value in every edited frame, and keeps its motion gradient between them (eq. 5-6).
    A control vertex without a track gets its motion gradient from a first pass without it, and is a 3D constraint of
    the second. Frames that no edit reaches keep the base solution's bits.

    Parameters
    ----------
    base : the base solution.
    edits : frame -> {vertex: place (3,)}: positions committed by `commit_edit`.
    smooth : corrections run as monotone cubics instead of linearly; default for "joint", not for "paper".
    follow : control vertex -> track that it follows (one pass suffices for it).
    end : frame at which the correction of the last edit has faded out; by default it is held to the clip's end.
    reach : edited frame -> (in, out) frames outside which this edit changes nothing, itself included.
    origin : frame from which the work spreads outward, t, t + 1, t - 1, ...; by default the first edited one.
    previous : an earlier result on the same base; spans that have not changed are taken from it, not recomputed.
    on_frame : called with each recomputed frame's vertices as they are ready.

    Raises
    ------
    InputError
        An edit outside the clip or of a vertex that does not exist, a reach outside the clip, an unknown track.
    """
    check_places(base, edits)
    report, clock = progress or silent, Clock()
    placed = {frame: {int(v): np.asarray(p, np.float64) for v, p in edits[frame].items()} for frame in sorted(edits)}
    ranges = _reaches(placed, reach or {}, end)
    placed = {frame: places for frame, places in placed.items() if places and _inside(frame, ranges)}
    counted, placed = placed, {frame: places for frame, places in placed.items() if frame or not _given(base, places)}
    spans = cut_spans(len(base), placed, ranges)
    gradients = _followed(base, follow or {})
    smooth = base.method == "joint" if smooth is None else smooth
    deformer = deformer or make_deformer(base.rest, base.faces)
    _warm(base, deformer, spans, placed, report)
    vertices = base.vertices.copy()
    fresh: list[int] = []
    for frame, places in placed.items():
        known = previous.edits.get(frame) if previous is not None and previous.base is base else None
        if previous is not None and known is not None and _same(known, places):
            vertices[frame] = previous.vertices[frame]
        else:
            vertices[frame] = edited_pose(base, frame, places, deformer=deformer)
            fresh.append(frame)
    start = origin if origin is not None else next(iter(placed), 0)
    for frame in sorted_outward(np.array(fresh, np.int64), start):
        if on_frame is not None:
            on_frame(frame, vertices[frame])
    solvers, solved = _prepare(base, spans, vertices, deformer, smooth, gradients, two_pass, previous)
    ranked = sorted(
        ((rank, frame < start, frame, solver) for solver in solvers for rank, frame in solver.order(start)),
        key=lambda each: each[:3],
    )
    for done, (_, _, frame, solver) in enumerate(ranked):
        report(done / len(ranked))
        vertices[frame] = solver.frame(frame)
        if on_frame is not None:
            on_frame(frame, vertices[frame])
    report(1.0)
    clock.lap("propagation")
    summary = make_report(base, counted, clock.seconds)
    return Imitation(vertices, vertices[:, base.keys.vertices], base.keys.names, summary, base, placed, solved)


def _warm(base: Base, deformer: Deformer, spans: list[Span], placed: Mapping[int, Places], report: Progress) -> None:
    """Find the slow directions that the work needs before it begins, so that a cancel is heard meanwhile."""
    keys = frozenset(base.keys.vertices.tolist())
    sets = {tuple(sorted(places.keys() - keys)) for places in placed.values()}
    sets |= {tuple(span.controls(keys)) for span in spans if span.touched and len(span.frames)}
    for controls in sorted({(), *sets}) if sets else ():
        typical_modes(base, deformer, controls, lambda: report(0.0))


def _prepare(
    base: Base,
    spans: list[Span],
    vertices: Array,
    deformer: Deformer,
    smooth: bool,
    follow: Mapping[int, int],
    two_pass: bool,
    previous: Imitation | None,
) -> tuple[list[SpanSolver], dict[int, tuple[bytes, range]]]:
    """Solvers of the spans that have to be computed; the others' frames are copied from the earlier result."""
    solvers: list[SpanSolver] = []
    solved: dict[int, tuple[bytes, range]] = {}
    firsts: dict[int, Pose] = {}
    for span in spans:
        if not span.touched or not len(span.frames):
            continue
        solver = SpanSolver(
            base, span, vertices, deformer, smooth=smooth, follow=follow, two_pass=two_pass, firsts=firsts
        )
        made = (solver.signature(), span.frames)
        solved[span.first.frame] = made
        if previous is not None and previous.base is base and previous._solved.get(span.first.frame) == made:
            vertices[span.frames.start : span.frames.stop] = previous.vertices[span.frames.start : span.frames.stop]
        else:
            solvers.append(solver)
    return solvers, solved


def _reaches(
    edits: Mapping[int, Places], reach: Mapping[int, tuple[int | None, int | None]], end: int | None
) -> dict[int, tuple[int | None, int | None]]:
    ranges = dict(reach)
    if end is not None and edits:
        last = max(edits)
        ranges[last] = (ranges.get(last, (None, None))[0], end)
    return ranges


def _inside(frame: int, ranges: Mapping[int, tuple[int | None, int | None]]) -> bool:
    """Whether an edit lies in its own reach; one outside the range that the user set counts for nothing now."""
    first, last = ranges.get(frame, (None, None))
    return (first is None or first <= frame) and (last is None or frame <= last)


def _given(base: Base, places: Places) -> bool:
    """Whether the base solution begins with this pose of frame 0 already, and nothing in it is a control vertex."""
    keys = set(base.keys.vertices.tolist())
    return keys.issuperset(places) and all(np.array_equal(base.vertices[0, v], place) for v, place in places.items())


def _followed(base: Base, follow: Mapping[int, str]) -> dict[int, int]:
    for vertex, name in follow.items():
        if name not in base.keys.names:
            raise InputError(f'Vertex {vertex} is told to follow "{name}", which is no paired track; pair it first.')
    return {vertex: base.keys.names.index(name) for vertex, name in follow.items()}


def _same(first: Places, second: Places) -> bool:
    return first.keys() == second.keys() and all(np.array_equal(first[vertex], second[vertex]) for vertex in first)
