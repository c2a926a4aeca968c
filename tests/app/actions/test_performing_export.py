"""What an exported performance could not keep is said."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from app.actions.performing_export import export_performance
from app.actions.session import Session
from app.formats import write_image
from app.formats.tvm import FrameMesh, Texture


class Worn(list[FrameMesh]):
    """Frames of one mesh that wears a picture."""

    fps, moving = 25.0, True

    def blended(self, position: int) -> bool:
        """No frame is an in-between."""
        return False


def worn(folder: Path, *, picture: bool) -> Worn:
    """Two poses of a tetrahedron."""
    image = folder / "skin.png"
    write_image(image, np.full((4, 4, 3), (200, 30, 30), np.uint8))
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], np.float64)
    faces = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]], np.int32)
    texture = Texture(np.full((4, 2), 0.5), faces, (image,), np.zeros(4, np.int32)) if picture else None
    return Worn(FrameMesh(corners + shift, faces, None, texture) for shift in (0.0, 0.2))


@pytest.mark.parametrize("picture", [True, False])
def test_one_animated_glb_says_that_pictures_became_colours(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, picture: bool
) -> None:
    """It holds colours at the vertices; without pictures nothing is lost, and nothing is said."""
    frames: Any = worn(tmp_path, picture=picture)
    monkeypatch.setattr("app.actions.performing_export.performance_frames", lambda *_, **__: frames)
    session = Session.new(tmp_path / "moves")
    try:
        form, note = export_performance(session, tmp_path / "moving.glb")
    finally:
        session.close()
    assert form == "animation"
    assert (tmp_path / "moving.glb").stat().st_size > 0
    assert ("colours at the vertices" in note) == picture
