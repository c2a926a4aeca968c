"""Where a file goes, and the button that writes it: progress and cancel in the same line while it is written."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from PySide6.QtCore import QUrl, Signal
from PySide6.QtGui import QDesktopServices
from PySide6.QtWidgets import QFileDialog, QHBoxLayout, QLineEdit, QProgressBar, QVBoxLayout, QWidget

from app.stages.job import Job
from app.window.controls import ErrorBar, button, icon_button, label
from app.window.project import Project
from app.window.render.choices import remember_text, remembered_text
from imitation.progress import Progress

Write = Callable[[Path, Progress], Any]


class TargetLine(QWidget):
    """``wanted`` asks for the file to be written. The folder used last is remembered under ``name``."""

    wanted = Signal()

    def __init__(self, project: Project, name: str, verb: str, icon: str) -> None:
        super().__init__()
        self.project, self.name = project, name
        self.filter, self.suffix, self.into_folder = "", "", False
        self.job: Job | None = None
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(8)
        self.bar = ErrorBar()
        column.addWidget(self.bar)
        row = QHBoxLayout()
        row.setSpacing(8)
        self.path = QLineEdit()
        self.path.setAccessibleName("File to write")
        self.browse = icon_button("open", "Choose where to write", self._browse)
        self.progress = QProgressBar()
        self.progress.setRange(0, 1000)
        self.progress.setTextVisible(False)
        self.share = label("", "label")
        self.share.setFixedWidth(40)
        self.write = button(verb, self.wanted.emit, primary=True, name=icon)
        self.cancel = button("Cancel", self._cancel, name="cancel")
        self.path.returnPressed.connect(self.write.click)
        self.caption = label("To", "label")
        row.addWidget(self.caption)
        for widget, stretch in ((self.path, 1), (self.browse, 0), (self.progress, 1), (self.share, 0)):
            row.addWidget(widget, stretch)
        row.addWidget(self.write)
        row.addWidget(self.cancel)
        column.addLayout(row)
        project.work_progressed.connect(self._progressed)
        project.job_ended.connect(self._ended)
        self._show_running(False)

    @property
    def target(self) -> Path:
        """The path as it stands."""
        return Path(self.path.text().strip()).expanduser()

    def suggest(self, stem: str, suffix: str, filter_: str, *, folder: bool) -> None:
        """Take another kind of file: its suffix, what the file dialog lists, whether it is a folder."""
        self.suffix, self.filter, self.into_folder = suffix, filter_, folder
        text = self.path.text().strip()
        if not text:
            place = Path(remembered_text(f"{self.name}_folder", str(Path.home())))
            self.path.setText(str((place if place.is_dir() else Path.home()) / f"{stem}{suffix}"))
        elif Path(text).name:
            self.path.setText(str(Path(text).with_suffix(suffix)))

    def _browse(self) -> None:
        start = str(self.target)
        if self.into_folder:
            chosen = QFileDialog.getExistingDirectory(self, "Choose a folder", str(self.target.parent))
        else:
            chosen, _ = QFileDialog.getSaveFileName(self, "Choose a file", start, self.filter)
        if chosen:
            path = Path(chosen)
            self.path.setText(str(path if path.suffix or self.into_folder else path.with_suffix(self.suffix)))

    def run(self, what: str, write: Write) -> None:
        """Write in the background; what was there stays until all of it is there."""
        target = self.target
        if not self.path.text().strip() or not target.name:
            self.bar.tell("Say where to write it: choose a file.")
            return
        if self.job is not None:
            return
        remember_text(f"{self.name}_folder", str(target.parent))
        self.bar.hide()
        self.job = self.project.call(f"{what} {target.name}", lambda progress: write(target, progress))
        self._show_running(True)
        self.cancel.setFocus()

    def _cancel(self) -> None:
        if self.job is not None:
            self.job.cancel()

    def _progressed(self) -> None:
        if self.job is not None and self.job in self.project.progress:
            share = self.project.progress[self.job][0]
            self.progress.setValue(round(1000 * share))
            self.share.setText(f"{100 * share:.0f} %")

    def _ended(self, job: Job) -> None:
        if job is not self.job:
            return
        self.job = None
        focused = self.cancel.hasFocus()
        self._show_running(False)
        if focused:
            self.write.setFocus()
        if job.state == "done":
            path = Path(job.value)
            place = QUrl.fromLocalFile(str(path if path.is_dir() else path.parent))
            show = ("Show it", lambda: QDesktopServices.openUrl(place))
            self.bar.tell(f"{path.name} is written.", level="note", action=show)
        elif job.state == "cancelled":
            self.bar.tell("Cancelled: nothing was written.", level="warn")
        else:
            self.bar.tell(job.sentence)

    def _show_running(self, running: bool) -> None:
        for widget in (self.path, self.browse, self.write):
            widget.setVisible(not running)
        for widget in (self.progress, self.share, self.cancel):
            widget.setVisible(running)
        self.progress.setValue(0)
        self.share.setText("0 %")
        self.caption.setText(self.job.label if running and self.job is not None else "To")
