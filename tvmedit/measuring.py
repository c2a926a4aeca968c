"""``measure``: one pass over the meshes of a sequence, keeping what all later steps need."""

from __future__ import annotations

from collections.abc import Iterable, Sized
from typing import Any, Literal

import attrs
import numpy as np
from numpy.typing import NDArray

from imitation.errors import InputError
from imitation.progress import Progress, silent
from tvmedit.features import CylinderHistograms, Features, Method, SphericalHistograms, checked_meshes, facing
from tvmedit.features.heading import turning
from tvmedit.features.lengthwise import lengthwise_cues
from tvmedit.features.measure import foot_cue, samples_by_area
from tvmedit.features.paper import ANGLE_BIN

Array = NDArray[np.float64]
SAMPLES = 600
"""Points kept of each frame's surface, for alignment."""


@attrs.frozen(eq=False)
class Measurement:
    """What one pass over n meshes leaves, z up, in their unit.

    Attributes
    ----------
    features : Features
    headings : (n,) float64
        Where the performer faces: radians about the up axis, from +x towards +y.
    fps, height, floor, edge : float
    centres : (n, 2) float64
    samples : (n, 600, 3) float32
    up : "z" or "y"
        As in ``Analysis``.
    """

    features: Features
    headings: Array
    fps: float
    height: float
    floor: float
    centres: Array
    samples: NDArray[np.float32]
    edge: float
    up: str = "z"

    def __len__(self) -> int:
        return len(self.headings)

    def facing(self, front: float | None) -> Measurement:
        """Give the same with another front: where the performer faces in frame 0, radians; None changes nothing."""
        if front is None or not len(self.headings):
            return self
        return attrs.evolve(self, headings=self.headings + (front - self.headings[0]))


def measure(
    meshes: Iterable[tuple[Any, Any]],
    *,
    fps: float,
    up: Literal["z", "y"] = "z",
    method: Method = "robust",
    height: float | None = None,
    count: int | None = None,
    progress: Progress | None = None,
) -> Measurement:
    """Read a sequence once (paper B, section 3); the arguments are those of ``analyse``."""
    if not fps > 0 or not np.isfinite(fps):
        raise InputError(f"The frame rate is {fps}: give a positive number of frames a second.")
    if method not in ("robust", "paper"):
        raise InputError(f'The method is {method!r}: say "robust" or "paper".')
    pass_ = _Pass(height, method)
    total = count or (len(meshes) if isinstance(meshes, Sized) else 0)
    report = progress or silent
    for done, mesh in enumerate(checked_meshes(meshes, up), start=1):
        pass_.add(*mesh)
        report(min(1.0, done / total) if total else 0.5)
    if not pass_.cues:
        raise InputError("The sequence has no frames: give at least one mesh.")
    features, robust = pass_.features()
    centres = np.array(pass_.robust.centres)
    samples = np.array(pass_.samples)
    cues, turns = lengthwise_cues(samples, robust.height, fps), turning(robust.histograms)
    if cues is None:
        cues = pass_.foot_cues(robust.height)
    return Measurement(
        features=features,
        headings=facing(cues, centres, robust.height, fps, None, turns),
        fps=float(fps),
        height=robust.height,
        floor=float(robust.origin[2]),
        centres=centres,
        samples=samples,
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
        areas, running = self.robust.add(vertices, faces)
        assert running is not None
        if not self.scale:
            # The cue's bands need a body height before it is known: the first frame's own must do.
            self.scale = self.robust.height or max(self.robust.highs[-1] - self.robust.lows[-1], 1e-9)
        self.cues.append(foot_cue(vertices, areas, self.robust.lows[-1], self.scale))
        self.samples.append(samples_by_area(vertices, faces, running, SAMPLES))
        if self.printed is not None:
            self.printed.add(vertices)

    def features(self) -> tuple[Features, Features]:
        robust = self.robust.features()
        return (robust if self.printed is None else self.printed.features()), robust

    def foot_cues(self, height: float) -> Array:
        return np.array(self.cues) * (self.scale / height)
