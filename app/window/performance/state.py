"""What the parts of the Motion graph share: what is selected, the place in the performance, results as they stand.

None of it is part of the document, and none of it is undone.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject, Signal

from app.model.document import Document
from app.model.performance import HardCut, Motion
from app.stages.stage import Stage
from app.window import theme
from app.window.playback import Playback
from app.window.project import Project

if TYPE_CHECKING:
    from app.actions.performing import MotionName
    from app.actions.performing_graph import Gap

RESULTS = ("features", "structure", "analysis", "database", "graph", "paths", "performance", "blends")


class PerformanceState(QObject):
    """One a window. Parts read it, change it by its methods, and listen to its signals.

    ``shows`` says what the playhead runs over: "performance", at ``position``; or "source", the selected sequence at
    ``source_frame``. The graph is the last one there was: ``fresh`` tells whether it is that of the document.
    ``problem`` says why there is no path, ``gap`` between which key motions.
    """

    sequence_changed = Signal(str)
    node_changed = Signal(int)
    cut_changed = Signal(int)
    position_changed = Signal(int)
    source_changed = Signal(str, int)
    shows_changed = Signal(str)
    compare_changed = Signal(bool)
    results_changed = Signal()
    document_changed = Signal(object, object)
    hint = Signal(str)

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.project: Project | None = None
        self.sequence_id, self.node, self.cut = "", -1, -1
        self.position = self.source_frame = 0
        self.shows = "performance"
        self.before = False
        self.playback = Playback(self, lambda: self.place)
        self.playback.due.connect(self.show_place)
        self._forget()

    def _forget(self) -> None:
        self.graph: Any = None
        self.motions: list[MotionName] = []
        self.paths: list[Any] = []
        self.placed: Any = None
        self.blends: Any = None
        self._nodes: dict[tuple[str, int], int] = {}
        self.fresh = False
        self.gap: Gap | None = None
        self.problem = ""
        self._failed: BaseException | None = None

    # the project -------------------------------------------------------------------------------------------------

    def attach(self, project: Project | None) -> None:
        """Take another project, or none."""
        self.playback.stop()
        if self.project is not None and self.project is not project:
            self.project.document_changed.disconnect(self._changed)
            self.project.stage_finished.disconnect(self._finished)
            self.project.work_changed.disconnect(self._work_changed)
        self.project = project
        self._forget()
        self.sequence_id, self.node, self.cut = "", -1, -1
        self.position = self.source_frame = 0
        self.shows = "performance"
        if project is not None:
            project.document_changed.connect(self._changed)
            project.stage_finished.connect(self._finished)
            project.work_changed.connect(self._work_changed)
            if project.document.sequences:
                self.sequence_id = project.document.sequences[0].id
            self.take_results()

    @property
    def document(self) -> Document:
        """The document of the open project; an empty one where there is none."""
        return self.project.document if self.project is not None else Document()

    def _changed(self, before: Document, after: Document) -> None:
        ids = [sequence.id for sequence in after.sequences]
        if self.sequence_id not in ids:
            self.select_sequence(ids[-1] if ids else "")
        if [sequence.id for sequence in before.sequences] != ids and self.graph is not None:
            self._forget()
        own = before.sequences is not after.sequences or before.performance is not after.performance
        if own:
            self.take_results()
        if own or before.characters is not after.characters:
            self.document_changed.emit(before, after)

    def _finished(self, stage: Stage) -> None:
        if stage.name.split("/")[0] in RESULTS:
            self.take_results()

    def _work_changed(self) -> None:
        """A search that failed says so in its own place, with what would help."""
        if self.project is not None and self._failure() is not self._failed:
            self.take_results()

    def _failure(self) -> BaseException | None:
        if self.project is None or not self.document.performance.keys:
            return None
        session = self.project.session
        return session.runner.failure(session.stages.paths)

    def take_results(self) -> None:
        """Look which results are there; what is missing stays as it was, and is not fresh."""
        project = self.project
        if project is None:
            return
        stages = project.session.stages
        if not project.document.sequences:
            self._forget()
        else:
            self._take_graph(project.result(stages.graph))
            self._take_paths(project.result(stages.paths) or [])
            self.placed = project.result(stages.performance) if self.paths else None
            self.blends = project.result(stages.blends) if self.placed is not None else None
        if self.position >= max(self.frame_count, 1):
            self.show_position(self.frame_count - 1)
        self.results_changed.emit()

    def _take_paths(self, found: list[Any]) -> None:
        """Take the paths, or why there is none."""
        from app.actions.performing_graph import trouble

        self._failed = self._failure()
        self.gap, self.problem = trouble(self.document, self.motions, self._failed)
        if self.problem or not self.document.performance.keys:
            found = []
        self.paths = found

    def _take_graph(self, graph: Any) -> None:
        self.fresh = graph is not None
        if graph is None or graph is self.graph:
            return
        from app.actions.performing import motions

        self.graph, self.motions = graph, motions(self.document, graph)
        self._nodes = {}
        if self.node >= len(self.motions):
            self.select_node(-1)

    # results -----------------------------------------------------------------------------------------------------

    @property
    def performance(self) -> Any:
        """The engine's performance: placed where it is, else the chosen path as found; None without one."""
        if self.placed is not None:
            return self.placed.performance
        if not self.paths:
            return None
        return self.paths[min(self.document.performance.alternative, len(self.paths) - 1)]

    @property
    def frame_count(self) -> int:
        """Frames of the performance, 0 without one."""
        return 0 if self.performance is None else len(self.performance)

    @property
    def fps(self) -> float:
        """Frames a second of all sequences and of the performance."""
        return self.document.sequences[0].fps if self.document.sequences else 25.0

    def motion_node(self, motion: Motion) -> int:
        """The node of the motion that a frame belongs to; -1 where it is not known."""
        found = self._nodes.get((motion.sequence, motion.frame))
        if found is None:
            found = next(
                (m.node for m in self.motions if m.sequence == motion.sequence and m.first <= motion.frame <= m.last),
                -1,
            )
            self._nodes[motion.sequence, motion.frame] = found
        return found

    def cut_motions(self, number: int) -> tuple[Motion, Motion]:
        """The last frame before a cut and the first after it, as the document names them."""
        cut, order = self.performance.cuts[number], self.document.sequences
        leave, enter = (order[self.graph.nodes[node].sequence].id for node in (cut.source, cut.target))
        return Motion(leave, cut.leave), Motion(enter, cut.enter)

    def hard_cuts(self) -> set[int]:
        """Numbers of the cuts that shall not be blended."""
        hard = self.document.performance.hard_cuts
        cuts = self.performance.cuts if hard and self.performance is not None else ()
        return {k for k in range(len(cuts)) if HardCut(*self.cut_motions(k)) in hard}

    def colour(self, sequence_id: str) -> str:
        """The colour of a sequence everywhere in this workspace."""
        cycle = theme.active().tracks
        for number, sequence in enumerate(self.document.sequences):
            if sequence.id == sequence_id:
                return cycle[number % len(cycle)]
        return theme.active().text3

    # selection and place -----------------------------------------------------------------------------------------

    def select_sequence(self, sequence_id: str) -> None:
        """Choose the sequence whose structure is shown."""
        if sequence_id != self.sequence_id:
            self.sequence_id, self.source_frame = sequence_id, 0
            self.sequence_changed.emit(sequence_id)

    def select_node(self, node: int) -> None:
        """Choose a motion of the graph, or none (-1); its sequence is chosen with it."""
        if node != self.node:
            self.node = node
            self.node_changed.emit(node)

    def select_cut(self, cut: int) -> None:
        """Choose a cut of the performance by its number among ``performance.cuts``, or none (-1)."""
        if cut != self.cut:
            self.cut = cut
            self.cut_changed.emit(cut)

    @property
    def place(self) -> int:
        """Where the playhead is, in what is shown."""
        return self.position if self.shows == "performance" else self.source_frame

    @property
    def places(self) -> int:
        """How many frames what is shown has."""
        if self.shows == "performance":
            return self.frame_count
        found = [each.frame_count for each in self.document.sequences if each.id == self.sequence_id]
        return found[0] if found else 0

    def show_place(self, place: int) -> None:
        """Move the playhead in what is shown."""
        if self.shows == "performance":
            self.show_position(place)
        else:
            self.show_source(self.sequence_id, place)

    def point_at(self, sequence_id: str, frame: int) -> None:
        """Choose a frame of a sequence without leaving what is shown."""
        self.select_sequence(sequence_id)
        if frame != self.source_frame:
            self.source_frame = frame
            self.source_changed.emit(sequence_id, frame)

    def show_position(self, position: int) -> None:
        """Show a frame of the performance; an earlier look at a source ends."""
        position = min(max(position, 0), max(self.frame_count - 1, 0))
        moved, self.position = position != self.position, position
        self._show("performance")
        if moved:
            self.position_changed.emit(position)

    def show_source(self, sequence_id: str, frame: int) -> None:
        """Show a frame of a sequence as captured."""
        self.select_sequence(sequence_id)
        moved = frame != self.source_frame or self.shows != "source"
        self.source_frame = frame
        self._show("source")
        if moved:
            self.source_changed.emit(sequence_id, frame)

    def _show(self, what: str) -> None:
        if what != self.shows:
            if self.playback.playing:
                self.playback.stop()
            self.shows = what
            self.shows_changed.emit(what)

    def compare(self, before: bool) -> None:
        """Show the performance without in-betweens, to compare."""
        if before != self.before:
            self.before = before
            self.compare_changed.emit(before)

    def play(self, speed: float = 1.0) -> None:
        """Play what is shown from where it stands."""
        self.playback.play(0, self.places - 1, self.fps, speed)
