"""The characters that the sample's motion is put on: the hound itself, and a fox of other proportions."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numba import njit
from numpy.typing import NDArray

from resources.world.body import Body, body_of, make_body
from resources.world.coats import cloth, fox_fur, hound_fur
from resources.world.render import develop
from resources.world.skeleton import OTHER, Array, Skeleton, make_skeleton


def fox_skeleton() -> Skeleton:
    """A young fox: short legs, long trunk, a big head with upright ears, a bushy tail."""
    body = make_skeleton("quadruped", OTHER)
    ears, tails = {"left ear", "right ear"}, {"tail 1", "tail 2", "tail 3"}
    head = body.bones["head"].head
    snout = [f for f in body.flesh if f.bone == "head"][1]
    body.flesh = [f for f in body.flesh if f.bone not in ears | tails and f is not snout]
    body.cover("head", head + _h(0.1, 0, -0.025), head + _h(0.21, 0, -0.06), 0.07, 0.032)
    for side, s in (("left", 1), ("right", -1)):
        for foot in (_h(0.015, s * 0.035, 0.05), _h(-0.005, s * 0.085, 0.03)):
            body.cover(f"{side} ear", head + foot, head + _h(-0.04, s * 0.098, 0.165), 0.048, 0.013)
        body.cover("head", head + _h(0.0, 0, -0.02), head + _h(0.015, s * 0.075, -0.05), 0.07, 0.035)
        body.extras[f"{side} ear"] = head + _h(-0.04, s * 0.105, 0.178)
    tail = [body.bones[f"tail {i}"].head for i in (1, 2, 3)]
    tip = tail[2] + np.array([-0.26, 0, 0.15])
    for i, (a, b, r0, r1) in enumerate(
        ((tail[0], tail[1], 0.05, 0.07), (tail[1], tail[2], 0.075, 0.1), (tail[2], tip, 0.1, 0.03))
    ):
        body.cover(f"tail {i + 1}", a, b, r0, r1)
    body.keys["nose"] = head + _h(0.235, 0, -0.06)
    body.keys["tail root"] = body.keys["tail root"] + [0, 0, 0.01]
    body.extras["tail tip"] = tip + np.array([-0.02, 0, 0.02])
    return body


def _h(x: float, y: float, z: float) -> Array:
    return OTHER.head * np.array([x, y, z])


@lru_cache(maxsize=2)
def make_fox(vertices: int = 6000) -> Body:
    """The fox as a body that can walk."""
    return body_of(fox_skeleton(), vertices)


@njit(cache=True)
def _colours(places, coat):  # type: ignore[no-untyped-def]
    found = np.zeros_like(places)
    for i in range(len(places)):
        x, y, z = places[i]
        if coat == 0:
            found[i] = hound_fur(x, y, z, 0.004)
        elif coat == 1:
            found[i] = fox_fur(x, y, z, 0.004)
        else:
            found[i] = cloth(x, y, z, 0.004)
    return found


def vertex_colours(body: Body, coat: str) -> NDArray[np.uint8]:
    """Colours (n, 3) uint8 of a body's vertices in the coat "hound", "fox" or "cloth", as in soft light."""
    linear = _colours(np.ascontiguousarray(body.vertices), ["hound", "fox", "cloth"].index(coat))
    colours: NDArray[np.uint8] = np.rint(255 * develop(1.5 * linear)).astype(np.uint8)
    return colours


def characters() -> dict[str, tuple[Body, str]]:
    """The sample's characters by name: body and coat."""
    return {"hound": (make_body("quadruped"), "hound"), "fox": (make_fox(), "fox")}
