"""Figures of performances through the program: a long capture from files, and a new mu."""

from __future__ import annotations

import os
import resource
import time
from pathlib import Path

import pytest

from app.actions import performing
from app.actions.session import Session
from app.formats.tvm import FrameMesh, open_mesh_frames, write_mesh_frames
from app.model.edits import performance
from app.model.performance import Motion
from resources.performer import Part, perform
from tests.app.captured import write_capture
from tests.benchmarks.record import Recorder

pytestmark = pytest.mark.bench
FRAMES, DISTINCT = 2000, 32


def peak() -> float:
    """Peak memory of this process, MB."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def test_a_long_capture_from_files(bench: Recorder, tmp_path: Path) -> None:
    """2,000 files of 17,000 vertices (32 different ones, linked): time a frame, memory, matrix, structure."""
    capture = perform([Part("walk", 2)], fps=16, seed=1, cell=0.0122)
    write_mesh_frames(
        tmp_path / "few", (FrameMesh(*capture.mesh(k)) for k in range(DISTINCT)), form="ply", fps=25, count=DISTINCT
    )
    files = sorted((tmp_path / "few").iterdir())
    (tmp_path / "many").mkdir()
    for frame in range(FRAMES):
        os.link(files[frame % DISTINCT], tmp_path / "many" / f"f_{frame:05d}.ply")
    session = Session.new(tmp_path / "film")
    try:
        made, _ = performing.add_sequence(session, tmp_path / "many", fps=25.0, up="z", unit=1.0)
        before, started = peak(), time.process_time()
        session.result(session.stages.features(made))
        a_frame = 1000 * (time.process_time() - started) / FRAMES
        started = time.process_time()
        session.result(session.stages.distances(made))
        matrix = time.process_time() - started
        started = time.process_time()
        session.result(session.stages.structure(made))
        structure = time.process_time() - started
        used = peak() - before
        frames = open_mesh_frames(tmp_path / "many")
        started = time.process_time()
        for frame in range(100):
            frames[frame]
        reading = 10 * (time.process_time() - started)
    finally:
        session.close()
    name = "performances: 2,000 PLY files of 17,000 vertices"
    bench.record(
        f"{name}, features a frame without reading", a_frame - reading, asked=2.0, unit="ms", baseline=reading,
        baseline_name="reading the file alone",
    )  # fmt: skip
    bench.record(
        f"{name}, features a frame with reading", a_frame, asked=2.0, unit="ms", baseline=reading,
        baseline_name="reading the file alone",
    )  # fmt: skip
    bench.record(f"{name}, matrix", matrix, asked=6.0, unit="s")
    bench.record(f"{name}, segmentation", structure, asked=0.5, unit="s")
    bench.record(
        f"{name}, memory above the start", used, asked=600.0, unit="MB", baseline=before,
        baseline_name="the process before",
    )  # fmt: skip


def test_a_new_mu(bench: Recorder, tmp_path: Path) -> None:
    """From another mu to the new path, through the stages, against building the graph again."""
    session = Session.new(tmp_path / "film")
    try:
        made, _ = performing.add_sequence(session, write_capture(tmp_path / "take.npz"))
        for frame in (10, 90, 10):
            session.apply(performance.add_key(session.document, Motion(made, frame)))
        session.result(session.stages.paths)
        spent = []
        for step in range(20):
            started = time.perf_counter()
            session.apply(performance.set_mu(session.document, 0.5 + 0.02 * step))
            session.result(session.stages.paths)
            spent.append(1000 * (time.perf_counter() - started))
        started = time.perf_counter()
        session.apply(performance.set_methods(session.document, graph="paper"))
        session.apply(performance.set_mu(session.document, 5.0))
        session.result(session.stages.paths)
        rebuilt = 1000 * (time.perf_counter() - started)
    finally:
        session.close()
    bench.record(
        "performances: mu to new path, through the stages", sorted(spent)[len(spent) // 2], asked=50.0, unit="ms",
        baseline=rebuilt, baseline_name="building the graph again",
    )  # fmt: skip
