"""What is known of the selected point and what can be done with it."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QGridLayout, QHBoxLayout, QLineEdit, QVBoxLayout, QWidget

from app.actions import proposing
from app.model.edits import contacts, tracks
from app.model.tracks import Track
from app.window.controls import Chip, Elided, Meter, Row, ScrollColumn, Swatches, button, icon_button, label, separator
from app.window.lanes_of import DOUBT
from app.window.project import Project
from app.window.reading import KnownTrack
from app.window.video.confidence_strip import ConfidenceStrip
from app.window.video.contact_info import ContactInfo
from app.window.video.point_list import PointList

SHOWN_SPANS = 4
EMPTY = "No points yet: press P and click a place on the subject that can be recognised."
NOTHING = "Choose a point here, in the picture or in the timeline, or add one with the Point tool."


class TrackInspector(ScrollColumn):
    """Shows one track; every change is an edit of the document."""

    go = Signal(int)

    def __init__(self) -> None:
        super().__init__()
        self.project: Project | None = None
        self.track: Track | None = None
        self.nothing = label(EMPTY, "label")
        self.nothing.setWordWrap(True)
        self.rows.addWidget(self.nothing)
        self.list = PointList()
        self.rows.addWidget(self.list)
        self.list.hidden.connect(self._toggle_row)
        self.list.recoloured.connect(self._recolour_row)
        self.body = QWidget()
        column = QVBoxLayout(self.body)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(6)
        self.name = QLineEdit()
        self.name.setAccessibleName("Name of the point")
        self.name.editingFinished.connect(self._rename)
        self.colours = Swatches()
        self.colours.chosen.connect(lambda index: self._edit(tracks.set_track_look, colour=index))
        self.meter = Meter()
        self.sure = label("", "value")
        self.sure.setFixedWidth(34)
        column.addWidget(Row("Name", self.name))
        column.addWidget(Row("Colour", self.colours))
        self.contact_info = ContactInfo()
        column.addWidget(self.contact_info)
        meter = Row("Confidence", self.meter)
        meter.layout().addWidget(self.sure)
        column.addWidget(meter)
        self.strip = ConfidenceStrip()
        self.strip.go.connect(self.go)
        column.addWidget(self.strip)
        column.addWidget(separator())
        self.table = SpanTable()
        self.table.go.connect(self.go)
        column.addWidget(self.table)
        self.suggest = button("Go where a click helps most", self._suggest, name="go")
        column.addWidget(self.suggest)
        column.addWidget(separator())
        column.addLayout(self._actions())
        self.rows.addWidget(self.body)
        self.rows.addStretch(1)
        self.show_track(None, None, 0)

    def _actions(self) -> QGridLayout:
        grid = QGridLayout()
        grid.setSpacing(6)
        self.remove = button("Remove this click", lambda: self._edit(tracks.remove_click, self._frame()))
        self.end = button("End here", lambda: self._edit(tracks.end_track, self._frame()))
        self.hide_ = button("Hidden here", self._toggle_hidden)
        self.contact = button("Contact here", self._toggle_contact)
        self.visible_ = button("Do not draw", self._toggle_drawn)
        self.delete = button("Delete point", lambda: self._edit(tracks.delete_track))
        for each, words in (
            (self.end, "The point leaves the picture here (E); a click in a later frame restarts it."),
            (self.hide_, "Something is in front of the point in this frame (X)."),
            (self.contact, "The point stands on the ground in this frame (Shift+C)."),
            (self.visible_, "Keep the point without drawing it (Shift+H)."),
        ):
            each.setToolTip(words)
        for number, each in enumerate((self.remove, self.end, self.hide_, self.contact, self.visible_, self.delete)):
            grid.addWidget(each, number // 2, number % 2)
        return grid

    def show_track(self, project: Project | None, known: KnownTrack | None, frame: int) -> None:
        """Show the selected track of a project as far as it is known, in a frame."""
        self.project = project
        found = [each for each in project.document.tracks if each.id == project.track_id] if project else []
        self.track = found[0] if found else None
        self.nothing.setVisible(self.track is None)
        self.body.setVisible(self.track is not None)
        if self.track is None or project is None or known is None:
            return
        track = self.track
        if not self.name.hasFocus():
            self.name.setText(track.name)
        self.colours.set_index(track.colour)
        sure = float(known.confidence[frame]) if frame < len(known.confidence) else 0.0
        self.meter.show_value(sure, "ok" if sure >= DOUBT else "warn", DOUBT)
        self.sure.setText(f"{sure:.2f}" if known.state[frame] else "–")
        self.strip.show_track(known, tuple(track.clicks), frame)
        self.table.show_spans(project, track, frame)
        self.contact_info.show_contact(project, track, frame)
        clicked = frame in track.clicks
        hidden = any(frame in interval for interval in track.occluded)
        self.remove.setEnabled(clicked and len(track.clicks) > 1)
        gone = any(frame in interval for interval in track.absent)
        self.end.setEnabled(not gone and not clicked and frame > min(track.clicks))
        self.end.setText("Has ended" if gone else "End here")
        self.hide_.setText("Not hidden here" if hidden else "Hidden here")
        planted = any(frame in contact.span for contact in track.contacts)
        self.contact.setText("No contact here" if planted else "Contact here")
        self.visible_.setText("Do not draw" if track.visible else "Draw again")
        self.suggest.setEnabled(known.complete)

    def show_points(self, rows: list[tuple[Track, KnownTrack]]) -> None:
        """Show the list of all points, where none is chosen."""
        self.list.setVisible(self.track is None and bool(rows))
        if self.track is None:
            self.nothing.setText(NOTHING if rows else EMPTY)
            self.list.show_points(rows)

    def _row(self, track_id: str) -> Track | None:
        tracks = self.project.document.tracks if self.project is not None else ()
        return next((each for each in tracks if each.id == track_id), None)

    def _toggle_row(self, track_id: str) -> None:
        track = self._row(track_id)
        if track is not None and self.project is not None:
            self.project.edit(tracks.set_track_look, track_id, visible=not track.visible)

    def _recolour_row(self, track_id: str) -> None:
        track = self._row(track_id)
        if track is not None and self.project is not None:
            self.project.edit(tracks.set_track_look, track_id, colour=(track.colour + 1) % tracks.COLOURS)

    def _frame(self) -> int:
        return self.project.frame if self.project else 0

    def _edit(self, make: object, *values: object, **options: object) -> None:
        if self.project is not None and self.track is not None:
            self.project.edit(make, self.track.id, *values, **options)  # type: ignore[arg-type]

    def _rename(self) -> None:
        if self.track is not None and self.name.text().strip() != self.track.name:
            self._edit(tracks.rename_track, self.name.text())
            if self.track is not None:
                self.name.setText(self.track.name)

    def _toggle_hidden(self) -> None:
        if self.track is not None:
            hidden = any(self._frame() in interval for interval in self.track.occluded)
            self._edit(tracks.set_occluded, self._frame(), self._frame(), not hidden)

    def _toggle_drawn(self) -> None:
        if self.track is not None:
            self._edit(tracks.set_track_look, visible=not self.track.visible)

    def _suggest(self) -> None:
        if self.project is None or self.track is None:
            return
        found = proposing.click_wanted(self.project.session, self.track.id)
        if found is not None:
            self.go.emit(found[1])

    def _toggle_contact(self) -> None:
        self._edit(contacts.toggle_contact, self._frame())

    def command(self, name: str) -> bool:
        """Do a command on the track that is shown; says whether it was one."""
        handlers: dict[str, Callable[[], object]] = {
            "contact_here": self._toggle_contact,
            "end_point": lambda: self._edit(tracks.end_track, self._frame()),
            "hide_point": self._toggle_hidden,
            "draw_point": self._toggle_drawn,
            "rename_point": lambda: (self.name.setFocus(), self.name.selectAll()),
        }
        if name in handlers and self.track is not None:
            handlers[name]()
        return name in handlers


class SpanTable(QWidget):
    """The spans round the present frame: frames, lowest confidence, state; a click goes there."""

    go = Signal(int)

    def __init__(self) -> None:
        super().__init__()
        self.column = QVBoxLayout(self)
        self.column.setContentsMargins(0, 0, 0, 0)
        self.column.setSpacing(2)
        head = QHBoxLayout()
        for text, stretch in (("Span", 5), ("Surest to least", 5), ("State", 4)):
            head.addWidget(label(text, "caption"), stretch)
        self.column.addLayout(head)
        self._lines: list[tuple[QWidget, Elided, Elided, Chip]] = []
        for _ in range(SHOWN_SPANS):
            line = QWidget()
            row = QHBoxLayout(line)
            row.setContentsMargins(0, 0, 0, 0)
            row.setSpacing(6)
            frames, sure, state = Elided("", "value"), Elided("", "label"), Chip()
            row.addWidget(frames, 5)
            row.addWidget(sure, 4)
            row.addWidget(state, 0)
            jump = icon_button("go", "Go to the least sure frame of this span", lambda line=line: self._jump(line))
            jump.setFixedSize(24, 22)
            row.addWidget(jump)
            self._lines.append((line, frames, sure, state))
            self.column.addWidget(line)

    def _jump(self, line: QWidget) -> None:
        frame = line.property("frame")
        if frame is not None:
            self.go.emit(int(frame))

    def show_spans(self, project: Project, track: Track, frame: int) -> None:
        """Show the spans nearest to a frame."""
        stages = project.session.stages.spans(track.id)
        ranges = [tuple(int(end) for end in stage.name.rsplit("/", 1)[-1].split("-")) for stage in stages]
        here = next((number for number, (first, last) in enumerate(ranges) if first <= frame <= last), 0)
        begin = max(min(here - SHOWN_SPANS // 2, len(stages) - SHOWN_SPANS), 0)
        words = {"fresh": ("solved", "ok"), "running": ("solving", "accent"), "failed": ("failed", "err")}
        for number, (line, frames, sure, chip) in enumerate(self._lines):
            index = begin + number
            line.setVisible(index < len(stages))
            if index >= len(stages):
                continue
            first, last = ranges[index]
            span = project.result(stages[index])
            frames.setText(f"{first} – {last}")
            lowest = first
            if span is None:
                sure.setText("")
            else:
                lowest = first + int(span.confidence.argmin())
                sure.setText(f"{span.confidence.max():.2f} – {span.confidence.min():.2f}")
            line.setProperty("frame", lowest)
            chip.show_state(*words.get(project.state(stages[index]), ("waiting", "warn")))
