"""The Motion graph workspace: sequences, their motions as a graph, what is composed of them, and how it looks."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QEvent, QPoint, Qt, QTimer
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QSizePolicy, QSplitter, QVBoxLayout, QWidget

from app.model.document import Document
from app.window.background_call import BackgroundCalls
from app.window.controls import Panel
from app.window.fold_away import FoldAway
from app.window.frames import FrameLoader
from app.window.performance.carried import Carried
from app.window.performance.composed_panel import ComposedPanel
from app.window.performance.crossing import Crossing
from app.window.performance.database_panel import DatabasePanel
from app.window.performance.editing import PerformanceEditing
from app.window.performance.graph_panel import HINT, GraphPanel
from app.window.performance.graph_places import GraphPlaces
from app.window.performance.library import Library
from app.window.performance.matrix import Matrix, PreviewSide
from app.window.performance.parts import Parts
from app.window.performance.preview import Preview
from app.window.performance.source_strip import SourceStrip
from app.window.performance.state import PerformanceState
from app.window.performance.thumbnails import Thumbnails
from app.window.performance.time_commands import TimeCommands
from app.window.performance.trial import Trial
from app.window.project import Project
from app.window.viewport.hosts import Choice
from app.window.workspaces import Workspace

LOW = 690
"""Pixels of height below which lanes are lower."""


class PerformanceWorkspace(Workspace):
    """Puts the parts side by side, ties them to one state, and answers commands.

    Not made ``whole``, its parts stand alone until ``put_together`` is called.
    """

    own_timeline = True

    def __init__(self, choice: Choice = "auto", *, whole: bool = True) -> None:
        super().__init__()
        self.project: Project | None = None
        self.calls = BackgroundCalls(self)
        self.state = PerformanceState(self)
        self.editing = PerformanceEditing(self.state, self)
        self.trial = Trial(self.state, self.calls, self)
        self.places = GraphPlaces(self.state, self.calls, self)
        self.thumbnails = Thumbnails(self._draw, self)
        self.time = TimeCommands(self.state)
        self.library = Library(self.state, self.thumbnails.picture)
        self.database = DatabasePanel(self.state, self.trial)
        self.graph = GraphPanel(self.state, self.editing, self.places, self.trial, self.thumbnails)
        self.preview = Preview(self.state, choice)
        self.composed = ComposedPanel(self.state, self.editing, self.thumbnails)
        self.strip = SourceStrip(self.state)
        self.matrix = Matrix(self.state, self.strip)
        self.side = PreviewSide(self.preview, self.matrix, self.strip)
        self.library.facts.azimuth = self.preview.azimuth
        self.carried = Carried(self)
        self.crossing = Crossing(self, self.state, self.thumbnails)
        self.parts = Parts(self)
        self._low = False
        self.errors = self.graph.errors
        self._cards = QTimer(self)
        self._cards.setSingleShot(True)
        self._cards.setInterval(60)
        self._cards.timeout.connect(self.library.refresh)
        if whole:
            self.put_together()

    def put_together(self) -> None:
        """Put the parts into the page and tie them to each other."""
        self._build()
        self._connect()

    def _build(self) -> None:
        left = QWidget()
        column = QVBoxLayout(left)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(8)
        self.base = Panel()
        self.base.column.addWidget(self.database)
        self.base.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Fixed)
        column.addWidget(self.library, 1)
        column.addWidget(self.base)
        self.aside = FoldAway("performance", "Preview")
        self.aside.column.addWidget(self.side)
        self.strip.matrix_wanted.connect(self.aside.unfold)
        self.across = _splitter(Qt.Orientation.Horizontal, (left, self.graph, self.aside), (0, 1, 0))
        self.across.setSizes([280, 690, 430])
        self.down = _splitter(Qt.Orientation.Vertical, (self.across, self.composed, self.strip), (1, 0, 0))
        whole = QVBoxLayout(self)
        whole.setContentsMargins(0, 0, 0, 0)
        whole.addWidget(self.down)

    def _connect(self) -> None:
        self.editing.told.connect(self._told)
        self.graph.hint.connect(lambda _: self.hint.emit(self._hint()))
        self.graph.wanted.connect(self.wanted)
        self.graph.carried.connect(self._carry)
        self.graph.dropped.connect(self._drop)
        self.graph.canvas.crossing.connect(self.crossing.show_edge)
        self.composed.options.paths.looked_at.connect(self.trial.look_at)
        self.composed.crossing.connect(self.crossing.show_cut)
        self.composed.wanted.connect(self.wanted)
        self.composed.source_wanted.connect(lambda _: self._show_parts())
        self.state.hint.connect(self.hint)
        self.thumbnails.ready.connect(self._drawn)
        self.preview.view.made.connect(self.parts.chain)
        self.parts.chain()

    def changeEvent(self, event: QEvent) -> None:
        """What is drawn once and kept is drawn anew for another look."""
        super().changeEvent(event)
        if event.type() == QEvent.Type.StyleChange:
            self.strip.view.refresh()
            self.library.refresh()

    def resizeEvent(self, event: QResizeEvent) -> None:
        """In a low window lanes are lower, and the source is shown when it is asked for."""
        super().resizeEvent(event)
        low = self.height() < LOW
        if low != self._low:
            self._low = low
            self.composed.view.show_low(low)
            self.composed.source.setChecked(not low)

    # the project -------------------------------------------------------------------------------------------------

    def attach(self, project: Project, loader: FrameLoader | None) -> None:
        """Take another project."""
        self.detach()
        self.project = project
        self.state.attach(project)
        self.library.attach()
        self._show_parts()

    def detach(self) -> None:
        """Let go of the project."""
        self.library.detach()
        self.state.attach(None)
        self.preview.refresh()
        self.strip.refresh()
        self.trial.drop()
        self.places.forget()
        self.editing.key = self.editing.replacing = -1
        self.thumbnails.forget()
        self.graph.stop()
        self.composed.stop()
        self.crossing.stop()
        self._cards.stop()
        self.project = None

    def close_view(self) -> None:
        """End threads and the render window."""
        self.detach()
        self.side.finish()
        self.thumbnails.close()
        self.calls.close()

    def leave(self) -> None:
        """Nothing plays unseen."""
        self.state.playback.stop()
        self.graph.stop()
        self.crossing.stop()

    def is_empty(self, document: Document) -> bool:
        """It says itself what to do first."""
        return False

    def document_changed(self, before: Document, after: Document) -> None:
        """Pictures of sequences whose files or front changed are drawn anew."""
        if bool(before.sequences) != bool(after.sequences):
            self._show_parts()
        former = {sequence.id: sequence for sequence in before.sequences}
        for sequence in after.sequences:
            old = former.get(sequence.id)
            if old is not None and _looks(old) != _looks(sequence):
                self.thumbnails.forget(sequence.id)

    def refresh(self) -> None:
        """Show the project as it is."""
        self.graph.refresh()
        self.composed.refresh()
        self._show_parts()
        self.hint.emit(self._hint())

    def _show_parts(self) -> None:
        """Where there is no sequence nothing can be composed, and the invitation has the room."""
        there = bool(self.state.document.sequences)
        self.base.setVisible(there)
        self.preview.show_controls(there)
        self.composed.setVisible(there)
        self.strip.setVisible(there and self.composed.source.isChecked())

    def counts(self, document: Document) -> str:
        """How much there is."""
        graph = self.state.graph
        many = f"{len(document.sequences)} sequence{'' if len(document.sequences) == 1 else 's'}"
        keys = f"{len(document.performance.keys)} key motions"
        return f"{many}, {len(graph.nodes)} motions, {keys}" if graph is not None else many

    def device(self) -> str:
        """What draws in 3D."""
        view = self.preview.view.viewport
        return view.host.name if view is not None else ""

    def say(self, sentence: str) -> None:
        """Say it in the line at the bottom."""
        self.hint.emit(sentence)

    def _hint(self) -> str:
        if not self.state.document.sequences:
            return "Add a sequence of meshes to begin."
        if self.editing.replacing >= 0:
            return "Double-click the motion that takes the place of the one out of reach. Esc leaves it."
        return self.parts.hint() or HINT

    def _told(self, sentence: str) -> None:
        self.hint.emit(sentence)
        self.graph.errors.tell(sentence, level="note")

    def _draw(self, sequence_id: str, frame: int) -> object:
        """A picture of a frame; called in the thread that draws them."""
        from app.actions.performing_cutouts import cutout

        project = self.project
        assert project is not None
        return cutout(project.session, sequence_id, frame)

    def _drawn(self, sequence_id: str, frame: int) -> None:
        self.composed.refresh_soon()
        if not self._cards.isActive():
            self._cards.start()

    # carrying motions to the timeline --------------------------------------------------------------------------------

    def _carry(self, node: int, where: QPoint) -> None:
        view = self.composed.view
        view.show_insertion(view.place_at(where))
        inside = self.graph.canvas.rect().contains(self.graph.canvas.mapFromGlobal(where))
        self.carried.show_at(None if inside else self._picture(node), self.mapFromGlobal(where))

    def _drop(self, node: int, where: QPoint) -> None:
        view = self.composed.view
        place = view.place_at(where)
        view.show_insertion(-1)
        self.carried.hide()
        if place >= 0:
            self.editing.append(node, place)

    def _picture(self, node: int) -> tuple[object, str]:
        motion = self.state.motions[node]
        return self.thumbnails.picture(motion.sequence, motion.texton[0]), motion.name

    # commands ----------------------------------------------------------------------------------------------------

    def command(self, name: str) -> bool:
        """Do a command; those of the clip's time and points mean the performance here, or nothing."""
        handlers: dict[str, Callable[[], object]] = {
            "hide_point": lambda: self.editing.forbid(self.state.node),
            "delete": self._delete,
            "next_track": lambda: self.window().focusNextPrevChild(True),
            "next_part": lambda: self.parts.go(1),
            "previous_part": lambda: self.parts.go(-1),
            "nudge_left": lambda: self.editing.move(self.editing.key, self.editing.key - 1),
            "nudge_right": lambda: self.editing.move(self.editing.key, self.editing.key + 1),
            "nudge_up": lambda: self.editing.repeat(self.editing.key, 1),
            "nudge_down": lambda: self.editing.repeat(self.editing.key, -1),
            "fit": self.graph.canvas.fit,
            "fit_time": self.composed.view.show_all,
            "zoom_time_in": lambda: self.composed.view.zoom(1.5),
            "zoom_time_out": lambda: self.composed.view.zoom(1 / 1.5),
            "ghosts": self.preview.ghost_button.toggle,
            "add_sequence": self.library.show_add_menu,
            "export": self._export,
        }
        at_boundary = self.strip.view.hasFocus() or self.matrix.view.hasFocus()
        if (at_boundary and self.strip.command(name)) or self.preview.command(name):
            return True
        if name == "cancel":
            return self._cancel()
        if name in handlers:
            handlers[name]()
            return True
        return self.time.command(name)

    def _export(self) -> None:
        """Ask what of the performance is written, and where."""
        from app.window.performance.export_dialog import ExportDialog

        dialog = ExportDialog(self, self.state, self.preview.azimuth())
        dialog.done.connect(lambda sentence: self.errors.tell(sentence, level="note"))
        dialog.open()

    def _cancel(self) -> bool:
        given_up = [
            self.strip.view.cancel(),
            self.matrix.view.cancel(),
            self.graph.canvas.cancel(),
            self.composed.view.cancel(),
            self.editing.cancel(),
        ]
        self.carried.hide()
        if any(given_up):
            self.refresh()
        return any(given_up)

    def _delete(self) -> None:
        """Take away the key motion that is chosen: in the lane, or the last one that the chosen motion is."""
        keys = self.state.document.performance.keys
        place = self.editing.key
        if self.graph.canvas.hasFocus():
            own = [k for k, key in enumerate(keys) if self.state.motion_node(key.motion) == self.state.node]
            place = own[-1] if own else -1
        if place < 0:
            self.hint.emit("Choose a key motion in the timeline, or a motion with a number, to remove it.")
            return
        self.editing.remove(place)
        if self.composed.view.hasFocus():
            self.editing.choose(min(place, len(keys) - 2))


def _splitter(direction: Qt.Orientation, parts: tuple[QWidget, ...], stretch: tuple[int, ...]) -> QSplitter:
    made = QSplitter(direction)
    made.setHandleWidth(8)
    made.setChildrenCollapsible(False)
    for number, (part, share) in enumerate(zip(parts, stretch, strict=True)):
        made.addWidget(part)
        made.setStretchFactor(number, share)
    return made


def _looks(sequence: object) -> tuple[object, ...]:
    """What of a sequence changes how its frames look."""
    names = ("media", "character", "frame_count", "fps", "source_fps", "up", "unit", "front")
    return tuple(getattr(sequence, name) for name in names)
