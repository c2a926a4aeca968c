"""The program's own typeface, so that it looks the same on every machine."""

from __future__ import annotations

from functools import cache
from importlib.resources import as_file, files

from PySide6.QtGui import QFont, QFontDatabase
from PySide6.QtWidgets import QApplication

FAMILY = "Inter"
BODY, CAPTION, LANE = 13, 12, 11


@cache
def _loaded() -> bool:
    found = False
    for entry in sorted((files("resources") / "fonts").iterdir(), key=lambda item: item.name):
        if entry.name.endswith(".otf"):
            with as_file(entry) as path:
                found |= QFontDatabase.addApplicationFont(str(path)) >= 0
    return found


@cache
def font(size: int = BODY, weight: QFont.Weight = QFont.Weight.Normal) -> QFont:
    """The typeface at a size in pixels, with figures of equal width and unhinted, so that numbers do not jitter."""
    face = QFont(FAMILY if _loaded() else QApplication.font().family())
    face.setPixelSize(size)
    face.setWeight(weight)
    face.setHintingPreference(QFont.HintingPreference.PreferNoHinting)
    if hasattr(face, "setFeature"):
        face.setFeature(QFont.Tag("tnum"), 1)
    return face


def apply(application: QApplication) -> None:
    """Make the typeface the program's default."""
    application.setFont(font())
