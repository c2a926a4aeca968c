"""The statistics of the paper's Table 1, and what else a person wants to know of a result."""

from __future__ import annotations

from collections.abc import Mapping

import attrs
import numpy as np
from numpy.typing import ArrayLike

from imitation.motion.rays import project_points
from imitation.propagation.base import Base


@attrs.frozen(eq=False)
class Report:
    """A result in figures.

    Attributes
    ----------
    frames, vertices, faces, tracks, anchors, contacts, edited_frames, control_vertices : counts (Table 1); ``tracks``
        are the paired ones, ``contacts`` the planted intervals.
    method : "joint" or "paper".
    noise : track -> estimated jitter, pixels.
    reprojection : track -> rms distance of the key point from its transferred 2D track, pixels.
    seconds : step -> CPU seconds.
    """

    frames: int
    vertices: int
    faces: int
    tracks: int
    anchors: int
    contacts: int
    edited_frames: int
    control_vertices: int
    method: str
    noise: dict[str, float]
    reprojection: dict[str, float]
    seconds: dict[str, float]

    def as_dict(self) -> dict[str, object]:
        """Plain values, for a file."""
        return attrs.asdict(self)


def make_report(base: Base, edits: Mapping[int, Mapping[int, ArrayLike]], seconds: Mapping[str, float]) -> Report:
    """Count and measure a result."""
    keys = base.keys
    controls = {vertex for places in edits.values() for vertex in places} - set(keys.vertices.tolist())
    starts = np.diff(keys.planted.astype(np.int8), axis=0, prepend=0) == 1
    return Report(
        frames=len(base),
        vertices=len(base.rest),
        faces=len(base.faces),
        tracks=len(keys),
        anchors=int(keys.planted.any(axis=0).sum()),
        contacts=int(starts.sum()),
        edited_frames=len(edits),
        control_vertices=len(controls),
        method=base.method,
        noise=dict(zip(keys.names, base.noise.tolist(), strict=True)),
        reprojection=_reprojection(base),
        seconds={**base.seconds, **seconds},
    )


def _reprojection(base: Base) -> dict[str, float]:
    points = base.key_points
    squared = ((project_points(base.cameras, points) - base.keys.pixels) ** 2).sum(axis=2)
    squared[~base.keys.observed] = np.nan
    seen = np.flatnonzero(base.keys.observed.any(axis=0)).tolist()
    return {base.keys.names[key]: float(np.sqrt(np.nanmean(squared[:, key]))) for key in seen}
