"""The source strip: motions and textons of the chosen sequence, corrected by hand."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from PySide6.QtCore import QEvent, QPoint, Qt, Signal
from PySide6.QtWidgets import QMenu, QSizePolicy

from app.model.edits import performance, sequences
from app.model.performance import CapturedSequence, Motion
from app.window.controls import Elided, Panel, icon_button, label, toggle
from app.window.performance.state import PerformanceState
from app.window.performance.strip import Span, Strip, StripHit, strip_of
from app.window.performance.strip_colours import structure_of
from app.window.performance.strip_view import StripView

NO_SEQUENCE = "Add a sequence: its motions are shown here."
LEGEND = "★ kept in the database"


class SourceStrip(Panel):
    """Follows the shared state. ``matrix_wanted`` asks to show or hide the self-similarity matrix, ``refreshed`` says
    that the strip may look different now.
    """

    matrix_wanted = Signal(bool)
    refreshed = Signal()

    def __init__(self, state: PerformanceState) -> None:
        super().__init__("Source", " ", header_height=34)
        self.state = state
        self.view = StripView()
        self._shown: dict[str, tuple[Any, Strip]] = {}
        self._project: object = None
        self.legend = Elided(LEGEND)
        self.legend.setAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
        row = self.header.row
        row.addWidget(self.legend, 1)
        self.matrix_button = toggle("matrix", "Self-similarity", self.matrix_wanted.emit)
        self.matrix_button.setToolTip("Which moments look alike, and why the motions are what they are")
        row.addWidget(self.matrix_button)
        row.addWidget(icon_button("fit_time", "Show the whole sequence", self.view.show_all))
        self.empty = label(NO_SEQUENCE, "caption")
        self.empty.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self.empty.setWordWrap(True)
        self.empty.setFixedHeight(self.view.height())
        self.column.addWidget(self.view)
        self.column.addWidget(self.empty)
        self.view.hide()
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.view.sought.connect(self._seek)
        self.view.chosen.connect(self._chosen)
        self.view.chosen_twice.connect(lambda found: self.keep(found.motion, found.texton))
        self.view.moved.connect(self.move_boundary)
        self.view.menu_wanted.connect(self._menu)
        for signal in (state.sequence_changed, state.results_changed, state.document_changed):
            signal.connect(self.refresh)
        for signal in (state.position_changed, state.source_changed, state.shows_changed):
            signal.connect(self._move)

    # showing -----------------------------------------------------------------------------------------------------

    @property
    def sequence(self) -> CapturedSequence | None:
        """The sequence chosen."""
        return next((each for each in self.state.document.sequences if each.id == self.state.sequence_id), None)

    def refresh(self, *_: object) -> None:
        """Show the structure of the chosen sequence; while it is found anew the one before stays in sight."""
        if self.state.project is not self._project:
            self._project, self._shown = self.state.project, {}
        sequence = self.sequence
        structure = structure_of(self.state, sequence.id) if sequence is not None else None
        if sequence is not None and structure is not None:
            self._shown = {sequence.id: (structure, strip_of(self.state, sequence.id, structure))}
        kept = self._shown.get(sequence.id) if sequence is not None else None
        if kept is not None and sequence is not None and kept[1].count != sequence.frame_count:
            kept = None
        self.view.setVisible(kept is not None)
        self.empty.setVisible(kept is None)
        self.legend.setVisible(kept is not None)
        self.header.title.setText(sequence.name if sequence is not None else "Source")
        if kept is not None:
            if not _same(kept[1], self.view.strip):
                self.view.show_span(None)
                self.view.show_strip(kept[1])
            elif structure is not None and self.view.drag is not None:
                self.view.show_strip(kept[1])
        self.empty.setText(self._why_empty(sequence))
        self._caption(kept[1] if kept is not None else None, structure is None)
        self._move()
        self.refreshed.emit()

    def changeEvent(self, event: QEvent) -> None:
        """Take the colours of another look."""
        super().changeEvent(event)
        if event.type() == QEvent.Type.PaletteChange and self.isVisible():
            self.refresh()

    def _why_empty(self, sequence: CapturedSequence | None) -> str:
        project = self.state.project
        if sequence is None or project is None:
            return NO_SEQUENCE
        stages = project.session.stages
        for stage in (stages.features(sequence.id), stages.distances(sequence.id), stages.structure(sequence.id)):
            why = project.session.runner.why_failed(stage) or stage.why_blocked()
            if why:
                return why
            if project.state(stage) == "running":
                return f"{stage.label}…"
        return f"The motions of {sequence.name} have not been found yet."

    def _caption(self, strip: Strip | None, stale: bool) -> None:
        if strip is None:
            self.header.caption.setText("")
            return
        count = sum(len(motion.textons) for motion in strip.motions)
        many = f"{len(strip.motions)} motion{'s' if len(strip.motions) != 1 else ''}"
        by_hand = self.sequence is not None and self.sequence.structure.boundaries is not None
        words = f"{strip.count:,} frames, {many}, {count} texton{'s' if count != 1 else ''}"
        tail = ", finding the motions…" if stale else ", boundaries set by hand" if by_hand else ""
        self.header.caption.setText(words + tail)

    def _move(self, *_: object) -> None:
        """Follow the playhead: of the source, or of the performance where it plays this sequence."""
        state, frame = self.state, -1
        if state.shows == "source":
            frame = state.source_frame
        elif state.performance is not None and state.position < len(state.performance.frames):
            number, source = (int(value) for value in state.performance.frames[state.position])
            order = state.document.sequences
            if number < len(order) and order[number].id == state.sequence_id:
                frame = source
        self.view.show_frame(frame)

    # hands -------------------------------------------------------------------------------------------------------

    def _seek(self, frame: int) -> None:
        if self.state.playback.playing:
            self.state.playback.stop()
        self.state.show_source(self.state.sequence_id, frame)

    def _chosen(self, found: StripHit) -> None:
        motion = self.view.strip.motions[found.motion] if found.motion >= 0 else None
        if found.kind == "texton" and motion is not None:
            self.view.show_span(motion.textons[found.texton])
            self.state.hint.emit("Double-click a texton to keep it in the database. Right-click for more.")
        else:
            self.view.show_span(None)
        if found.kind == "boundary":
            self.state.hint.emit("Drag the boundary, or move it by Ctrl+Left and Ctrl+Right; Delete joins the motions.")
        elif motion is not None and found.kind in ("texton", "motion"):
            self.state.select_node(self.state.motion_node(Motion(self.state.sequence_id, motion.first)))

    def _edit(self, make: Callable[..., Any], *values: Any, **options: Any) -> bool:
        project = self.state.project
        return project is not None and project.edit(make, *values, **options)

    def present(self) -> tuple[int, ...]:
        """The boundaries that hold now: those set by hand, else those that were found."""
        sequence = self.sequence
        if sequence is not None and sequence.structure.boundaries is not None:
            return sequence.structure.boundaries
        return self.view.strip.boundaries

    def move_boundary(self, old: int, new: int | None, gesture: str | None = None) -> bool:
        """Move a boundary, take it away (None), or add one (``old`` 0): one entry of the history."""
        done = self._edit(sequences.move_boundary, self.state.sequence_id, self.present(), old, new, gesture=gesture)
        if not done:
            self.view.cancel()
        return done

    def keep(self, motion: int, texton: int) -> bool:
        """Let a texton stand for its motion."""
        shown = self.view.strip.motions[motion]
        first, last = shown.textons[texton]
        sequence = self.sequence
        if sequence is None or texton == shown.kept:
            return False
        others = tuple(frame for frame in sequence.representatives if shown.first <= frame <= shown.last)
        return self._edit(sequences.set_representative, sequence.id, (first + last) // 2, others)

    def play_span(self, span: Span) -> None:
        """Play some frames of the source again and again."""
        self.state.show_source(self.state.sequence_id, span[0])
        self.view.show_span(span)
        self.state.playback.stop()
        self.state.playback.play(span[0], span[1], self.state.fps)

    def menu_for(self, found: StripHit) -> QMenu:
        """What can be done with what was hit."""
        menu = QMenu(self)
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        sequence = self.sequence
        if sequence is None or found.motion < 0:
            return menu
        motion = self.view.strip.motions[found.motion]
        if found.texton >= 0:
            span = motion.textons[found.texton]
            menu.addAction("Play this texton", lambda: self.play_span(span))
            keep = menu.addAction("Keep this texton", lambda: self.keep(found.motion, found.texton))
            keep.setEnabled(found.texton != motion.kept)
        menu.addAction("Play this motion", lambda: self.play_span((motion.first, motion.last)))
        if sequence.representatives:
            menu.addAction(
                "Choose all textons automatically",
                lambda: self._edit(sequences.forget_representatives, sequence.id),
            )
        word = "Allow" if motion.forbidden else "Forbid"
        menu.addAction(f"{word} this motion", lambda: self._forbid(motion.first, motion.last, not motion.forbidden))
        menu.addSeparator()
        self._boundaries(menu, found, motion.first, motion.last)
        menu.addSeparator()
        cyclic = menu.addAction(
            "Everything repeats",
            lambda: self._edit(sequences.set_structure, sequence.id, force_cyclic=not sequence.structure.force_cyclic),
        )
        cyclic.setCheckable(True)
        cyclic.setChecked(sequence.structure.force_cyclic)
        return menu

    def _boundaries(self, menu: QMenu, found: StripHit, first: int, last: int) -> None:
        here = found.frame
        if found.kind == "boundary":
            menu.addAction("Join the motions here", lambda: self.move_boundary(here, None))
        else:
            split = menu.addAction(f"Split at frame {here}", lambda: self.move_boundary(0, here))
            split.setEnabled(first < here <= last)
            if first:
                menu.addAction("Join with the motion before", lambda: self.move_boundary(first, None))
            if last + 1 < self.view.strip.count:
                menu.addAction("Join with the motion after", lambda: self.move_boundary(last + 1, None))
        sequence = self.sequence
        if sequence is not None and sequence.structure.boundaries is not None:
            menu.addAction("Find the boundaries again", lambda: self._edit(sequences.set_boundaries, sequence.id, None))

    def _forbid(self, first: int, last: int, forbidden: bool) -> None:
        """Forbid the motion of these frames, or allow all that forbids it."""
        sequence_id = self.state.sequence_id
        if forbidden:
            self._edit(performance.set_forbidden, Motion(sequence_id, first), True)
            return
        for each in self.state.document.performance.forbidden:
            if each.sequence == sequence_id and first <= each.frame <= last:
                self._edit(performance.set_forbidden, each, False, gesture="allow")
        if self.state.project is not None:
            self.state.project.close_gesture()

    def _menu(self, found: StripHit, place: QPoint) -> None:
        self.menu_for(found).popup(place)

    def command(self, name: str) -> bool:
        """Do a command where it belongs to the strip; says whether it did."""
        boundary = self.view.boundary
        if name == "cancel":
            return self.view.cancel()
        if boundary < 0 or not self.view.isVisible():
            return False
        if name in ("nudge_left", "nudge_right"):
            new = boundary + (1 if name == "nudge_right" else -1)
            if 0 < new < self.view.strip.count and new not in self.present():
                self.view.boundary = new
                self.move_boundary(boundary, new, gesture=f"nudge boundary {self.state.sequence_id}")
            return True
        if name == "delete":
            self.view.boundary = -1
            return self.move_boundary(boundary, None)
        return False


def _same(one: Strip, other: Strip) -> bool:
    return (one.count, one.motions, one.reason) == (other.count, other.motions, other.reason) and (
        one.curve is other.curve
        or (one.curve is not None and other.curve is not None and bool((one.curve == other.curve).all()))
    )
