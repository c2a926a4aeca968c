"""``analyse``: everything the graph needs to know of a sequence, from one pass over its meshes."""

from __future__ import annotations

from collections.abc import Iterable, Sized
from typing import Any, Literal

import attrs
import numpy as np
from numpy.typing import NDArray

from imitation.errors import InputError
from imitation.progress import Progress, part, silent
from tvmedit.features import (
    CylinderHistograms,
    Features,
    Method,
    SphericalHistograms,
    atom_distances,
    checked_meshes,
    facing,
    frame_distances,
    hann_taps,
    yaw_free_atom_distances,
)
from tvmedit.features.heading import turning
from tvmedit.features.measure import foot_cue, surface_samples
from tvmedit.features.paper import ANGLE_BIN
from tvmedit.structure import Structure, parse_structure

Array = NDArray[np.float64]
SAMPLES = 600
"""Points kept of each frame's surface, for alignment."""


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
    if not fps > 0 or not np.isfinite(fps):
        raise InputError(f"The frame rate is {fps}: give a positive number of frames a second.")
    if method not in ("robust", "paper"):
        raise InputError(f'The method is {method!r}: say "robust" or "paper".')
    pass_ = _Pass(height, method)
    total = count or (len(meshes) if isinstance(meshes, Sized) else 0)
    reading, comparing = part(progress, 0.0, 0.6), part(progress, 0.6, 1.0)
    for done, mesh in enumerate(checked_meshes(meshes, up), start=1):
        pass_.add(*mesh)
        reading(min(1.0, done / total) if total else 0.5)
    if not pass_.cues:
        raise InputError("The sequence has no frames: give at least one mesh.")
    features, robust = pass_.features()
    centres = np.array(pass_.robust.centres)
    headings = facing(pass_.foot_cues(robust.height), centres, robust.height, fps, front, turning(robust.histograms))
    if method == "paper":
        distances = frame_distances(features, progress=comparing)
        atoms = atom_distances(distances)
    else:
        distances = frame_distances(features, headings=headings)
        atoms = yaw_free_atom_distances(features, hann_taps(fps), harmonics=harmonics, progress=comparing)
    parsed = parse_structure(
        atoms, method="paper" if method == "paper" else "optimal", beta=beta, fps=fps, **(structure or {})
    )
    (progress or silent)(1.0)
    return Analysis(
        features=features,
        frame_distances=distances,
        atom_distances=atoms,
        headings=headings,
        structure=parsed,
        fps=float(fps),
        height=robust.height,
        floor=float(robust.origin[2]),
        centres=centres,
        samples=np.array(pass_.samples),
        edge=float(np.median(pass_.robust.edges)),
        up=up,
    )


class _Pass:
    """Collectors of one pass."""

    def __init__(self, height: float | None, method: Method) -> None:
        self.robust = CylinderHistograms(height=height)
        self.printed = (
            SphericalHistograms(origin=None, radius_bin=None, angle_bin=ANGLE_BIN) if method == "paper" else None
        )
        self.samples: list[NDArray[np.float32]] = []
        self.cues: list[Array] = []
        self.scale = 0.0

    def add(self, vertices: Array, faces: NDArray[np.int32]) -> None:
        areas = self.robust.add(vertices, faces)
        if not self.scale:
            # The cue's bands need a body height before it is known: the first frame's own must do.
            self.scale = self.robust.height or max(self.robust.highs[-1] - self.robust.lows[-1], 1e-9)
        self.cues.append(foot_cue(vertices, areas, self.robust.lows[-1], self.scale))
        self.samples.append(surface_samples(vertices, faces, SAMPLES))
        if self.printed is not None:
            self.printed.add(vertices)

    def features(self) -> tuple[Features, Features]:
        robust = self.robust.features()
        return (robust if self.printed is None else self.printed.features()), robust

    def foot_cues(self, height: float) -> Array:
        return np.array(self.cues) * (self.scale / height)
