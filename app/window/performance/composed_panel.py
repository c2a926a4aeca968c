"""The composed performance: playing, its choices, its blocks and cuts, and what helps where there is no path."""

from __future__ import annotations

from PySide6.QtCore import QPoint, Qt, QTimer, Signal
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QMenu, QSizePolicy

from app.window import theme
from app.window.controls import Elided, Panel, button, label, set_tooltip, toggle
from app.window.keys import shown_key
from app.window.performance.blocks import Block, ComposedHit, composed
from app.window.performance.composed_paint import told
from app.window.performance.composed_view import ComposedView
from app.window.performance.editing import PerformanceEditing
from app.window.performance.options_bar import OptionsBar
from app.window.performance.state import PerformanceState
from app.window.performance.thumbnails import Thumbnails
from app.window.timeline.axis import LABELS
from app.window.timeline.lanes import RULER
from app.window.timeline.transport import Transport

LEGEND = (("hidden", "ok", "bar"), ("jump is seen", "warn", "bar"), ("poses far apart", "warn", "hatch"))
EMPTY = "Double-click motions in the graph, in the order in which they shall be played. Or drag them here."
GAP_SHARE = 0.5


class GapNote(QFrame):
    """Lies over the gap: why there is no path, and what can be done."""

    def __init__(self, editing: PerformanceEditing) -> None:
        super().__init__()
        self.setObjectName("gapNote")
        row = QHBoxLayout(self)
        row.setContentsMargins(10, 2, 8, 2)
        row.setSpacing(8)
        self.sentence = QLabel()
        self.sentence.setProperty("role", "value")
        self.sentence.setWordWrap(True)
        self.use = button("Use", editing.use_gap_mu, primary=True)
        self.pick = button("Pick another", editing.pick_another)
        row.addWidget(self.sentence, 1)
        row.addWidget(self.use)
        row.addWidget(self.pick)
        self.hide()

    def tell(self, sentence: str, mu: float | None) -> None:
        """Say it; a mu that helps is offered."""
        self.sentence.setText(sentence)
        self.use.setVisible(mu is not None)
        self.use.setText(f"Use {mu:.4g}" if mu is not None else "")
        look = theme.active()
        style = f"#gapNote {{ background: {look.panel}; border: 1px solid {look.err}; border-radius: 5px; }}"
        if style != self.styleSheet():
            self.setStyleSheet(style)


class ComposedPanel(Panel):
    """Shows what is composed, and hands on what the hands do."""

    wanted = Signal(str)
    source_wanted = Signal(bool)
    crossing = Signal(int, str, QPoint)

    def __init__(self, state: PerformanceState, editing: PerformanceEditing, thumbnails: Thumbnails) -> None:
        super().__init__()
        self.state, self.editing = state, editing
        self.transport = Transport()
        for name, text in (("previous_mark", "Previous cut"), ("next_mark", "Next cut")):
            set_tooltip(self.transport.buttons[name], text, name)
            self.transport.buttons[name].setAccessibleName(text)
        self.summary = Elided("", "caption")
        self.summary.setAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
        row = self.transport.layout()
        assert isinstance(row, QHBoxLayout)
        row.insertWidget(row.indexOf(self.transport.legend), self.summary, 1)
        self.source = toggle("layers", "Source", self.source_wanted.emit, on=True)
        self.source.setToolTip("Show the chosen sequence and its motions below")
        row.addWidget(self.source)
        self.options = OptionsBar(state, editing)
        self.view = ComposedView()
        self.view.thumbnail = lambda sequence, frame: thumbnails.picture(sequence, frame)
        self.column.addWidget(self.transport)
        self.column.addWidget(self.options)
        self.column.addWidget(self.view)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.note = GapNote(editing)
        self.note.setParent(self.view)
        self.empty = label(EMPTY, "caption")
        self.empty.setParent(self.view)
        self.empty.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self._later = QTimer(self)
        self._later.setSingleShot(True)
        self._later.setInterval(40)
        self._later.timeout.connect(self.view.refresh)
        self._connect()

    def refresh_soon(self) -> None:
        """Draw the pictures that have come."""
        if not self._later.isActive():
            self._later.start()

    def stop(self) -> None:
        """Wait for nothing."""
        self._later.stop()

    def _connect(self) -> None:
        view, state = self.view, self.state
        view.sought.connect(state.show_position)
        view.chosen.connect(self._choose)
        view.chosen_cut.connect(self._choose_cut)
        view.reordered.connect(self.editing.move)
        view.repeated.connect(self.editing.repeat)
        view.keyed.connect(self._make_key)
        view.menu_wanted.connect(self._menu)
        view.moved.connect(self._place)
        view.crossing.connect(self._cross)
        self.transport.wanted.connect(self.wanted)
        self.editing.key_changed.connect(self.refresh)
        state.results_changed.connect(self.refresh)
        state.document_changed.connect(self.refresh)
        state.compare_changed.connect(self.refresh)
        state.cut_changed.connect(self.refresh)
        state.position_changed.connect(self.show_place)
        state.source_changed.connect(lambda *_: self.show_place())
        state.shows_changed.connect(lambda _: self.show_place())
        state.playback.playing_changed.connect(self.transport.show_playing)

    def refresh(self, *_: object) -> None:
        """Show the performance as it is."""
        state = self.state
        if self.editing.key >= len(state.document.performance.keys):
            self.editing.key = -1
        self.view.show_composed(composed(state, GAP_SHARE))
        self.view.show_choice(self.editing.key, state.cut)
        self.options.refresh()
        self.transport.legend.show_entries(LEGEND if state.frame_count else ())
        for each in self.transport.buttons.values():
            each.setEnabled(state.frame_count > 0)
        self.summary.setText(self._words())
        style = f"color: {theme.active().err};" if state.problem and state.gap is None else ""
        if style != self.summary.styleSheet():
            self.summary.setStyleSheet(style)
        self.show_place()
        self._place()

    def _words(self) -> str:
        state = self.state
        keys, performance = state.document.performance.keys, state.performance
        if not keys:
            return ""
        if state.problem:
            return state.problem if state.gap is None else "a key motion is out of reach"
        many = f"{len(keys)} key motion{'s' if len(keys) > 1 else ''}"
        if performance is None:
            return f"{many}, searching"
        near = f", {len(performance)} frames is the nearest length" if performance.note else ""
        return f"{many}, worst transition {performance.cost:.2f}{near}"

    def show_place(self, *_: object) -> None:
        """Move the playhead and the numbers."""
        state = self.state
        self.view.show_frame(state.position)
        if state.frame_count:
            seconds = state.position / max(state.fps, 1e-9)
            self.transport.show_frame(state.position, state.frame_count, state.fps, seconds)
        else:
            self.transport.number.setText("")
            self.transport.of.setText("")

    def _place(self) -> None:
        """Put what lies over the lanes where it belongs."""
        self.empty.setVisible(not self.view.shown.blocks)
        self.empty.setText(EMPTY if not self.state.document.performance.keys else self._words())
        height = self.view.heights[0]
        self.empty.setGeometry(LABELS, RULER, max(self.view.width() - LABELS, 10), height)
        room = self.view.gap_room()
        gap = self.state.gap
        self.note.setVisible(room is not None and gap is not None)
        if room is not None and gap is not None:
            self.note.tell(gap.sentence, gap.mu)
            self.note.setToolTip(f"It brings back {' and '.join(gap.brings)}." if gap.brings else "")
            left, right = max(room[0] + 8, LABELS + 4), min(room[1] - 8, self.view.width() - 4)
            wide = max(right - left, 330)
            left = max(min(left, self.view.width() - 4 - wide), LABELS + 4)
            self.note.setGeometry(round(left), RULER + 5, round(wide), height - 10)

    def _cross(self, number: int, where: QPoint) -> None:
        words = [told(joint) for joint in self.view.shown.joints if joint.number == number]
        self.crossing.emit(number if words else -1, words[0] if words else "", where)

    def _choose(self, index: int) -> None:
        block = self.view.shown.blocks[index]
        self.editing.choose(block.key)
        self.state.select_node(block.node)

    def _choose_cut(self, cut: int) -> None:
        self.state.select_cut(cut)

    def _make_key(self, index: int) -> None:
        blocks = self.view.shown.blocks
        before = sum(len(block.keys) for block in blocks[:index])
        self.editing.key_through(before, blocks[index].node)

    def _menu(self, found: ComposedHit, where: QPoint) -> None:
        menu = self.menu_for(found)
        if menu.actions():
            menu.popup(where)

    def menu_for(self, found: ComposedHit) -> QMenu:
        """What can be done with something in the lanes."""
        menu = QMenu(self)
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        if found.kind in ("block", "more", "fewer"):
            self._block_menu(menu, found.index, self.view.shown.blocks[found.index])
        elif found.kind == "joint":
            hard = self.editing.is_hard(found.index)
            text = "Blend this cut" if hard else "Leave this cut as it is"
            menu.addAction(text, lambda: self.editing.set_hard(found.index, not hard))
        return menu

    def _block_menu(self, menu: QMenu, index: int, block: Block) -> None:
        editing = self.editing
        if not block.keys:
            menu.addAction("Make it a key motion", lambda: self._make_key(index))
            menu.addAction("Forbid this motion", lambda: editing.forbid(block.node))
            return
        key = block.key
        if block.cyclic:
            menu.addAction("Play it once more", lambda: editing.repeat(key, 1))
            if block.repeats > 1:
                menu.addAction("Play it once less", lambda: editing.repeat(key, -1))
        menu.addAction(f"Move it earlier\t{shown_key('nudge_left')}", lambda: editing.move(key, key - 1))
        menu.addAction(f"Move it later\t{shown_key('nudge_right')}", lambda: editing.move(key, key + 1))
        menu.addAction(f"Remove it\t{shown_key('delete')}", lambda: editing.remove(key))
