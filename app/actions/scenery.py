"""The measured background as a mesh that is light enough to be looked round."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from app.actions.backgrounds import solved_background
from app.actions.session import Session
from imitation.depth import BackgroundMesh, joined_mesh

MOST = 60_000
"""Vertices that a view without a graphics card turns smoothly."""


def background_for_view(session: Session) -> BackgroundMesh:
    """The background in the user's world, every few pixels a vertex; may run in any thread.

    Raises ``InputError`` where it has not been measured.
    """
    known, _ = solved_background(session)
    pixels = sum(each.depth.size for each in known.maps)
    step = max(3, int(np.ceil(np.sqrt(pixels / (4 * MOST)))))
    pictures: list[NDArray[np.uint8]] = [known.pictures.colour(each.frame) for each in known.maps]
    mesh = joined_mesh(known.maps, pictures, step=step)
    while len(mesh.vertices) > MOST:
        step = int(np.ceil(1.3 * step))
        mesh = joined_mesh(known.maps, pictures, step=step)
    return mesh
