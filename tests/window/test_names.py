"""Names are typed where they are shown: of the project, of a character."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from app.model.edits import scene
from app.window.shell import Shell
from tests.window.conftest import settle, wait_for

pytestmark = [pytest.mark.window, pytest.mark.slow, pytest.mark.xdist_group("window")]
LEFT = Qt.MouseButton.LeftButton
CONTROL = Qt.KeyboardModifier.ControlModifier


def test_the_name_is_typed_at_the_top(shell: Shell) -> None:
    """A double click begins, Enter takes, Escape and an empty name leave; letters are no shortcuts meanwhile."""
    name = shell.bar.name
    QTest.mouseDClick(name, LEFT)
    QTest.keyClicks(name, "Pan & Zoom")
    QTest.keyClick(name, Qt.Key.Key_Return)
    assert shell.project.document.name == "Pan & Zoom"
    assert shell.project.session.history.undo_label == "Rename the project to Pan & Zoom"
    for typed, key in (("other", Qt.Key.Key_Escape), ("", Qt.Key.Key_Return)):
        name.setFocus()
        QTest.keyClick(name, Qt.Key.Key_Return)
        QTest.keyClick(name, Qt.Key.Key_Backspace)
        QTest.keyClicks(name, typed)
        QTest.keyClick(name, key)
        assert name.text() == "Pan & Zoom"
    assert shell.video.tool == "select"
    QTest.keyClick(shell, Qt.Key.Key_Z, CONTROL)
    assert name.text() == "small"


def test_a_character_is_called_otherwise(shell: Shell) -> None:
    """The pencil begins, Enter takes the name as one entry, Escape leaves it; a name that is taken is refused."""
    QTest.keyClick(shell, Qt.Key.Key_F2)
    inspector = shell.character.inspector
    wait_for(lambda: inspector.character is not None)
    for typed, key, name in (("Rex", Qt.Key.Key_Return, "Rex"), ("Bello", Qt.Key.Key_Escape, "Rex")):
        QTest.mouseClick(inspector.name.rename, LEFT)
        field = inspector.chooser.lineEdit()
        QTest.keyClicks(field, typed)
        QTest.keyClick(field, key)
        settle()
        assert shell.project.document.characters[0].name == name
        assert inspector.chooser.currentText() == name
        assert not inspector.chooser.isEditable()
    assert shell.project.session.history.undo_label == "Rename hound to Rex"
    shell.setFocus()
    QTest.keyClick(shell, Qt.Key.Key_Z, CONTROL)
    settle()
    assert inspector.chooser.currentText() == "hound"


def test_all_masks_are_removed_at_once(shell: Shell) -> None:
    """One entry, taken back by one undo."""
    square = [(20, 20), (80, 20), (80, 80)]
    for frame in (0, 5):
        shell.project.edit(scene.add_lasso, frame, square)
    shell.do("clear_masks")
    assert not shell.project.document.masks
    QTest.keyClick(shell, Qt.Key.Key_Z, CONTROL)
    assert len(shell.project.document.masks) == 2
