"""Stages of one sequence: what one pass over its meshes leaves, distances, motions."""

from __future__ import annotations

from typing import Any

import numpy as np

from app.model.document import Document
from app.model.performance import CapturedSequence
from app.stages.context import Context
from app.stages.performance.footage import Footage, needs_of, open_footage, source_of
from app.stages.performance.results import Distances, Measured, Statistics
from app.stages.stage import Stage


def features(document: Document, sequence: CapturedSequence) -> Stage:
    """What one pass over the meshes leaves: features, headings, surface samples, statistics.

    All sequences are measured with one body height: the user's, or that of the first sequence.
    """
    choice = document.performance
    first = document.sequences[0]
    lead = choice.height is None and sequence.id != first.id
    needs = needs_of(document, sequence)
    if lead:
        needs = (*needs, features(document, first))
    inputs = (source_of(document, sequence), choice.features, choice.height, lead)
    weight = 0.004 * sequence.frame_count + 0.5
    return Stage(
        f"features/{sequence.id}", f"Reading {sequence.name}", _features, inputs, needs, version=2, weight=weight
    )


def distances(document: Document, sequence: CapturedSequence) -> Stage:
    """Frame and atom distances (eq. 2 and 5)."""
    needs = (features(document, sequence),)
    weight = 2e-6 * sequence.frame_count**2 + 0.2
    return Stage(f"distances/{sequence.id}", f"Comparing {sequence.name}", _distances, (), needs, weight=weight)


def structure(document: Document, sequence: CapturedSequence) -> Stage:
    """Motions of a sequence: clusters and textons; inside the user's boundaries where there are any."""
    choice = sequence.structure
    inputs = (
        choice.method,
        choice.beta,
        choice.longest_period,
        choice.sensitivity,
        choice.force_cyclic,
        choice.boundaries,
        sequence.fps,
    )
    needs = (distances(document, sequence),)
    label = f"Finding motions of {sequence.name}"
    return Stage(f"structure/{sequence.id}", label, _structure, inputs, needs, version=4, weight=0.3)


def analysis(document: Document, sequence: CapturedSequence) -> Stage:
    """All that the graph needs to know of a sequence; put together, so not kept again."""
    needs = (features(document, sequence), distances(document, sequence), structure(document, sequence))
    inputs = (sequence.front,)
    label = f"Knowing {sequence.name}"
    return Stage(f"analysis/{sequence.id}", label, _analysis, inputs, needs, stored=False, weight=0.01)


def _features(context: Context, inputs: tuple[Any, ...], *results: Any) -> Measured:
    from tvmedit.measuring import measure

    source, method, height, lead = inputs
    if lead:
        *rest, first = results
        results, height = tuple(rest), first.measurement.height
    footage = open_footage(context.media, source, results)
    counter = _Counter(footage)
    measurement = measure(
        counter, fps=source.fps, method=method, height=height, count=len(footage), progress=context.progress
    )
    return Measured(measurement, counter.statistics(source.fps, measurement.height))


def _distances(context: Context, inputs: tuple[()], measured: Measured) -> Distances:
    from tvmedit.analysis import compare

    frames, atoms = compare(measured.measurement, progress=context.progress)
    return Distances(frames, atoms)


def _structure(context: Context, inputs: tuple[Any, ...], found: Distances) -> Any:
    from tvmedit import parse_structure

    method, beta, longest, sensitivity, cyclic, boundaries, fps = inputs
    context.progress(0.0)
    return parse_structure(
        found.atoms,
        method=method,
        beta=beta,
        fps=fps,
        longest_period=longest,
        sensitivity=sensitivity,
        force_cyclic=cyclic,
        boundaries=boundaries,
    )


def _analysis(context: Context, inputs: tuple[float | None], measured: Measured, found: Distances, parsed: Any) -> Any:
    from tvmedit.analysis import joined

    (front,) = inputs
    facing = measured.measurement.facing(None if front is None else float(np.deg2rad(front)))
    return joined(facing, found.frames, found.atoms, parsed)


class _Counter:
    """Hands the meshes on, and counts what passes."""

    def __init__(self, footage: Footage) -> None:
        self.footage = footage
        self.vertices: list[int] = []
        self.faces: list[int] = []
        self.coloured = self.textured = 0
        self.low, self.high = np.full(3, np.inf), np.full(3, -np.inf)

    def __iter__(self) -> Any:
        from tvmedit.features.measure import extent

        for mesh in self.footage:
            self.vertices.append(len(mesh.vertices))
            self.faces.append(len(mesh.faces))
            self.coloured += mesh.colours is not None
            self.textured += mesh.texture is not None
            if len(mesh.vertices):
                low, high = extent(mesh.vertices)
                self.low, self.high = np.minimum(self.low, low), np.maximum(self.high, high)
            yield mesh.vertices, mesh.faces

    def statistics(self, fps: float, height: float) -> Statistics:
        return Statistics(
            frames=len(self.vertices),
            seconds=len(self.vertices) / fps,
            vertices=(min(self.vertices), int(np.median(self.vertices)), max(self.vertices)),
            faces=(min(self.faces), int(np.median(self.faces)), max(self.faces)),
            moving=self.footage.moving,
            coloured=self.coloured,
            textured=self.textured,
            low=tuple(float(value) for value in self.low),
            high=tuple(float(value) for value in self.high),
            height=height,
        )
