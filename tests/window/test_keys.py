"""Keys of a person's own: recorded on the sheet, taken from others when told to, remembered, in force at once."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QKeySequence
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from app.window import keys, settings
from app.window.key_map import key_map
from app.window.key_sheet import KeySheet
from app.window.shell import Shell
from tests.window.conftest import settle, wait_for

pytestmark = [pytest.mark.window, pytest.mark.slow, pytest.mark.xdist_group("window")]
LEFT = Qt.MouseButton.LeftButton
CONTROL = Qt.KeyboardModifier.ControlModifier


@pytest.fixture(autouse=True)
def keys_as_they_came() -> Iterator[None]:
    """No test leaves keys behind."""
    yield
    key_map().reset_all()


@pytest.fixture
def sheet(shell: Shell) -> Iterator[KeySheet]:
    """The sheet, opened by its key."""
    QTest.keyClick(shell, Qt.Key.Key_Question)
    opened = shell.findChild(KeySheet)
    assert opened is not None
    wait_for(opened.isVisible)
    opened.activateWindow()
    yield opened
    if shell.findChild(KeySheet) is not None:
        opened.close()
    settle()


def press(sheet: KeySheet, command: str, key: Qt.Key, held: Qt.KeyboardModifier, number: int = 0) -> None:
    """Click a key on the sheet and press another one."""
    chip = sheet.rows[command].chips[number]
    QTest.mouseClick(chip, LEFT)
    assert chip.text() == "Press a key…"
    QTest.keyClick(chip, key, held)
    settle()


def test_a_recorded_key_works_at_once(shell: Shell, sheet: KeySheet) -> None:
    """The new key does it, the old one no longer; tooltip, menu and sheet say so; it is remembered."""
    press(sheet, "next", Qt.Key.Key_Period, CONTROL)
    assert sheet.rows["next"].chips[0].text() == "Ctrl+."
    sheet.close()
    shell.activateWindow()  # without a screen nobody gives it back the keys
    wait_for(shell.isActiveWindow)
    settle()
    QTest.keyClick(shell, Qt.Key.Key_Period, CONTROL)
    assert shell.project.frame == 1
    QTest.keyClick(shell, Qt.Key.Key_Right)
    assert shell.project.frame == 1
    assert shell.timeline.transport.buttons["next"].toolTip().endswith("(Ctrl+.)")
    assert "Ctrl+." in str(settings.settings().value("keys"))
    keys.set_own_keys({})
    key_map().load()
    assert keys.shown_key("next") == "Ctrl+."
    key_map().reset_all()
    assert shell.timeline.transport.buttons["next"].toolTip().endswith("(Right)")
    QTest.keyClick(shell, Qt.Key.Key_Right)
    assert shell.project.frame == 2


def test_a_key_of_another_command_is_asked_about(shell: Shell, sheet: KeySheet) -> None:
    """Left there nothing changes; given over it belongs to one command only, and the other has none."""
    press(sheet, "undo", Qt.Key.Key_H, CONTROL)
    assert sheet.question.isVisible()
    assert "History" in sheet.sentence.text()
    QTest.mouseClick(sheet.keep, LEFT)
    assert keys.keys_of("undo") == ("Ctrl+Z",)
    press(sheet, "undo", Qt.Key.Key_H, CONTROL)
    QTest.mouseClick(sheet.take, LEFT)
    assert keys.keys_of("undo") == ("Ctrl+H",)
    assert keys.keys_of("history") == ()
    assert sheet.rows["history"].chips[0].text() == "none"
    QTest.mouseClick(sheet.rows["history"].reset, LEFT)
    assert sheet.question.isVisible(), "its key belongs to undo now"
    QTest.mouseClick(sheet.take, LEFT)
    assert keys.keys_of("history") == ("Ctrl+H",)
    assert keys.keys_of("undo") == ()
    QTest.mouseClick(sheet.rows["undo"].reset, LEFT)
    assert keys.keys_of("undo") == ("Ctrl+Z",)
    assert not keys.own_keys()
    assert not sheet.reset.isEnabled()


def test_keys_are_taken_away_and_left(sheet: KeySheet) -> None:
    """Backspace takes one of two keys away, Escape leaves what was and keeps the sheet open; reset all brings back."""
    press(sheet, "redo", Qt.Key.Key_Escape, Qt.KeyboardModifier.NoModifier)
    assert sheet.isVisible()
    assert keys.keys_of("redo") == ("Ctrl+Shift+Z", "Ctrl+Y")
    press(sheet, "redo", Qt.Key.Key_Backspace, Qt.KeyboardModifier.NoModifier)
    assert keys.keys_of("redo") == ("Ctrl+Y",)
    press(sheet, "tool_pan", Qt.Key.Key_Tab, CONTROL)
    assert keys.keys_of("tool_pan") == ("Ctrl+Tab",)
    QTest.mouseClick(sheet.reset, LEFT)
    assert not keys.own_keys()
    assert [chip.text() for chip in sheet.rows["redo"].chips] == ["Ctrl+Shift+Z", "Ctrl+Y"]


def test_the_sheet_is_searched(sheet: KeySheet) -> None:
    """A word or a key leaves the commands that have it, and the headings of their groups."""
    QTest.keyClicks(sheet.search, "contact")
    seen = {name for name, row in sheet.rows.items() if row.isVisible()}
    assert {"contact_here", "propose_contacts", "accept_contacts", "tool_contact"} <= seen
    assert all("contact" in keys.BY_ID[name].text.lower() for name in seen)
    assert {heading.text() for heading, _ in sheet.headings if heading.isVisible()} == {"Edit", "Tools"}
    sheet.search.clear()
    QTest.keyClicks(sheet.search, "ctrl+shift+s")
    assert [name for name, row in sheet.rows.items() if row.isVisible()] == ["save_as"]


def test_the_sheet_is_worked_by_keys_alone(sheet: KeySheet) -> None:
    """Enter on a key waits for another one."""
    chip = sheet.rows["save"].chips[0]
    chip.setFocus()
    QTest.keyClick(chip, Qt.Key.Key_Return)
    assert chip.recording
    QTest.keyClick(chip, Qt.Key.Key_F9)
    assert keys.keys_of("save") == ("F9",)


def test_keys_are_written_as_qt_writes_them(qapp: QApplication) -> None:
    """What is recorded can be compared with what commands come with."""
    for command in keys.COMMANDS:
        for key in command.keys:
            assert QKeySequence(key).toString(QKeySequence.SequenceFormat.PortableText) == key


def test_damaged_or_foreign_settings_do_no_harm(qapp: QApplication) -> None:
    """Commands that are no more are forgotten, a key stays with one command, rubbish is no keys at all."""
    settings.settings().setValue("keys", '{"gone": ["F9"], "save": ["Ctrl+O"]}')
    key_map().load()
    assert keys.own_keys() == {"save": ("Ctrl+O",), "open": ()}
    settings.settings().setValue("keys", "[1, {")
    key_map().load()
    assert not keys.own_keys()


def test_two_views_have_a_key_of_their_own(shell: Shell) -> None:
    """D shows camera and side at once, and is said where one looks for it."""
    QTest.keyClick(shell, Qt.Key.Key_F2)
    button = shell.character.mesh.bar.split_button
    assert button.toolTip().endswith("(D)")
    wait_for(lambda: shell.character.mesh.viewport is not None)
    QTest.keyClick(shell, Qt.Key.Key_D)
    assert button.isChecked()
    QTest.keyClick(shell, Qt.Key.Key_D)
    assert not button.isChecked()
