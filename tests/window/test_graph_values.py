"""Graph and blocks as values: lenses, hits, neighbours; nothing of it needs a window."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from app.window.performance.blocks import (
    COMPOSED,
    Block,
    Composed,
    Joint,
    box,
    found_at,
    key_place,
    place_x,
    repeatable,
)
from app.window.performance.composed_paint import advice, steps, told, tone
from app.window.performance.graph_view import (
    EdgeMark,
    Lens,
    NodeMark,
    Picture,
    bow,
    edge_at,
    fitted,
    following,
    neighbour,
    node_at,
    on_bow,
)
from app.window.performance.sequence_cards import Card
from app.window.timeline.axis import LABELS, Axis
from app.window.timeline.lanes import RULER


def marks(*places: tuple[float, float]) -> tuple[NodeMark, ...]:
    """Nodes at places."""
    return tuple(NodeMark(node, x, y, f"m/{node}", "accent", "s1") for node, (x, y) in enumerate(places))


CROSS = Picture(
    marks((0, 0), (3, 0), (0, 2), (-3, 0), (0, -2)),
    (EdgeMark(0, 1, 0.5, 1.0, "path"), EdgeMark(1, 0, 0.7, 0.5), EdgeMark(0, 2, 2.0, 0.0, "faint")),
)


def test_a_lens_goes_there_and_back() -> None:
    """A pixel and its place, and zooming about a pixel."""
    lens = Lens(60, 90, 50, 12, -7)
    assert lens.place(*lens.pixel(1.5, -2.25)) == pytest.approx((1.5, -2.25))
    zoomed = lens.zoomed(1.3, 200, 100)
    assert zoomed.pixel(*lens.place(200, 100)) == pytest.approx((200, 100))
    assert zoomed.size == pytest.approx(78)
    assert zoomed.across / zoomed.down == pytest.approx(lens.across / lens.down)


@pytest.mark.parametrize("size", [(660, 340), (1100, 620), (300, 500)])
def test_everything_is_in_sight(size: tuple[int, int]) -> None:
    """All nodes with their names lie inside, and none overlaps another."""
    lens = fitted(CROSS, *size)
    places = [lens.pixel(mark.x, mark.y) for mark in CROSS.nodes]
    for x, y in places:
        assert lens.size / 2 <= x <= size[0] - lens.size / 2
        assert lens.size / 2 <= y <= size[1] - lens.size / 2 - 18
    gaps = [math.dist(a, b) for k, a in enumerate(places) for b in places[k + 1 :]]
    assert min(gaps) > lens.size


def test_nodes_and_edges_are_found() -> None:
    """Both directions of a pair are told apart."""
    lens = fitted(CROSS, 660, 340)
    for mark in CROSS.nodes:
        found = node_at(CROSS, lens, *lens.pixel(mark.x, mark.y))
        assert found is not None
        assert found.node == mark.node
    assert node_at(CROSS, lens, 1, 1) is None
    start, goal = lens.pixel(0, 0), lens.pixel(3, 0)
    there = edge_at(CROSS, lens, *on_bow(*bow(start, goal, lens.size / 2), 0.5))
    back = edge_at(CROSS, lens, *on_bow(*bow(goal, start, lens.size / 2), 0.5))
    assert there is not None
    assert back is not None
    assert (there.start, there.goal) == (0, 1)
    assert (back.start, back.goal) == (1, 0)
    below = on_bow(*bow(lens.pixel(0, 0), lens.pixel(0, 2), lens.size / 2), 0.5)
    assert edge_at(CROSS, lens, *below) is None, "what is pruned cannot be hit"


def test_arrows_and_tab_reach_every_node() -> None:
    """From the middle of a cross to all its arms."""
    assert [neighbour(CROSS, 0, *step) for step in ((1, 0), (0, 1), (-1, 0), (0, -1))] == [1, 2, 3, 4]
    assert neighbour(CROSS, 1, 1, 0) == 1
    assert neighbour(CROSS, -1, 1, 0) == 0
    seen, node = [], -1
    for _ in CROSS.nodes:
        node = following(CROSS, node, 1)
        seen.append(node)
    assert sorted(seen) == [0, 1, 2, 3, 4]
    assert following(CROSS, seen[0], -1) == seen[-1]
    assert following(Picture(), -1, 1) == -1


BLOCKS = Composed(
    (
        Block(0, 0, 40, "a", "accent", (0,), 1, True),
        Block(1, 40, 20, "b"),
        Block(2, 60, 40, "c", "accent", (1,), 2, True),
    ),
    (
        Joint(0, 20, "wrap", 0.0, ("a", "a")),
        Joint(1, 40, "cut", 0.8, ("a", "b"), 12.0, 0.9),
        Joint(2, 60, "cut", 1.2, ("b", "c")),
    ),
    100,
)
AXIS = Axis(count=101, width=1200)


def test_what_lies_under_the_mouse() -> None:
    """Ruler, blocks, their buttons, and cuts."""
    middle = RULER + 15.0
    assert found_at(BLOCKS, AXIS, 20, middle).kind == "label"
    assert found_at(BLOCKS, AXIS, AXIS.x(33), 5) == found_at(BLOCKS, AXIS, AXIS.x(33), 8)
    assert found_at(BLOCKS, AXIS, AXIS.x(33), 5).frame == 33
    assert [found_at(BLOCKS, AXIS, AXIS.x(at), middle).index for at in (10, 50, 80)] == [0, 1, 2]
    assert found_at(BLOCKS, AXIS, AXIS.x(60) + 4, RULER + COMPOSED + 20).index == 2
    assert found_at(BLOCKS, AXIS, AXIS.x(20) - 20, RULER + COMPOSED + 20).kind == "empty", "rounds have no bar"
    right, low = box(BLOCKS.blocks[0], AXIS)[1], RULER + COMPOSED - 12.0
    assert repeatable(BLOCKS.blocks[0], AXIS)
    assert not repeatable(BLOCKS.blocks[1], AXIS)
    assert found_at(BLOCKS, AXIS, right - 12, low).kind == "more"
    assert found_at(BLOCKS, AXIS, right - 58, low).kind == "fewer"


def test_places_among_the_key_motions() -> None:
    """What is dropped left of a key motion's middle comes before it; blocks on the way count for nothing."""
    assert [key_place(BLOCKS, AXIS, AXIS.x(at)) for at in (5, 30, 50, 75, 95)] == [0, 1, 1, 1, 2]
    assert place_x(BLOCKS, AXIS, 0) < place_x(BLOCKS, AXIS, 1) < place_x(BLOCKS, AXIS, 2)
    assert place_x(Composed(), AXIS, 0) > LABELS


def test_cuts_say_how_far_they_stand_out() -> None:
    """Their colour and their words."""
    plain = BLOCKS.joints[1]
    assert (tone(plain), tone(BLOCKS.joints[2])) == ("ok", "accent")
    assert tone(Joint(4, 60, "cut", 2.0, ("b", "c"), 3.0, 1.9)) == "warn"
    assert tone(Joint(4, 60, "cut", 2.0, ("b", "c"), 3.0, 1.9, 1.0)) == "ok"
    assert steps(plain) == "12.0 \N{RIGHTWARDS ARROW} 0.9"


def test_cuts_say_what_can_be_done() -> None:
    """Hidden ones nothing; a jump and poses far apart are amber and say what mends them, once it is known."""
    cut = Joint(3, 60, "cut", 2.0, ("b", "c"), 12.0, 0.9)
    poor = replace(cut, poor=True)
    assert (advice(cut), cut.apart) == ("", False)
    assert (tone(poor), poor.apart) == ("warn", True), "the mean step hides a limb that jumps"
    assert "far apart" in advice(poor)
    assert "Switch Blend on" in advice(poor)
    assert "Nothing nearer leads there" in told(poor)
    assert not replace(poor, waiting=True).apart, "in-betweens are still being made"
    bridged = replace(poor, blended=0.8, frames=8)
    assert (tone(bridged), bridged.apart) == ("ok", False)
    assert "bridge" in advice(bridged)
    refused = replace(cut, refused=True, reason="The cut is left as it is: why.")
    assert (tone(refused), refused.apart) == ("warn", True)
    assert "Blend" not in advice(refused)
    assert "Put a motion between" in told(refused)
    seen = replace(cut, after=1.9)
    assert (tone(seen), seen.apart) == ("warn", False)
    assert "Switch Blend on" in advice(seen)


def test_many_cards_are_lower() -> None:
    """Each sequence takes less room where there are many; what is to be known of it is still there."""
    one = Card("s1", "Walk", "114 frames · 25 fps", warnings=("guessed: 25 fps",))
    low = replace(one, low=True)
    assert low.height <= one.height - 20
    assert low.height - low.base == one.height - one.base, "warnings have their lines"
    assert low.strip_room[0] + low.strip_room[1] < low.base
    assert low.picture < low.base


def test_words_of_the_preview_go_on_in_another_line(qapp: object) -> None:
    """A sentence takes two lines at most, and only the last one is shortened."""
    from PySide6.QtGui import QFontMetricsF

    from app.window import fonts
    from app.window.performance.preview_notes import broken

    metrics = QFontMetricsF(fonts.font(fonts.CAPTION))
    sentence = "part of the body has no counterpart there and lies elsewhere"
    wide = metrics.horizontalAdvance(sentence)
    assert broken(sentence, metrics, wide + 1) == [sentence]
    two = broken(sentence, metrics, 0.6 * wide)
    assert " ".join(two) == sentence
    assert len(two) == 2
    short = broken(sentence, metrics, 0.3 * wide)
    assert len(short) == 2
    assert short[1].endswith("\N{HORIZONTAL ELLIPSIS}")
    assert all(metrics.horizontalAdvance(line) <= 0.3 * wide for line in short)


def test_names_and_costs_keep_clear(qapp: object) -> None:
    """Names stand below their nodes, or beside them where another node is in the way; no plate covers a node."""
    from app.window.performance import graph_paint

    picture = Picture(marks((0, 0), (0, 1.3), (2, 0)))
    lens = Lens(60, 60, 60, 200, 100)
    plates = graph_paint.name_plates(picture, lens)
    assert plates[1].top() > lens.pixel(0, 1.3)[1], "below"
    circles = [graph_paint._circle(mark, lens) for mark in picture.nodes]
    for node, plate in plates.items():
        assert not any(plate.intersects(circle) for circle in circles)
        assert not any(plate.intersects(other) for k, other in plates.items() if k != node)
    small = graph_paint.name_plates(picture, replace(lens, size=16.0), 2)
    assert list(small) == [2], "where nodes are small only what is chosen or on the path has its name"


def test_a_large_graph_is_drawn_in_groups(qapp: object) -> None:
    """150 nodes: sequences keep together, and the whole picture is drawn without the edges that would hide it."""
    from PySide6.QtGui import QPainter, QPixmap

    from app.actions.performing_graph import layout
    from app.window.performance import graph_paint
    from app.window.performance.graph_view import GroupMark

    random = np.random.default_rng(4)
    points = random.normal(size=(150, 3))
    weights = np.linalg.norm(points[:, None] - points, axis=2) + 0.1
    np.fill_diagonal(weights, np.inf)
    groups = np.repeat(np.arange(3), 50)
    places = layout(weights, groups)
    nodes = tuple(
        NodeMark(k, float(x), float(y), f"m/{k}", "accent", str(groups[k])) for k, (x, y) in enumerate(places)
    )
    edges = tuple(EdgeMark(int(a), int(b), 1.0, 0.5) for a, b in np.argwhere(weights < 1.0))
    picture = Picture(nodes, edges, (GroupMark("s", "accent", 0, 0, 4, 4),), crowded=True)
    lens = fitted(picture, 700, 400)
    pixels = QPixmap(700, 400)
    pixels.fill()
    painter = QPainter(pixels)
    graph_paint.paint_groups(painter, picture.groups, lens)
    graph_paint.paint_group_names(painter, picture.groups, lens)
    graph_paint.paint_edges(painter, picture, lens, 3)
    names = graph_paint.name_plates(picture, lens, 3)
    graph_paint.paint_costs(painter, picture, lens, names)
    for mark in picture.nodes:
        graph_paint.paint_node(
            painter, mark, lens, None, chosen=mark.node == 3, hovered=False, focus=True, name=names.get(mark.node)
        )
    painter.end()
    centres = [places[groups == group].mean(axis=0) for group in range(3)]
    spread = [np.linalg.norm(places[groups == group] - centres[group], axis=1).mean() for group in range(3)]
    assert min(np.linalg.norm(a - b) for k, a in enumerate(centres) for b in centres[k + 1 :]) > max(spread)
