"""``frame_features``: features of a sequence that is already in memory."""

from __future__ import annotations

from typing import Any

import numpy as np

from imitation.errors import InputError
from tvmedit.features.feature import Features, Method
from tvmedit.features.frames import as_frames
from tvmedit.features.paper import ANGLE_BIN, SphericalHistograms
from tvmedit.features.robust import CylinderHistograms


def frame_features(
    vertices: Any,
    *,
    faces: Any = None,
    origin: Any = None,
    method: Method = "robust",
    floor: float | None = None,
    height: float | None = None,
    radius_bin: float | None = None,
    angle_bin: float = ANGLE_BIN,
) -> Features:
    """Feature vectors of the frames of a sequence (paper B, section 3).

    Parameters
    ----------
    vertices : (v, 3), (n, v, 3) or a sequence of (v_t, 3) float
        One frame, or the frames in order; z up.
    faces : (m, 3), or a sequence of (m_t, 3) int, optional
        Triangles, shared or one set a frame. "robust" weighs a vertex by a third of its triangles' areas; without
        faces all weigh alike.
    origin : (3,) float, optional
        Only "paper": the origin of the spherical coordinates; default the mean vertex of the first frame.
    method : "robust" or "paper"
        "paper": histograms of r, theta, phi (eq. 1-4), as shares. "robust": a soft joint histogram over height, radius
        and azimuth around each frame's own vertical axis.
    floor, height : float, optional
        Only "robust": z of the ground and body height; by default read from the frames. Give the same height for all
        sequences of one performer.
    radius_bin, angle_bin : float, optional
        Only "paper": bin sizes of r (default a 35th of the first frame's longest extent: 5 cm on a person) and of the
        two angles (default 10 degrees, in radians).

    Returns
    -------
    Features

    Raises
    ------
    InputError
        A frame without vertices, with values that are not finite, with faces beyond its vertices, or without area.
    """
    frames = as_frames(vertices, faces)
    if method == "paper":
        if not angle_bin > 0 or (radius_bin is not None and not radius_bin > 0):
            raise InputError("The bin sizes must be positive.")
        centre = None if origin is None else np.asarray(origin, np.float64).reshape(3)
        printed = SphericalHistograms(origin=centre, radius_bin=radius_bin, angle_bin=angle_bin)
        for points, _ in frames:
            printed.add(points)
        return printed.features()
    if method != "robust":
        raise InputError(f'The method is {method!r}: say "robust" or "paper".')
    robust = CylinderHistograms(floor=floor, height=height)
    for points, triangles in frames:
        robust.add(points, triangles)
    return robust.features()
