"""The sheet of keys: every command with its keys, in groups, found by a word, changed by pressing another one."""

from __future__ import annotations

from itertools import combinations, pairwise

from PySide6.QtCore import QEvent, Qt
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QDialog, QFrame, QHBoxLayout, QLabel, QLineEdit, QScrollArea, QVBoxLayout, QWidget

from app.window.controls import Elided, button, icon_button, label
from app.window.key_chip import KeyChip
from app.window.key_map import key_map
from app.window.keys import BY_ID, COMMANDS, Command, holder, keys_of, own_keys

COLUMNS = 3
ROW, HEADING = 28, 40
"""Heights in pixels, by which groups are shared out among the columns."""


class KeySheet(QDialog):
    """Not modal: it may stay open beside the window, whose keys change at once."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.setWindowTitle("Keys")
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.rows: dict[str, KeyRow] = {}
        self._asked: tuple[str, str, str] | None = None
        column = QVBoxLayout(self)
        column.setContentsMargins(20, 16, 20, 16)
        column.setSpacing(12)
        column.addLayout(self._head())
        column.addWidget(self._question())
        column.addWidget(self._sheet(), 1)
        key_map().changed.connect(self._show)
        self._show()
        self.resize(min(1360, max(parent.width() - 64, 960)), 760)

    def _head(self) -> QHBoxLayout:
        row = QHBoxLayout()
        row.setSpacing(12)
        self.search = QLineEdit()
        self.search.setPlaceholderText("Find a command or a key")
        self.search.setClearButtonEnabled(True)
        self.search.setFixedWidth(280)
        self.search.textChanged.connect(self._filter)
        self.reset = button("Reset all keys", key_map().reset_all, name="reset")
        row.addWidget(self.search)
        row.addWidget(label("Click a key, then press another one. Backspace takes it away.", "caption"), 1)
        row.addWidget(self.reset)
        return row

    def _question(self) -> QFrame:
        self.question = QFrame()
        self.question.setObjectName("errorBar")
        self.question.setProperty("level", "warn")
        row = QHBoxLayout(self.question)
        row.setContentsMargins(12, 6, 8, 6)
        row.setSpacing(8)
        self.sentence = QLabel()
        self.take = button("Give it over", self._taken, primary=True)
        self.keep = button("Leave it there", self._kept)
        row.addWidget(self.sentence, 1)
        row.addWidget(self.take)
        row.addWidget(self.keep)
        self.question.hide()
        return self.question

    def _sheet(self) -> QScrollArea:
        area = QScrollArea()
        area.setWidgetResizable(True)
        area.setFrameShape(QFrame.Shape.NoFrame)
        area.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        body = QWidget()
        body.setObjectName("scrollBody")
        across = QHBoxLayout(body)
        across.setContentsMargins(0, 0, 12, 0)
        across.setSpacing(24)
        self.headings: list[tuple[QLabel, list[KeyRow]]] = []
        for groups in _shared_out():
            column = QVBoxLayout()
            column.setSpacing(2)
            for name, commands in groups:
                heading = label(name, "title")
                column.addWidget(heading)
                rows = [KeyRow(command, self) for command in commands]
                for row in rows:
                    self.rows[row.command.id] = row
                    column.addWidget(row)
                self.headings.append((heading, rows))
                column.addSpacing(12)
            column.addStretch(1)
            across.addLayout(column, 1)
        area.setWidget(body)
        return area

    def _show(self) -> None:
        for row in self.rows.values():
            row.show_keys()
        self.reset.setEnabled(bool(own_keys()))

    def _filter(self, text: str) -> None:
        words = text.lower().split()
        for heading, rows in self.headings:
            for row in rows:
                row.setVisible(all(word in row.sought for word in words))
            heading.setVisible(any(not row.isHidden() for row in rows))

    def ask(self, command_id: str, old: str, new: str) -> None:
        """Put a key in another's place; where it belongs to another command, ask first."""
        owner = holder(new) if new else None
        self.question.hide()
        if owner is None or owner.id == command_id:
            self._put(command_id, old, new)
            return
        self._asked = (command_id, old, new)
        self.sentence.setText(f"{new} belongs to “{owner.text}”. Shall it do “{BY_ID[command_id].text}” from now on?")
        self.question.show()
        self.take.setFocus()

    def _put(self, command_id: str, old: str, new: str) -> None:
        present = keys_of(command_id)
        if new and new in present:
            return
        changed = [new if key == old else key for key in present] if old in present else [*present, new]
        key_map().assign(command_id, tuple(key for key in changed if key))

    def _taken(self) -> None:
        asked, self._asked = self._asked, None
        self.question.hide()
        if asked is not None:
            self._put(*asked)

    def _kept(self) -> None:
        self._asked = None
        self.question.hide()

    def event(self, event: QEvent) -> bool:
        """Keep Escape for closing the sheet."""
        escape = isinstance(event, QKeyEvent) and event.key() == Qt.Key.Key_Escape
        if event.type() == QEvent.Type.ShortcutOverride and escape:
            event.accept()
            return True
        return super().event(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Enter answers no button that nobody has chosen."""
        if event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            event.ignore()
            return
        super().keyPressEvent(event)


class KeyRow(QWidget):
    """One command: its name, its keys, and a way back to those it came with."""

    def __init__(self, command: Command, sheet: KeySheet) -> None:
        super().__init__()
        self.command, self._sheet = command, sheet
        self.chips: list[KeyChip] = []
        self.setFixedHeight(ROW)
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(4)
        self.name = Elided(command.text, "label")
        row.addWidget(self.name, 1)
        self._keys = QHBoxLayout()
        self._keys.setSpacing(4)
        row.addLayout(self._keys)
        self.reset = icon_button("reset", "Back to the key it came with", lambda: self._back())
        self.reset.setFixedSize(24, 24)
        room = self.reset.sizePolicy()
        room.setRetainSizeWhenHidden(True)
        self.reset.setSizePolicy(room)
        row.addWidget(self.reset)
        self._shown: tuple[str, ...] | None = None

    @property
    def sought(self) -> str:
        """What a search looks through."""
        return " ".join((self.command.text, *keys_of(self.command.id))).lower()

    def show_keys(self) -> None:
        """Show the keys as they are now."""
        keys = keys_of(self.command.id)
        self.reset.setVisible(self.command.id in own_keys())
        if keys == self._shown:
            return
        self._shown = keys
        for chip in self.chips:
            chip.hide()
            self._keys.removeWidget(chip)
            chip.deleteLater()
        self.chips = [KeyChip(key, self.command.text) for key in keys or ("",)]
        for chip in self.chips:
            chip.pressed.connect(lambda new, old=chip.key: self._sheet.ask(self.command.id, old, new))
            self._keys.addWidget(chip)

    def _back(self) -> None:
        owners = [owner for key in self.command.keys if (owner := holder(key)) and owner.id != self.command.id]
        if owners:
            self._sheet.ask(self.command.id, self._shown[0] if self._shown else "", self.command.keys[0])
        else:
            key_map().reset(self.command.id)


def _shared_out() -> list[list[tuple[str, list[Command]]]]:
    """The groups in their order, cut into columns of which the longest is as short as can be."""
    groups: dict[str, list[Command]] = {}
    for command in COMMANDS:
        groups.setdefault(command.group, []).append(command)
    entries = list(groups.items())

    def columns(cuts: tuple[int, ...]) -> list[list[tuple[str, list[Command]]]]:
        return [entries[begin:end] for begin, end in pairwise((0, *cuts, len(entries)))]

    def longest(cuts: tuple[int, ...]) -> int:
        return max(sum(HEADING + ROW * len(commands) for _, commands in column) for column in columns(cuts))

    return columns(min(combinations(range(1, len(entries)), COLUMNS - 1), key=longest))
