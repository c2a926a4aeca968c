"""Icons as letters of a font: Material Design Icons 6 out of the qtawesome package, drawn by Qt itself.

The package's own module is not imported: it loads a compatibility layer over all of Qt, a fifth of a second of the
window's start. Its data are a font and a table of names.
"""

from __future__ import annotations

import json
from functools import cache
from importlib.util import find_spec
from pathlib import Path

from PySide6.QtCore import QPoint, QRect, QSize, Qt
from PySide6.QtGui import QColor, QFont, QFontDatabase, QIcon, QIconEngine, QPainter, QPixmap

from app.window import theme

FILL = 0.875
"""Height of the letters in the square of the icon."""


def _find(pattern: str) -> Path:
    package = find_spec("qtawesome")
    origin = package.origin if package is not None else None
    assert origin is not None, "qtawesome belongs to the installation"
    return max((Path(origin).parent / "fonts").glob(pattern))


@cache
def _letters() -> dict[str, str]:
    table: dict[str, str] = json.loads(_find("materialdesignicons6-webfont-charmap-*.json").read_text())
    return table


@cache
def _family() -> str:
    number = QFontDatabase.addApplicationFont(str(_find("materialdesignicons6-webfont-[0-9]*.ttf")))
    return QFontDatabase.applicationFontFamilies(number)[0]


class Drawing(QIconEngine):
    """One letter in three colours: usually, switched on, and where nothing can be done.

    A colour is a token of the look, taken when it is drawn, so that another look is seen at once; or a literal one.
    """

    def __init__(self, name: str, normal: str, checked: str, disabled: str) -> None:
        super().__init__()
        self.given = (name, normal, checked, disabled)
        self.letter = chr(int(_letters()[name], 16))

    def paint(self, painter: QPainter, rect: QRect, mode: QIcon.Mode, state: QIcon.State) -> None:
        """Draw the letter in the middle of a square."""
        _, normal, checked, disabled = self.given
        token = disabled if mode == QIcon.Mode.Disabled else checked if state == QIcon.State.On else normal
        face = QFont(_family())
        face.setPixelSize(max(round(FILL * rect.height()), 1))
        painter.save()
        painter.setFont(face)
        painter.setPen(QColor(token) if token.startswith("#") else theme.active().colour(token))
        painter.drawText(rect, Qt.AlignmentFlag.AlignCenter, self.letter)
        painter.restore()

    def pixmap(self, size: QSize, mode: QIcon.Mode, state: QIcon.State) -> QPixmap:
        """The same as a picture."""
        picture = QPixmap(size)
        picture.fill(Qt.GlobalColor.transparent)
        painter = QPainter(picture)
        self.paint(painter, QRect(QPoint(0, 0), size), mode, state)
        painter.end()
        return picture

    def clone(self) -> Drawing:
        """Another of the same."""
        return Drawing(*self.given)
