"""The library: captured sequences and characters' motions that the motion database is made of."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from PySide6.QtCore import QEvent, QPoint, Qt, Signal
from PySide6.QtGui import QDragEnterEvent, QDropEvent, QImage, QResizeEvent
from PySide6.QtWidgets import QApplication, QFileDialog, QMenu, QVBoxLayout, QWidget

from app.actions.kinds import kind_of
from app.model.edits import sequences
from app.model.performance import CapturedSequence
from app.stages.job import Job
from app.window.controls import ErrorBar, Fold, Panel, ScrollColumn, button, icon_button, label
from app.window.performance.card_words import strip_of, warnings_of
from app.window.performance.sequence_cards import ROOMY, Card, SequenceCards
from app.window.performance.sequence_facts import SequenceFacts
from app.window.performance.sequence_structure import SequenceStructure
from app.window.performance.state import PerformanceState

FILES = {".npz", ".glb", ".gltf", ".usd", ".usda", ".usdc", ".usdz"}
FILTER = "Sequences (*.npz *.glb *.gltf *.usd *.usda *.usdc *.usdz);;All files (*)"
EMPTY = "No sequences yet. Add a folder of PLY, OBJ, OFF or GLB files, one a frame, or drop one here."
Picture = Callable[[str, int], QImage | None]


class Library(Panel):
    """Cards above, facts and structure of the chosen sequence below; files are read in the background.

    ``picture`` gives the thumbnail of (sequence, frame) where there is one; ``added`` says that a sequence came in.
    """

    added = Signal(str)

    def __init__(self, state: PerformanceState, picture: Picture | None = None) -> None:
        super().__init__("Sequences", " ")
        self.state = state
        self.picture: Picture = picture or (lambda sequence_id, frame: None)
        self._reading: dict[Job, tuple[str, str]] = {}
        self.setAcceptDrops(True)
        self.add_button = icon_button("add_sequence", "Add a sequence", self.show_add_menu)
        self.header.row.addWidget(self.add_button)
        self.errors = ErrorBar()
        self.column.addWidget(self.errors)
        self.body = ScrollColumn()
        self.column.addWidget(self.body, 1)
        self.empty = self._empty()
        self.cards = SequenceCards()
        self.facts, self.structure = SequenceFacts(state), SequenceStructure(state)
        self.sections = [Fold("Facts of the files", opened=False), Fold("How motions are found", opened=False)]
        for section, inner in zip(self.sections, (self.facts, self.structure), strict=True):
            section.column.addWidget(inner)
        rows = self.body.rows
        rows.addWidget(self.empty)
        rows.addWidget(self.cards)
        for section in self.sections:
            rows.addWidget(section)
        rows.addStretch(1)
        self.cards.chosen.connect(state.select_sequence)
        self.cards.played.connect(self.play)
        self.cards.renamed.connect(self.rename)
        self.cards.removed.connect(self.remove)
        self.cards.menu_wanted.connect(self._menu)
        self.facts.measured.connect(self.measure)
        for signal in (state.document_changed, state.results_changed, state.sequence_changed):
            signal.connect(self.refresh)
        state.sequence_changed.connect(self._bring_into_sight)

    def _bring_into_sight(self, sequence_id: str) -> None:
        """Scroll to the card that was chosen, wherever that was done."""
        box = self.cards.box(sequence_id)
        if not box.isEmpty():
            QApplication.sendPostedEvents(None, QEvent.Type.LayoutRequest)
            place = self.cards.mapTo(self.body.widget(), box.center().toPoint())
            self.body.ensureVisible(place.x(), place.y(), 0, round(box.height() / 2) + 2)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Keep the chosen card in sight."""
        super().resizeEvent(event)
        self._bring_into_sight(self.state.sequence_id)

    def _empty(self) -> QWidget:
        body = QWidget()
        column = QVBoxLayout(body)
        column.setContentsMargins(0, 8, 0, 8)
        column.setSpacing(10)
        words = label(EMPTY, "caption")
        words.setWordWrap(True)
        column.addWidget(words)
        column.addWidget(button("Add a folder…", self.ask_folder, name="add_sequence"))
        return body

    # showing -----------------------------------------------------------------------------------------------------

    def attach(self) -> None:
        """Follow the state's project; called after the state has taken it."""
        self._reading.clear()
        project = self.state.project
        if project is not None:
            project.job_ended.connect(self._ended)
            project.work_changed.connect(self.refresh)
        self.errors.hide()
        self.refresh()

    def detach(self) -> None:
        """Let go of the project."""
        project = self.state.project
        if project is not None:
            project.job_ended.disconnect(self._ended)
            project.work_changed.disconnect(self.refresh)
        self._reading.clear()
        self.cards.end_renaming()

    def refresh(self, *_: object) -> None:
        """Show the sequences as they are."""
        order = self.state.document.sequences
        cards = tuple(self._card(sequence) for sequence in order)
        pictures = {each.id: self.picture(each.id, each.frame_count // 2) for each in order}
        found = {name: picture for name, picture in pictures.items() if picture is not None}
        self.empty.setVisible(not order)
        self.cards.setVisible(bool(order))
        self.cards.show_cards(cards, found, self.state.sequence_id)
        for section in self.sections:
            section.setVisible(bool(order))
        self.facts.refresh()
        self.structure.refresh()
        reading = ", ".join(name for name, _ in self._reading.values())
        self.header.caption.setText(f"reading {reading}…" if reading else str(len(order) or ""))

    def _card(self, sequence: CapturedSequence) -> Card:
        words, tone = self._state_of(sequence)
        return Card(
            id=sequence.id,
            name=sequence.name,
            caption=f"{sequence.frame_count:,} frames · {sequence.fps:g} fps",
            strip=strip_of(self.state, sequence),
            state=words,
            tone=tone,
            warnings=warnings_of(sequence),
            hidden=not sequence.visible,
            low=len(self.state.document.sequences) > ROOMY,
        )

    def _state_of(self, sequence: CapturedSequence) -> tuple[str, str]:
        """What is to be said of a sequence's analysis, and the token of its colour."""
        project = self.state.project
        if project is None:
            return "", "text3"
        stages = project.session.stages
        stage = stages.structure(sequence.id)
        closure = (stages.features(sequence.id), stages.distances(sequence.id), stage)
        state = project.state(stage)
        if state == "fresh":
            return "", "ok"
        for each in closure:
            if project.state(each) == "running":
                return "analysing…", "accent"
            why = project.session.runner.why_failed(each)
            if why:
                return why, "err"
        why = stage.why_blocked()
        if why:
            return why, "warn"
        return ("changed", "warn") if state == "stale" else ("not analysed", "text3")

    # adding ------------------------------------------------------------------------------------------------------

    def show_add_menu(self) -> None:
        """Offer folders, files, and the motion of each character."""
        self.add_menu().popup(self.add_button.mapToGlobal(QPoint(0, self.add_button.height() + 2)))

    def add_menu(self) -> QMenu:
        """What can be added."""
        menu = QMenu(self)
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        menu.addAction("Folder of meshes, one a frame…", self.ask_folder)
        menu.addAction("File: npz, animated GLB or USD…", self.ask_file)
        menu.addAction("Motion of another project…", self.ask_project)
        if self.state.document.sequences:
            menu.addAction("Key motions of an exported path…", self.ask_path)
        project = self.state.project
        for character in project.document.characters if project is not None else ():
            action = menu.addAction(
                f"Motion of {character.name}", lambda character=character: self.add_motion(character.id)
            )
            assert project is not None
            solved = project.result(project.session.stages.animation(character.id)) is not None
            action.setEnabled(solved or project.document.clip is not None)
        return menu

    def ask_folder(self) -> None:
        """Ask for a folder and add it."""
        chosen = QFileDialog.getExistingDirectory(self, "Add a sequence: a folder of meshes", str(Path.home()))
        if chosen:
            self.add(Path(chosen))

    def ask_project(self) -> None:
        """Ask for another project and add the finished motions of its characters."""
        chosen = QFileDialog.getExistingDirectory(self, "Add motions of another project", str(Path.home()))
        if chosen:
            self.add(Path(chosen))

    def ask_file(self) -> None:
        """Ask for a file and add it."""
        chosen, _ = QFileDialog.getOpenFileName(self, "Add a sequence", str(Path.home()), FILTER)
        if chosen:
            self.add(Path(chosen))

    def ask_path(self) -> None:
        """Ask for a path that was exported, and take its choices."""
        chosen, _ = QFileDialog.getOpenFileName(self, "Key motions of a path", str(Path.home()), "Paths (*.json)")
        if chosen:
            self.take_path(Path(chosen))

    def take_path(self, path: Path) -> None:
        """Take key motions and all other choices of a path that was exported: one entry of the history."""
        from app.actions.performing_path import choice_from_path

        project = self.state.project
        if project is not None:
            project.edit(lambda _: choice_from_path(project.session, path))

    def add(self, path: Path) -> None:
        """Read a sequence in the background, then add it."""
        from app.actions.performing import read_sequences

        project = self.state.project
        if project is not None:
            session = project.session
            job = project.call(
                f"Reading {path.name}", lambda progress: read_sequences(session, path, progress=progress)
            )
            self._reading[job] = (path.name, "")
            self.refresh()

    def add_motion(self, character_id: str) -> None:
        """Add the motion of a character."""
        from app.actions.performing import add_character_motion

        self._take(lambda session: add_character_motion(session, character_id))

    def _take(self, call: Callable[[Any], tuple[str, str]]) -> None:
        from app.model.values import ModelError
        from imitation.errors import InputError

        project = self.state.project
        if project is None:
            return
        try:
            made, note = call(project.session)
        except (InputError, ModelError) as error:
            self.errors.tell(str(error))
            return
        if note:
            self.state.hint.emit(note)
        self.state.select_sequence(made)
        self.added.emit(made)
        self.refresh()

    def _ended(self, job: Job) -> None:
        """What was read comes into the project, unless it was cancelled or could not be read."""
        name, sequence_id = self._reading.pop(job, ("", ""))
        if not name:
            return
        project = self.state.project
        if job.state == "done" and project is not None:
            if sequence_id:
                project.edit(sequences.relink_sequence, sequence_id, job.value)
            else:
                from app.actions.performing import take_sequence

                for found in job.value:
                    self._take(lambda session, found=found: take_sequence(session, found))
        self.refresh()

    # the chosen one ----------------------------------------------------------------------------------------------

    def play(self, sequence_id: str) -> None:
        """Play a sequence as captured."""
        self.state.show_source(sequence_id, 0)
        self.state.play()

    def rename(self, sequence_id: str, name: str) -> None:
        """Give a sequence another name."""
        self._edit(sequences.rename_sequence, sequence_id, name)

    def remove(self, sequence_id: str) -> None:
        """Take a sequence out of the project; its files stay."""
        self._edit(sequences.delete_sequence, sequence_id)

    def _edit(self, make: Callable[..., Any], *values: Any) -> None:
        if self.state.project is not None:
            self.state.project.edit(make, *values)

    def measure(self, sequence_id: str) -> None:
        """Read all frames of a sequence once."""
        project = self.state.project
        if project is not None:
            stage = project.session.stages.features(sequence_id)
            project.start(stage.label, stage)
            self.refresh()

    def find_again(self, sequence_id: str, path: Path) -> None:
        """Look whether the files of a sequence lie at a place, in the background, and take them from there."""
        from app.actions.performing import find_again

        project = self.state.project
        if project is not None:
            session = project.session
            job = project.call(
                f"Looking at {path.name}", lambda progress: find_again(session, sequence_id, path, progress=progress)
            )
            self._reading[job] = (path.name, sequence_id)
            self.refresh()

    def ask_again(self, sequence_id: str) -> None:
        """Ask where the files of a sequence lie now."""
        media = self.state.document.sequence(sequence_id).media
        if media is None:
            return
        if Path(media.path).suffix.lower() in FILES:
            chosen, _ = QFileDialog.getOpenFileName(self, "Where does it lie now?", str(Path.home()), FILTER)
        else:
            chosen = QFileDialog.getExistingDirectory(self, "Where do its files lie now?", str(Path.home()))
        if chosen:
            self.find_again(sequence_id, Path(chosen))

    def menu_for(self, sequence_id: str) -> QMenu:
        """What can be done with a card."""
        menu = QMenu(self)
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        sequence = self.state.document.sequence(sequence_id)
        menu.addAction("Play as captured", lambda: self.play(sequence_id))
        menu.addAction("Rename", lambda: self.cards.rename(sequence_id))
        words = "Hide its motions" if sequence.visible else "Show its motions"
        menu.addAction("Facts of its files", lambda: self.unfold(0))
        menu.addAction("How its motions are found", lambda: self.unfold(1))
        menu.addAction(words, lambda: self._edit(sequences.show_sequence, sequence_id, not sequence.visible))
        if sequence.media is not None:
            menu.addAction("Find its files again…", lambda: self.ask_again(sequence_id))
        menu.addSeparator()
        menu.addAction("Remove from the project", lambda: self.remove(sequence_id))
        return menu

    def unfold(self, number: int) -> None:
        """Open a section below the cards and bring it into sight."""
        section = self.sections[number]
        section.open()
        QApplication.sendPostedEvents(None, QEvent.Type.LayoutRequest)
        self.body.ensureWidgetVisible(section, 0, 12)

    def _menu(self, sequence_id: str, place: QPoint) -> None:
        self.menu_for(sequence_id).popup(place)

    def changeEvent(self, event: QEvent) -> None:
        """Take the colours of another look."""
        super().changeEvent(event)
        if event.type() == QEvent.Type.PaletteChange and self.isVisible():
            self.refresh()

    # dropping ----------------------------------------------------------------------------------------------------

    def dragEnterEvent(self, event: QDragEnterEvent) -> None:
        """Take folders and files of meshes, other projects for their motions, and paths that were exported."""
        paths = [Path(url.toLocalFile()) for url in event.mimeData().urls() if url.isLocalFile()]
        if any(_is_path(path) or self._is_sequence(path) for path in paths):
            event.acceptProposedAction()

    def dropEvent(self, event: QDropEvent) -> None:
        """Add what was dropped."""
        for url in event.mimeData().urls():
            path = Path(url.toLocalFile())
            if _is_path(path):
                self.take_path(path)
            elif self._is_sequence(path):
                self.add(path)
        event.acceptProposedAction()

    def _is_sequence(self, path: Path) -> bool:
        """Whether it may be one; the project that is open is none of its own sequences."""
        project = self.state.project
        return _is_sequence(path) and (project is None or path != project.session.folder.path)


def _is_path(path: Path) -> bool:
    return path.suffix.lower() == ".json" and path.is_file() and kind_of(path) == ""


def _is_sequence(path: Path) -> bool:
    """Whether it may be one; a folder that is nothing known is taken, to say what is wrong with it."""
    return kind_of(path) in ("sequence", "project", "") if path.is_dir() else path.suffix.lower() in FILES
