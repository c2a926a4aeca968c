"""The panel of the self-similarity matrix, beside the preview or in its place."""

from __future__ import annotations

from typing import Any

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QImage
from PySide6.QtWidgets import QStackedWidget

from app.window.controls import ErrorBar, Panel, icon_button, label
from app.window.newest_call import NewestCall
from app.window.performance.matrix_view import MatrixView
from app.window.performance.preview import Preview
from app.window.performance.source_strip import SourceStrip
from app.window.performance.state import PerformanceState
from app.window.work import details

WAITING = "Dark where two moments look alike. The sequence has not been compared yet."


class Matrix(Panel):
    """Follows the source strip: the same motions, the same playhead, the same edits. ``closed`` asks to hide it."""

    closed = Signal()

    def __init__(self, state: PerformanceState, strip: SourceStrip) -> None:
        super().__init__("Self-similarity", " ")
        self.state, self.strip = state, strip
        self.view = MatrixView()
        self.errors = ErrorBar()
        self.waiting = label(WAITING, "caption")
        self.waiting.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self.waiting.setWordWrap(True)
        self.header.row.addWidget(icon_button("fit", "Show the whole matrix", self.view.show_all))
        self.header.row.addWidget(icon_button("close", "Back to the preview", self.closed.emit))
        for widget, stretch in ((self.errors, 0), (self.view, 1), (self.waiting, 1)):
            self.column.addWidget(widget, stretch)
        self._calls = NewestCall("similarity", self)
        self._calls.answered.connect(self._drawn)
        self._calls.refused.connect(lambda _, error: self.errors.tell(str(error), details(error)))
        self._shown: Any = None
        self._picture = QImage()
        self._found: Any = None
        self.view.sought.connect(lambda frame: state.show_source(state.sequence_id, frame))
        self.view.moved.connect(self._moved)
        self.view.stepped.connect(self._step)
        strip.view.chosen.connect(lambda _: self.view.show_boundary(strip.view.boundary))
        strip.refreshed.connect(self.refresh)
        for signal in (state.position_changed, state.source_changed, state.shows_changed):
            signal.connect(self._move)

    def refresh(self, *_: object) -> None:
        """Show the matrix of the chosen sequence, drawn in the background where it is another one."""
        project, sequence = self.state.project, self.strip.sequence
        if not self.isVisible() or project is None or sequence is None:
            return
        found = project.result(project.session.stages.distances(sequence.id))
        if found is not None and found is not self._shown:
            self._shown = found
            session, chosen = project.session, sequence.id

            def draw() -> Any:
                from app.actions.performing_matrix import similarity

                made = similarity(session, chosen)
                return made, _image(made.picture)

            self._calls.want(id(found), draw)
        there = found is not None and not self._picture.isNull()
        self.view.setVisible(there)
        self.waiting.setVisible(not there)
        self.header.caption.setText(sequence.name)
        if there and self._found is not None and len(self._found) == self.strip.view.strip.count:
            self.view.show_matrix(self._picture, self.strip.view.strip)
        self._move()

    def _drawn(self, wish: object, made: Any) -> None:
        self._found, self._picture = made
        self.view.distance = self._found.distance
        self.errors.hide()
        self.refresh()

    def _move(self, *_: object) -> None:
        self.view.show_frame(self.strip.view.frame)
        self.view.show_boundary(self.strip.view.boundary)

    def _moved(self, old: int, new: int) -> None:
        if not self.strip.move_boundary(old, new):
            self.view.cancel()

    def _step(self, step: int) -> None:
        """Choose the next boundary as the strip does; the same keys then move it and take it away."""
        self.strip.view.next_boundary(step)
        self.view.show_boundary(self.strip.view.boundary)

    def showEvent(self, event: Any) -> None:
        """Draw what changed while it was hidden."""
        super().showEvent(event)
        self.refresh()

    def finish(self) -> None:
        """End the thread."""
        self._calls.close()


class PreviewSide(QStackedWidget):
    """The preview, and the matrix in its place while it is wanted."""

    def __init__(self, preview: Preview, matrix: Matrix, strip: SourceStrip) -> None:
        super().__init__()
        self.preview, self.matrix, self._strip = preview, matrix, strip
        self.addWidget(preview)
        self.addWidget(matrix)
        strip.matrix_wanted.connect(self.show_matrix)
        matrix.closed.connect(lambda: strip.matrix_button.setChecked(False))

    def show_matrix(self, on: bool) -> None:
        """Show the matrix, or the preview again."""
        self.setCurrentWidget(self.matrix if on else self.preview)

    def finish(self) -> None:
        """End the threads and close the render window."""
        self.matrix.finish()
        self.preview.finish()


def _image(picture: Any) -> QImage:
    height, width = picture.shape[:2]
    return QImage(picture.data, width, height, 3 * width, QImage.Format.Format_RGB888).copy()
