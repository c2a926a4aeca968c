"""Hiding a cut: for a moment around it, frames in between the two clips (the paper's future work)."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any

import attrs
import numpy as np
from numpy.typing import NDArray

from imitation.errors import InputError
from imitation.progress import Progress, silent
from tvmedit.cuts.limbs import FREE_ENDS
from tvmedit.cuts.registration import SAMPLES, Registration, register
from tvmedit.cuts.surface import Surface, evenly
from tvmedit.features.frames import check_faces, check_vertices, upright
from tvmedit.graph.motion_graph import MotionGraph
from tvmedit.graph.performance import Cut, Performance

Array = NDArray[np.float64]
Colours = NDArray[np.uint8]
MeshSource = Callable[[int, int], Sequence[Any]]
"""(sequence, frame) to (vertices (v, 3), faces (m, 3)) or (vertices, faces, colours (v, 3) uint8), as captured."""
SECONDS = 0.3
LONGER = 2.0
"""A blend lasts at most so many times as long as asked."""
SPEED = 0.35
"""Body heights a second by which a blend may move the body on average; more makes it longer."""
WAYS = ((False, False), (True, False), (False, True), (True, True))
"""Whether to deform the mesh of the clip that is entered, and whether to free limbs first, in the order of trial."""
REACH = 4
"""So many frames away a mesh with free limbs is looked for."""
BENDING = 14
"""Steps of the registration that bends it; a third where it was bent onto a neighbouring frame already."""
FEWEST = 3
"""A blend of fewer good frames is refused."""


@attrs.frozen(eq=False)
class Shape:
    """A mesh of a performance: vertices z up where the performer stands, faces, and colours if there are any."""

    vertices: Array
    faces: NDArray[np.int32]
    colours: Colours | None = None


@attrs.frozen(eq=False)
class Blend:
    """The frames in between at one cut.

    Attributes
    ----------
    cut : Cut
    shapes : dict of int to Shape
        By position in the performance; empty where the blend is refused.
    step_before, step_after : float
        Largest surface step around the cut without and with the blend, in the meshes' unit.
    residuals : dict of int to float
        Of each registration tried, by position.
    reason : str
        Why it is refused, or why it is shorter than asked; empty otherwise.
    backwards : bool
        Whether the shapes are those of the clip that is entered, deformed back towards the one that is left.
    meshes : dict of int to (int, int)
        By position, sequence and frame of the mesh that was deformed.
    """

    cut: Cut
    shapes: dict[int, Shape]
    step_before: float
    step_after: float
    residuals: dict[int, float]
    reason: str = ""
    backwards: bool = False
    meshes: dict[int, tuple[int, int]] = attrs.field(factory=dict)


def blend_cut(
    graph: MotionGraph,
    performance: Performance,
    cut: Cut,
    mesh_of: MeshSource,
    *,
    seconds: float = SECONDS,
    iterations: int = 14,
    progress: Progress | None = None,
) -> Blend:
    """Make the frames around a cut pass from one clip to the other.

    Around the cut both clips are there: the one that is left goes on beyond its last frame, the one entered begins
    before its first. Each of the window's frames is the first clip's mesh deformed towards the second's, by a share
    that rises smoothly; or the second's towards the first's, where only that is possible (a hand that lies on a hip
    cannot be torn off, one that is free can be laid there). Where neither is, or the mesh to deform has more limbs
    grown together than the one to reach, a near frame's mesh whose limbs are freer is bent onto its frame first.
    Registration starts at the cut, where the two are most alike, and runs outwards; frames where it fails end the
    window on that side. Colours pass from one clip's to the nearest ones of the other.

    Parameters
    ----------
    graph : MotionGraph
    performance : Performance
        Aligned.
    cut : Cut
        One of the performance's.
    mesh_of : callable
        Gives the captured mesh of (sequence, frame).
    seconds : float
        Length of the window; up to twice as long where the body has further to go than looks natural in that time.
    iterations : int
        Of the first registration; the others start from it and take a third as many.
    progress : callable, optional

    Returns
    -------
    Blend
        Refused, with a reason, where it would break the body.
    """
    if not performance.aligned:
        raise InputError("The performance has not been aligned: align it before blending its cuts.")
    if cut.kind == "loop" or not 0 < cut.position < len(performance):
        raise InputError("The cut is not inside the performance: blend cuts and wraps.")
    report = progress or silent
    pairs = _Pairs(graph, performance, cut, mesh_of)
    first, last = blend_window(graph, performance, cut, seconds)
    if last < first:
        step = _steps(pairs, {}, cut, first, last)
        reason = "The cut is left as it is: one sequence ends at it and the other begins, so they share no frames."
        return Blend(cut, {}, step, step, {}, reason)
    centre = 0 if last >= 0 else last
    found: dict[int, Registration] = {}
    tried: dict[int, float] = {}
    reason = ""
    done = 0

    def registered(k: int, start: Registration | None, way: tuple[bool, bool]) -> Registration | None:
        nonlocal reason, done
        report(min(done / (last - first + 1), 1.0))
        done += 1
        source, target = pairs.ends(k, *way)
        registration = register(
            pairs.surface(source),
            pairs.surface(target),
            height=pairs.height,
            edge=pairs.edge,
            iterations=iterations if start is None else max(4, iterations // 3),
            start=start,
        )
        tried[cut.position + k] = registration.residual
        if registration.reason:
            reason = reason or registration.reason
            return None
        found[k] = registration
        return registration

    at_cut = None
    for way in WAYS:
        at_cut = registered(centre, None, way)
        if at_cut is not None:
            break
    if at_cut is not None:
        reason = ""
        first, last = blend_window(graph, performance, cut, _needed(at_cut, seconds, pairs.height))
        for side in (range(centre + 1, last + 1), range(centre - 1, first - 1, -1)):
            start: Registration | None = at_cut
            for k in side:
                start = registered(k, start, way)
                if start is None:
                    break
    report(1.0)
    before = _steps(pairs, {}, cut, first, last)
    if len(found) < FEWEST:
        why = reason or "the two clips share too few frames around the cut"
        return Blend(cut, {}, before, before, tried, f"The cut is left as it is: {why}.")
    shapes = _in_between(pairs, found, cut, way)
    note = f"The blend is shorter than asked: {reason}." if reason else ""
    return Blend(
        cut, shapes, before, _steps(pairs, shapes, cut, first, last), tried, note, way[0], pairs.taken(found, way)
    )


def _needed(at_cut: Registration, seconds: float, height: float) -> float:
    """How long the blend takes: as asked, or longer where the body is further away than it can go in that time."""
    gap = float(np.linalg.norm(at_cut.between(1.0) - at_cut.vertices, axis=1).mean())
    # The smooth rise of the shares is half as fast again in its middle.
    return min(max(seconds, 1.5 * gap / (SPEED * height)), LONGER * seconds)


def performance_shape(
    graph: MotionGraph, performance: Performance, position: int, mesh_of: MeshSource, blends: Sequence[Blend] = ()
) -> Shape:
    """Mesh of a performance at a position, where the performer stands then; from a blend where there is one."""
    for blend in blends:
        if position in blend.shapes:
            return blend.shapes[position]
    sequence, frame = (int(value) for value in performance.frames[position])
    shape = _load(graph, mesh_of, sequence, frame)
    return attrs.evolve(shape, vertices=performance.place(position, shape.vertices))


def _load(graph: MotionGraph, mesh_of: MeshSource, sequence: int, frame: int) -> Shape:
    mesh = mesh_of(sequence, frame)
    vertices = check_vertices(mesh[0], frame)
    faces = check_faces(mesh[1], len(vertices), frame)
    colours = None if len(mesh) < 3 or mesh[2] is None else np.asarray(mesh[2], np.uint8)
    return Shape(upright(vertices, graph.analyses[sequence].up), faces, colours)


class _Pairs:
    """Both clips' meshes k frames from the cut, placed in the performance."""

    def __init__(self, graph: MotionGraph, performance: Performance, cut: Cut, mesh_of: MeshSource) -> None:
        self.graph, self.performance, self.cut, self.mesh_of = graph, performance, cut, mesh_of
        self.source = graph.nodes[cut.source].sequence
        self.target = graph.nodes[cut.target].sequence
        self.height = graph.analyses[self.source].height
        self.edge = max(graph.analyses[self.source].edge, graph.analyses[self.target].edge)
        self._known: dict[tuple[bool, int], Shape] = {}
        self._known_ties: dict[tuple[bool, int], int] = {}
        self._free: dict[tuple[bool, int], tuple[Shape, int]] = {}
        self._bent: dict[tuple[bool, int], Registration] = {}
        self._surfaces: dict[int, tuple[Shape, Surface]] = {}

    def ends(self, k: int, backwards: bool, freed: bool) -> tuple[Shape, Shape]:
        """The mesh to deform and the one to reach: of the clip that is left, going on, and of the one entered.

        What hangs free in the mesh to reach has to hang free in the one that is deformed: a hand that is one surface
        with a hip would draw the hip along.
        """
        reached = self._freed(backwards, k)[0] if freed else self._shape(backwards, k)
        return self._deformed(k, backwards, freed)[0], reached

    def _deformed(self, k: int, backwards: bool, freed: bool) -> tuple[Shape, int]:
        mine = not backwards
        if freed or self._tied(mine, k) > self._tied(backwards, k):
            return self._freed(mine, k)
        return self._shape(mine, k), 0

    def taken(self, found: Iterable[int], way: tuple[bool, bool]) -> dict[int, tuple[int, int]]:
        """Sequence and frame of the meshes that were deformed, by position."""
        backwards, freed = way
        sequence, frame = (self.target, self.cut.enter) if backwards else (self.source, self.cut.leave + 1)
        shifts = {k: self._deformed(k, backwards, freed)[1] for k in found}
        return {self.cut.position + k: (sequence, frame + k + shift) for k, shift in sorted(shifts.items())}

    def _freed(self, before: bool, k: int) -> tuple[Shape, int]:
        """A frame whose limbs hang free: itself, or the freest near one bent onto it, and how far away that is."""
        if (before, k) not in self._free:
            self._free[before, k] = self._find_free(before, k)
        return self._free[before, k]

    def _tied(self, before: bool, k: int) -> int:
        """How many limbs do not hang free: none, or those that are one surface with the body or with each other."""
        if (before, k) not in self._known_ties:
            surface = self.surface(self._shape(before, k))
            self._known_ties[before, k] = max(FREE_ENDS - surface.limbs, surface.handles)
        return self._known_ties[before, k]

    def _find_free(self, before: bool, k: int) -> tuple[Shape, int]:
        own = self._shape(before, k)
        most, frame = (self.source, self.cut.leave + 1) if before else (self.target, self.cut.enter)
        count = len(self.graph.analyses[most])
        if not self._tied(before, k):
            return own, 0
        shifts = [shift for shift in range(-REACH, REACH + 1) if 0 <= frame + k + shift < count]
        freer = [shift for shift in shifts if self._tied(before, k + shift) < self._tied(before, k)]
        for shift in sorted(freer, key=lambda shift: (self._tied(before, k + shift), abs(shift), shift)):
            other = self._shape(before, k + shift)
            # What was bent onto the frame before has hardly any way left.
            start = self._bent.get((before, k + shift))
            bent = register(
                self.surface(other),
                self.surface(own),
                height=self.height,
                edge=self.edge,
                iterations=BENDING if start is None else BENDING // 3,
                start=start,
            )
            if not bent.reason:
                self._bent[before, k + shift] = bent
                return attrs.evolve(other, vertices=bent.between(1.0)), shift
        return own, 0

    def earlier(self, k: int) -> Shape:
        """The clip that is left; its sequence may end at the cut."""
        return self._shape(True, k)

    def later(self, k: int) -> Shape:
        """The clip that is entered; its sequence may begin at the cut."""
        return self._shape(False, k)

    def surface(self, shape: Shape) -> Surface:
        """A shape's mesh, with all that has been found out about it."""
        if id(shape) not in self._surfaces:
            # The shape is kept beside it: its number stays its own.
            self._surfaces[id(shape)] = shape, Surface(shape.vertices, shape.faces)
        return self._surfaces[id(shape)][1]

    def _shape(self, before: bool, k: int) -> Shape:
        if (before, k) not in self._known:
            sequence, frame = (self.source, self.cut.leave + 1) if before else (self.target, self.cut.enter)
            shape = _load(self.graph, self.mesh_of, sequence, frame + k)
            position = self.cut.position - 1 if before else self.cut.position
            placed = self.performance.place(position, shape.vertices)
            self._known[before, k] = attrs.evolve(shape, vertices=placed)
        return self._known[before, k]


def blend_window(graph: MotionGraph, performance: Performance, cut: Cut, seconds: float) -> tuple[int, int]:
    """First and last offset from the cut: what both sequences have, and no nearer to another joint than half-way.

    What there is no room for on one side of the cut is taken on the other, as far as there is room. The last lies
    before the first where one clip ends, and the other begins, with its sequence.
    """
    half = max(1, round(seconds * graph.fps / 2))
    positions = [0, *(other.position for other in performance.cuts if other.kind == "cut"), len(performance)]
    earlier = max(position for position in positions if position < cut.position)
    later = min((position for position in positions if position > cut.position), default=len(performance))
    source = graph.analyses[graph.nodes[cut.source].sequence]
    target = graph.analyses[graph.nodes[cut.target].sequence]
    before = min((cut.position - earlier) // 2, cut.enter, _since_wrap(performance, cut))
    filmed = min(len(source) - 2 - cut.leave, len(target) - 1 - cut.enter, _until_wrap(performance, cut))
    after = min((later - cut.position) // 2 - 1, filmed) + 1
    return -min(before, max(half, 2 * half - after)), min(after, max(half, 2 * half - before)) - 1


def _since_wrap(performance: Performance, cut: Cut) -> int:
    """Frames before the cut that follow each other as filmed."""
    frames, count = performance.frames, 0
    while count < cut.position and frames[cut.position - 1 - count, 1] == cut.leave - count:
        count += 1
    return count


def _until_wrap(performance: Performance, cut: Cut) -> int:
    """Last offset after the cut up to which the frames follow each other as filmed."""
    frames, count = performance.frames, 0
    while cut.position + count < len(frames) and frames[cut.position + count, 1] == cut.enter + count:
        count += 1
    return count - 1


def _in_between(pairs: _Pairs, found: dict[int, Registration], cut: Cut, way: tuple[bool, bool]) -> dict[int, Shape]:
    """Shapes with shares rising smoothly over the good frames."""
    order = sorted(found)
    shapes = {}
    for rank, k in enumerate(order):
        x = (rank + 1) / (len(order) + 1)
        share = x * x * (3 - 2 * x)
        source, target = pairs.ends(k, *way)
        share = 1.0 - share if way[0] else share
        vertices = found[k].between(share)
        colours = _mixed(pairs, found[k], source, target, share)
        shapes[cut.position + k] = Shape(vertices, source.faces, colours)
    return shapes


def _mixed(pairs: _Pairs, found: Registration, source: Shape, target: Shape, share: float) -> Colours | None:
    if source.colours is None or target.colours is None:
        return source.colours
    nearest = pairs.surface(target).tree.query(found.between(1.0))[1]
    mixed = (1 - share) * source.colours.astype(float) + share * target.colours[nearest].astype(float)
    return np.asarray(np.round(mixed), np.uint8)


def _steps(pairs: _Pairs, shapes: dict[int, Shape], cut: Cut, first: int, last: int) -> float:
    """Largest surface step from frame to frame through the window and one frame to either side."""

    def at(k: int) -> Surface:
        position = cut.position + k
        return pairs.surface(shapes[position] if position in shapes else pairs.earlier(k) if k < 0 else pairs.later(k))

    def step(one: Surface, other: Surface) -> float:
        # The mean of evenly spread vertices: all of them would tell the same, and take longer than the registration.
        return float(np.mean(other.tree.query(one.vertices[evenly(len(one.vertices), SAMPLES)])[0]))

    neighbours = [(at(k), at(k + 1)) for k in range(min(first, -1), max(last, 0))]
    return max(0.5 * (step(one, other) + step(other, one)) for one, other in neighbours)
