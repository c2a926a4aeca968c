"""The look as one table of tokens; the style sheet and everything painted by hand take their colours from it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, fields
from importlib.resources import files
from string import Template

from PySide6.QtGui import QColor, QPalette
from PySide6.QtWidgets import QApplication, QStyleFactory

TRACKS = ("#58C4DD", "#F78FB3", "#A3DE83", "#F5D76E", "#B39DFF", "#FF9F68", "#6EE7C8", "#E58CFF")


@dataclass(frozen=True)
class Theme:
    """Colours of one look. Contrast of text on the surfaces is checked by a test."""

    name: str
    canvas: str
    window: str
    panel: str
    raised: str
    hover: str
    line: str
    line2: str
    text: str
    text2: str
    text3: str
    accent: str
    on_accent: str
    edit: str
    contact: str
    ok: str
    warn: str
    err: str
    tracks: tuple[str, ...] = TRACKS

    def colour(self, token: str, alpha: int = 255) -> QColor:
        """The colour of a token, or of a literal such as ``#FF9F68``."""
        colour = QColor(token if token.startswith("#") else getattr(self, token))
        colour.setAlpha(alpha)
        return colour


DARK = Theme(
    name="dark",
    canvas="#0D0F12",
    window="#14171B",
    panel="#1B1F24",
    raised="#242930",
    hover="#2E353E",
    line="#2C323A",
    line2="#6E7A87",
    text="#E8EBEF",
    text2="#B0B8C2",
    text3="#8C96A2",
    accent="#5AA9FF",
    on_accent="#0B1320",
    edit="#FFA94D",
    contact="#C39BFF",
    ok="#4CC38A",
    warn="#F2B84B",
    err="#FF7A7A",
)

LIGHT = Theme(
    name="light",
    canvas="#D3D8DE",
    window="#E6E9ED",
    panel="#F7F8FA",
    raised="#FFFFFF",
    hover="#E3E8EE",
    line="#D5DAE0",
    line2="#7D8894",
    text="#161A1F",
    text2="#3F4854",
    text3="#5B6672",
    accent="#1465C0",
    on_accent="#FFFFFF",
    edit="#A85400",
    contact="#7A3FD0",
    ok="#137A4B",
    warn="#8A6100",
    err="#C22F2F",
    tracks=("#0E7F9C", "#C2386B", "#4A8A22", "#8E7208", "#6A4CD6", "#C2581A", "#0F8A6C", "#A834C8"),
)

THEMES = {theme.name: theme for theme in (DARK, LIGHT)}
_active = DARK


def active() -> Theme:
    """The look of the running program."""
    return _active


def stylesheet(theme: Theme) -> str:
    """The Qt style sheet of a look, made from ``resources/theme/window.qss``."""
    folder = files("resources")
    values = {field.name: getattr(theme, field.name) for field in fields(theme) if field.name != "tracks"}
    values["icons"] = str(folder / "icons").replace("\\", "/")
    return Template((folder / "theme" / "window.qss").read_text(encoding="utf-8")).substitute(values)


def _palette(theme: Theme) -> QPalette:
    palette = QPalette()
    roles = {
        QPalette.ColorRole.Window: theme.window,
        QPalette.ColorRole.WindowText: theme.text,
        QPalette.ColorRole.Base: theme.raised,
        QPalette.ColorRole.AlternateBase: theme.panel,
        QPalette.ColorRole.Text: theme.text,
        QPalette.ColorRole.Button: theme.raised,
        QPalette.ColorRole.ButtonText: theme.text,
        QPalette.ColorRole.Highlight: theme.accent,
        QPalette.ColorRole.HighlightedText: theme.on_accent,
        QPalette.ColorRole.ToolTipBase: theme.raised,
        QPalette.ColorRole.ToolTipText: theme.text,
        QPalette.ColorRole.PlaceholderText: theme.text3,
    }
    for role, colour in roles.items():
        palette.setColor(role, QColor(colour))
    for role in (QPalette.ColorRole.WindowText, QPalette.ColorRole.Text, QPalette.ColorRole.ButtonText):
        palette.setColor(QPalette.ColorGroup.Disabled, role, QColor(theme.line2))
    return palette


@contextmanager
def bare() -> Iterator[None]:
    """Build many widgets without a style sheet, and dress them together at the end.

    Qt matches the sheet anew for all that lies in a widget whenever it gets a parent, which for a window built from
    the inside out takes three times as long as everything else about it.
    """
    application = QApplication.instance()
    assert isinstance(application, QApplication), "widgets need an application"
    sheet = application.styleSheet()
    application.setStyleSheet("")
    try:
        yield
    finally:
        application.setStyleSheet(sheet)


def apply(application: QApplication, theme: Theme = DARK) -> None:
    """Give the whole program a look; painted widgets take it at their next paint."""
    global _active
    _active = theme
    application.setStyle(QStyleFactory.create("Fusion"))
    application.setPalette(_palette(theme))
    application.setStyleSheet(stylesheet(theme))
