"""The look: contrast, the style sheet, icons, the typeface."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from PySide6.QtCore import QSize
from PySide6.QtGui import QColor, QFontInfo
from PySide6.QtWidgets import QApplication, QComboBox, QWidget

from app.window import fonts, icons, theme
from app.window.keys import COMMANDS

LOOKS = [theme.DARK, theme.LIGHT]


def luminance(colour: str) -> float:
    """WCAG relative luminance."""
    parts = [
        value / 12.92 if value <= 0.03928 else ((value + 0.055) / 1.055) ** 2.4
        for value in QColor(colour).getRgbF()[:3]
    ]
    return 0.2126 * parts[0] + 0.7152 * parts[1] + 0.0722 * parts[2]


def contrast(first: str, second: str) -> float:
    """WCAG contrast ratio."""
    light, dark = sorted((luminance(first), luminance(second)), reverse=True)
    return (light + 0.05) / (dark + 0.05)


@pytest.mark.parametrize("look", LOOKS, ids=lambda look: look.name)
@pytest.mark.parametrize("token", ["text", "text2", "text3", "accent", "edit", "contact", "ok", "warn", "err"])
def test_words_can_be_read(look: theme.Theme, token: str) -> None:
    """Every token that carries words reaches 4.5 on panels and raised surfaces."""
    for surface in (look.panel, look.raised):
        assert contrast(getattr(look, token), surface) >= 4.5, (look.name, token, surface)


@pytest.mark.parametrize("look", LOOKS, ids=lambda look: look.name)
def test_text_on_the_accent_can_be_read(look: theme.Theme) -> None:
    """Primary buttons are legible."""
    assert contrast(look.on_accent, look.accent) >= 4.5


@pytest.mark.parametrize("look", LOOKS, ids=lambda look: look.name)
def test_borders_that_mean_something_stand_out(look: theme.Theme) -> None:
    """Control borders reach 3 on the surfaces they stand on."""
    assert contrast(look.line2, look.panel) >= 3.0
    assert contrast(look.line2, look.raised) >= 3.0


@pytest.mark.parametrize("look", LOOKS, ids=lambda look: look.name)
def test_style_sheet_is_whole(look: theme.Theme) -> None:
    """No token is left open, and the pictures it names exist."""
    sheet = theme.stylesheet(look)
    assert "$" not in sheet
    from pathlib import Path

    for name in re.findall(r'url\("([^"]+)"\)', sheet):
        assert Path(name).is_file(), name


def test_applying_a_look_changes_the_palette(qapp: QApplication) -> None:
    """Light and dark are really applied, and dark is the default."""
    assert theme.active() is theme.DARK
    theme.apply(qapp, theme.LIGHT)
    assert qapp.palette().window().color().name().upper() == theme.LIGHT.window
    theme.apply(qapp, theme.DARK)
    assert qapp.palette().window().color().name().upper() == theme.DARK.window


def test_every_icon_has_a_drawing(qapp: QApplication) -> None:
    """Each meaning in the table draws something."""
    for name in icons.NAMES:
        image = icons.icon(name).pixmap(QSize(18, 18)).toImage()
        assert any(image.pixelColor(x, y).alpha() for x in range(18) for y in range(18)), name
    assert not icons.application_icon().pixmap(32, 32).isNull()


def test_the_bundled_typeface_is_used(qapp: QApplication) -> None:
    """The window is set in its own typeface, wherever it runs."""
    assert QFontInfo(fonts.font()).family().startswith("Inter")
    assert qapp.font().pixelSize() == fonts.BODY


def test_figures_have_equal_width(qapp: QApplication) -> None:
    """Numbers do not jitter while they change."""
    from PySide6.QtGui import QFontMetricsF

    metrics = QFontMetricsF(fonts.font())
    assert len({round(metrics.horizontalAdvance(digit), 3) for digit in "0123456789"}) == 1


def test_combo_arrow_is_drawn(qapp: QApplication) -> None:
    """The style keeps the arrow of a combo box: its right end is not empty."""
    combo = QComboBox()
    combo.addItem("x")
    combo.resize(160, 28)
    image = combo.grab().toImage()
    colours = {image.pixelColor(x, y).rgb() for x in range(136, 156) for y in range(6, 22)}
    assert len(colours) > 2
    combo.deleteLater()


def test_no_two_commands_share_a_key() -> None:
    """Keys are unique, ids too."""
    keys = [key for command in COMMANDS for key in command.keys]
    assert len(keys) == len(set(keys))
    assert len({command.id for command in COMMANDS}) == len(COMMANDS)


def test_panels_do_not_paint_over_what_stands_in_them(qapp: QApplication) -> None:
    """A plain widget inside a panel is see-through, so that its buttons keep their own colours."""
    from app.window.controls import Panel, button

    panel = Panel("Title")
    inner = QWidget()
    panel.column.addWidget(inner)
    primary = button("Do it", lambda: None, primary=True)
    panel.column.addWidget(primary)
    panel.resize(300, 160)
    image = panel.grab().toImage()
    place = primary.geometry().center()
    found = image.pixelColor(primary.geometry().left() + 12, place.y()).name().upper()
    assert found == theme.DARK.accent
    panel.deleteLater()


def test_another_look_is_seen_in_icons_that_are_there(qapp: QApplication) -> None:
    """What was built in the dark look is drawn in the colours of the light one, buttons and large icons alike."""
    from app.window.controls import Pictogram, icon_button

    button, large = icon_button("undo", "Undo", lambda: None), Pictogram("video")
    try:
        for look in LOOKS:
            theme.apply(qapp, look)
            for shown, token in (
                (button.icon().pixmap(QSize(24, 24)).toImage(), "text2"),
                (large.grab().toImage(), "text3"),
            ):
                places = [(x, y) for x in range(shown.width()) for y in range(shown.height())]
                inked = {shown.pixelColor(*place).name() for place in places}
                assert QColor(getattr(look, token)).name() in inked, look.name
    finally:
        theme.apply(qapp, theme.DARK)


@pytest.mark.parametrize("look", LOOKS, ids=lambda look: look.name)
def test_a_check_is_seen_on_its_box(look: theme.Theme) -> None:
    """The mark is drawn in the colour for what stands on the accent, in either look."""
    (check,) = re.findall(r'url\("([^"]+/check[^"/]*)"\)', theme.stylesheet(look))
    assert look.on_accent in Path(check).read_text()
