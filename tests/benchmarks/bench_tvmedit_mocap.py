"""Figures of a database of several takes of one body: motion capture of a walk, a run, kicks and bows, meshed anew."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import tvmedit
from tests.benchmarks.carried import blended_cuts, worst_steps
from tests.benchmarks.record import Recorder
from tests.realdata.mocap import performed

pytestmark = [pytest.mark.bench, pytest.mark.realdata]


def test_joints_at_cuts_of_mocap(bench: Recorder, shared_data: Path) -> None:
    """Walk twice, run, walk, kicks, bow: joints at the cuts, and how far the performer turns there."""
    takes = [performed(shared_data / "mocap" / f"{name}.bvh") for name in ("walk", "run", "kick", "bow")]
    analyses = [
        # The run is one short pass: that it repeats is the user's word.
        tvmedit.analyse(take.meshes(), fps=take.fps, height=1.75, structure={"force_cyclic": take.name == "run"})
        for take in takes
    ]
    graph = tvmedit.motion_graph(analyses)
    kick = max(
        (k for k, n in enumerate(graph.nodes) if n.sequence == 2 and n.cyclic), key=lambda k: len(graph.nodes[k])
    )
    bow = next(k for k, n in enumerate(graph.nodes) if n.sequence == 3)
    performance = tvmedit.compose(graph, [0, 1, 0, kick, bow], repeats={0: 2})

    def mesh_of(sequence: int, frame: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        return takes[sequence].mesh(frame)

    def joints_of(sequence: int, frame: int) -> np.ndarray:
        return takes[sequence].joints[frame]

    blends = blended_cuts(graph, performance, mesh_of)
    placed, blended = worst_steps(graph, performance, joints_of, mesh_of, blends)
    filmed = np.array([joints_of(int(s), int(f)) for s, f in performance.frames])
    steps = np.linalg.norm(np.diff(filmed, axis=0), axis=2).mean(axis=1)
    at = [cut.position - 1 for cut in performance.cuts]
    note = f"{len(at)} joints of {len(performance)} frames, {sum(bool(b.shapes) for b in blends)} of {len(blends)} cuts"
    bench.record(
        "tvm mocap, joint step at cuts over the largest within motions",
        placed,
        asked=1.2,
        baseline=float(steps[at].max() / np.delete(steps, at).max()),
        baseline_name="as filmed",
        note=f"{note} blended: {blended:.2f}",
    )
    turned = max(seam.turned for seam in tvmedit.seam_scores(graph, performance))
    bench.record("tvm mocap, largest turn at a cut", np.degrees(turned), asked=120, unit="degrees")
