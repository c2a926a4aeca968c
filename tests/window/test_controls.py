"""Base controls, driven with real events."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from app.window.controls import Chip, Elided, ErrorBar, Meter, NumberField, NumberRange, Swatches
from app.window.controls.number import dragged
from tests.window.conftest import at, drag

RANGE = NumberRange(-10.0, 10.0, 0.01, 2, "m", 1.5)


@given(st.floats(-10, 10, allow_nan=False))
def test_shown_numbers_are_read_back(value: float) -> None:
    """What is shown, typed again, gives the same number up to the shown decimals."""
    found = RANGE.parsed(RANGE.text(value))
    assert found is not None
    assert abs(found - value) <= 0.5 * 10**-RANGE.decimals + 1e-12


@pytest.mark.parametrize(
    ("text", "value"), [("1,5", 1.5), (" 2.25 m", 2.25), ("99", 10.0), ("-99", -10.0), ("x", None)]
)
def test_typed_numbers(text: str, value: float | None) -> None:
    """Comma and unit are understood, bounds hold, nonsense is refused."""
    assert RANGE.parsed(text) == value


@given(st.floats(-10, 10), st.floats(-5000, 5000), st.booleans(), st.booleans())
def test_drags_stay_in_bounds(start: float, pixels: float, fast: bool, fine: bool) -> None:
    """No drag leaves the range."""
    assert RANGE.low <= dragged(start, pixels, RANGE, fast=fast, fine=fine) <= RANGE.high


@pytest.fixture
def field(qapp: QApplication) -> NumberField:
    """A number field on the screen."""
    field = NumberField(RANGE, 1.5)
    field.resize(120, 28)
    field.show()
    yield field
    field.close()
    field.deleteLater()


def test_dragging_changes_live_and_reports_once_at_the_end(field: NumberField) -> None:
    """A sideways drag of 40 pixels adds 0.40."""
    live, done = [], []
    field.changing.connect(live.append)
    field.changed.connect(done.append)
    drag(field, (30, 14), (70, 14))
    assert len(live) > 2
    assert done == [pytest.approx(1.9)]
    assert field.text() == "1.90 m"


def test_clicking_lets_type(field: NumberField) -> None:
    """A click opens the field, Enter takes the number."""
    done = []
    field.changed.connect(done.append)
    QTest.mouseClick(field, Qt.MouseButton.LeftButton, pos=at(30, 14))
    QTest.keyClicks(field, "2.5")
    QTest.keyClick(field, Qt.Key.Key_Return)
    assert done == [2.5]
    assert field.text() == "2.50 m"


def test_escape_keeps_the_old_number(field: NumberField) -> None:
    """Typing is given up by Escape."""
    QTest.mouseClick(field, Qt.MouseButton.LeftButton, pos=at(30, 14))
    QTest.keyClicks(field, "7")
    QTest.keyClick(field, Qt.Key.Key_Escape)
    assert field.value == 1.5
    assert field.text() == "1.50 m"


def test_keys_step_and_reset_goes_back(field: NumberField) -> None:
    """Up steps, Shift steps ten, reset gives the default."""
    field.setFocus()
    QTest.keyClick(field, Qt.Key.Key_Up)
    QTest.keyClick(field, Qt.Key.Key_Up, Qt.KeyboardModifier.ShiftModifier)
    assert field.value == pytest.approx(1.61)
    field.reset()
    assert field.value == 1.5


def test_the_document_does_not_overwrite_what_is_being_typed(field: NumberField) -> None:
    """A value that arrives while the user types waits."""
    QTest.mouseClick(field, Qt.MouseButton.LeftButton, pos=at(30, 14))
    QTest.keyClicks(field, "3")
    field.set_value(9.0)
    assert field.text() == "3"
    QTest.keyClick(field, Qt.Key.Key_Return)
    assert field.value == 3.0


def test_error_bar_says_one_sentence_with_details_on_demand(qapp: QApplication) -> None:
    """The details are folded away until asked for; the action does its thing and hides the bar."""
    bar, done = ErrorBar(), []
    bar.tell("Frame 3 is damaged.", "trace", action=("Skip it", lambda: done.append(1)))
    bar.resize(700, 200)
    bar.show()
    assert bar.sentence.text() == "Frame 3 is damaged."
    assert not bar.details.isVisible()
    QTest.mouseClick(bar._more, Qt.MouseButton.LeftButton)
    assert bar.details.isVisible()
    QTest.mouseClick(bar._action, Qt.MouseButton.LeftButton)
    assert done == [1]
    assert not bar.isVisible()
    bar.deleteLater()


def test_swatches_choose_by_mouse_and_keys(qapp: QApplication) -> None:
    """The colour under the mouse is chosen, the arrow keys go on from there."""
    row, chosen = Swatches(), []
    row.chosen.connect(chosen.append)
    row.resize(180, 24)
    row.show()
    QTest.mouseClick(row, Qt.MouseButton.LeftButton, pos=at(70, 12))
    QTest.keyClick(row, Qt.Key.Key_Right)
    assert chosen == [3, 4]
    row.close()
    row.deleteLater()


def test_elided_text_shows_all_of_itself_as_a_tooltip(qapp: QApplication) -> None:
    """What does not fit can be read by pointing at it."""
    text = Elided("A very long description of a small thing")
    text.resize(60, 20)
    text.grab()
    assert text.toolTip() == text.text()
    text.resize(600, 20)
    text.grab()
    assert text.toolTip() == ""
    text.deleteLater()


def test_chip_and_meter_take_states(qapp: QApplication) -> None:
    """An empty chip is hidden; a meter keeps its share in bounds."""
    chip, meter = Chip("", "ok"), Meter()
    assert not chip.isVisibleTo(None)
    meter.show_value(3.0)
    assert meter.value == 1.0
    chip.deleteLater()
    meter.deleteLater()
