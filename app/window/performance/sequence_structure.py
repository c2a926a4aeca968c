"""How the motions of the chosen sequence are found: the numbers of the method, and what it says of its result."""

from __future__ import annotations

from typing import Any

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QCheckBox, QVBoxLayout, QWidget

from app.model.edits import sequences
from app.model.performance import CapturedSequence
from app.window.controls import Chooser, NumberField, NumberRange, Row, button, label
from app.window.controls.own_keys import PressKeys
from app.window.performance.state import PerformanceState
from app.window.performance.strip_colours import structure_of

BETA = NumberRange(0.0001, 10.0, 0.001, 3, "")
SENSITIVITY = NumberRange(0.05, 5.0, 0.01, 2, "×", 1.0)
PERIOD = NumberRange(0.2, 60.0, 0.05, 1, "s", 5.0)
METHODS = (("optimal", "Whole sequence"), ("paper", "As printed"))
WIDE = 92


class SequenceStructure(QWidget):
    """Every change is an edit of the sequence."""

    def __init__(self, state: PerformanceState) -> None:
        super().__init__()
        self.state = state
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(6)
        self.method = Chooser([text for _, text in METHODS], "Method")
        self.method.setToolTip("Cut the whole sequence at once, or frame by frame as the paper prints it")
        self.method.activated.connect(lambda index: self._change(method=METHODS[index][0]))
        column.addWidget(Row("Method", self.method, width=WIDE))
        self.sensitivity = NumberField(SENSITIVITY)
        self.sensitivity.setToolTip("Less finds fewer, longer motions. Right-click for the default.")
        self.sensitivity.setAccessibleName("Sensitivity")
        self.sensitivity.changed.connect(lambda value: self._change(sensitivity=value))
        self.sensitivity_row = Row("Sensitivity", self.sensitivity, width=WIDE)
        column.addWidget(self.sensitivity_row)
        self.beta = NumberField(BETA)
        self.beta.setToolTip("Threshold of eq. 8: less finds more motions")
        self.beta.setAccessibleName("Threshold beta")
        self.beta.changed.connect(lambda value: self._change(beta=value))
        self.derive = button("Derive it", lambda: self._change(beta=None))
        self.beta_row = Row("Threshold β", self.beta, self.derive, width=WIDE)
        column.addWidget(self.beta_row)
        self.period = NumberField(PERIOD)
        self.period.setToolTip("The longest time that a repeat may take. Right-click for the default.")
        self.period.setAccessibleName("Longest period")
        self.period.changed.connect(lambda value: self._change(longest_period=value))
        column.addWidget(Row("Longest repeat", self.period, width=WIDE))
        self.cyclic = QCheckBox("Everything repeats")
        self.cyclic.setToolTip("Every stretch that is long enough counts as repeating")
        self.cyclic.toggled.connect(lambda on: self._change(force_cyclic=on))
        self.cyclic.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        PressKeys(self.cyclic)
        column.addWidget(Row("", self.cyclic, width=WIDE))
        self.reason = label("", "caption")
        self.reason.setWordWrap(True)
        self.reason.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        column.addWidget(self.reason)
        self.again = button("Find the boundaries again", self.find_again, name="reset")
        self.again.setToolTip("Forget boundaries set by hand")
        column.addWidget(self.again, 0, Qt.AlignmentFlag.AlignLeft)

    @property
    def sequence(self) -> CapturedSequence | None:
        """The sequence chosen."""
        return next((each for each in self.state.document.sequences if each.id == self.state.sequence_id), None)

    def refresh(self) -> None:
        """Show the document."""
        sequence = self.sequence
        self.setVisible(sequence is not None)
        if sequence is None:
            return
        choice, found = sequence.structure, structure_of(self.state, sequence.id)
        printed = choice.method == "paper"
        self.method.setCurrentIndex([name for name, _ in METHODS].index(choice.method))
        self.sensitivity.set_value(choice.sensitivity)
        self.period.set_value(choice.longest_period)
        self.beta_row.setVisible(printed)
        self.sensitivity_row.setVisible(not printed)
        derived = float(found.threshold) if found is not None and found.method == "paper" else BETA.low
        self.beta.set_value(choice.beta if choice.beta is not None else derived)
        self.derive.setEnabled(choice.beta is not None)
        self.cyclic.blockSignals(True)
        self.cyclic.setChecked(choice.force_cyclic)
        self.cyclic.blockSignals(False)
        self.again.setVisible(choice.boundaries is not None)
        self.reason.setText(found.reason if found is not None else "")

    def _change(self, **changes: Any) -> None:
        sequence = self.sequence
        if sequence is not None and self.state.project is not None:
            self.state.project.edit(sequences.set_structure, sequence.id, **changes)
        self.refresh()

    def find_again(self) -> None:
        """Forget boundaries set by hand."""
        sequence = self.sequence
        if sequence is not None and self.state.project is not None:
            self.state.project.edit(sequences.set_boundaries, sequence.id, None)
