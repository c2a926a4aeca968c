"""How long points, camera path and ground serve while the character moves on."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from app.window.character.surroundings import Surroundings

POINTS, CENTRES = np.arange(30.0).reshape(10, 3), np.arange(9.0).reshape(3, 3)


def asked(**changes: Any) -> dict[str, Any]:
    """What is asked for, but for what is changed; arrays are copies, as results read again are."""
    same = {"points": POINTS.copy(), "centres": CENTRES.copy(), "ground": 0.5, "middle": np.zeros(3), "radius": 2.0}
    return {**same, **changes}


@pytest.mark.parametrize("changes", [{}, {"middle": np.array([0.4, 0.2, 0.0])}, {"radius": 2.3}, {"radius": 1.7}])
def test_a_step_leaves_it_standing(changes: dict[str, Any]) -> None:
    """A character that moves or stretches a little needs nothing laid anew."""
    assert Surroundings(**asked(), near=POINTS).serves(**asked(**changes))


@pytest.mark.parametrize(
    "changes",
    [
        {"middle": np.array([0.6, 0.0, 0.0])},
        {"radius": 2.5},
        {"radius": 1.6},
        {"ground": 0.6},
        {"points": POINTS + 1e-9},
        {"centres": CENTRES[:2]},
    ],
)
def test_what_is_no_longer_true_is_laid_anew(changes: dict[str, Any]) -> None:
    """Another solution with as many points is another one, too."""
    assert not Surroundings(**asked(), near=POINTS).serves(**asked(**changes))
