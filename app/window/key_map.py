"""The keys that a person chose: remembered between runs, told to whoever shows or binds them."""

from __future__ import annotations

import json
from functools import cache

from PySide6.QtCore import QKeyCombination, QObject, Qt, Signal
from PySide6.QtGui import QKeyEvent, QKeySequence

from app.window import keys, settings

MODIFIERS = (
    Qt.Key.Key_Control,
    Qt.Key.Key_Shift,
    Qt.Key.Key_Alt,
    Qt.Key.Key_AltGr,
    Qt.Key.Key_Meta,
    Qt.Key.Key_unknown,
)
FIRST_SPECIAL = 0x01000000
"""Codes of keys that write no character begin here."""


class KeyMap(QObject):
    """One for the whole program; ``changed`` says that keys are others now."""

    changed = Signal()

    def load(self) -> None:
        """Take what the last run remembered; damaged settings count as none."""
        try:
            held = json.loads(str(settings.settings().value("keys", "{}")))
            own = {str(name): tuple(map(str, chosen)) for name, chosen in held.items()}
        except (ValueError, TypeError, AttributeError):
            own = {}
        keys.set_own_keys(own)
        self.changed.emit()

    def assign(self, command_id: str, chosen: tuple[str, ...]) -> None:
        """Give a command other keys; whoever had them loses them."""
        keys.assign(command_id, chosen)
        self._keep()

    def reset(self, command_id: str) -> None:
        """Give a command the keys back that it came with."""
        keys.assign(command_id, keys.BY_ID[command_id].keys)
        self._keep()

    def reset_all(self) -> None:
        """Give every command the keys that it came with."""
        keys.set_own_keys({})
        self._keep()

    def _keep(self) -> None:
        settings.settings().setValue("keys", json.dumps(keys.own_keys()))
        self.changed.emit()


@cache
def key_map() -> KeyMap:
    """The program's keys, as the last run left them."""
    made = KeyMap()
    made.load()
    return made


def pressed_key(event: QKeyEvent) -> str:
    """The name of what was pressed; empty while only Ctrl, Shift or Alt are down."""
    key = Qt.Key(event.key())
    if key in MODIFIERS:
        return ""
    held = event.modifiers() & ~Qt.KeyboardModifier.KeypadModifier
    if key == Qt.Key.Key_Backtab:
        key = Qt.Key.Key_Tab
    elif key == Qt.Key.Key_Enter:
        key = Qt.Key.Key_Return
    letter = Qt.Key.Key_A <= key <= Qt.Key.Key_Z
    if key < FIRST_SPECIAL and not letter and key != Qt.Key.Key_Space:
        held &= ~Qt.KeyboardModifier.ShiftModifier  # "?" is written with Shift already
    return QKeySequence(QKeyCombination(held, key)).toString(QKeySequence.SequenceFormat.PortableText)
