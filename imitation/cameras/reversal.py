"""The right way round: weak perspective leaves a second explanation of a clip, with near and far exchanged.

Seen from far away with a long lens, a scene and its mirror image in depth, each with a camera that turns the other way,
give nearly the same pictures (the Necker reversal). An adjustment that begins in the wrong one stays there; only the
small perspective that is left tells which of the two fits better.
"""

from __future__ import annotations

from collections.abc import Callable

import attrs
import numpy as np

from imitation.cameras.adjust import Bundle, adjust

FLIP = np.diag([1.0, 1.0, -1.0])
TRIAL_STEPS = 12
HOPEFUL = 2.0
"""A trial whose median error is still this many times the found one's after some steps is not worth finishing."""
BETTER = 0.95
KEPT = 0.75


def reversed_bundle(bundle: Bundle) -> Bundle:
    """The same pictures with near and far exchanged about the middle of the points, exact for an infinite lens."""
    middle = np.median(bundle.points, axis=0)
    R = FLIP @ bundle.R @ FLIP
    T = bundle.R @ middle + bundle.T
    return attrs.evolve(bundle, R=R, T=T, points=(bundle.points - middle) @ FLIP)


def right_way_round(bundle: Bundle, finish: Callable[[Bundle], Bundle], *, free_focal: bool) -> Bundle:
    """Give the bundle, or its reversal where that explains what was seen better.

    Parameters
    ----------
    bundle : adjusted. finish : adjusts a bundle to the end.
    """
    trial = reversed_bundle(bundle)
    found = float(np.median(bundle.errors()))
    scale = float(np.clip(2.5 * found, 0.25, 1.5))
    trial = adjust(trial, loss=max(4 * scale, 2.0), free_focal=free_focal, iterations=TRIAL_STEPS)
    if not float(np.median(trial.errors())) < HOPEFUL * max(found, 0.05):
        return bundle
    trial = finish(trial)
    # The reversal loses points that were found under the other geometry, so costs are compared a sighting.
    if len(trial.camera) < KEPT * len(bundle.camera) or _cost(trial, scale) > BETTER * _cost(bundle, scale):
        return bundle
    return trial


def _cost(bundle: Bundle, scale: float) -> float:
    return float(np.mean(np.log1p((bundle.errors() / scale) ** 2)))
