"""The preview: the composed performance, or a source as captured, played in 3D at its own rate."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QElapsedTimer, Qt, Signal
from PySide6.QtGui import QPainter
from PySide6.QtWidgets import QButtonGroup, QHBoxLayout, QToolButton, QWidget

from app.window import icons
from app.window.controls import Elided, ErrorBar, Panel, icon_button, toggle
from app.window.controls.own_keys import OwnKeys
from app.window.lazy_view import LazyView
from app.window.performance.player import Dropped, FrameReader, ahead, way
from app.window.performance.preview_notes import MODES, Mode, cut_lines, cut_near, paint_lines, place_lines
from app.window.performance.preview_source import Source, front, opener, wanted_source
from app.window.performance.state import PerformanceState
from app.window.performance.view_keys import ViewKeys
from app.window.viewport.hosts import Choice
from app.window.viewport.lens import Lens
from app.window.work import details

if TYPE_CHECKING:
    from app.actions.performing_playback import ShownFrame
    from app.window.performance.stage_view import StageView

NO_SEQUENCE = "Add a sequence to see it here."
NO_PERFORMANCE = "Choose motions in the graph: what they make is played here."
NO_PATH = "There is no path through the key motions: the timeline says what would help."
COMPOSING = "The performance is being composed…"
NOT_COMPOSED = "The performance has not been composed yet: Ctrl+Enter runs what is missing."
READING = "Reading the frames…"
ASIDE = 0.7
"""Radians from the performer's front to where one looks from at first."""
STEP = 6
"""Frames from the present one to its ghosts, away from cuts."""


class Preview(Panel):
    """Follows the shared state: frames are read ahead in a thread, and those that come too late are counted."""

    drawn = Signal(int)

    def __init__(self, state: PerformanceState, choice: Choice = "auto") -> None:
        super().__init__("Preview", " ")
        self.state = state
        self.mode: Mode = "blended"
        self.frame: ShownFrame | None = None
        self.shown = -1
        self.dropped = Dropped()
        self._source: Source = ()
        self._count = 0
        self._due = -1
        self._watch = QElapsedTimer()
        self.reader = FrameReader(self)
        self.stage: StageView | None = None
        self.keys: ViewKeys | None = None
        self.view = LazyView(choice)
        self.errors = ErrorBar()
        self._header()
        self.column.addWidget(self.errors)
        self.column.addWidget(self.view, 1)
        self.footer = self._footer()
        self.column.addWidget(self.footer)
        self._connect()
        self._show_nothing()

    def _header(self) -> None:
        self.ghost_button = toggle("ghosts", "Ghosts", lambda _: self._again(), key="G")
        self.ghost_button.setToolTip("Frames before and after; at a cut both sides of it  (G)")
        self.follow_button = toggle("follow", "Follow", self._follow, on=True)
        self.follow_button.setToolTip("Go along with the performer")
        for each in (self.ghost_button, self.follow_button):
            each.setAccessibleName(each.text())
            each.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonIconOnly)
            self.header.row.addWidget(each)
        self.fit_button = icon_button("fit", "Show the whole performer", self.fit, "F")
        self.header.row.addWidget(self.fit_button)

    def _footer(self) -> QWidget:
        bar = QWidget()
        bar.setFixedHeight(38)
        row = QHBoxLayout(bar)
        row.setContentsMargins(8, 0, 12, 0)
        row.setSpacing(4)
        self.play_button = icon_button("play", "Play or pause", self.play, "Space")
        row.addWidget(self.play_button)
        self.modes = QButtonGroup(self)
        self.mode_buttons: dict[Mode, QToolButton] = {}
        for mode, text, tip in MODES:
            each = QToolButton()
            each.setText(text)
            each.setToolTip(tip)
            each.setProperty("toggle", "true")
            each.setCheckable(True)
            each.setChecked(mode == self.mode)
            each.setFocusPolicy(Qt.FocusPolicy.TabFocus)
            OwnKeys(each)
            each.toggled.connect(lambda on, mode=mode: self.show_mode(mode) if on else None)
            self.modes.addButton(each)
            self.mode_buttons[mode] = each
            row.addWidget(each)
        self.rate = Elided()
        self.rate.setAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
        row.addWidget(self.rate, 1)
        return bar

    def _connect(self) -> None:
        state = self.state
        self.view.made.connect(self._made)
        self.view.failed.connect(self.errors.tell)
        self.reader.opened.connect(self._opened)
        self.reader.arrived.connect(self._arrived)
        self.reader.failed.connect(self._failed)
        state.position_changed.connect(self._moved)
        state.source_changed.connect(self._moved)
        state.shows_changed.connect(self.refresh)
        state.results_changed.connect(self.refresh)
        state.sequence_changed.connect(self.refresh)
        state.document_changed.connect(self.refresh)
        state.compare_changed.connect(self._compared)
        state.cut_changed.connect(lambda _: self._again())
        state.playback.playing_changed.connect(self._playing)

    # what is shown -----------------------------------------------------------------------------------------------

    def refresh(self, *_: object) -> None:
        """Show what the state says; frames that are still right stay."""
        source = wanted_source(self.state, self.mode)
        performing = self.state.shows == "performance"
        there = bool(source) or (performing and self.frame is not None and self._being_composed())
        for mode, each in self.mode_buttons.items():
            each.setEnabled(performing and there and (mode != "blended" or self.state.document.performance.blend))
        self.play_button.setEnabled(there)
        self.header.caption.setText(self._caption())
        if source == self._source:
            if not source and self.frame is None:
                self._show_nothing()
            self._over()
            return
        if not source and performing and self._being_composed():
            if self.frame is None:
                self.view.say(COMPOSING)
            return  # a new path is being placed: the one before stays in sight
        self._source = source
        self._count = 0
        self.reader.open(opener(self.state, self.mode, source))
        if not source:
            self._show_nothing()
        elif self.isVisible():
            self.view.want()
            if self.frame is None:
                self.view.say(READING)

    def _being_composed(self) -> bool:
        """Whether a performance is on its way: there are key motions, and nothing speaks against them."""
        state = self.state
        return bool(state.document.performance.keys) and state.gap is None and not state.problem

    def show_controls(self, on: bool) -> None:
        """Show what plays and compares, or nothing of it where there is nothing to play."""
        for each in (self.footer, self.ghost_button, self.follow_button, self.fit_button):
            each.setVisible(on)

    def _working(self) -> bool:
        return self.state.project is not None and bool(self.state.project.progress)

    def _caption(self) -> str:
        if not self.state.document.sequences:
            return ""
        if self.state.shows == "performance":
            return "composed performance" if self.state.document.performance.keys else ""
        found = [each.name for each in self.state.document.sequences if each.id == self.state.sequence_id]
        return f"{found[0]} as captured" if found else ""

    def _show_nothing(self) -> None:
        self.frame, self.shown = None, -1
        if self.stage is not None:
            self.stage.clear()
            self.stage.begin()
        document = self.state.document
        words = NO_PERFORMANCE
        if document.performance.keys:
            words = NO_PATH if not self._being_composed() else COMPOSING if self._working() else NOT_COMPOSED
        self.view.say(words if document.sequences else NO_SEQUENCE)
        self.play_button.setEnabled(False)
        self.rate.setText("")

    def _opened(self, count: int) -> None:
        self._count = count
        self.errors.hide()
        if self.stage is not None and self.shown < 0:
            self.stage.begin()
        self._moved()

    def _failed(self, sentence: str, error: BaseException) -> None:
        from imitation.errors import InputError

        if not isinstance(error, InputError):
            sentence = f"The preview stopped by an error of the program: {sentence}"
        self.errors.tell(sentence, details(error))

    def _made(self) -> None:
        from app.window.performance.stage_view import StageView

        viewport = self.view.viewport
        assert viewport is not None
        self.stage = StageView(viewport)
        self.keys = ViewKeys(viewport)
        self.stage.follow = self.follow_button.isChecked()
        viewport.notes = (self._paint,)
        viewport.calm = self._calm
        self._moved()

    def _calm(self) -> bool:
        return not self.state.playback.playing and not self._working()

    def show_mode(self, mode: Mode) -> None:
        """Show cuts blended, as they are, or every clip where it was filmed."""
        self.mode = mode
        self.mode_buttons[mode].setChecked(True)
        self.state.compare(mode != "blended")
        self.refresh()

    def _compared(self, before: bool) -> None:
        if before == (self.mode == "blended"):
            self.show_mode("placed" if before else "blended")

    # frames ------------------------------------------------------------------------------------------------------

    def _moved(self, *_: object) -> None:
        """The playhead is elsewhere: show its frame now, or when it comes."""
        place = self.state.place
        self._due = place
        frame = self.reader.frame(place)
        if frame is not None:
            self._draw(place, frame)
        self._want()

    def _want(self) -> None:
        wanted = ahead(self.state.place, self._count, self.state.playback.course)
        self.reader.want([*wanted[:1], *self._ghost_places(), *wanted[1:]])

    def _arrived(self, position: int) -> None:
        if position == self._due or self._better(position):
            frame = self.reader.frame(position)
            if frame is not None:
                self._draw(position, frame)
        elif position in self._ghost_places():
            self._again()

    def _better(self, position: int) -> bool:
        """Whether a frame that comes late is still later than the one in sight, while playing."""
        course = self.state.playback.course
        if course is None or self.shown < 0:
            return False
        open_ = way(course, self.shown, self._due)
        return 0 < way(course, self.shown, position) <= open_ < (course.last - course.first + 1) // 2

    def _ghost_places(self) -> list[int]:
        state, place = self.state, self.state.place
        near = cut_near(state, place) if state.shows == "performance" else None
        chosen = near is not None and near.number == state.cut
        if state.playback.playing or not (self.ghost_button.isChecked() or chosen):
            return []
        both = [near.position - 1, near.position] if near is not None else [place - STEP, place + STEP]
        return [each for each in both if 0 <= each < self._count and each != place]

    def _draw(self, place: int, frame: ShownFrame) -> None:
        if self.view.want() is None or self.stage is None:
            return
        self.view.say("")
        course = self.state.playback.course
        ghosts = [each for each in map(self.reader.frame, self._ghost_places()) if each is not None]
        step = abs(place - self.shown)
        elapsed = step / self.state.fps if self.shown >= 0 and step <= self.state.fps else math.inf
        if self.frame is None:
            self.stage.face(front(self.state, self.mode, place, frame) + ASIDE)
        self.frame, self.shown = frame, place
        self.stage.show(frame, ghosts, elapsed=elapsed, moving=course is not None)
        if course is not None:
            self.dropped.saw(place, course)
            self._say_rate()
        self.drawn.emit(place)

    def _again(self) -> None:
        """Draw the present frame once more, with or without its ghosts."""
        frame = self.reader.frame(self.shown)
        self._want()
        if frame is not None:
            self._draw(self.shown, frame)

    def _playing(self, playing: bool) -> None:
        self.play_button.setIcon(icons.icon("pause" if playing else "play", "text2", "text2"))
        if playing:
            self.dropped.begin()
            self._watch.start()
            self._want()
        else:
            self._again()
            self._say_rate()

    def _say_rate(self) -> None:
        text = f"{self.state.fps:g} fps"
        if self.dropped.dropped:
            text += f", {self.dropped.dropped} of {self.dropped.dropped + self.dropped.shown} left out"
        self.rate.setText(text)

    def play(self) -> None:
        """Play or pause what is shown."""
        if self.state.playback.playing:
            self.state.playback.stop()
        else:
            self.state.play()

    # the view ----------------------------------------------------------------------------------------------------

    def fit(self) -> None:
        """Look at the whole performer."""
        if self.stage is not None:
            self.stage.fit()

    def command(self, name: str) -> bool:
        """Do a command of the 3D view where it has the keys; says whether it did."""
        return self.keys is not None and self.keys.command(name)

    def azimuth(self) -> float | None:
        """From which side one looks, degrees from +x towards +y; None while nothing is shown."""
        if self.view.viewport is None or self.frame is None:
            return None
        return math.degrees(self.view.viewport.orbit.azimuth)

    def _follow(self, on: bool) -> None:
        if self.stage is not None:
            self.stage.follow = on

    def _over(self) -> None:
        if self.view.viewport is not None:
            self.view.viewport.surface.update()

    def _paint(self, painter: QPainter, lens: Lens) -> None:
        frame = self.frame
        if self.keys is not None:
            self.keys.paint(painter)
        if frame is None or self.stage is None:
            return
        top = place_lines(self.state, frame.sequence, frame.source, frame.blended)
        near = cut_near(self.state, self.shown) if self.state.shows == "performance" else None
        paint_lines(painter, lens.size, top, cut_lines(near, self.mode) if near is not None else [])

    def showEvent(self, event: Any) -> None:
        """Load the 3D libraries when there is something to show."""
        super().showEvent(event)
        if self._source:
            self.view.want()
            self._moved()

    def finish(self) -> None:
        """End the thread and close the render window."""
        self.reader.close()
        self.view.finish()
