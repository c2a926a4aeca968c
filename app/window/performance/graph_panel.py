"""The motion graph with its tools: filter, forbid, key motion; what to do where there is no graph yet."""

from __future__ import annotations

from PySide6.QtCore import QPoint, Qt, QTimer, Signal
from PySide6.QtGui import QImage
from PySide6.QtWidgets import QLineEdit, QMenu, QSizePolicy, QStackedWidget

from app.window.controls import ErrorBar, Invitation, Panel, button, icon_button, set_tooltip
from app.window.keys import shown_key
from app.window.performance.editing import PerformanceEditing
from app.window.performance.graph_canvas import GraphCanvas
from app.window.performance.graph_legend import GraphLegend
from app.window.performance.graph_model import picture_of, told
from app.window.performance.graph_places import GraphPlaces
from app.window.performance.state import PerformanceState
from app.window.performance.thumbnails import Thumbnails
from app.window.performance.trial import Trial

HINT = "Double-click a motion, or Enter, adds it as key motion. X forbids it. Drag it to the timeline to insert it."
NOTHING = "Add a sequence folder (PLY or OBJ per frame), or drop one here."
HOW = "Captured or animated meshes are cut into motions; new performances are composed of them."
SAMPLES = 24
"""So many pictures of a motion play under the mouse at most."""


class Nothing(Invitation):
    """Where the graph will be: what is missing, and the one thing to do."""

    def __init__(self) -> None:
        super().__init__("graph", NOTHING, HOW)
        self.add = self.offer("Add a sequence", "add_sequence", primary=True, icon="sequence")
        self.sample = self.offer("Open the sample", "sample_performance", icon="sample")
        self.run = self.offer("Run what is missing", "propagate", primary=True, icon="run")

    def tell(self, sentence: str, how: str, *, empty: bool, run: bool) -> None:
        """Say what is missing."""
        self.sentence.setText(sentence)
        self.more[0].setText(how)
        self.add.setVisible(empty)
        self.sample.setVisible(empty)
        self.run.setVisible(run)


class GraphPanel(Panel):
    """Shows the graph and turns what the hands do into edits."""

    wanted = Signal(str)
    hint = Signal(str)
    carried = Signal(int, QPoint)
    dropped = Signal(int, QPoint)

    def __init__(
        self,
        state: PerformanceState,
        editing: PerformanceEditing,
        places: GraphPlaces,
        trial: Trial,
        thumbs: Thumbnails,
    ) -> None:
        super().__init__("Motion graph", " ")
        self.state, self.editing, self.places, self.trial, self.thumbs = state, editing, places, trial, thumbs
        self.errors = ErrorBar()
        self.canvas = GraphCanvas()
        self.canvas.thumbnail = self._thumbnail
        self.canvas.told = lambda start, goal: told(state, start, goal)
        self.nothing = Nothing()
        self.stack = QStackedWidget()
        self.stack.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.stack.addWidget(self.nothing)
        self.stack.addWidget(self.canvas)
        self.legend = GraphLegend()
        self._tools()
        self.column.addWidget(self.errors)
        self.column.addWidget(self.stack, 1)
        self.column.addWidget(self.legend)
        self._later = QTimer(self)
        self._later.setSingleShot(True)
        self._later.setInterval(40)
        self._later.timeout.connect(self.canvas.refresh)
        self._connect()

    def _tools(self) -> None:
        self.filter = QLineEdit()
        self.filter.setPlaceholderText("Filter motions")
        self.filter.setClearButtonEnabled(True)
        self.filter.setAccessibleName("Filter motions by name")
        self.filter.setMaximumWidth(150)
        self.filter.setMinimumWidth(84)
        self.filter.textChanged.connect(lambda _: self.refresh())
        self.filter.returnPressed.connect(self._find)
        self.forbid = button("Forbid", lambda: self.editing.forbid(self.state.node), name="forbid")
        set_tooltip(self.forbid, "Never play the chosen motion, or allow it again", "hide_point")
        self.key = button("Key motion", lambda: self.editing.append(self.state.node), primary=True, name="key_motion")
        self.key.setToolTip("Add the chosen motion to the timeline  (Enter)")
        self.header.title.setMinimumWidth(self.header.title.sizeHint().width())
        row = self.header.row
        self.tools = (
            self.filter,
            self.forbid,
            self.key,
            icon_button("fit", "Show the whole graph", self.canvas.fit, "fit"),
        )
        for each in self.tools:
            row.addWidget(each)

    def _connect(self) -> None:
        canvas, state = self.canvas, self.state
        self.nothing.wanted.connect(self.wanted)
        canvas.chosen.connect(self._choose)
        canvas.appended.connect(self.editing.append)
        canvas.moved.connect(self.places.move)
        canvas.carried.connect(self.carried)
        canvas.dropped.connect(self.dropped)
        canvas.menu_wanted.connect(self._menu)
        self.places.changed.connect(self.refresh)
        self.trial.changed.connect(self.refresh)
        state.results_changed.connect(self.refresh)
        state.document_changed.connect(self.refresh)
        state.node_changed.connect(self._chosen)
        self.thumbs.ready.connect(self._drawn)

    # showing -----------------------------------------------------------------------------------------------------

    def refresh(self, *_: object) -> None:
        """Show the graph as it is, or what is missing."""
        self.places.refresh()
        state = self.state
        picture = picture_of(state, self.places.places, tried=self.trial.result, typed=self.filter.text())
        self.canvas.show_picture(picture)
        self.stack.setCurrentWidget(self.canvas if picture.nodes else self.nothing)
        for each in self.tools:
            each.setVisible(bool(picture.nodes))
        shown = sum(not mark.dim for mark in picture.nodes)
        stale = "" if state.fresh or state.graph is None else ", being made anew"
        self.header.caption.setText(f"{shown} of {len(state.motions)} motions shown{stale}" if state.motions else "")
        self.legend.show_state(state, bool(picture.nodes))
        if not picture.nodes:
            self._say_nothing()
        self._chosen(state.node)

    def _say_nothing(self) -> None:
        project = self.state.project
        running = [text for _, text in project.progress.values()] if project is not None else []
        if project is None or not self.state.document.sequences:
            coming = [text for text in running if text.startswith(("Making", "Reading"))]
            if coming:
                self.nothing.tell("A sequence is on its way.", coming[0], empty=False, run=False)
            else:
                self.nothing.tell(NOTHING, HOW, empty=True, run=False)
            return
        stages = project.session.stages
        blocked, failed = stages.graph.why_blocked(), self._why_failed()
        if blocked or failed:
            self.nothing.tell("There is no motion graph.", blocked or failed, empty=False, run=not blocked)
        elif running:
            self.nothing.tell("The motions are being found.", running[0], empty=False, run=False)
        elif self.state.graph is None:
            how = "A sequence that is a character's motion needs that motion first."
            self.nothing.tell("The sequences have not been cut into motions yet.", how, empty=False, run=True)
        else:
            self.nothing.tell("Every sequence is hidden.", "Show one in the list at the left.", empty=False, run=False)

    def _why_failed(self) -> str:
        project = self.state.project
        if project is None:
            return ""
        runner = project.session.runner
        sentences = (runner.why_failed(stage) for stage in project.session.stages.graph.closure())
        return next((each for each in sentences if each), "")

    def _thumbnail(self, node: int, step: int) -> QImage | None:
        if not 0 <= node < len(self.state.motions):
            return None
        motion = self.state.motions[node]
        first, last = motion.texton
        stride = max(1, -(-(last - first + 1) // SAMPLES))
        frames = range(first, last + 1, stride)
        return self.thumbs.picture(motion.sequence, frames[step % len(frames)], first=step > 0)

    def _drawn(self, sequence: str, frame: int) -> None:
        if not self._later.isActive():
            self._later.start()

    # choosing ----------------------------------------------------------------------------------------------------

    def _choose(self, node: int) -> None:
        self.state.select_node(node)
        if node >= 0:
            self.canvas.setFocus(Qt.FocusReason.MouseFocusReason)
            motion = self.state.motions[node]
            self.state.point_at(motion.sequence, motion.texton[0])
        self.hint.emit(HINT)

    def _chosen(self, node: int) -> None:
        self.canvas.show_node(node)
        known = 0 <= node < len(self.state.motions)
        self.forbid.setEnabled(known)
        self.key.setEnabled(known)
        mark = self.canvas.picture.mark(node)
        self.forbid.setText("Allow" if mark is not None and mark.forbidden else "Forbid")

    def _find(self) -> None:
        """Choose the first motion that the filter leaves."""
        found = [mark.node for mark in self.canvas.picture.nodes if not mark.dim]
        if found:
            self._choose(found[0])

    def _menu(self, node: int, where: QPoint) -> None:
        self._choose(node)
        self.menu_for(node).popup(where)

    def menu_for(self, node: int) -> QMenu:
        """What can be done with a motion."""
        menu = QMenu(self)
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        menu.addAction("Add as key motion\tEnter", lambda: self.editing.append(node))
        mark = self.canvas.picture.mark(node)
        verb = "Allow" if mark is not None and mark.forbidden else "Forbid"
        menu.addAction(f"{verb}\t{shown_key('hide_point')}", lambda: self.editing.forbid(node))
        menu.addSeparator()
        menu.addAction("Put all motions back in order", self.places.tidy)
        return menu

    def stop(self) -> None:
        """Let nothing play or wait."""
        self._later.stop()
        self.canvas.stop()
