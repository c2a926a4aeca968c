"""Settings of the program: few, each in force at once or said to be so at the next start."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QDialog, QHBoxLayout, QVBoxLayout, QWidget

from app.window import settings, theme
from app.window.controls import Chooser, button, label, separator

if TYPE_CHECKING:
    from app.window.shell import Shell

LABELS, CHOICES = 150, 220
"""Widths in pixels of the two columns."""
VIEWPORTS = {"auto": "Whatever is quicker here", "gl": "OpenGL", "raster": "Processor alone"}


class SettingsDialog(QDialog):
    """Not modal; what is chosen is remembered."""

    def __init__(self, shell: Shell) -> None:
        super().__init__(shell)
        self.shell = shell
        self.setWindowTitle("Settings")
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.column = QVBoxLayout(self)
        self.column.setContentsMargins(20, 16, 20, 16)
        self.column.setSpacing(8)
        self.look = self._choice("Look", ("dark", "light"), ("Dark", "Light"), theme.active().name, self._set_look)
        seconds = settings.AUTOSAVES
        said = [f"{each} seconds" if each < 120 else f"{each // 60} minutes" for each in seconds]
        self.autosave = self._choice("Autosave every", seconds, said, settings.autosave_seconds(), self._set_autosave)
        sizes = [f"{each} MB" if each < 1024 else f"{each // 1024} GB" for each in settings.MEMORY]
        self.memory = self._choice(
            "Results in memory", settings.MEMORY, sizes, settings.memory_megabytes(), self._set_memory
        )
        self.viewport = self._choice(
            "3D drawn by", tuple(VIEWPORTS), tuple(VIEWPORTS.values()), settings.viewport(), self._set_viewport
        )
        self.note = label("", "caption")
        self.note.hide()
        self.column.addWidget(self.note)
        self.column.addWidget(separator())
        self._results()
        self._end()
        self._measure()

    def _choice(
        self, text: str, values: Sequence[object], said: Sequence[str], present: object, call: Callable[[object], None]
    ) -> Chooser:
        box = Chooser(name=text)
        for value, words in zip(values, said, strict=True):
            box.addItem(words, value)
        box.setCurrentIndex(list(values).index(present))
        box.activated.connect(lambda index: call(box.itemData(index)))
        self._row(text, box)
        return box

    def _row(self, text: str, control: QWidget) -> None:
        row = QHBoxLayout()
        row.setSpacing(12)
        caption = label(text, "label")
        caption.setFixedWidth(LABELS)
        control.setFixedWidth(CHOICES)
        row.addWidget(caption)
        row.addWidget(control)
        row.addStretch(1)
        self.column.addLayout(row)

    def _results(self) -> None:
        """What is computed for the open project, and a way to make room."""
        row = QHBoxLayout()
        row.setSpacing(12)
        caption = label("Results on the disk", "label")
        caption.setFixedWidth(LABELS)
        self.size = label("", "value")
        self.clear = button("Delete them", self._clear, name="delete")
        self.clear.setToolTip("What was computed for this project; it can be computed again.")
        row.addWidget(caption)
        row.addWidget(self.size, 1)
        row.addWidget(self.clear)
        self.column.addLayout(row)

    def _end(self) -> None:
        row = QHBoxLayout()
        row.addWidget(button("Keys…", lambda: self.shell.do("keys"), name="keys"))
        row.addStretch(1)
        self.close_button = button("Close", self.close, primary=True)
        row.addWidget(self.close_button)
        self.column.addSpacing(8)
        self.column.addLayout(row)

    # what is chosen ----------------------------------------------------------------------------------------------

    def _set_look(self, name: object) -> None:
        if name != theme.active().name:
            self.shell.dispatch.switch_look()

    def _set_autosave(self, seconds: object) -> None:
        settings.settings().setValue("autosave", seconds)
        self.shell.care.set_pace()

    def _set_memory(self, megabytes: object) -> None:
        settings.settings().setValue("memory", megabytes)
        self.shell.care.set_memory()

    def _set_viewport(self, kind: object) -> None:
        settings.settings().setValue("viewport", kind)
        self.note.setText("3D is drawn so when the program starts again.")
        self.note.show()

    # results -----------------------------------------------------------------------------------------------------

    def _measure(self) -> None:
        project = self.shell.project
        self.clear.setEnabled(False)
        if project is not None and project.session.cache.store is not None:
            self.size.setText("…")
            self.shell.calls.run(project.session.cache.store.size, self._measured)

    def _measured(self, size: int) -> None:
        from shiboken6 import isValid

        if isValid(self):
            project = self.shell.project
            self.size.setText(f"{size / 1e6:.0f} MB")
            self.clear.setEnabled(size > 0 and project is not None and not project.progress)

    def _clear(self) -> None:
        project = self.shell.project
        if project is not None and not project.progress and project.session.cache.store is not None:
            self.shell.calls.run(project.session.cache.store.clear, lambda _: self._cleared())

    def _cleared(self) -> None:
        from shiboken6 import isValid

        self.shell.refresh_soon()
        if isValid(self):
            self._measure()
