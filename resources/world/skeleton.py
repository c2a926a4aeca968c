"""What the bodies of the sample world are made of: bones, legs, flesh and key points, in a rest pose facing +x."""

from __future__ import annotations

from typing import Literal

import attrs
import numpy as np
from numpy.typing import ArrayLike, NDArray

from imitation.errors import InputError

Array = NDArray[np.float64]
Kind = Literal["quadruped", "biped"]


@attrs.frozen
class Proportions:
    """Factors on the parts of a body; 1 is the filmed subject itself."""

    legs: float = 1.0
    trunk: float = 1.0
    width: float = 1.0
    head: float = 1.0


SUBJECT = Proportions()
OTHER = Proportions(legs=0.88, trunk=1.12, width=1.15, head=1.3)


@attrs.frozen(eq=False)
class Bone:
    """A rigid part; ``head`` (3,) is the joint it turns about, rest pose, metres."""

    name: str
    parent: str | None
    head: Array


@attrs.frozen(eq=False)
class Flesh:
    """A capsule between two points (3,) with a radius at each, carried by a bone."""

    bone: str
    start: Array
    end: Array
    radii: tuple[float, float]


@attrs.frozen(eq=False)
class Leg:
    """Two links from hip to ankle and the foot under it; ``pole`` (3,) is where the knee points.

    ``soles`` are the points (name, place) of the foot that stand on the ground.
    """

    name: str
    upper: str
    lower: str
    foot: str
    pole: Array
    soles: tuple[tuple[str, Array], ...]


@attrs.define(eq=False)
class Skeleton:
    """Bones in the order parents first, legs, flesh, and where in the rest pose the 16 key points and others are.

    ``extras`` are further points that are easy to see and to click on.
    """

    kind: Kind
    bones: dict[str, Bone] = attrs.field(factory=dict)
    flesh: list[Flesh] = attrs.field(factory=list)
    legs: list[Leg] = attrs.field(factory=list)
    keys: dict[str, Array] = attrs.field(factory=dict)
    extras: dict[str, Array] = attrs.field(factory=dict)
    blend: float = 0.03

    def bone(self, name: str, parent: str | None, head: ArrayLike) -> None:
        """Add a bone with its joint at ``head`` (3,)."""
        self.bones[name] = Bone(name, parent, np.asarray(head, np.float64))

    def cover(self, bone: str, start: ArrayLike, end: ArrayLike, r0: float, r1: float) -> None:
        """Put a capsule from ``start`` (3,) to ``end`` (3,) on a bone."""
        self.flesh.append(Flesh(bone, np.asarray(start, np.float64), np.asarray(end, np.float64), (r0, r1)))


def two_links(hip: ArrayLike, ankle: ArrayLike, upper: ArrayLike, lower: ArrayLike, pole: ArrayLike) -> Array:
    """Knee (..., 3) of two links of given lengths (...) between hip and ankle (..., 3), on the side of ``pole``.

    Where the ankle is out of reach the links are stretched straight.
    """
    hip, ankle, pole = (np.asarray(a, np.float64) for a in (hip, ankle, pole))
    upper, lower = np.asarray(upper, np.float64), np.asarray(lower, np.float64)
    chord = ankle - hip
    length = np.linalg.norm(chord, axis=-1)
    along = chord / length[..., None]
    bound = np.minimum(length, upper + lower)
    at = (bound**2 + upper**2 - lower**2) / (2 * bound)
    off = np.sqrt(np.maximum(upper**2 - at**2, 0))
    side = pole - np.sum(pole * along, axis=-1, keepdims=True) * along
    side /= np.linalg.norm(side, axis=-1, keepdims=True)
    knee: Array = hip + at[..., None] * along + off[..., None] * side
    return knee


def by(x: float, y: float, z: float) -> Array:
    """A step (3,) in metres."""
    return np.array([x, y, z], np.float64)


ANKLE = 0.05  # height of a quadruped's ankle above its sole
FOOT = 0.09  # height of a biped's ankle above its sole


def quadruped(proportions: Proportions = SUBJECT) -> Skeleton:
    """A hound, shoulder height 0.66 m, with 25 bones."""
    p, body = proportions, Skeleton("quadruped")
    lift = (p.legs - 1) * 0.46

    def trunk(x: float, y: float, z: float) -> Array:
        return np.array([x * p.trunk, y * p.width, z + lift])

    w = p.width**0.5
    body.bone("pelvis", None, trunk(-0.14, 0, 0.575))
    body.bone("chest", "pelvis", trunk(-0.06, 0, 0.575))
    body.cover("pelvis", trunk(-0.37, 0, 0.565), trunk(-0.12, 0, 0.57), 0.112 * w, 0.1 * w)
    body.cover("chest", trunk(-0.1, 0, 0.57), trunk(0.12, 0, 0.56), 0.1 * w, 0.128 * w)
    body.cover("chest", trunk(0.12, 0, 0.56), trunk(0.33, 0, 0.58), 0.128 * w, 0.11 * w)
    body.cover("chest", trunk(0.14, 0, 0.49), trunk(0.34, 0, 0.51), 0.095 * w, 0.09 * w)
    body.bone("neck", "chest", trunk(0.36, 0, 0.63))
    poll = trunk(0.36, 0, 0.63) + np.array([0.19, 0, 0.22])
    body.cover("neck", trunk(0.34, 0, 0.61), poll, 0.1 * w, 0.07 * w)
    body.bone("head", "neck", poll)

    def head(x: float, y: float, z: float) -> Array:
        place: Array = poll + p.head * np.array([x, y, z])
        return place

    h = p.head
    body.cover("head", head(0.0, 0, 0.01), head(0.09, 0, 0.005), 0.082 * h, 0.074 * h)
    body.cover("head", head(0.1, 0, -0.02), head(0.255, 0, -0.05), 0.055 * h, 0.036 * h)
    for side, s in (("left", 1), ("right", -1)):
        ear = f"{side} ear"
        body.bone(ear, "head", head(0.0, s * 0.065, 0.06))
        body.cover(ear, head(0.0, s * 0.068, 0.055), head(-0.015, s * 0.105, -0.07), 0.026 * h, 0.034 * h)
    at = trunk(-0.44, 0, 0.61)
    tail = [at, at + by(-0.15, 0, 0.0), at + by(-0.28, 0, 0.07), at + by(-0.37, 0, 0.17)]
    radii = [0.045, 0.031, 0.028, 0.022]
    for i in range(3):
        body.bone(f"tail {i + 1}", "pelvis" if i == 0 else f"tail {i}", tail[i])
        body.cover(f"tail {i + 1}", tail[i], tail[i + 1], radii[i], radii[i + 1])

    for side, s in (("left", 1), ("right", -1)):
        for end, x, z, upper, lower, pole in (
            ("front", 0.31, 0.5, 0.265, 0.265, -1.0),
            ("hind", -0.35, 0.52, 0.275, 0.3, 1.0),
        ):
            _paw_leg(body, f"{side} {end}", trunk(x, s * 0.105, z), 0.115 * s * p.width, (upper, lower), pole, p)
    body.keys |= {
        "nose": head(0.292, 0, -0.05),
        "poll": head(0.0, 0, 0.092),
        "back": trunk(0.02, 0, 0.72),
        "tail root": at + by(0.0, 0, 0.05),
    }
    body.extras |= {
        "tail tip": tail[3] + by(-0.02, 0, 0.01),
        "brow": head(0.1, 0, 0.075),
        "withers": trunk(0.28, 0, 0.7),
    }
    for side, s in (("left", 1), ("right", -1)):
        body.extras[f"{side} ear"] = head(-0.02, s * 0.138, -0.04)
        body.extras[f"{side} neck"] = 0.5 * (trunk(0.34, 0, 0.61) + poll) + by(0.0, s * 0.085, 0)
        body.extras[f"{side} flank"] = trunk(0.0, s * 0.115, 0.56)
        body.extras[f"{side} haunch"] = trunk(-0.39, s * 0.15, 0.6)
    return body


def _paw_leg(
    body: Skeleton, name: str, hip: Array, y: float, links: tuple[float, float], pole: float, p: Proportions
) -> None:
    hind = pole > 0
    ankle = np.array([hip[0], y, ANKLE])
    upper, lower = links[0] * p.legs, links[1] * p.legs
    knee = two_links(hip, ankle, upper, lower, [pole, 0, 0])
    names = [f"{name} {part}" for part in ("upper", "lower", "paw")]
    body.bone(names[0], "pelvis" if hind else "chest", hip)
    body.bone(names[1], names[0], knee)
    body.bone(names[2], names[1], ankle)
    y_out = 0.01 * np.sign(y)
    if hind:
        hock = 0.4 * knee + 0.6 * ankle + by(-0.075 * p.legs, 0, 0.02)
        body.cover(names[0], hip, 0.35 * hip + 0.65 * knee + by(-0.015, y_out, 0), 0.082, 0.066)
        body.cover(names[0], 0.35 * hip + 0.65 * knee, knee, 0.06, 0.048)
        body.cover(names[1], knee, hock, 0.05, 0.027)
        body.cover(names[1], hock, ankle, 0.026, 0.026)
    else:
        body.cover(names[0], hip, knee, 0.07, 0.046)
        body.cover(names[1], knee, ankle, 0.041, 0.027)
    body.cover(names[2], ankle + by(0.0, 0, -0.016), ankle + by(0.05, 0, -0.018), 0.035, 0.036)
    sole = np.array([ankle[0] + 0.03, y, 0.0])
    body.legs.append(Leg(name, names[0], names[1], names[2], np.array([pole, 0, 0.0]), ((f"{name} paw", sole),)))
    side = np.array([0, np.sign(y), 0])
    body.keys[f"{name} paw"] = sole
    body.keys[f"{name} knee"] = knee + 0.045 * side
    body.keys[f"{name} hip"] = hip + 0.08 * side


def biped(proportions: Proportions = SUBJECT) -> Skeleton:
    """A person, 1.78 m high, with 17 bones."""
    p, body = proportions, Skeleton("biped", blend=0.035)
    hip_z = FOOT + 0.84 * p.legs

    def trunk(x: float, y: float, z: float) -> Array:
        return np.array([x, y * p.width, hip_z + (z - 0.93) * p.trunk])

    w = p.width**0.5
    body.bone("pelvis", None, trunk(0, 0, 0.95))
    body.bone("chest", "pelvis", trunk(0, 0, 1.12))
    body.cover("pelvis", trunk(0, -0.065, 0.97), trunk(0, 0.065, 0.97), 0.115 * w, 0.115 * w)
    body.cover("pelvis", trunk(0.005, 0, 1.0), trunk(0.0, 0, 1.12), 0.12 * w, 0.112 * w)
    body.cover("chest", trunk(0.0, 0, 1.12), trunk(0, 0, 1.3), 0.112 * w, 0.12 * w)
    body.cover("chest", trunk(0, -0.085, 1.32), trunk(0, 0.085, 1.32), 0.105 * w, 0.105 * w)
    body.cover("chest", trunk(0, -0.15, 1.43), trunk(0, 0.15, 1.43), 0.062, 0.062)
    neck = trunk(0, 0, 1.46)
    body.bone("neck", "chest", neck)
    top = neck + np.array([0.02, 0, 0.1])
    body.cover("neck", neck, top, 0.058, 0.054)
    body.bone("head", "neck", top)
    h = p.head
    body.cover("head", top + h * np.array([0.02, 0, 0.03]), top + h * np.array([0.01, 0, 0.13]), 0.08 * h, 0.1 * h)
    body.cover("head", top + h * np.array([0.11, 0, 0.05]), top + h * np.array([0.09, 0, 0.08]), 0.02 * h, 0.018 * h)
    body.keys |= {"head": top + h * np.array([0.0, 0, 0.232]), "back": trunk(-0.12, 0, 1.25)}
    for side, s in (("left", 1), ("right", -1)):
        _arm(body, side, s, trunk(0, s * 0.19, 1.42))
        _shoe_leg(body, side, s * 0.1 * p.width, trunk(0, s * 0.092, 0.93), p)
        body.extras[f"{side} waist"] = trunk(0, s * 0.12, 1.12)
        body.extras[f"{side} chest"] = trunk(0.1, s * 0.09, 1.32)
    return body


def _arm(body: Skeleton, side: str, s: int, shoulder: Array) -> None:
    elbow = shoulder + by(-0.03, s * 0.075, -0.28)
    wrist = elbow + by(0.06, s * 0.03, -0.25)
    tip = wrist + by(0.02, s * 0.005, -0.1)
    body.bone(f"{side} arm", "chest", shoulder)
    body.bone(f"{side} forearm", f"{side} arm", elbow)
    body.bone(f"{side} hand", f"{side} forearm", wrist)
    body.cover(f"{side} arm", shoulder, elbow, 0.062, 0.046)
    body.cover(f"{side} forearm", elbow, wrist, 0.045, 0.032)
    body.cover(f"{side} hand", wrist, tip, 0.036, 0.034)
    body.keys |= {
        f"{side} shoulder": shoulder + by(0, s * 0.06, 0.02),
        f"{side} elbow": elbow + by(-0.04, s * 0.02, 0),
        f"{side} hand": tip + by(0, 0, -0.03),
    }


def _shoe_leg(body: Skeleton, side: str, y: float, hip: Array, p: Proportions) -> None:
    ankle = np.array([0.0, y, FOOT])
    knee = two_links(hip, ankle, 0.437 * p.legs, 0.437 * p.legs, [1, 0, 0])
    names = [f"{side} {part}" for part in ("thigh", "shin", "foot")]
    body.bone(names[0], "pelvis", hip)
    body.bone(names[1], names[0], knee)
    body.bone(names[2], names[1], ankle)
    body.cover(names[0], hip, knee, 0.09, 0.062)
    body.cover(names[1], knee, ankle, 0.06, 0.042)
    body.cover(names[2], ankle + by(-0.03, 0, -0.045), ankle + by(0.15, 0.0, -0.055), 0.046, 0.038)
    heel, toe = np.array([-0.045, y, 0.0]), np.array([0.165, y, 0.0])
    soles = ((f"{side} heel", heel), (f"{side} toe", toe))
    body.legs.append(Leg(side, names[0], names[1], names[2], np.array([1.0, 0, 0]), soles))
    out = np.array([0, np.sign(y), 0])
    body.keys |= {
        f"{side} heel": heel,
        f"{side} toe": toe,
        f"{side} knee": knee + by(0.06, 0, 0),
        f"{side} hip": hip + 0.085 * out,
    }


def make_skeleton(kind: Kind, proportions: Proportions = SUBJECT) -> Skeleton:
    """The skeleton of a kind of body; raises InputError for a kind that is not known."""
    if kind not in ("quadruped", "biped"):
        raise InputError(f"The sample world knows the bodies quadruped and biped, not {kind!r}.")
    return quadruped(proportions) if kind == "quadruped" else biped(proportions)
