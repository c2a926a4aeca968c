"""Motions in a row: phases that vary from repeat to repeat, and transitions in which both motions run."""

from __future__ import annotations

from collections.abc import Callable, Container, Mapping, Sequence

import attrs
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@attrs.frozen
class Part:
    """One motion of a script: its name, how often it is repeated, and how its speed changes over the part."""

    motion: str
    repeats: float = 4
    speed_up: float = 1.0


def phases(
    part: Part,
    period: float,
    rate: float,
    random: np.random.Generator,
    period_sd: float,
    amplitude_sd: float,
) -> tuple[Array, Array]:
    """Phase and amplitude of one part at each step; amplitudes run smoothly from repeat to repeat.

    Parameters
    ----------
    period : float
        Seconds a repeat.
    rate : float
        Steps a second.
    """
    cycles = int(np.ceil(part.repeats)) + 2
    periods = period * np.exp(period_sd * random.standard_normal(cycles))
    periods /= part.speed_up ** np.linspace(0.0, 1.0, cycles)
    knots = np.exp(amplitude_sd * random.standard_normal(cycles + 1))
    starts = np.r_[0.0, np.cumsum(periods)]
    length = float(np.interp(part.repeats, np.arange(cycles + 1), starts))
    times = np.arange(max(2, round(length * rate))) / rate
    phase = np.interp(times, starts, np.arange(cycles + 1))
    return phase + random.random(), np.interp(phase, np.arange(cycles + 1), knots)


def laid_out(
    script: Sequence[Part],
    tracks: list[tuple[Array, Array]],
    gaps: list[int],
    pose_of: Callable[[str, float, float], Array],
    *,
    travelling: Container[str],
    turning: Mapping[str, slice],
) -> tuple[Array, NDArray[np.int64], Array, Array, list[int]]:
    """Lay the parts one after another, both motions running through each transition.

    Parameters
    ----------
    tracks : list of (phase, amplitude)
        What ``phases`` gives for each part.
    gaps : list of int
        Steps of each transition.
    pose_of : callable
        (motion, phase, amplitude) to pose values (v,).
    travelling : container of str
        Motions that move on over the ground.
    turning : mapping of str to slice
        Motions with pose values that grow by a whole turn a period, and which.

    Returns
    -------
    poses (n, v), part (n,), phase (n,), travel (n,) share of travelling, first step of every part but the first
    """
    total = sum(len(phase) for phase, _ in tracks)
    poses, weights = np.zeros((total, len(pose_of(script[0].motion, 0.0, 1.0)))), np.zeros(total)
    part, phase_of, travel = np.zeros(total, np.int64), np.zeros(total), np.zeros(total)
    middles, first = [], 0
    for index, (item, (phase, amplitude)) in enumerate(zip(script, tracks, strict=True)):
        last = first + len(phase)
        before = gaps[index - 1] // 2 if index else 0
        after = gaps[index] // 2 if index < len(gaps) else 0
        step = np.arange(max(0, first - before), min(total, last + after))
        speed_in, speed_out = phase[1] - phase[0], phase[-1] - phase[-2]
        local = step - first
        run = np.interp(local, np.arange(len(phase)), phase)
        run += np.minimum(local, 0) * speed_in + np.maximum(local - len(phase) + 1, 0) * speed_out
        size = np.interp(local, np.arange(len(phase)), amplitude)
        rise = smoothstep((local + before) / max(1, 2 * before)) if before else np.ones(len(step))
        fall = smoothstep((len(phase) + after - local) / max(1, 2 * after)) if after else np.ones(len(step))
        weight = rise * fall
        rows = np.array([pose_of(item.motion, p, a) for p, a in zip(run, size, strict=True)])
        if item.motion in turning:
            # Within a transition the arm must not wind through a whole turn: count turns from its middle.
            turns = np.floor(run)
            for near in ((before, 0), (after, len(phase))):
                if near[0]:
                    inside = np.abs(local - near[1]) <= near[0]
                    centre = np.round(np.interp(near[1], local, run))
                    rows[inside, turning[item.motion]] += (2 * np.pi * (turns - centre))[inside, None]
        poses[step] += weight[:, None] * rows
        weights[step] += weight
        travel[step] += weight * (item.motion in travelling)
        part[first:last], phase_of[first:last] = index, phase
        if index:
            middles.append(first)
        first = last
    return poses / weights[:, None], part, phase_of, travel / weights, middles


def smoothstep(x: Array) -> Array:
    """From 0 to 1 without speed at both ends."""
    inside = np.clip(x, 0.0, 1.0)
    return inside * inside * (3.0 - 2.0 * inside)


def low_pass(noise: Array, width: float) -> Array:
    """Gaussian low-pass of white noise, scaled back to unit variance."""
    from scipy.ndimage import gaussian_filter1d

    smooth = gaussian_filter1d(noise, width / 2.5, mode="reflect")
    spread = float(np.sqrt(2 * np.sqrt(np.pi) * width / 2.5))
    return np.asarray(smooth * spread)
