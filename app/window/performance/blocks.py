"""The composed timeline as values: blocks, joints, a gap where there is no path; and what lies under the mouse."""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

from app.window.timeline.axis import LABELS, Axis
from app.window.timeline.lanes import RULER

if TYPE_CHECKING:
    from app.window.performance.state import PerformanceState

COMPOSED, COSTS = 64, 44
LOW, LOW_COSTS = 48, 30
"""Heights of the two lanes, and where room is scarce."""
BUTTON = 18.0
NEAR = 6.0
STANDS_OUT = 1.2
"""A step of more than so many times the largest within the motions is seen."""


@dataclass(frozen=True)
class Block:
    """Frames of the performance that one motion plays; or the gap before a key motion that no path reaches.

    keys : places of the key motions that it is, counted from 0. cyclic : whether it can be repeated.
    picture : sequence and the first and last frame shown.
    """

    node: int
    first: int
    count: int
    name: str = ""
    colour: str = "line2"
    keys: tuple[int, ...] = ()
    repeats: int = 1
    cyclic: bool = False
    picture: tuple[str, int, int] = ("", 0, 0)
    gap: bool = False

    @property
    def key(self) -> int:
        """The place of its first key motion, -1 where it is none."""
        return self.keys[0] if self.keys else -1


@dataclass(frozen=True)
class Joint:
    """A cut. before, after, blended : how far its step stands out as filmed, placed and with in-betweens; None unknown.

    number : among all joints of the performance. frames : how many in-betweens. poor : over the limit of the graph.
    refused : in-betweens were tried and would break the body. waiting : whether they hold is not known yet.
    """

    number: int
    position: int
    kind: str
    cost: float
    names: tuple[str, str]
    before: float | None = None
    after: float | None = None
    blended: float | None = None
    frames: int = 0
    hard: bool = False
    poor: bool = False
    refused: bool = False
    waiting: bool = False
    reason: str = ""

    @property
    def apart(self) -> bool:
        """Whether the poses that meet are far apart and nothing lies between: the mean step may be small, and yet a
        limb jumps.
        """
        return self.refused or (self.poor and self.blended is None and not self.waiting)

    @property
    def seen(self) -> bool:
        """Whether the step stands out."""
        return self.score is not None and self.score > STANDS_OUT

    @property
    def score(self) -> float | None:
        """The step that is seen in the end."""
        return self.after if self.blended is None else self.blended


@dataclass(frozen=True)
class Composed:
    """All that the composed timeline shows."""

    blocks: tuple[Block, ...] = ()
    joints: tuple[Joint, ...] = ()
    count: int = 0


@dataclass(frozen=True)
class ComposedHit:
    """What lies under the mouse: its frame, and the block or joint by its number."""

    kind: Literal["ruler", "block", "more", "fewer", "gap", "joint", "label", "empty"]
    frame: int
    index: int = -1


def composed(state: PerformanceState, gap_share: float = 0.4) -> Composed:
    """What is composed; where a key motion is out of reach the key motions with the gap between them."""
    performance = state.performance
    if performance is None or not len(performance):
        return _in_pieces(state, gap_share)
    if max(performance.path) >= len(state.motions):
        return Composed()
    starts = [0, *(cut.position for cut in performance.cuts if cut.kind == "cut")]
    ends = [*starts[1:], len(performance)]
    groups = _groups(state)
    keys = {place: groups[k] for k, place in enumerate(performance.keys) if k < len(groups)}
    blocks = []
    for place, (node, first, end) in enumerate(zip(performance.path, starts, ends, strict=True)):
        shown = (int(performance.frames[first, 1]), int(performance.frames[end - 1, 1]))
        blocks.append(_block(state, node, first, end - first, keys.get(place, ()), shown))
    return Composed(tuple(blocks), _joints(state, performance), len(performance))


def _block(
    state: PerformanceState, node: int, first: int, count: int, keys: tuple[int, ...], shown: tuple[int, int]
) -> Block:
    motion = state.motions[node]
    repeats = sum(state.document.performance.keys[key].repeats for key in keys) or 1
    picture = (motion.sequence, *shown)
    return Block(node, first, count, motion.name, state.colour(motion.sequence), keys, repeats, motion.cyclic, picture)


def _groups(state: PerformanceState) -> list[tuple[int, ...]]:
    """Key motions in order, equal neighbours together, as the engine takes them."""
    nodes = [state.motion_node(key.motion) for key in state.document.performance.keys]
    order = itertools.groupby(range(len(nodes)), key=lambda place: nodes[place])
    return [tuple(places) for _, places in order]


def _in_pieces(state: PerformanceState, gap_share: float) -> Composed:
    """Key motions alone, each as long as it is at least; a gap where the search failed."""
    keys = state.document.performance.keys
    nodes = [state.motion_node(key.motion) for key in keys]
    if not state.problem or -1 in nodes:
        return Composed()
    lengths = [
        (state.motions[node].texton[1] - state.motions[node].texton[0] + 1) * key.repeats
        for node, key in zip(nodes, keys, strict=True)
    ]
    wide = max(round(sum(lengths) * gap_share / (1 - gap_share)), 1)
    blocks: list[Block] = []
    at = 0
    for place, (node, length) in enumerate(zip(nodes, lengths, strict=True)):
        if place and _is_gap(state, nodes[place - 1], node):
            blocks.append(Block(node, at, wide, gap=True))
            at += wide
        blocks.append(_block(state, node, at, length, (place,), state.motions[node].texton))
        at += length
    if state.gap is not None and not any(block.gap for block in blocks):
        # A loop whose end does not lead back to its start.
        blocks.append(Block(state.gap.goal, at, wide, gap=True))
        at += wide
    return Composed(tuple(blocks), (), at)


def _is_gap(state: PerformanceState, start: int, goal: int) -> bool:
    return state.gap is not None and (state.gap.start, state.gap.goal) == (start, goal)


def _joints(state: PerformanceState, performance: Any) -> tuple[Joint, ...]:
    return tuple(joint_of(state, performance, number) for number in range(len(performance.cuts)))


def joint_of(state: PerformanceState, performance: Any, number: int) -> Joint:
    """One joint as far as it is known by now."""
    cut, choice = performance.cuts[number], state.document.performance
    seams = state.placed.seams if state.placed is not None else ()
    seam = seams[number] if number < len(seams) else None
    made = state.blends.blends if state.blends is not None and cut.kind == "cut" else ()
    blend = next((each for each in made if each.cut.position == cut.position), None)
    hard = number in state.hard_cuts()
    usual = seam.usual if seam is not None and seam.usual > 0 else None
    mixed = blend is not None and bool(blend.shapes) and not state.before
    return Joint(
        number=number,
        position=cut.position,
        kind=cut.kind,
        cost=float(cut.weight),
        names=(state.motions[cut.source].name, state.motions[cut.target].name),
        before=None if seam is None or usual is None else seam.before / usual,
        after=None if seam is None else seam.score,
        blended=blend.step_after / usual if blend is not None and mixed and usual is not None else None,
        frames=len(blend.shapes) if blend is not None else 0,
        hard=hard,
        poor=bool(cut.source != cut.target and state.graph.poor[cut.source, cut.target]),
        refused=blend is not None and not blend.shapes and bool(blend.reason),
        waiting=choice.align and choice.blend and state.blends is None and not (hard or state.before),
        reason=blend.reason if blend is not None else "",
    )


def box(block: Block, axis: Axis) -> tuple[float, float]:
    """Left and right end of a block in pixels, with the gap to the next one."""
    return axis.x(block.first) + 1, axis.x(block.first + block.count) - 1


def repeatable(block: Block, axis: Axis) -> bool:
    """Whether + and - stand on a block."""
    left, right = box(block, axis)
    return bool(block.keys) and block.cyclic and right - left >= 3 * BUTTON + 40


def found_at(shown: Composed, axis: Axis, x: float, y: float, height: int = COMPOSED) -> ComposedHit:
    """What lies under a pixel."""
    # Half a pixel more: a mouse on a tick of the ruler means its frame.
    frame = min(max(int(axis.first + (x + 0.5 - axis.left) / axis.pixels), 0), max(shown.count - 1, 0))
    if x < LABELS:
        return ComposedHit("label", frame)
    if y < RULER:
        return ComposedHit("ruler", frame)
    if y < RULER + height:
        return _in_blocks(shown, axis, x, y - RULER, frame, height)
    near = [joint for joint in shown.joints if joint.kind != "wrap" and -NEAR <= x - axis.x(joint.position) <= 92]
    if near:
        return ComposedHit("joint", near[-1].position, near[-1].number)
    return ComposedHit("empty", frame)


def _in_blocks(shown: Composed, axis: Axis, x: float, y: float, frame: int, height: int) -> ComposedHit:
    for index, block in enumerate(shown.blocks):
        left, right = box(block, axis)
        if not left <= x <= right:
            continue
        if block.gap:
            return ComposedHit("gap", frame, index)
        if repeatable(block, axis) and y > height - BUTTON - 8:
            if right - BUTTON - 6 <= x <= right - 4:
                return ComposedHit("more", frame, index)
            if right - 3 * BUTTON - 14 <= x <= right - 2 * BUTTON - 12:
                return ComposedHit("fewer", frame, index)
        return ComposedHit("block", frame, index)
    return ComposedHit("empty", frame)


def key_place(shown: Composed, axis: Axis, x: float) -> int:
    """Before which key motion something dropped at x would stand: those whose middle lies to the left come first."""
    return sum(len(block.keys) for block in shown.blocks if block.keys and sum(box(block, axis)) / 2 < x)


def place_x(shown: Composed, axis: Axis, place: int) -> float:
    """Where the line of a place among the key motions stands."""
    keyed = [block for block in shown.blocks if block.keys]
    for block in keyed:
        if block.keys[0] >= place:
            return box(block, axis)[0] - 1
    return box(keyed[-1], axis)[1] + 1 if keyed else axis.left
