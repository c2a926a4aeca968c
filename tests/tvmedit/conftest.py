"""One small performance, analysed once."""

from __future__ import annotations

import pytest

import tvmedit
from resources.performer import Capture, Part, perform


@pytest.fixture(scope="session")
def capture() -> Capture:
    """Squats, kicks and a walk, 15 frames a second."""
    return perform([Part("squat", 3), Part("kick", 3), Part("walk", 4)], fps=15, seed=11, turning=0.4)


@pytest.fixture(scope="session")
def analysis(capture: Capture) -> tvmedit.Analysis:
    """Its robust analysis."""
    return tvmedit.analyse(capture.meshes(), fps=15)


@pytest.fixture(scope="session")
def graph(analysis: tvmedit.Analysis) -> tvmedit.MotionGraph:
    """Its motion graph."""
    return tvmedit.motion_graph([analysis])
