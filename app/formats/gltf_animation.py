"""What an animation of a glTF file does at a time: node transforms and morph weights by its key frames."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import attrs
import numpy as np
from numpy.typing import NDArray

from app.formats.gltf import Gltf
from imitation.errors import InputError

Array = NDArray[np.float64]
WIDTHS = {"translation": 3, "rotation": 4, "scale": 3}
RATE = Fraction(30)
"""Frames a second at which keys are sampled that lie at no even rate."""
SLOWEST, FASTEST = 10, 240
"""Frames a second between which even keys are taken to be the frames themselves."""
SAME_TIME = 1e-4
"""Seconds; key times closer than this are one, being single precision."""
MOST_NAMED = 12
"""Animations that a message lists."""
LONGEST = 100_000
"""Frames; a longer animation is a mistake in its times."""


@attrs.frozen(eq=False)
class Channel:
    """One property of one node over time.

    Attributes
    ----------
    node : its number. path : "translation", "rotation", "scale" or "weights".
    times : (k,) seconds, ascending.
    values : (k, 3, width) in-tangent, value and out-tangent at each key; tangents are 0 where there are none.
    way : "LINEAR", "STEP" or "CUBICSPLINE".
    """

    node: int
    path: str
    times: Array
    values: Array
    way: str

    def at(self, seconds: float) -> Array:
        """Value (width,); before the first key and after the last it holds."""
        # A step comes with its frame, although the key's time is in single precision.
        late = SAME_TIME if self.way == "STEP" else 0.0
        after = int(np.searchsorted(self.times, seconds + late, side="right"))
        if after == 0 or after == len(self.times) or self.way == "STEP":
            return self._whole(self.values[max(after - 1, 0), 1])
        low, high = self.values[after - 1], self.values[after]
        step = self.times[after] - self.times[after - 1]
        t = (seconds - self.times[after - 1]) / step
        if self.way == "CUBICSPLINE":
            return self._whole(
                (2 * t**3 - 3 * t**2 + 1) * low[1]
                + step * (t**3 - 2 * t**2 + t) * low[2]
                + (3 * t**2 - 2 * t**3) * high[1]
                + step * (t**3 - t**2) * high[0]
            )
        if self.path == "rotation":
            return _slerp(self._whole(low[1]), self._whole(high[1]), t)
        return self._whole((1 - t) * low[1] + t * high[1])

    def _whole(self, value: Array) -> Array:
        """A rotation with length 1."""
        if self.path != "rotation":
            return value
        unit: Array = value / max(float(np.linalg.norm(value)), 1e-12)
        return unit


@attrs.frozen(eq=False)
class Animation:
    """The channels of one animation, and the frames it is sampled at.

    Attributes
    ----------
    start : seconds of frame 0. fps : frames a second. count : frames.
    even : whether the file's keys, or the file itself, say that rate.
    """

    name: str
    channels: tuple[Channel, ...]
    start: float
    fps: Fraction
    count: int
    even: bool

    def seconds(self, frame: int) -> float:
        """When a frame is shown, in the file's time."""
        return self.start + float(frame / self.fps)


def read_animation(gltf: Gltf) -> Animation | None:
    """The first animation that moves a node or a morph target; None where there is none.

    Raises
    ------
    InputError
        Key times that do not ascend or last for hours.
    ValueError, KeyError, IndexError, TypeError
        The file is damaged.
    """
    for number, entry in enumerate(gltf.items("animations")):
        channels = tuple(_channels(gltf, entry))
        if channels:
            return _timed(gltf, str(entry.get("name") or f"animation {number + 1}"), channels)
    return None


def keep_animation(gltf: Gltf, wanted: str | None) -> str:
    """Leave one of a file's animations, the first if none is wanted; gives a sentence where others were there.

    Parameters
    ----------
    wanted : its name, or its number from 1.

    Raises
    ------
    InputError
        There is none, or there are several, of that name.
    """
    entries = gltf.tree.get("animations")
    if not isinstance(entries, list) or not entries or not all(isinstance(entry, dict) for entry in entries):
        if wanted is None:
            return ""
        raise InputError(f"The file {gltf.name} has no animation to choose: add it without naming one.")
    names = [str(entry.get("name") or f"animation {number}") for number, entry in enumerate(entries, start=1)]
    listed = ", ".join(names[:MOST_NAMED]) + (", ..." if len(names) > MOST_NAMED else "")
    # Those that move nothing here (lights, cameras' lenses) are not played unless asked for.
    chosen = [k for k, entry in enumerate(entries) if _moves_something(entry)][:1] or [0]
    if wanted is not None:
        chosen = [k for k, name in enumerate(names) if name == wanted]
        chosen = chosen or [k for k, name in enumerate(names) if name.lower() == wanted.lower()]
        if not chosen and wanted.isdecimal() and 1 <= int(wanted) <= len(names):
            chosen = [int(wanted) - 1]
        if not chosen:
            raise InputError(f"The file {gltf.name} has no animation {wanted}: it has {listed}.")
        if len(chosen) > 1:
            numbers = " and ".join(str(k + 1) for k in chosen)
            raise InputError(
                f"The file {gltf.name} has {len(chosen)} animations called {wanted}: name one by its number, {numbers}."
            )
    gltf.tree["animations"] = [entries[chosen[0]]]
    if wanted is not None or len(names) == 1:
        return ""
    taken = names[chosen[0]]
    return f"{gltf.name} has {len(names)} animations ({listed}): {taken} is taken; name another one when adding it."


def keys_are_frames(gltf: Gltf, sampler: dict[str, Any]) -> bool:
    """Whether a sampler's keys are the frames themselves: at a stated or an even rate, with nothing curved between."""
    if sampler.get("interpolation", "LINEAR") not in ("LINEAR", "STEP"):
        return False
    times = gltf.accessor(sampler["input"])[:, 0].astype(np.float64)
    return _stated(gltf) is not None or _even_rate(times) is not None


def _moves_something(entry: dict[str, Any]) -> bool:
    try:
        targets = [channel["target"] for channel in entry["channels"]]
        return any(target.get("node") is not None and target["path"] in (*WIDTHS, "weights") for target in targets)
    except (KeyError, TypeError, AttributeError):
        return True


def _channels(gltf: Gltf, entry: dict[str, Any]) -> list[Channel]:
    found = []
    for channel in entry["channels"]:
        node, path = channel["target"].get("node"), channel["target"]["path"]
        if node is None or path not in (*WIDTHS, "weights"):
            continue  # extensions move other things, such as lights
        sampler = entry["samplers"][channel["sampler"]]
        times = gltf.accessor(sampler["input"])[:, 0].astype(np.float64)
        if not len(times) or not np.isfinite(times).all() or (np.diff(times) <= 0).any():
            raise InputError(f"The file {gltf.name} has key frames whose times do not ascend: export it again.")
        way = sampler.get("interpolation", "LINEAR")
        raw = gltf.accessor(sampler["output"]).astype(np.float64)
        width = WIDTHS.get(path) or raw.size // (len(times) * (3 if way == "CUBICSPLINE" else 1))
        if way == "CUBICSPLINE":
            values = raw.reshape(len(times), 3, width)
        elif way in ("LINEAR", "STEP"):
            values = np.zeros((len(times), 3, width))
            values[:, 1] = raw.reshape(len(times), width)
        else:
            raise ValueError("interpolation")
        if not 0 <= node < len(gltf.items("nodes")):
            raise IndexError("node")
        found.append(Channel(node, path, times, values, way))
    return found


def _timed(gltf: Gltf, name: str, channels: tuple[Channel, ...]) -> Animation:
    times = np.unique(np.concatenate([channel.times for channel in channels]))
    span = float(times[-1] - times[0])
    found = _stated(gltf) or _even_rate(times)
    fps = found or RATE
    # A frame less than a hundredth beyond the last key is that key: times are single precision.
    count = int(span * float(fps) + 0.01) + 1 if span * float(fps) < LONGEST else LONGEST + 1
    if count > LONGEST:
        raise InputError(f"The animation of {gltf.name} lasts {span:.0f} seconds: cut it before it is exported.")
    return Animation(name, channels, float(times[0]), fps, count, found is not None)


def _stated(gltf: Gltf) -> Fraction | None:
    """The rate a file of our own states."""
    extras = gltf.tree["asset"].get("extras", {})
    try:
        rate = Fraction(extras["fps"])
    except (TypeError, ValueError, KeyError, ZeroDivisionError):
        return None
    return rate if 0 < rate <= 1000 else None


def _even_rate(times: Array) -> Fraction | None:
    """The rate at which all key times are frames, None where there is no likely one."""
    steps = np.diff(times)
    steps = steps[steps > SAME_TIME]
    if not len(steps):
        return None
    span = times[-1] - times[0]
    rate = round(span / steps.min()) / span
    places = (times - times[0]) * rate
    if not SLOWEST <= rate <= FASTEST or np.abs(places - places.round()).max() > 0.05:
        return None
    for neat in (Fraction(round(rate)), Fraction(round(rate * 1.001) * 1000, 1001)):
        if abs(float(neat) - rate) < 1e-4 * rate:
            return neat
    return Fraction(rate).limit_denominator(1001)


def _slerp(low: Array, high: Array, t: float) -> Array:
    """From one unit quaternion to another, by the shorter way."""
    cosine = float(low @ high)
    if cosine < 0:
        high, cosine = -high, -cosine
    angle = np.arccos(min(cosine, 1.0))
    if angle < 1e-6:
        between = (1 - t) * low + t * high
    else:
        between = (np.sin((1 - t) * angle) * low + np.sin(t * angle) * high) / np.sin(angle)
    unit: Array = between / np.linalg.norm(between)
    return unit
