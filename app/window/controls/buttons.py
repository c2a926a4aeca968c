"""Buttons: icons with a tooltip that names the key, toggles, tabs and tools."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QSize, Qt
from PySide6.QtWidgets import QAbstractButton, QPushButton, QToolButton, QWidget

from app.window import icons
from app.window.controls.own_keys import PressKeys
from app.window.keys import present_key


def set_tooltip(button: QAbstractButton, text: str, key: str = "") -> None:
    """Say what a button does and its key: a command's name, or the key that it comes with."""
    shown = present_key(key)
    button.setToolTip(f"{text}  ({shown})" if shown else text)
    button.setProperty("tip", [text, key])


def renew_tooltips(root: QWidget) -> None:
    """Show the keys as they are now on every button below a widget."""
    for button in root.findChildren(QAbstractButton):
        tip = button.property("tip")
        if tip is not None:
            set_tooltip(button, *tip)


def icon_button(name: str, text: str, call: Callable[[], object] | None = None, key: str = "") -> QToolButton:
    """A square button of one icon; its text is the tooltip and what a screen reader says."""
    button = QToolButton()
    button.setIcon(icons.icon(name, "text2", "text2"))
    button.setIconSize(QSize(18, 18))
    button.setFixedSize(30, 28)
    set_tooltip(button, text, key)
    button.setAccessibleName(text)
    button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
    PressKeys(button)
    if call is not None:
        button.clicked.connect(lambda: call())
    return button


def toggle(name: str, text: str, call: Callable[[bool], object], *, on: bool = False, key: str = "") -> QToolButton:
    """A button with icon and text that is on or off."""
    button = QToolButton()
    button.setProperty("toggle", "true")
    button.setIcon(icons.icon(name))
    button.setIconSize(QSize(16, 16))
    button.setText(text)
    button.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
    button.setCheckable(True)
    button.setChecked(on)
    set_tooltip(button, text, key)
    button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
    PressKeys(button)
    button.toggled.connect(call)
    return button


def tool(name: str, text: str, key: str = "") -> QToolButton:
    """A tool of the strip at the left: icon above its name."""
    button = QToolButton()
    button.setProperty("tool", "true")
    button.setIcon(icons.icon(name))
    button.setIconSize(QSize(18, 18))
    button.setText(text)
    button.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextUnderIcon)
    button.setCheckable(True)
    button.setFixedSize(56, 52)
    set_tooltip(button, text, key)
    button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
    PressKeys(button)
    return button


def button(text: str, call: Callable[[], object], *, primary: bool = False, name: str = "") -> QPushButton:
    """A button with a text, in the accent colour where it is the one thing to do next."""
    made = QPushButton(text)
    if primary:
        made.setProperty("primary", "true")
    if name:
        made.setIcon(icons.icon(name, "on_accent" if primary else "text", "text"))
        made.setIconSize(QSize(16, 16))
    made.setFocusPolicy(Qt.FocusPolicy.TabFocus)
    # Else a dialog takes some button for its default, and Enter in any field presses it.
    made.setAutoDefault(False)
    PressKeys(made)
    made.clicked.connect(lambda: call())
    return made
