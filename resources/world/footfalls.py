"""Where and when the feet stand: the footfalls of a walk, and the path of a foot from one to the next."""

from __future__ import annotations

from itertools import pairwise

import attrs
import numpy as np

from resources.world.skeleton import Array, Kind
from resources.world.terrain import Stairs


@attrs.frozen
class Gait:
    """How a kind of body walks.

    Attributes
    ----------
    cycle : frames of one stride. stride : its length, metres. duty : share of it that a foot stands.
    phases : for each leg when in the cycle it comes down. hips : x of the place under which it stands in mid stance.
    sides : y of the soles. lift : height of the swing, metres.
    """

    cycle: float
    stride: float
    duty: float
    phases: dict[str, float]
    hips: dict[str, float]
    sides: dict[str, float]
    lift: float


def gait_of(kind: Kind, terrain: Stairs) -> Gait:
    """The walk of a quadruped (cycle 30 frames) or a biped (34); on stairs each stride climbs two treads."""
    if kind == "quadruped":
        phases = {"left hind": 0.0, "left front": 0.25, "right hind": 0.5, "right front": 0.75}
        hips = {leg: (0.34 if "front" in leg else -0.33) for leg in phases}
        sides = {leg: (0.115 if "left" in leg else -0.115) for leg in phases}
        return Gait(30.0, 2 * terrain.tread if terrain.count else 0.66, 0.64, phases, hips, sides, 0.075)
    phases = {"left": 0.0, "right": 0.5}
    stride = 2 * terrain.tread if terrain.count else 1.0
    return Gait(34.0, stride, 0.6, phases, dict.fromkeys(phases, 0.04), {"left": 0.1, "right": -0.1}, 0.095)


@attrs.frozen(eq=False)
class Footfall:
    """A stance: from time ``land`` to ``leave`` (frames, fractional), the middle of the sole at ``place`` (3,)."""

    land: float
    leave: float
    place: Array


def footfalls(
    gait: Gait, terrain: Stairs, frames: int, start: float, phase: float, seed: int = 0
) -> dict[str, list[Footfall]]:
    """All footfalls of each leg that matter for frames 0 to ``frames`` - 1 of a walk along +x from x = ``start``."""
    rng = np.random.default_rng([seed, 17])
    found: dict[str, list[Footfall]] = {}
    for leg, offset in gait.phases.items():
        stances = []
        for k in range(-2, int(frames / gait.cycle) + 4):
            land = (k + offset - phase) * gait.cycle
            leave = land + gait.duty * gait.cycle
            x = start + gait.hips[leg] + gait.stride * (land + leave) / 2 / gait.cycle
            jitter = rng.uniform(-0.02, 0.02, 2)
            x = float(terrain.middle(x)) + jitter[0]
            stances.append(Footfall(land, leave, np.array([x, gait.sides[leg] + jitter[1], float(terrain.height(x))])))
        found[leg] = stances
    return found


def ease(u: Array) -> Array:
    """From 0 to 1 (...) with no speed and no acceleration at both ends."""
    u = np.clip(u, 0, 1)
    return u**3 * (10 - 15 * u + 6 * u**2)


def foot_path(stances: list[Footfall], gait: Gait, frames: int) -> tuple[Array, Array, Array, list[tuple[int, int]]]:
    """Place of a sole and what it is doing in each frame.

    Returns
    -------
    place : (n, 3). swing : (n,) how far through its swing, 0 while it stands. late : (n,) how far through its stance,
    0 to 1, 1 in swing. planted : (first, last) frames, both included, of every stance that touches the clip.
    """
    time = np.arange(frames, dtype=np.float64)
    place, swing, late = np.zeros((frames, 3)), np.zeros(frames), np.ones(frames)
    planted = []
    for here, there in pairwise(stances):
        stands = (time >= here.land) & (time <= here.leave)
        place[stands] = here.place
        late[stands] = (time[stands] - here.land) / (here.leave - here.land)
        if stands.any():
            inside = np.flatnonzero(stands)
            planted.append((int(inside[0]), int(inside[-1])))
        moves = (time > here.leave) & (time < there.land)
        u = (time[moves] - here.leave) / (there.land - here.leave)
        climb = there.place[2] - here.place[2]
        forward = here.place + (there.place - here.place) * ease(u)[:, None]
        forward[:, 2] = here.place[2] + climb * ease(u * (1.35 if climb > 0 else 1.0))
        # A foot that climbs goes up before it goes forward, to clear the edges of the treads.
        forward[:, 2] += (gait.lift + 0.12 * max(climb, 0)) * np.sin(np.pi * u**0.8) ** 2
        place[moves], swing[moves] = forward, u
    return place, swing, late, planted
