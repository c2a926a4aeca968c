"""Figures of structure on generated sequences of unseen seeds: boundaries, false boundaries, textons, and scale."""

from __future__ import annotations

import os
import time
import tracemalloc
from collections.abc import Iterable

import numpy as np
import pytest

import tvmedit
from resources.performer import (
    MOTIONS,
    Capture,
    Part,
    body_capsules,
    body_mesh,
    broken_capture,
    capture_options,
    drifting,
    perform,
    random_script,
    similar_script,
    single,
)
from tests.benchmarks.record import Recorder, cpu_seconds
from tvmedit.features import CylinderHistograms, Features, frame_features, hann_taps, yaw_free_atom_distances
from tvmedit.features.cylinder import cylinder_histogram
from tvmedit.features.measure import foot_cue, surface_samples, vertex_areas
from tvmedit.structure import Agreement, Structure, texton_errors

Pair = tuple[Capture, Structure, Structure]
MORE = int(os.environ.get("BENCH_MORE", "1"))
"""How many times as many sequences; the seeds of the first stay the same."""


def both(capture: Capture) -> Pair:
    """Structure by this engine and as printed, from the same meshes."""
    meshes = list(capture.meshes())
    ours = tvmedit.analyse(meshes, fps=capture.fps).structure
    features = frame_features([vertices for vertices, _ in meshes], method="paper")
    atoms = tvmedit.atom_distances(tvmedit.frame_distances(features))
    return capture, ours, tvmedit.parse_structure(atoms, fps=capture.fps, method="paper")


def pooled(pairs: Iterable[Pair], which: int, seconds: float | None = None) -> Agreement:
    """Agreement over several sequences within 5 frames, or within some seconds."""
    total = Agreement(0, 0, 0)
    for pair in pairs:
        tolerance = 5 if seconds is None else seconds * pair[0].fps
        total += tvmedit.compare_boundaries(pair[which].boundaries, pair[0].boundaries, tolerance=tolerance)
    return total


def right_textons(pairs: Iterable[Pair], which: int) -> tuple[float, int]:
    """Share within max(10 %, one frame), standing still left out: nobody sees its period."""
    good: list[bool] = []
    for pair in pairs:
        capture = pair[0]
        for error, step in _errors(capture, pair[which]):
            good.append(abs(error) <= max(0.1, step))
    return float(np.mean(good)) if good else 0.0, len(good)


def _errors(capture: Capture, structure: Structure) -> np.ndarray:
    standing = np.array([name == "stand" for name in capture.names])[capture.part]
    part = np.where(standing, -1 - np.arange(len(capture)), capture.part)
    return texton_errors(structure, part, capture.phase)


@pytest.mark.bench
@pytest.mark.timeout(1800)
def test_boundaries_and_textons_of_unseen_sequences(bench: Recorder) -> None:
    """Random scripts, clean and hard."""
    everything = []
    for name, hard, asked in (("clean", False, 0.97), ("hard", True, 0.92)):
        seeds = range(71_000 + 500 * hard, 71_000 + 500 * hard + 7 * MORE)
        pairs = [both(perform(random_script(seed), **capture_options(seed), hard=hard)) for seed in seeds]
        ours, printed = pooled(pairs, 1), pooled(pairs, 2)
        late = pooled(pairs, 1, 0.4).f_score
        note = f"{len(pairs)} sequences, {ours.labelled} boundaries; within 0.4 s {late:.3f}"
        bench.record(
            f"tvm boundaries, F within 5 frames, {name}",
            ours.f_score,
            asked=asked,
            better="higher",
            baseline=printed.f_score,
            baseline_name="as printed",
            note=note,
        )
        everything += pairs
    share, count = right_textons(everything, 1)
    bench.record(
        "tvm textons within 10 % or one frame",
        share,
        asked=0.95,
        better="higher",
        baseline=right_textons(everything, 2)[0],
        baseline_name="as printed",
        note=f"{count} textons",
    )


@pytest.mark.bench
@pytest.mark.timeout(1800)
def test_stress_sets(bench: Recorder) -> None:
    """One-shot actions between cycles, motions of one family side by side, broken meshes."""
    sets = {
        "one-shot actions": lambda seed: perform(
            random_script(seed, motions=4, one_shot=True), **capture_options(seed)
        ),
        "similar motions": lambda seed: perform(similar_script(seed), **capture_options(seed)),
        "broken meshes": broken_capture,
    }
    for number, (name, make) in enumerate(sets.items()):
        pairs = [both(make(72_000 + 100 * number + k)) for k in range(4 * MORE)]
        ours = pooled(pairs, 1, 0.4)
        bench.record(
            f"tvm boundaries, F within 0.4 s, {name}",
            ours.f_score,
            asked=0.97,
            better="higher",
            baseline=pooled(pairs, 2, 0.4).f_score,
            baseline_name="as printed",
            note=f"{len(pairs)} sequences, {ours.labelled} boundaries",
        )


@pytest.mark.bench
@pytest.mark.timeout(1800)
def test_false_boundaries_of_single_motions(bench: Recorder) -> None:
    """Twelve walks and runs, half of them turning, a third hard; fifteen varied or drifting motions."""
    gaits = [
        both(single(73_000 + k, ("walk", "run")[k % 2], hard=k % 3 == 0, turning=0.6 if k % 4 > 1 else None))
        for k in range(12)
    ]
    names = [name for name in MOTIONS if name != "stand"]
    varied = [
        both(single(73_100 + k, names[(5 * k) % 13], amplitude_spread=0.12, period_spread=0.10)) for k in range(8)
    ]
    varied += [both(drifting(73_200 + k, names[(7 * k + 1) % 13])) for k in range(7)]
    for name, pairs, asked in (("12 walks and runs", gaits, 0), ("15 varied and drifting", varied, 2)):
        bench.record(
            f"tvm false boundaries, {name}",
            pooled(pairs, 1).found,
            asked=asked,
            baseline=pooled(pairs, 2).found,
            baseline_name="as printed",
        )


@pytest.mark.bench
@pytest.mark.timeout(1800)
def test_two_thousand_frames(bench: Recorder) -> None:
    """Features a frame at 15,000 vertices, the matrix of 2,000 frames at 30 fps, its segmentation, memory."""
    capture = perform([Part("walk", 1)], fps=10, seed=74_000)
    vertices, faces, _ = body_mesh(body_capsules(capture.joints[3]), cell=0.0131)

    def describe() -> None:
        areas, _ = vertex_areas(vertices, faces)
        x, y = (float(areas @ vertices[:, k] / areas.sum()) for k in range(2))
        np.partition(vertices[:, 2], (70, len(vertices) - 70))
        cylinder_histogram(vertices, areas, x, y, 0.0, 1.75)

    def whole() -> None:
        describe()
        foot_cue(vertices, vertex_areas(vertices, faces)[0], 0.0, 1.75)
        surface_samples(vertices, faces, 600)

    def printed() -> None:
        shifted = vertices - vertices.mean(axis=0)
        r = np.linalg.norm(shifted, axis=1)
        np.histogram(r, 35)
        np.histogram(np.arctan2(shifted[:, 1], shifted[:, 0]), 36)
        np.histogram(np.arccos(np.clip(shifted[:, 2] / r, -1, 1)), 18)

    whole()
    bench.record(
        "tvm features of a frame of 15k vertices",
        1e3 * cpu_seconds(describe, 15),
        asked=2.0,
        unit="ms",
        baseline=1e3 * cpu_seconds(printed, 15),
        baseline_name="eq. 1 with numpy.histogram",
        note=f"{len(vertices)} vertices; with heading cue and samples {1e3 * cpu_seconds(whole, 15):.2f} ms",
    )
    features = _long_features()
    taps = hann_taps(30)
    start = time.process_time()
    atoms = yaw_free_atom_distances(features, taps)
    spent = time.process_time() - start
    # The process's own high-water mark may stem from an earlier test: count what this call allocates.
    tracemalloc.start()
    yaw_free_atom_distances(features, taps)
    grown = tracemalloc.get_traced_memory()[1] / 2**20
    tracemalloc.stop()
    start = time.process_time()
    yaw_free_atom_distances(features, taps, harmonics=5, yaws=24)
    preview = time.process_time() - start
    bench.record(
        "tvm matrix of 2,000 frames",
        spent,
        asked=6.0,
        unit="s",
        baseline=preview,
        baseline_name="preview of 5 harmonics",
        note="one thread, K = 7",
    )
    bench.record("tvm matrix of 2,000 frames, memory above the start", grown, asked=600, unit="MB")
    tvmedit.parse_structure(atoms[:300, :300], fps=30)
    start = time.process_time()
    tvmedit.parse_structure(atoms, fps=30)
    ours = time.process_time() - start
    start = time.process_time()
    tvmedit.parse_structure(atoms, fps=30, method="paper")
    bench.record(
        "tvm segmentation of 2,000 frames",
        ours,
        asked=0.5,
        unit="s",
        baseline=time.process_time() - start,
        baseline_name="as printed",
    )


def _long_features() -> Features:
    """Two thousand frames made of a short sequence played to and fro with noise."""
    short = perform([Part("walk", 3), Part("squat", 2)], fps=30, seed=74_001)
    robust = CylinderHistograms()
    for vertices, faces in short.meshes():
        robust.add(vertices, faces)
    features = robust.features()
    rows = np.abs((np.arange(2000) % (2 * len(short) - 2)) - (len(short) - 1))
    noise = np.random.default_rng(0).random((2000, *features.parts), np.float32)
    histograms = features.histograms[rows] + 0.01 * noise
    histograms /= np.sqrt((histograms**2).sum(axis=(1, 2, 3), keepdims=True))
    return Features("robust", histograms, features.parts, features.origin, features.height)
