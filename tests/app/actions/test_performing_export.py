"""What an exported performance could not keep is said."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import attrs
import numpy as np
import pytest

from app.actions.performing_export import export_performance
from app.actions.session import Session
from app.formats import write_image
from app.formats.tvm import FrameMesh, Texture, open_mesh_frames


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


def exported(folder: Path, frames: Any, monkeypatch: pytest.MonkeyPatch, name: str) -> tuple[str, str]:
    """Form and note of the frames, written under that name."""
    monkeypatch.setattr("app.actions.performing_export.performance_frames", lambda *_, **__: frames)
    session = Session.new(folder / "moves")
    try:
        return export_performance(session, folder / name)
    finally:
        session.close()


@pytest.mark.parametrize("picture", [True, False])
def test_one_animated_glb_keeps_the_picture(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, picture: bool) -> None:
    """What all frames wear comes back byte for byte, on the same vertices; nothing is lost, and nothing is said."""
    frames: Any = worn(tmp_path, picture=picture)
    assert exported(tmp_path, frames, monkeypatch, "moving.glb") == ("animation", "")
    with open_mesh_frames(tmp_path / "moving.glb") as back:
        assert (len(back), back.moving, back.fps) == (2, True, 25)
        for mesh, frame in zip(back, frames, strict=True):
            assert mesh.vertices == pytest.approx(frame.vertices, abs=1e-6)
            assert np.array_equal(np.sort(mesh.faces, axis=1), np.sort(frame.faces, axis=1))
            assert (mesh.texture is not None) == picture
            if mesh.texture is not None:
                assert mesh.texture.images[0].read_bytes() == (tmp_path / "skin.png").read_bytes()
                assert mesh.texture.coordinates == pytest.approx(np.full_like(mesh.texture.coordinates, 0.5))


def test_pictures_that_change_become_colours_in_one_animated_glb(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """One GLB wears one picture: it is said that there are colours instead."""
    frames: Any = worn(tmp_path, picture=True)
    other = tmp_path / "other.png"
    write_image(other, np.full((4, 4, 3), (0, 30, 200), np.uint8))
    texture = attrs.evolve(frames[1].texture, images=(other,))
    frames[1] = attrs.evolve(frames[1], texture=texture)
    form, note = exported(tmp_path, frames, monkeypatch, "moving.glb")
    assert form == "animation"
    assert "no pictures that change" in note


def test_usd_holds_faces_that_change(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A stage of frames with faces of their own is read back frame by frame, colours and rate with it."""
    pytest.importorskip("pxr")
    frames: Any = worn(tmp_path, picture=True)
    frames[1] = attrs.evolve(frames[1], faces=frames[1].faces[:3], texture=None, colours=np.full((4, 3), 90, np.uint8))
    frames.moving = False
    form, note = exported(tmp_path, frames, monkeypatch, "moving.usdc")
    assert form == "usd"
    assert "USD holds no pictures" in note
    with open_mesh_frames(tmp_path / "moving.usdc") as back:
        assert (len(back), back.moving, back.fps, back.up, back.unit) == (2, False, 25, "z", 1.0)
        for mesh, frame in zip(back, frames, strict=True):
            assert np.array_equal(mesh.faces, frame.faces)
            assert mesh.vertices == pytest.approx(frame.vertices, abs=1e-6)
        assert back[0].colours is not None
        assert np.abs(back[0].colours.astype(int) - (200, 30, 30)).max() <= 1
        assert back[1].colours is not None
        assert np.abs(back[1].colours.astype(int) - 90).max() <= 1
