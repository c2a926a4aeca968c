"""Several takes of one body by motion capture in one database: motions, path, placement."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import tvmedit
from tests.realdata.mocap import Mocap, performed

pytestmark = [pytest.mark.realdata, pytest.mark.slow]


@pytest.fixture(scope="module")
def takes(shared_data: Path) -> list[Mocap]:
    """A straight walk of five strides and one short pass of a run."""
    return [performed(shared_data / "mocap" / f"{name}.bvh") for name in ("walk", "run")]


def test_a_walk_and_a_run_of_one_body_are_joined(takes: list[Mocap]) -> None:
    """The walk's stride is found, both travel on, nobody turns round, and no joint jumps as it does as filmed."""
    walk, run = (
        tvmedit.analyse(take.meshes(), fps=take.fps, height=1.75, structure={"force_cyclic": take.name == "run"})
        for take in takes
    )
    (stride,) = walk.structure.clusters
    assert stride.cyclic
    assert stride.period == pytest.approx(33, abs=1)
    graph = tvmedit.motion_graph([walk, run])
    performance = tvmedit.compose(graph, [0, 1, 0], repeats={0: 2})
    placed = [performance.place(k, takes[s].joints[f]) for k, (s, f) in enumerate(performance.frames)]
    filmed = [takes[s].joints[f] for s, f in performance.frames]
    at = [cut.position - 1 for cut in performance.cuts]
    ratios = []
    for joints in (placed, filmed):
        steps = np.linalg.norm(np.diff(np.array(joints), axis=0), axis=2).mean(axis=1)
        ratios.append(steps[at].max() / np.delete(steps, at).max())
    assert ratios[0] < 1.5
    assert ratios[1] > 10
    way = np.array(placed)[:, 0, :2]
    assert np.linalg.norm(way[-1] - way[0]) > 0.8 * np.linalg.norm(np.diff(way, axis=0), axis=1).sum()
    assert max(seam.turned for seam in tvmedit.seam_scores(graph, performance)) < np.radians(20)
