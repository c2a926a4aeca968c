"""``analyse``: everything the graph needs to know of a sequence, from one pass over its meshes."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, Literal

import attrs
import numpy as np
from numpy.typing import NDArray

from imitation.progress import Progress, part, silent
from tvmedit.features import (
    Features,
    Method,
    atom_distances,
    frame_distances,
    hann_taps,
    yaw_free_atom_distances,
)
from tvmedit.measuring import Measurement, measure
from tvmedit.structure import Structure, parse_structure

Array = NDArray[np.float64]


@attrs.frozen(eq=False)
class Analysis:
    """What one pass over a sequence of n meshes leaves.

    Attributes
    ----------
    features : Features
    frame_distances : (n, n) float32
        Eq. 2; for "robust" with every frame turned to face one way.
    atom_distances : (n, n) float32
        Eq. 5; for "robust" least over one common turn.
    headings : (n,) float64
        Where the performer faces: radians about the up axis, from +x towards +y.
    structure : Structure
    fps : float
    height : float
        Body height in the sequence's unit.
    floor : float
        z of the ground.
    centres : (n, 2) float64
        Centroid of each frame on the ground.
    samples : (n, 600, 3) float32
        Points spread over each frame's surface, z up.
    edge : float
        Median over the frames of the mean edge length.
    up : "z" or "y"
        The up axis of the meshes; all that is kept here is z up.
    """

    features: Features
    frame_distances: NDArray[np.float32]
    atom_distances: NDArray[np.float32]
    headings: Array
    structure: Structure
    fps: float
    height: float
    floor: float
    centres: Array
    samples: NDArray[np.float32]
    edge: float
    up: str = "z"

    def __len__(self) -> int:
        return len(self.headings)


def analyse(
    meshes: Iterable[tuple[Any, Any]],
    *,
    fps: float,
    up: Literal["z", "y"] = "z",
    method: Method = "robust",
    height: float | None = None,
    front: float | None = None,
    beta: float | None = None,
    harmonics: int | None = None,
    count: int | None = None,
    structure: dict[str, Any] | None = None,
    progress: Progress | None = None,
) -> Analysis:
    """Read a sequence once and describe it (paper B, sections 3 and 4).

    Parameters
    ----------
    meshes : iterable of (vertices (v_t, 3), faces (m_t, 3))
        Frames in order, any unit; read once, none is kept.
    fps : float
        Frames a second.
    up : "z" or "y"
    method : "robust" or "paper"
        Which features, atom distances and structure.
    height : float, optional
        Body height in the meshes' unit; give the same for all sequences of one performer. Default: measured.
    front : float, optional
        Where the performer faces in frame 0, radians; turns all headings by the same angle.
    beta : float, optional
        Only "paper": threshold of eq. 8.
    harmonics : int, optional
        Azimuth harmonics of the atom distances; 5 for a preview.
    count : int, optional
        Number of frames, for the progress of a stream of unknown length.
    structure : dict, optional
        Further arguments of ``parse_structure``.
    progress : callable, optional

    Returns
    -------
    Analysis

    Raises
    ------
    InputError
        No frame, a frame that is not a mesh, or a frame rate that is not positive.
    """
    measured = measure(
        meshes, fps=fps, up=up, method=method, height=height, count=count, progress=part(progress, 0.0, 0.6)
    ).facing(front)
    distances, atoms = compare(measured, harmonics=harmonics, progress=part(progress, 0.6, 1.0))
    parsed = parse_structure(
        atoms, method="paper" if method == "paper" else "optimal", beta=beta, fps=fps, **(structure or {})
    )
    (progress or silent)(1.0)
    return joined(measured, distances, atoms, parsed)


def compare(
    measured: Measurement, *, harmonics: int | None = None, progress: Progress | None = None
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Frame distances (eq. 2) and atom distances (eq. 5) of a sequence, each (n, n) float32."""
    features = measured.features
    if features.method == "paper":
        distances = frame_distances(features, progress=progress)
        return distances, atom_distances(distances)
    distances = frame_distances(features, headings=measured.headings)
    taps = hann_taps(measured.fps)
    return distances, yaw_free_atom_distances(features, taps, harmonics=harmonics, progress=progress)


def joined(
    measured: Measurement,
    frame_distances: NDArray[np.float32],
    atom_distances: NDArray[np.float32],
    structure: Structure,
) -> Analysis:
    """Put together what was measured, compared and parsed."""
    return Analysis(
        features=measured.features,
        frame_distances=frame_distances,
        atom_distances=atom_distances,
        headings=measured.headings,
        structure=structure,
        fps=measured.fps,
        height=measured.height,
        floor=measured.floor,
        centres=measured.centres,
        samples=measured.samples,
        edge=measured.edge,
        up=measured.up,
    )
