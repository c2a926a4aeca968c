"""A body walks: trunk, legs to planted feet, head, tail and arms, with the contacts that are exactly true."""

from __future__ import annotations

import attrs
import numpy as np
from scipy.ndimage import gaussian_filter1d, maximum_filter1d

from imitation.errors import InputError
from resources.world.body import Body
from resources.world.footfalls import Footfall, Gait, ease, foot_path, footfalls, gait_of
from resources.world.rotation import about, align, compose
from resources.world.skeleton import Array, Leg, Skeleton, two_links
from resources.world.terrain import FLAT, STAIRS, Stairs

Interval = tuple[int, int, Array]
REACH = 0.985  # legs are never stretched further than this share of their length


@attrs.frozen(eq=False)
class Walk:
    """A walk of a body and what is true of it.

    Attributes
    ----------
    body, terrain : who walked on what.
    rotations : (n, bones, 3, 3), translations (n, bones, 3): motion of each bone from the rest pose.
    vertices : (n, v, 3) world, metres.
    key_points : name -> (n, 3), the key vertices of the posed mesh.
    contacts : key point of a sole -> [(first, last, place (3,))], frames both included; it stands still in between.
    footfalls : leg -> the stances, so that another body can walk in the same footsteps.
    """

    body: Body
    terrain: Stairs
    rotations: Array
    translations: Array
    vertices: Array
    key_points: dict[str, Array]
    contacts: dict[str, list[Interval]]
    footfalls: dict[str, list[Footfall]]

    @property
    def centre(self) -> Array:
        """Middle (n, 3) of the vertices in each frame."""
        middle: Array = self.vertices.mean(axis=1)
        return middle

    def planted(self, name: str) -> Array:
        """Whether (n,) a key point stands in each frame; False everywhere for one that is no sole."""
        mask = np.zeros(len(self.vertices), bool)
        for first, last, _ in self.contacts.get(name, []):
            mask[first : last + 1] = True
        return mask


def walk(
    body: Body,
    frames: int = 81,
    terrain: str | Stairs = "flat",
    *,
    start: float | None = None,
    phase: float = 0.1,
    seed: int = 0,
    steps: dict[str, list[Footfall]] | None = None,
) -> Walk:
    """Let a body walk along +x.

    Parameters
    ----------
    terrain : "flat", "stairs", or a flight of stairs.
    start : x of the body in frame 0, metres; chosen to step onto the stairs where None.
    phase : where in its cycle the walk begins, 0 to 1.
    seed : varies footfalls, sway and the habits of head and tail.
    steps : footfalls of another body's walk to step into (same kind, frames, start and phase).
    """
    if frames < 1:
        raise InputError(f"A walk needs at least one frame, but {frames} were asked for.")
    if isinstance(terrain, str) and terrain not in ("flat", "stairs"):
        raise InputError(f"A walk goes over flat ground or stairs, not over {terrain!r}.")
    ground = terrain if isinstance(terrain, Stairs) else {"flat": FLAT, "stairs": STAIRS}[terrain]
    kind = body.skeleton.kind
    gait = gait_of(kind, ground)
    if start is None:
        start = -0.86 if kind == "quadruped" else -0.6
    steps = steps or footfalls(gait, ground, frames, start, phase, seed)
    joints = BonePose(body.skeleton, frames)
    feet = {leg.name: _place_foot(joints, body, leg, steps[leg.name], gait, frames) for leg in body.skeleton.legs}
    _trunk(joints, gait, ground, start, phase, seed)
    bend_legs(joints)
    _ends(joints, gait, phase, seed)
    rotations, translations = joints.motions()
    vertices = body.pose(rotations, translations)
    keys = {name: vertices[:, v].copy() for name, v in body.key_vertices.items()}
    contacts = {
        name: [(first, last, vertices[first, body.key_vertices[name]].copy()) for first, last in spans]
        for stands in feet.values()
        for name, spans in stands.items()
    }
    return Walk(body, ground, rotations, translations, vertices, keys, contacts, steps)


class BonePose:
    """Motions of the bones over all frames while they are put together."""

    def __init__(self, skeleton: Skeleton, frames: int) -> None:
        self.skeleton, self.frames = skeleton, frames
        self.R: dict[str, Array] = {}
        self.t: dict[str, Array] = {}

    def joint(self, name: str) -> Array:
        """Where (3,) a bone's joint is in the rest pose."""
        return self.skeleton.bones[name].head

    def put(self, name: str, rotation: Array, rest: Array, place: Array) -> None:
        """Turn a bone by (n, 3, 3) so that its point ``rest`` (3,) comes to ``place`` (n, 3)."""
        self.R[name] = rotation
        self.t[name] = place - np.einsum("nij,j->ni", rotation, rest)

    def apply(self, name: str, point: Array) -> Array:
        """Where (n, 3) a point (3,) of the rest pose goes with a bone."""
        moved: Array = np.einsum("nij,j->ni", self.R[name], point) + self.t[name]
        return moved

    def turn(self, name: str, local: Array) -> None:
        """Hang a bone on its parent and turn it about its joint by (n, 3, 3) in the parent's frame."""
        parent = self.skeleton.bones[name].parent or ""
        self.put(name, self.R[parent] @ local, self.joint(name), self.apply(parent, self.joint(name)))

    def motions(self) -> tuple[Array, Array]:
        """Rotations (n, bones, 3, 3) and translations (n, bones, 3) from the rest pose."""
        names = list(self.skeleton.bones)
        return np.stack([self.R[n] for n in names], axis=1), np.stack([self.t[n] for n in names], axis=1)


def _place_foot(
    joints: BonePose, body: Body, leg: Leg, stances: list[Footfall], gait: Gait, frames: int
) -> dict[str, list[tuple[int, int]]]:
    """Put a foot on its path; says in which frames the vertex of each of its soles stands still."""
    place, swing, late, planted = foot_path(stances, gait, frames)
    middle = np.mean([spot for _, spot in leg.soles], axis=0)
    roll = np.zeros(frames)
    if body.skeleton.kind == "quadruped":
        roll = 0.75 * np.sin(np.pi * swing) ** 2 * (swing < 0.999)
        joints.put(leg.foot, about("y", roll), middle, place)
        return {leg.soles[0][0]: planted}
    # The heel leaves the ground before the toe does: from then on the foot turns about the toe's own vertex.
    rise = 0.42 * ease((late - 0.66) / 0.34)
    down = np.where(swing > 0, 0.42 * (1 - ease(1.7 * swing)) - 0.14 * np.sin(np.pi * swing) ** 2 * swing, rise)
    flat = np.broadcast_to(np.eye(3), (frames, 3, 3))
    joints.put(leg.foot, flat, middle, place)
    pivot = body.vertices[body.key_vertices[leg.soles[1][0]]]
    joints.put(leg.foot, about("y", down), pivot, joints.apply(leg.foot, pivot))
    whole = [span for span in planted if (late[span[0] : span[1] + 1] <= 0.66).any()]
    heel = [(first, first + int((late[first : last + 1] <= 0.66).sum()) - 1) for first, last in whole]
    return {leg.soles[0][0]: heel, leg.soles[1][0]: planted}


def _wave(joints: BonePose, gait: Gait, phase: float, harmonic: float, shift: float = 0.0) -> Array:
    cycles = np.arange(joints.frames) / gait.cycle + phase
    wave: Array = np.sin(2 * np.pi * (harmonic * cycles + shift))
    return wave


def _trunk(joints: BonePose, gait: Gait, ground: Stairs, start: float, phase: float, seed: int) -> None:
    """Carry pelvis and chest over the slope, as low as the legs need it."""
    frames, skeleton = joints.frames, joints.skeleton
    quad = skeleton.kind == "quadruped"
    rng = np.random.default_rng([seed, 5])
    sway, bob, shift = rng.uniform(0.8, 1.2, 2), rng.uniform(0.8, 1.2), rng.uniform(-0.05, 0.05)
    x = start + gait.stride * np.arange(frames) / gait.cycle + 0.008 * _wave(joints, gait, phase, 2, shift)
    groups = [[leg for leg in skeleton.legs if ("front" in leg.name) == front] for front in (False, True)]
    groups = [group for group in groups if group]
    hips = [np.mean([joints.joint(leg.upper) for leg in group], axis=0) for group in groups]
    drop = [np.zeros(frames) for _ in groups]
    for _ in range(6):
        marks = []
        for hip, low, side in zip(hips, drop, (0.0, 0.5), strict=False):
            mark = np.zeros((frames, 3))
            mark[:, 0] = x + hip[0]
            mark[:, 1] = 0.012 * sway[0] * _wave(joints, gait, phase, 1, 0.25 + side * 0.5)
            mark[:, 2] = ground.slope_height(mark[:, 0]) + hip[2] - low
            mark[:, 2] += (0.006 if quad else 0.018) * bob * _wave(joints, gait, phase, 2, 0.1 + side)
            marks.append(mark)
        swing = 0.035 * sway[1] * _wave(joints, gait, phase, 1, 0.2)
        roll = 0.03 * sway[0] * _wave(joints, gait, phase, 1, 0.45)
        if quad:
            pitch = np.arctan2(marks[0][:, 2] - marks[1][:, 2], marks[1][:, 0] - marks[0][:, 0])
            joints.put("pelvis", compose(about("z", swing), about("y", pitch), about("x", roll)), hips[0], marks[0])
            joints.turn("chest", compose(about("z", -2 * swing), about("x", -1.6 * roll)))
        else:
            lean = np.full(frames, 0.05) + (0.06 if ground.count else 0.0)
            joints.put("pelvis", compose(about("z", 2 * swing), about("x", roll)), hips[0], marks[0])
            joints.turn("chest", compose(about("z", -4 * swing), about("y", lean), about("x", -roll)))
        short = 0.0
        for group, low in zip(groups, drop, strict=True):
            need = np.max([_overreach(joints, leg) for leg in group], axis=0)
            short = max(short, float(need.max()))
            low += gaussian_filter1d(maximum_filter1d(np.maximum(need, 0), 9, mode="nearest"), 3, mode="nearest")
        if short <= 0:
            break


def _links(joints: BonePose, leg: Leg) -> tuple[float, float]:
    hip, knee, ankle = (joints.joint(name) for name in (leg.upper, leg.lower, leg.foot))
    return float(np.linalg.norm(knee - hip)), float(np.linalg.norm(ankle - knee))


def _overreach(joints: BonePose, leg: Leg) -> Array:
    """By how much (n,) the hip must come down so that the leg reaches its foot."""
    parent = joints.skeleton.bones[leg.upper].parent or ""
    hip, ankle = joints.apply(parent, joints.joint(leg.upper)), joints.apply(leg.foot, joints.joint(leg.foot))
    reach = REACH * sum(_links(joints, leg))
    level = np.linalg.norm((hip - ankle)[:, :2], axis=1)
    need: Array = hip[:, 2] - ankle[:, 2] - np.sqrt(np.maximum(reach**2 - level**2, 1e-4))
    return need


def bend_legs(joints: BonePose) -> None:
    """Put the links of each leg between its hip and its foot, which must have their places."""
    for leg in joints.skeleton.legs:
        parent = joints.skeleton.bones[leg.upper].parent or ""
        rest = [joints.joint(name) for name in (leg.upper, leg.lower, leg.foot)]
        hip, ankle = joints.apply(parent, rest[0]), joints.apply(leg.foot, rest[2])
        upper, lower = _links(joints, leg)
        pole = joints.R[parent] @ leg.pole
        knee = two_links(hip, ankle, np.array(upper), np.array(lower), pole)
        hinge, rest_hinge = np.cross(ankle - hip, pole), np.cross(rest[2] - rest[0], leg.pole)
        joints.put(leg.upper, align(rest[1] - rest[0], rest_hinge, knee - hip, hinge), rest[0], hip)
        joints.put(leg.lower, align(rest[2] - rest[1], rest_hinge, ankle - knee, hinge), rest[1], knee)


def _ends(joints: BonePose, gait: Gait, phase: float, seed: int) -> None:
    """Neck, head, ears and tail of a quadruped; neck, head and arms of a biped."""
    rng = np.random.default_rng([seed, 9])
    a, b, c = rng.uniform(0.7, 1.3, 3)
    if joints.skeleton.kind == "quadruped":
        chest = -np.arcsin(np.clip(joints.R["chest"][:, 2, 0], -1, 1))
        level = gaussian_filter1d(chest, 4, mode="nearest")
        look = 0.1 * b * _wave(joints, gait, phase, 0.37, a)
        joints.turn(
            "neck", compose(about("z", look), about("y", 0.28 - 0.55 * level + 0.05 * _wave(joints, gait, phase, 2)))
        )
        joints.turn(
            "head",
            compose(about("z", look), about("y", -0.2 - 0.3 * level - 0.06 * _wave(joints, gait, phase, 2, 0.1))),
        )
        for side, s in (("left", 1), ("right", -1)):
            flap = 0.1 * c * _wave(joints, gait, phase, 2, 0.3) + 0.05
            joints.turn(f"{side} ear", compose(about("x", s * (0.06 + flap)), about("y", flap)))
        for i in range(3):
            wag = 0.16 * c * _wave(joints, gait, phase, 1.5, a - 0.08 * i)
            joints.turn(
                f"tail {i + 1}", compose(about("z", wag), about("y", 0.05 * _wave(joints, gait, phase, 2, 0.1 * i)))
            )
        return
    joints.turn("neck", about("y", np.full(joints.frames, -0.04)))
    joints.turn(
        "head",
        compose(
            about("z", 0.15 * b * _wave(joints, gait, phase, 0.4, a)), about("y", 0.03 * _wave(joints, gait, phase, 2))
        ),
    )
    for side, half in (("left", 0.0), ("right", 0.5)):
        s = 1 if side == "left" else -1
        reach = 0.36 * a * _wave(joints, gait, phase, 1, half + 0.27)
        joints.turn(f"{side} arm", compose(about("y", reach), about("x", np.full(joints.frames, -0.04 * s))))
        bend = -0.42 * c - 0.22 * _wave(joints, gait, phase, 1, half + 0.77)
        joints.turn(f"{side} forearm", about("y", bend))
        joints.turn(f"{side} hand", about("y", np.full(joints.frames, -0.1)))
