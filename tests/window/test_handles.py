"""Names of handles over the 3D picture: read in either look, clear of what lies at the right."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from PySide6.QtGui import QColor, QImage, QPainter
from PySide6.QtWidgets import QApplication

from app.window import theme
from app.window.canvas import marks
from app.window.viewport import Handle
from app.window.viewport.handles import paint_handles
from app.window.viewport.lens import Lens
from imitation.geometry import Camera
from tests.window.test_theme import contrast

SIZE = (640, 480)


def painted(monkeypatch: pytest.MonkeyPatch, handles: list[Handle], taken: int = 0) -> list[tuple[Any, ...]]:
    """The plates that are drawn for handles: left, right, colour."""
    plates: list[tuple[Any, ...]] = []
    draw = marks.plate

    def plate(painter: QPainter, x: float, y: float, text: str, colour: QColor, **options: Any) -> Any:
        box = draw(painter, x, y, text, colour, **options)
        plates.append((box.left(), box.right(), colour))
        return box

    monkeypatch.setattr(marks, "plate", plate)
    camera = Camera(np.array([[500.0, 0, 320], [0, 500, 240], [0, 0, 1]]), np.eye(3), np.zeros(3))
    image = QImage(*SIZE, QImage.Format.Format_RGB32)
    painter = QPainter(image)
    paint_handles(painter, Lens(camera, SIZE, 0.1, 100.0), handles, taken=taken)
    painter.end()
    return plates


@pytest.mark.parametrize("look", [theme.DARK, theme.LIGHT], ids=lambda look: look.name)
@pytest.mark.parametrize("kind", ["ray", "anchor", "edited", "plain"])
def test_the_name_of_a_handle_can_be_read(
    qapp: QApplication, monkeypatch: pytest.MonkeyPatch, look: theme.Theme, kind: str
) -> None:
    """Its plate is dark whatever the look, so its colour is light."""
    try:
        theme.apply(qapp, look)
        for colour in ("accent", *theme.DARK.tracks):
            ((_, _, shown),) = painted(monkeypatch, [Handle(0, "nose", (0.0, 0.0, 5.0), kind, colour, selected=True)])
            assert contrast(shown.name(), "#333333") >= 4.5, "on a plate over a light picture"
            monkeypatch.undo()
    finally:
        theme.apply(qapp, theme.DARK)


def test_a_name_keeps_clear_of_what_lies_at_the_right(qapp: QApplication, monkeypatch: pytest.MonkeyPatch) -> None:
    """It stands left of its handle where it would reach under a legend."""
    handle = Handle(0, "nose", (1.6, 0.0, 5.0), selected=True)
    ((left, _, _),) = painted(monkeypatch, [handle])
    assert left > 480
    monkeypatch.undo()
    ((_, right, _),) = painted(monkeypatch, [handle], taken=120)
    assert right < 480
