"""Scripts and settings of whole sets of captures, each drawn from a seed."""

from __future__ import annotations

from typing import Any

import numpy as np

from resources.performer.motions import MOTIONS
from resources.performer.script import Part
from resources.performer.sequence import Capture, perform

ONE_SHOT = ("kick", "squat", "bend", "side bend", "jumping jack")
FAMILIES = (("walk", "march"), ("wave", "wave both"), ("punch", "march"), ("bend", "squat"), ("twist", "side bend"))
RATES = (10.0, 15.0, 25.0, 30.0)


def random_script(seed: int, *, motions: int | None = None, one_shot: bool = False) -> list[Part]:
    """Four to six motions in random order, three to eight repeats each; with one-shot actions between them if asked."""
    random = np.random.default_rng([seed, 1])
    count = int(random.integers(4, 7)) if motions is None else motions
    names = list(random.permutation([name for name in MOTIONS if not (one_shot and name in ONE_SHOT)])[:count])
    script: list[Part] = []
    for name in names:
        if one_shot and script:
            script.append(Part(str(random.choice(ONE_SHOT)), 1.0))
        repeats = random.uniform(0.7, 1.4) if name == "stand" else float(random.integers(3, 9))
        script.append(Part(str(name), repeats))
    return script


def similar_script(seed: int) -> list[Part]:
    """Neighbours of one family, which look alike."""
    random = np.random.default_rng([seed, 2])
    pairs = [FAMILIES[int(k)] for k in random.permutation(len(FAMILIES))[:3]]
    return [Part(name, float(random.integers(3, 7))) for pair in pairs for name in pair]


def single(seed: int, name: str, **options: Any) -> Capture:
    """One motion alone, eight to fourteen times."""
    random = np.random.default_rng([seed, 3])
    settings = {"fps": float(random.choice(RATES)), "seed": seed} | options
    return perform([Part(name, float(random.integers(8, 15)))], **settings)


def drifting(seed: int, name: str, *, speed_up: float = 1.7, **options: Any) -> Capture:
    """One motion alone that grows faster."""
    random = np.random.default_rng([seed, 4])
    settings = {"fps": float(random.choice(RATES)), "seed": seed} | options
    return perform([Part(name, float(random.integers(10, 15)), speed_up=speed_up)], **settings)


def broken_capture(seed: int) -> Capture:
    """Missing limbs, stray blobs, 12 mm noise and a performer who turns at up to 1.2 rad/s."""
    options = capture_options(seed)
    return perform(random_script(seed), **options, hard=True, noise=0.012, turning=1.2, broken=True)


def capture_options(seed: int) -> dict[str, Any]:
    """Frame rate and seed of a capture."""
    return {"fps": float(np.random.default_rng([seed, 5]).choice(RATES)), "seed": seed}
