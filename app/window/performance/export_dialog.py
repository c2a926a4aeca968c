"""What of the performance is written, and where: meshes, one animated GLB, a film, the path; with progress."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import (
    QCheckBox,
    QDialog,
    QFileDialog,
    QHBoxLayout,
    QLineEdit,
    QProgressBar,
    QVBoxLayout,
    QWidget,
)

from app.stages.job import Job
from app.window import settings
from app.window.background_call import BackgroundCalls
from app.window.controls import Chooser, ErrorBar, NumberField, NumberRange, Row, button, icon_button, label, separator
from app.window.performance.preview_notes import wears_pictures
from app.window.performance.state import PerformanceState

if TYPE_CHECKING:
    from app.actions.performing_wishes import Wish

FORMS = (
    ("ply", "PLY, one file a frame", ""),
    ("obj", "OBJ, one file a frame", ""),
    ("off", "OFF, one file a frame", ""),
    ("glb", "GLB, one file a frame", ""),
    ("npz", "NumPy, one file", ".npz"),
    ("animation", "One animated GLB", ".glb"),
    ("usd", "Universal Scene Description, one file", ".usd"),
    ("film", "Film, mp4", ".mp4"),
    ("path", "The path only: what was composed, and how", ".json"),
)
SIZES = ((640, 360), (960, 540), (1280, 720), (1920, 1080), (720, 720))
ANGLE = NumberRange(-360.0, 360.0, 1.0, 0, "°", 60.0)
KEPT = "performance export"
BLENDING = "The cuts are still being blended: wait a moment, or leave the in-betweens out."


class ExportDialog(QDialog):
    """Does not stop the window: the work is a job like any other. ``done`` gives a sentence once it is written."""

    done = Signal(str)

    def __init__(self, parent: QWidget, state: PerformanceState, azimuth: float | None = None) -> None:
        super().__init__(parent)
        self.state, self._azimuth = state, azimuth
        self.job: Job | None = None
        self._still = ""
        self.setWindowTitle("Export the performance")
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setMinimumWidth(520)
        self._calls = BackgroundCalls(self)
        column = QVBoxLayout(self)
        column.setContentsMargins(20, 16, 20, 16)
        column.setSpacing(10)
        self.errors = ErrorBar()
        column.addWidget(label("Export the performance", "title"))
        column.addWidget(self.errors)
        self.body = self._body()
        column.addWidget(self.body)
        column.addWidget(separator())
        column.addLayout(self._foot())
        self._remembered()
        self._follow()

    # parts -------------------------------------------------------------------------------------------------------

    def _body(self) -> QWidget:
        body = QWidget()
        column = QVBoxLayout(body)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(8)
        self.form = Chooser((text for _, text, _ in FORMS), "Form")
        self.form.activated.connect(self._chose_form)
        column.addWidget(Row("Form", self.form))
        self.why = label("", "caption")
        self.why.setWordWrap(True)
        column.addWidget(Row("", self.why))
        self.place = QLineEdit()
        self.place.setAccessibleName("Where")
        self.place.textChanged.connect(lambda _: self._check())
        browse = icon_button("open", "Choose where", self.ask_place)
        where = QWidget()
        row = QHBoxLayout(where)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(6)
        row.addWidget(self.place, 1)
        row.addWidget(browse)
        column.addWidget(Row("Where", where))
        self.film = self._film()
        column.addWidget(self.film)
        self.blended = QCheckBox("With in-betweens at the cuts")
        self.blended.setChecked(True)
        self.blended.toggled.connect(lambda _: self._check())
        self.path = QCheckBox("Write path.json too: what was composed, and how")
        column.addWidget(Row("", self.blended))
        self.worn = label("In-betweens have colours at their vertices instead of the picture.", "caption")
        column.addWidget(Row("", self.worn))
        column.addWidget(Row("", self.path))
        return body

    def _film(self) -> QWidget:
        body = QWidget()
        column = QVBoxLayout(body)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(8)
        self.angle = NumberField(ANGLE, self._azimuth if self._azimuth is not None else 60.0)
        self.angle.setAccessibleName("Seen from")
        self.as_seen = button("As in the preview", self._take_azimuth)
        self.as_seen.setEnabled(self._azimuth is not None)
        self.turntable = QCheckBox("Once round")
        self.size = Chooser((f"{width} × {height}" for width, height in SIZES), "Size of the picture")
        self.marks = QCheckBox("Name motions and cuts")
        column.addWidget(Row("Seen from", self.angle, self.as_seen))
        column.addWidget(Row("Size", self.size))
        column.addWidget(Row("", self.turntable, self.marks))
        return body

    def _foot(self) -> QHBoxLayout:
        row = QHBoxLayout()
        row.setSpacing(8)
        self.bar = QProgressBar()
        self.bar.setTextVisible(False)
        self.bar.setRange(0, 1000)
        self.bar.hide()
        self.words = label("", "caption")
        self.words.setWordWrap(True)
        self.cancel_button = button("Close", self.reject)
        self.export_button = button("Export", self.export, primary=True, name="export")
        self.export_button.setDefault(True)
        row.addWidget(self.words, 1)
        row.addWidget(self.bar, 1)
        row.addWidget(self.cancel_button)
        row.addWidget(self.export_button)
        return row

    def _follow(self) -> None:
        project = self.state.project
        self.state.results_changed.connect(self._check)
        if project is None:
            return
        project.work_progressed.connect(self._progressed)
        project.job_ended.connect(self._ended)
        project.closing.connect(self._close)
        session = project.session

        def ask() -> str:
            from app.actions.performing_wishes import why_no_animation

            return why_no_animation(session)

        self._still = "Looking whether all frames have the same faces…"
        self._calls.run(ask, self._know)
        self._check()

    # choosing ----------------------------------------------------------------------------------------------------

    @property
    def chosen(self) -> str:
        """The form chosen."""
        return FORMS[self.form.currentIndex()][0]

    def _know(self, why: str) -> None:
        """Whether one animated GLB is possible is known now."""
        self._still = why
        self._check()

    def _chose_form(self, _: int) -> None:
        self.place.setText(str(self._suited(Path(self.place.text()))))
        self._check()

    def _suited(self, path: Path) -> Path:
        """The same place with the ending of the form chosen."""
        endings = {ending for _, _, ending in FORMS if ending}
        bare = path.with_suffix("") if path.suffix.lower() in endings else path
        return bare.with_name(bare.name + FORMS[self.form.currentIndex()][2]) if bare.name else bare

    def _check(self) -> None:
        """Show what belongs to the form, and why it cannot be written where it cannot."""
        project, writing = self.state.project, self.job is not None
        self.film.setVisible(self.chosen == "film")
        for box in (self.blended, self.path):
            box.parentWidget().setVisible(self.chosen != "path")
        pictures = any(wears_pictures(self.state, each.id) for each in self.state.document.sequences)
        worn = pictures and self.blended.isChecked() and self.chosen != "path"
        self.worn.parentWidget().setVisible(worn)
        self.body.setEnabled(not writing)
        why = self._still if self.chosen == "animation" else ""
        if project is None or self.state.placed is None:
            why = (
                "The performance is still being composed." if self.state.frame_count else "Compose a performance first."
            )
        elif self.chosen != "path" and self.blended.isChecked() and not self._blends_ready():
            why = why or BLENDING
        self.why.setText(why)
        self.why.parentWidget().setVisible(bool(why))
        place = self.place.text().strip()
        self.export_button.setEnabled(not why and not writing and bool(place))
        there = bool(place) and self._suited(Path(place).expanduser()).exists()
        self.words.setText("It is there already and will be replaced." if there else "")
        self.adjustSize()

    def _blends_ready(self) -> bool:
        project = self.state.project
        choice = self.state.document.performance
        if project is None or not (choice.blend and choice.align):
            return True
        return project.state(project.session.stages.blends) not in ("missing", "stale", "running")

    def _take_azimuth(self) -> None:
        if self._azimuth is not None:
            self.angle.set_value(self._azimuth)

    def ask_place(self) -> None:
        """Ask where to write."""
        ending = FORMS[self.form.currentIndex()][2]
        if ending:
            chosen, _ = QFileDialog.getSaveFileName(self, "Export the performance", self.place.text(), f"(*{ending})")
        else:
            chosen = QFileDialog.getExistingDirectory(self, "Export into a folder", self.place.text())
        if chosen:
            self.place.setText(str(self._suited(Path(chosen))))

    def _remembered(self) -> None:
        """Begin with what was chosen last."""
        kept = settings.settings()
        names = [name for name, _, _ in FORMS]
        form = str(kept.value(f"{KEPT}/form", "ply"))
        self.form.setCurrentIndex(names.index(form) if form in names else 0)
        folder = Path(str(kept.value(f"{KEPT}/folder", str(Path.home()))))
        name = f"{self.state.document.name} performance".replace("/", "-")
        self.place.setText(str(self._suited((folder if folder.is_dir() else Path.home()) / name)))
        for box, key, default in self._boxes():
            box.setChecked(str(kept.value(f"{KEPT}/{key}", default)) == "yes")
        number = str(kept.value(f"{KEPT}/size", "1"))
        self.size.setCurrentIndex(int(number) if number.isdigit() and int(number) < len(SIZES) else 1)

    def _boxes(self) -> tuple[tuple[QCheckBox, str, str], ...]:
        return (
            (self.blended, "blended", "yes"),
            (self.path, "path", "no"),
            (self.turntable, "turntable", "no"),
            (self.marks, "marks", "no"),
        )

    def _remember(self) -> None:
        kept = settings.settings()
        kept.setValue(f"{KEPT}/form", self.chosen)
        kept.setValue(f"{KEPT}/folder", str(Path(self.place.text()).parent))
        kept.setValue(f"{KEPT}/size", str(self.size.currentIndex()))
        for box, key, _ in self._boxes():
            kept.setValue(f"{KEPT}/{key}", "yes" if box.isChecked() else "no")

    # writing -----------------------------------------------------------------------------------------------------

    def wish(self) -> Wish:
        """What is asked for."""
        from app.actions.performing_wishes import Wish

        return Wish(
            form=self.chosen,  # type: ignore[arg-type]
            target=self._suited(Path(self.place.text().strip()).expanduser()),
            blended=self.blended.isChecked(),
            path=self.path.isChecked(),
            view=self.angle.value,
            turntable=self.turntable.isChecked(),
            size=SIZES[self.size.currentIndex()],
            marks=self.marks.isChecked(),
        )

    def export(self) -> None:
        """Write it in the background."""
        from app.actions.performing_wishes import write_wish

        project = self.state.project
        if project is None or self.job is not None:
            return
        wish, session = self.wish(), project.session
        self._remember()
        self.errors.hide()
        self.job = project.call(
            f"Writing {wish.target.name}", lambda progress: write_wish(session, wish, progress=progress)
        )
        self.bar.setValue(0)
        self.bar.show()
        self.words.hide()
        self.cancel_button.setText("Cancel")
        self._check()

    def _progressed(self) -> None:
        project = self.state.project
        if project is not None and self.job in project.progress:
            self.bar.setValue(round(1000 * project.progress[self.job][0]))

    def _ended(self, job: Job) -> None:
        if job is not self.job:
            return
        self.job = None
        self.bar.hide()
        self.words.show()
        self.cancel_button.setText("Close")
        self._check()
        if job.state == "done":
            self.done.emit(str(job.value))
            self.accept()
        elif job.state == "failed":
            self.errors.tell(job.sentence)
        else:
            self.words.setText("Cancelled: nothing was written.")

    def reject(self) -> None:
        """Cancel what is being written; where nothing is, close."""
        if self.job is not None:
            self.job.cancel()
        else:
            super().reject()

    def _close(self) -> None:
        """The project goes, and its jobs with it."""
        self.job = None
        super().reject()

    def hideEvent(self, event: Any) -> None:
        """Wait for the question that is still asked."""
        self._calls.close()
        super().hideEvent(event)
