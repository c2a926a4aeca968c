"""What is known of the chosen sequence: rate, up, unit, front, level, and what its files hold."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QCheckBox, QHBoxLayout, QToolButton, QVBoxLayout, QWidget

from app.model.edits import sequences
from app.model.performance import CapturedSequence
from app.window.controls import Chooser, NumberField, NumberRange, Row, button, icon_button, label
from app.window.controls.own_keys import PressKeys
from app.window.performance.state import PerformanceState

RATE = NumberRange(0.1, 1000.0, 0.1, 2, "fps")
METRES = NumberRange(1e-6, 1e4, 0.001, 4, "m")
ANGLE = NumberRange(-180.0, 180.0, 1.0, 0, "°")
UNITS = (("Metres", 1.0), ("Centimetres", 0.01), ("Millimetres", 0.001), ("Inches", 0.0254))
OTHER = "Other"
LABEL = 56


class SequenceFacts(QWidget):
    """Every change is an edit; what was guessed carries a tick that says it is right."""

    measured = Signal(str)

    def __init__(self, state: PerformanceState) -> None:
        super().__init__()
        self.state = state
        self.azimuth: Callable[[], float | None] = lambda: None
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(6)
        self.ticks: dict[str, QToolButton] = {}
        self.rate = NumberField(RATE)
        self.rate.changed.connect(lambda value: self._say(source_fps=value))
        self.rate.setAccessibleName("Frame rate of the files")
        column.addWidget(self._guessed("fps", "Filmed at", self.rate))
        self.up = Chooser(["Y up", "Z up"], "Axis that points up")
        self.up.activated.connect(lambda index: self._say(up="yz"[index]))
        column.addWidget(self._guessed("up", "Axes", self.up))
        self.unit = Chooser([*(name for name, _ in UNITS), OTHER], "Unit of the files")
        self.unit.activated.connect(self._chose_unit)
        self.metres = NumberField(METRES)
        self.metres.setAccessibleName("Metres in one unit")
        self.metres.changed.connect(lambda value: self._say(unit=value))
        column.addWidget(self._guessed("unit", "Unit", self.unit, self.metres))
        self.front = NumberField(ANGLE)
        self.front.setToolTip("Where the performer faces in the first frame, from +x towards +y")
        self.front.setAccessibleName("Front of the performer")
        self.front.changed.connect(lambda value: self._edit(sequences.set_front, value))
        self.here = button("Faces me", self.face_me)
        self.here.setToolTip("Show the first frame, turn the view until the performer looks at you, then click")
        self.found = icon_button("reset", "Find the front again", lambda: self._edit(sequences.set_front, None))
        column.addWidget(Row("Front", _line(self.front, self.here, self.found), width=LABEL))
        self.level = QCheckBox("Level the ground")
        self.level.setToolTip("Take out what the performer climbs, so that it joins motions on the flat")
        self.level.toggled.connect(self._level)
        self.level.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        PressKeys(self.level)
        column.addWidget(Row("", self.level, width=LABEL))
        self.statistics = label("", "caption")
        self.statistics.setWordWrap(True)
        self.statistics.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        column.addWidget(self.statistics)
        self.measure = button("Measure", lambda: self.measured.emit(self.state.sequence_id))
        self.measure.setToolTip("Read all frames once: vertices, faces, colours, height")
        column.addWidget(self.measure, 0, Qt.AlignmentFlag.AlignLeft)

    def _guessed(self, fact: str, text: str, *controls: QWidget) -> Row:
        tick = icon_button("right", "The guess is right", lambda: self._confirm(fact))
        self.ticks[fact] = tick
        return Row(text, _line(*controls, tick), width=LABEL)

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
        files = sequence.media is not None
        self.rate.set_value(sequence.source_fps)
        self.up.setCurrentIndex("yz".index(sequence.up))
        self.metres.set_value(sequence.unit)
        known = [value for _, value in UNITS]
        self.unit.setCurrentIndex(known.index(sequence.unit) if sequence.unit in known else len(UNITS))
        self.metres.setVisible(sequence.unit not in known)
        for each in (self.rate, self.up, self.unit, self.metres):
            each.setEnabled(files)
        for fact, tick in self.ticks.items():
            tick.setVisible(fact in sequence.guessed)
        self.front.set_value(self._facing(sequence))
        self.found.setEnabled(sequence.front is not None)
        self.level.blockSignals(True)
        self.level.setChecked(sequence.level)
        self.level.blockSignals(False)
        self._show_statistics(sequence)

    def _facing(self, sequence: CapturedSequence) -> float:
        if sequence.front is not None:
            return sequence.front
        project = self.state.project
        known = project.result(project.session.stages.analysis(sequence.id)) if project is not None else None
        return 0.0 if known is None else float(known.headings[0]) * 57.29577951308232

    def _show_statistics(self, sequence: CapturedSequence) -> None:
        project = self.state.project
        found: Any = project.result(project.session.stages.features(sequence.id)) if project is not None else None
        self.measure.setVisible(found is None)
        self.statistics.setText("\n".join(statistics_lines(sequence, None if found is None else found.statistics)))

    # edits -------------------------------------------------------------------------------------------------------

    def _edit(self, make: Callable[..., Any], *values: Any, **options: Any) -> None:
        sequence = self.sequence
        if sequence is not None and self.state.project is not None:
            self.state.project.edit(make, sequence.id, *values, **options)
        self.refresh()

    def _say(self, **facts: Any) -> None:
        self._edit(sequences.set_facts, **facts)

    def _chose_unit(self, index: int) -> None:
        if index < len(UNITS):
            self._say(unit=UNITS[index][1])
        else:
            self.metres.setVisible(True)
            self.metres.setFocus(Qt.FocusReason.OtherFocusReason)

    def _confirm(self, fact: str) -> None:
        sequence = self.sequence
        if sequence is not None:
            name = {"fps": "source_fps"}.get(fact, fact)
            self._say(**{name: getattr(sequence, name)})

    def _level(self, on: bool) -> None:
        self._edit(sequences.set_level, on)

    def face_me(self) -> None:
        """The performer of the first frame looks at whoever looks at it; the first frame is shown first."""
        sequence = self.sequence
        if sequence is None:
            return
        if self.state.shows != "source" or self.state.source_frame != 0:
            self.state.show_source(sequence.id, 0)
            self.state.hint.emit("Turn the view until the performer looks at you, then click Faces me once more.")
            return
        seen = self.azimuth()
        if seen is not None:
            self._edit(sequences.set_front, seen)


def statistics_lines(sequence: CapturedSequence, statistics: Any) -> list[str]:
    """What the files hold, in words; what is not measured yet is left out."""
    seconds = sequence.frame_count / sequence.fps
    lines = [f"{sequence.frame_count:,} frames, {seconds:.2f} s"]
    if sequence.fps != sequence.source_fps:
        lines.append(f"{sequence.source_count:,} files at {sequence.source_fps:g} fps, played at {sequence.fps:g}")
    if statistics is None:
        return lines
    low, middle, high = statistics.vertices
    counted = f"{middle:,}" if low == high else f"{low:,} to {high:,}"
    lines.append(f"{counted} vertices, {statistics.faces[1]:,} faces a frame")
    lines.append("the same faces in every frame" if statistics.moving else "faces of its own in every frame")
    dress = "pictures" if statistics.textured else "colours" if statistics.coloured else "no colours"
    lines.append(f"{statistics.height:.2f} m tall, {dress}")
    return lines


def _line(*controls: QWidget) -> QWidget:
    body = QWidget()
    row = QHBoxLayout(body)
    row.setContentsMargins(0, 0, 0, 0)
    row.setSpacing(4)
    for number, each in enumerate(controls):
        row.addWidget(each, 1 if number == 0 else 0)
        if isinstance(each, NumberField) and number:
            each.setFixedWidth(72)
    return body
