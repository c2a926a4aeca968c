"""Small pictures of captured frames without a background, for nodes, blocks and cards."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.actions.performing_frames import sequence_footage
from app.actions.session import Session
from app.formats.tvm import FrameMesh, painted

HALF_VIEW = float(np.radians(10))
TILT, ASIDE, MARGIN = 0.12, 40.0, 1.12


def cutout(session: Session, sequence_id: str, frame: int, *, size: int = 112) -> NDArray[np.uint8]:
    """Give a square picture (size, size, 4) of a frame, RGBA: the performer in half front view, nothing behind.

    Raises ``InputError`` when the files cannot be read.
    """
    sequence = session.document.sequence(sequence_id)
    analysis: Any = session.ready(session.stages.analysis(sequence_id))
    facing = float(np.degrees(analysis.headings[frame])) if analysis is not None else (sequence.front or 0.0)
    return drawn(painted(sequence_footage(session, sequence_id)[frame]), np.radians(facing + ASIDE), size)


def drawn(mesh: FrameMesh, turn: float, size: int) -> NDArray[np.uint8]:
    """Give a square picture of a mesh seen from a side, radians about z; it fills the picture."""
    from imitation.rendering import Renderer, look_at

    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    radius = max(0.5 * float(np.linalg.norm(high - low)), 1e-6)
    away = np.array([np.cos(turn) * np.cos(TILT), np.sin(turn) * np.cos(TILT), np.sin(TILT)])
    beside = np.array([-np.sin(turn), np.cos(turn), 0.0])
    # As large as it is seen, not as the ball round it.
    seen = np.ptp(mesh.vertices @ beside), high[2] - low[2]
    distance = radius / np.sin(HALF_VIEW)
    focal = size * distance / (MARGIN * max(*seen, 1e-6))
    K = np.array([[focal, 0, (size - 1) / 2], [0, focal, (size - 1) / 2], [0, 0, 1.0]])
    camera = look_at(0.5 * (low + high) + away * distance, 0.5 * (low + high), np.array([0.0, 0.0, 1.0]), K)
    with Renderer(mesh.faces, (size, size), colors=mesh.colours, samples=2) as renderer:
        vertices = np.ascontiguousarray(mesh.vertices, np.float64)
        rendered: NDArray[np.uint8] = renderer.draw(vertices, camera, renderer.lights(vertices, camera)).rgba
    return rendered
