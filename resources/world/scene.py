"""Places to film in: a garden with stairs, a room to measure depth in, a single wall."""

from __future__ import annotations

from itertools import pairwise

import attrs
import numpy as np

from resources.world.materials import Material
from resources.world.shapes import Geometry, box, lathe, leaves, rod, rope, sheet, turned, union
from resources.world.skeleton import Array, by
from resources.world.terrain import FLAT, Stairs

POT = [
    (0.0, 0.0),
    (0.1, 0.0),
    (0.125, 0.06),
    (0.16, 0.24),
    (0.175, 0.25),
    (0.178, 0.31),
    (0.15, 0.315),
    (0.13, 0.27),
    (0.0, 0.27),
]


@attrs.frozen(eq=False)
class Scene:
    """What stands still. ``middle`` (3,) and ``width``, metres: the part that gets fine shadows."""

    geometry: Geometry
    middle: Array
    width: float


def garden(stairs: Stairs = FLAT, *, seed: int = 0) -> Scene:
    """A garden at the back of a house, a flight of stairs up to its terrace; the subject walks along y = 0."""
    rng = np.random.default_rng([seed, 41])
    parts = [
        sheet([-90, -60, -0.03], [180, 0, 0], [0, 200, 0], Material.GRASS),
        box([-7.5, -2.6, -0.2], [9, 1.55, 0.0], Material.PAVING),
        box([-7.5, -2.72, -0.2], [9, -2.6, 0.035], Material.STONE),
    ]
    top = stairs.count * stairs.rise
    if stairs.count:
        parts += _flight(stairs)
        parts += _railing(stairs)
    parts += _house(top, seed)
    end = stairs.start - 0.15 if stairs.count else 9.0
    parts += [
        box([-7.5, 1.35, -0.1], [end, 1.65, 0.46], Material.STONE),
        box([-7.5, 1.32, 0.46], [end, 1.68, 0.52], Material.PAVING),
    ]
    parts += _pots(top, stairs, rng)
    parts += _bench([-2.75, 0.98, 0.0])
    parts += _plants(seed)
    parts.append(_ball([-0.72 - 0.2 * rng.uniform(), -1.15, 0.11], 0.11))
    return Scene(union(parts), np.array([0.2, 0.8, 0.6]), 13.0)


def _flight(stairs: Stairs) -> list[Geometry]:
    last = stairs.start + stairs.count * stairs.tread
    steps = [
        box(
            [stairs.start + k * stairs.tread, -0.8, k * stairs.rise - (0.1 if not k else 0)],
            [last, 0.85, (k + 1) * stairs.rise],
            Material.STONE,
        )
        for k in range(stairs.count)
    ]
    top = stairs.count * stairs.rise
    return [*steps, box([last - stairs.tread, -0.8, -0.1], [9, 4.2, top], Material.STONE)]


def _railing(stairs: Stairs) -> list[Geometry]:
    """An iron railing on the far side; on the near side posts and a rope, behind which the subject passes."""
    parts = []
    slope = np.array([stairs.tread, 0, stairs.rise])
    first = np.array([stairs.start + stairs.tread / 2, 0.76, stairs.rise])
    for k in range(2 * stairs.count):
        foot = first + slope * (k / 2)
        foot[2] = stairs.height(foot[0])
        head = first[2] + stairs.rise * k / 2 + 0.82
        wide = 0.02 if k % 6 == 0 else 0.009
        parts.append(rod(foot, [foot[0], foot[1], head], wide, Material.IRON, 8))
        if k % 6 == 0:
            parts.append(_knob([foot[0], foot[1], head + 0.02], 0.035))
    end = first + slope * (stairs.count - 0.5)
    for high, wide in ((0.82, 0.024), (0.16, 0.012)):
        parts.append(rod(first + by(0, 0, high), end + by(0, 0, high), wide, Material.IRON, 10))
    posts = [np.array([stairs.start + (k + 0.62) * stairs.tread, -0.72, (k + 1) * stairs.rise]) for k in (0, 3, 6)]
    posts = [p for p in posts if p[2] <= stairs.count * stairs.rise + 1e-9]
    for foot in posts:
        parts += [rod(foot, foot + by(0, 0, 0.78), 0.026, Material.IRON, 14), _knob(foot + by(0, 0, 0.81), 0.045)]
        parts.append(
            lathe(foot, [(0.0, 0.0), (0.06, 0.0), (0.055, 0.02), (0.03, 0.035), (0.026, 0.06)], Material.IRON, 14)
        )
    upper = pairwise(posts[1:])
    parts += [rope(a + by(0, 0, 0.7), b + by(0, 0, 0.7), 0.12, 0.013, Material.ROPE) for a, b in upper]
    return parts


def _knob(middle: list[float] | Array, radius: float) -> Geometry:
    angle = np.linspace(-np.pi / 2, np.pi / 2, 8)
    return lathe(middle, [(radius * np.cos(a) + 1e-5, radius * np.sin(a)) for a in angle], Material.IRON, 14)


def _ball(middle: list[float], radius: float) -> Geometry:
    angle = np.linspace(-np.pi / 2, np.pi / 2, 16)
    ball = lathe(middle, [(radius * np.cos(a) + 1e-5, radius * np.sin(a)) for a in angle], Material.BALL, 32)
    shades = np.broadcast_to([middle[0], middle[1], 0.0], ball.vertices.shape)
    return attrs.evolve(ball, shades=np.ascontiguousarray(shades))


def _house(top: float, seed: int) -> list[Geometry]:
    wall = 3.9
    parts = [
        box([-0.9, wall, -0.1], [10, wall + 0.4, 6.5], Material.PLASTER),
        box([-0.95, wall - 0.04, -0.1], [10, wall, 0.75], Material.BRICK),
        box([-0.95, wall - 0.06, 0.75], [10, wall, 0.82], Material.STONE),
    ]
    for row in range(24):
        wide = 0.34 if row % 2 else 0.24
        parts.append(
            box([-0.95, wall - 0.025, 0.84 + row * 0.24], [-0.95 + wide, wall, 1.07 + row * 0.24], Material.BRICK)
        )
    for x, low in ((0.15, 1.35), (6.3, 1.9)):
        parts += _window(x, wall, low)
    parts += [
        box([3.3, wall - 0.03, top], [4.25, wall + 0.01, top + 2.15], Material.WOOD),
        box([3.15, wall - 0.09, top], [3.3, wall, top + 2.3], Material.STONE),
        box([4.25, wall - 0.09, top], [4.4, wall, top + 2.3], Material.STONE),
        box([3.1, wall - 0.1, top + 2.15], [4.45, wall, top + 2.36], Material.STONE),
    ]
    wing = box([5.0, 1.9, -0.1], [8.5, 2.2, 6.0], Material.BRICK)
    return [*parts, turned(wing, [5.0, 1.9, 0], -0.45)]


def _window(x: float, wall: float, low: float) -> list[Geometry]:
    wide, high = 0.95, 1.3
    parts = [
        box([x, wall - 0.02, low], [x + wide, wall + 0.01, low + high], Material.GLASS),
        box([x - 0.08, wall - 0.12, low - 0.09], [x + wide + 0.08, wall, low], Material.STONE),
        box([x - 0.06, wall - 0.05, low + high], [x + wide + 0.06, wall, low + high + 0.14], Material.BRICK),
    ]
    bars = ((0.0, 0.05), (wide / 2 - 0.025, 0.05), (wide - 0.05, 0.05))
    parts += [box([x + a, wall - 0.05, low], [x + a + b, wall, low + high], Material.STONE) for a, b in bars]
    parts += [
        box([x, wall - 0.05, low + a], [x + wide, wall, low + a + 0.04], Material.STONE)
        for a in (0.0, 0.62, high - 0.04)
    ]
    for left in (x - 0.52, x + wide + 0.06):
        parts.append(box([left, wall - 0.06, low - 0.02], [left + 0.46, wall, low + high + 0.02], Material.SHUTTER))
    return parts


def _pots(top: float, stairs: Stairs, rng: np.random.Generator) -> list[Geometry]:
    end = stairs.start + stairs.count * stairs.tread
    spots = [(-1.45, 1.5, 0.52), (-0.55, 1.52, 0.52), (-3.9, 1.48, 0.52), (-1.9, 1.0, 0.0), (-0.3, 1.1, 0.0)]
    if stairs.count:
        spots += [
            (end + 0.3, 1.2, top),
            (end + 0.55, 1.75, top),
            (end + 1.75, 2.4, top),
            (end - 0.1, -1.12, 0.0),
            (end + 0.75, -1.2, 0.0),
        ]
    parts = []
    for i, (x, y, z) in enumerate(spots):
        k = rng.uniform(0.75, 1.15)
        shape = [(r * k, h * k) for r, h in POT]
        parts.append(lathe([x, y, z], shape, Material.CLAY))
        tall = rng.uniform(0.8, 1.3) if y > -1 else 0.75
        parts.append(
            leaves(
                [x, y, z + (0.3 + 0.16 * tall) * k],
                [0.2 * k, 0.2 * k, 0.2 * tall * k],
                420,
                0.042,
                Material.LEAF,
                100 * i + 7,
            )
        )
    return parts


def _bench(at: list[float]) -> list[Geometry]:
    x, y, z = at
    parts = [
        box([x - 0.65, y - 0.2 + 0.14 * i, z + 0.4], [x + 0.65, y - 0.08 + 0.14 * i, z + 0.44], Material.WOOD)
        for i in range(3)
    ]
    parts += [
        box([x - 0.65, y + 0.22, z + 0.55 + 0.14 * i], [x + 0.65, y + 0.25, z + 0.66 + 0.14 * i], Material.WOOD)
        for i in range(3)
    ]
    for side in (-0.55, 0.5):
        parts += [
            box([x + side, y - 0.2, z], [x + side + 0.06, y - 0.14, z + 0.4], Material.IRON),
            box([x + side, y + 0.2, z], [x + side + 0.06, y + 0.26, z + 0.98], Material.IRON),
        ]
    return parts


def _plants(seed: int) -> list[Geometry]:
    parts = [
        rod([-3.6, 3.3, -0.1], [-3.5, 3.25, 2.3], 0.15, Material.BARK, 16),
        rod([-3.5, 3.25, 2.1], [-2.8, 3.0, 3.1], 0.07, Material.BARK, 10),
        rod([-3.5, 3.25, 2.1], [-4.2, 3.4, 3.2], 0.08, Material.BARK, 10),
        leaves([-3.4, 3.2, 3.5], [1.7, 1.5, 1.15], 5200, 0.085, Material.HEDGE, seed + 1),
        leaves([-2.3, 2.9, 3.05], [0.9, 0.8, 0.6], 1500, 0.085, Material.HEDGE, seed + 2),
    ]
    parts += [
        leaves([x, y, 0.45 + 0.3 * r], [r, r * 0.8, r * 1.05], 1300, 0.055, Material.LEAF, seed + 20 + i)
        for i, (x, y, r) in enumerate(((-0.2, 2.3, 0.5), (0.9, 2.35, 0.42), (-1.3, 2.2, 0.55), (-2.2, 2.6, 0.4)))
    ]
    hedges = [([-1.9 - 1.25 * i, 7.2, 0.7], [0.85, 0.6, 0.95]) for i in range(9)]
    hedges += [([-9.5, -4.5 + 1.7 * i, 0.8], [0.7, 1.1, 1.1]) for i in range(7)]
    parts += [leaves(at, r, 900, 0.1, Material.HEDGE, seed + 40 + i) for i, (at, r) in enumerate(hedges)]
    for i, (x, z, r) in enumerate(
        ((-0.75, 0.7, 0.5), (-0.7, 1.5, 0.45), (-0.6, 2.3, 0.5), (-0.35, 3.0, 0.55), (0.6, 3.25, 0.5))
    ):
        parts.append(leaves([x, 3.86, z], [r, 0.12, r * 1.1], 520, 0.045, Material.HEDGE, seed + 140 + i, shell=0.1))
    rng = np.random.default_rng([seed, 43])
    for i in range(14):
        x, y, r = -34 + 4.2 * i + rng.uniform(-1, 1), rng.uniform(22, 42), rng.uniform(2.2, 4.2)
        parts.append(leaves([x, y, 1.0 + r], [r, r, 1.25 * r], 1700, 0.34, Material.HEDGE, seed + 80 + i, shell=0.7))
        parts.append(
            leaves([-36 + rng.uniform(-4, 4), x + 8, 1 + r], [r, r, 1.2 * r], 900, 0.42, Material.HEDGE, seed + 120 + i)
        )
    return parts


def foreground(place: Array, material: int = Material.BARK) -> Geometry:
    """Something large close to the camera: a trunk at ``place`` (3,) that hides part of the picture."""
    return rod([place[0], place[1], -0.2], [place[0] + 0.05, place[1], 4.0], 0.2, material, 20)


def room(*, seed: int = 0) -> Scene:
    """Ground, back wall in part weakly textured, slanted wall, five stairs, two boxes, a thin post: 3.4 to 9.4 m deep.

    It is filmed from y = -3.4 along +y at a height of 1.3 m, by ``camera.lateral_camera``; a subject that walks along
    y = 0 passes in front of it.
    """
    a, b, c, d = np.random.default_rng([seed, 47]).uniform(-0.08, 0.08, 4)
    parts = [
        sheet([-12, -5.4, 0], [24, 0, 0], [0, 14, 0], Material.PAVING),
        box([-12, 6.0, -0.1], [1.2, 6.3, 7], Material.BRICK),
        box([1.2, 6.0, -0.1], [12, 6.3, 7], Material.WEAK),
        turned(box([-4.6, 2.2, -0.1], [-4.3, 6.2, 5], Material.BUSY), [-4.4, 4.1, 0], 0.5),
        box([-1.6 + a, 1.6, 0], [-0.7 + a, 2.4, 0.95], Material.BUSY, 0.35),
        box([0.75 + b, 1.2, 0], [1.65 + b, 2.0, 0.8], Material.WEAK, -0.3),
        rod([0.25 + c, 0.5, 0], [0.25 + c, 0.5, 2.6], 0.035, Material.BUSY, 12),
    ]
    parts += [box([1.9 + d, 2.8 + 0.34 * k, 0], [4.2, 6.0, 0.17 * (k + 1)], Material.STONE) for k in range(5)]
    return Scene(union(parts), np.array([0.0, 2.6, 1.0]), 12.0)


def wall() -> Scene:
    """One textured wall behind the subject and nothing else: all that is still lies in a plane."""
    return Scene(sheet([-40, 1.2, -25], [80, 0, 0], [0, 0, 50], Material.BUSY, (4, 4)), np.array([0.0, 0.6, 0.6]), 10.0)
