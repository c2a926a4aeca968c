"""How the performance shall be: length, loop, which of the paths, placing and blending of cuts."""

from __future__ import annotations

from typing import Any

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QHBoxLayout, QWidget

from app.model.edits import performance as edits
from app.window import theme
from app.window.controls import Chooser, Elided, NumberField, NumberRange, toggle
from app.window.performance.blocks import joint_of
from app.window.performance.composed_paint import advice
from app.window.performance.editing import PerformanceEditing
from app.window.performance.state import PerformanceState


class PathChooser(Chooser):
    """The best path and the next best. ``looked_at`` gives the one that is marked in the open list, -1 at its end."""

    looked_at = Signal(int)

    def __init__(self) -> None:
        super().__init__(name="Which path is taken")
        self._looking = False
        self.highlighted.connect(self._look)

    def _look(self, number: int) -> None:
        if self.view().isVisible():
            self._looking = True
            self.looked_at.emit(number)

    def hidePopup(self) -> None:
        """Nothing is looked at any more."""
        super().hidePopup()
        if self._looking:
            self._looking = False
            self.looked_at.emit(-1)


class OptionsBar(QWidget):
    """One row of controls; each change is an entry of the history."""

    def __init__(self, state: PerformanceState, editing: PerformanceEditing) -> None:
        super().__init__()
        self.state, self.editing = state, editing
        self._showing = False
        self.setFixedHeight(36)
        row = QHBoxLayout(self)
        row.setContentsMargins(12, 0, 12, 0)
        row.setSpacing(6)
        self._paths(row)
        row.addSpacing(10)
        self._length(row)
        row.addSpacing(10)
        self._smoothing(row)
        row.addSpacing(10)
        self.note = Elided("", "caption")
        row.addWidget(self.note, 1)
        self.refresh()

    def _paths(self, row: QHBoxLayout) -> None:
        self.paths = PathChooser()
        self.paths.setToolTip("The best path and the next best: the cost of the worst transition, and the length")
        self.paths.setFixedWidth(262)
        self.paths.activated.connect(self._take)
        row.addWidget(self.paths)

    def _length(self, row: QHBoxLayout) -> None:
        self.wanted = toggle("length", "Length", self._want)
        self.wanted.setToolTip(
            "Want a number of frames: exact where it can be reached, else the nearest, with the reason"
        )
        self.frames = NumberField(NumberRange(1, 1_000_000, 1, 0, "f"), 1)
        self.frames.setFixedWidth(66)
        self.seconds = NumberField(NumberRange(0.04, 40_000, 0.04, 2, "s"), 0.04)
        self.seconds.setFixedWidth(66)
        self.frames.setAccessibleName("Wanted length in frames")
        self.seconds.setAccessibleName("Wanted length in seconds")
        self.frames.changed.connect(lambda value: self._set_length(round(value)))
        self.seconds.changed.connect(lambda value: self._set_length(round(value * self.state.fps)))
        self.loop = toggle("loop", "Loop", self._loop)
        self.loop.setToolTip("The end leads back to the start")
        for each in (self.wanted, self.frames, self.seconds, self.loop):
            row.addWidget(each)

    def _smoothing(self, row: QHBoxLayout) -> None:
        self.align = toggle("align", "Align", lambda on: self._smooth(align=on))
        self.align.setToolTip("Place every clip where the one before it ends, so that a walk walks on")
        self.blend = toggle("blend", "Blend", lambda on: self._smooth(blend=on))
        self.blend.setToolTip("Make in-betweens at cuts that need them")
        self.blend_seconds = NumberField(NumberRange(0.04, 5.0, 0.01, 2, "s", 0.3), 0.3)
        self.blend_seconds.setFixedWidth(60)
        self.blend_seconds.setAccessibleName("Seconds a blend lasts")
        self.blend_seconds.changed.connect(lambda value: self._smooth(seconds=value))
        self.hard = toggle("hard_cut", "Hard cut", self._hard)
        self.hard.setToolTip("Leave the chosen cut as it is")
        for each in (self.align, self.blend, self.blend_seconds, self.hard):
            row.addWidget(each)

    # showing -----------------------------------------------------------------------------------------------------

    def refresh(self) -> None:
        """Show the choices of the document."""
        self._showing = True
        choice, state = self.state.document.performance, self.state
        fps = state.fps
        self.wanted.setChecked(choice.length is not None)
        frames = choice.length or max(state.frame_count, 1)
        self.frames.set_value(frames)
        self.seconds.set_value(frames / fps)
        for field in (self.frames, self.seconds):
            field.setEnabled(choice.length is not None)
            if choice.length is None and not state.frame_count:
                field.setText("")
        self.loop.setChecked(choice.loop)
        self.align.setChecked(choice.align)
        self.blend.setChecked(choice.blend)
        self.blend.setEnabled(choice.align)
        self.blend_seconds.set_value(choice.blend_seconds)
        self.blend_seconds.setEnabled(choice.align and choice.blend)
        self.note.setText(self._words())
        style = f"color: {theme.active().warn};"
        if style != self.note.styleSheet():
            self.note.setStyleSheet(style)
        self._show_cut()
        self._show_paths()
        self._showing = False

    def _show_paths(self) -> None:
        texts = [
            f"{'Best path' if not number else f'Path {number + 1}'}: worst {path.cost:.2f}, {len(path)} frames"
            for number, path in enumerate(self.state.paths)
        ]
        texts = texts or ["No path yet"]
        if texts != [self.paths.itemText(number) for number in range(self.paths.count())]:
            self.paths.clear()
            self.paths.addItems(texts)
        for number, path in enumerate(self.state.paths):
            self.paths.setItemData(number, self._way(path), Qt.ItemDataRole.ToolTipRole)
        self.paths.setCurrentIndex(min(self.state.document.performance.alternative, len(texts) - 1))
        self.paths.setEnabled(len(texts) > 1)

    def _words(self) -> str:
        """Why a length is not met; else what can be done about the chosen cut."""
        performance, cut = self.state.performance, self.state.cut
        if performance is None or performance.note:
            return "" if performance is None else str(performance.note)
        known = 0 <= cut < len(performance.cuts) and performance.cuts[cut].kind == "cut"
        return advice(joint_of(self.state, performance, cut)) if known else ""

    def _way(self, path: Any) -> str:
        """The motions of a path by their names."""
        return ", ".join(self.state.motions[node].name for node in path.path if node < len(self.state.motions))

    def _show_cut(self) -> None:
        performance, cut = self.state.performance, self.state.cut
        known = performance is not None and 0 <= cut < len(performance.cuts)
        ready = known and self.state.document.performance.blend and performance.cuts[cut].kind == "cut"
        self.hard.setEnabled(ready)
        self.hard.setChecked(ready and self.editing.is_hard(cut))

    # changing ----------------------------------------------------------------------------------------------------

    def _take(self, number: int) -> None:
        if self.state.project is not None and number != self.state.document.performance.alternative:
            self.state.project.edit(edits.set_alternative, number)

    def _want(self, on: bool) -> None:
        if not self._showing:
            self._set_length(max(self.state.frame_count, 1) if on else None)

    def _set_length(self, frames: int | None) -> None:
        project = self.state.project
        if project is not None and frames != self.state.document.performance.length:
            project.edit(edits.set_length, frames)

    def _loop(self, on: bool) -> None:
        if not self._showing and self.state.project is not None:
            self.state.project.edit(edits.set_loop, on)

    def _smooth(self, **changes: bool | float) -> None:
        if not self._showing and self.state.project is not None:
            self.state.project.edit(edits.set_smoothing, **changes)

    def _hard(self, on: bool) -> None:
        if not self._showing:
            self.editing.set_hard(self.state.cut, on)
