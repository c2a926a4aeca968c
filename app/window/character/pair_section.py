"""Which point goes with which vertex: those without one first, pairs that can be taken apart."""

from __future__ import annotations

from PySide6.QtCore import Signal

from app.model.character import Character
from app.model.edits import characters
from app.window.character.row_list import Act, Entry, RowList
from app.window.controls import Fold, set_tooltip, toggle
from app.window.picture_layers import colour_of
from app.window.project import Project

REMOVE = Act("remove", "unlink", "Separate this point from its vertex")


class PairSection(Fold):
    """``pointed`` gives the track under the mouse; ``pairing`` that pairing by two clicks is wanted or not."""

    pointed = Signal(str)
    pairing = Signal(bool)

    def __init__(self) -> None:
        super().__init__("Pairs")
        self.project: Project | None = None
        self.button = toggle("link", "Pair by two clicks", self.pairing.emit, key="pair")
        set_tooltip(self.button, "Click a point and its place on the character, either first", "pair")
        self.column.addWidget(self.button)
        self.list = RowList("Pairs")
        self.column.addWidget(self.list)
        self.list.chosen.connect(self._choose)
        self.list.acted.connect(self._remove)
        self.list.pointed.connect(self.pointed)

    def show_pairs(self, project: Project, character: Character) -> None:
        """Show the points of a project by whether they are paired."""
        self.project = project
        tracks = sorted(project.document.tracks, key=lambda track: track.id in character.pairs)
        rows = []
        for track in tracks:
            vertex = character.pairs.get(track.id)
            caption = "no vertex yet" if vertex is None else f"vertex {vertex:,}"
            acts = () if vertex is None else (REMOVE,)
            lit = track.id == project.track_id
            rows.append(Entry(track.id, track.name, caption, colour_of(track), acts, faint=vertex is None, lit=lit))
        self.list.show_entries(tuple(rows))
        open_ = len(tracks) - sum(track.id in character.pairs for track in tracks)
        self.caption.setText(f"{open_} unmatched" if open_ else f"{len(tracks)} matched" if tracks else "no points yet")

    def _choose(self, track_id: str) -> None:
        project = self.project
        if project is None or not project.character_id:
            return
        project.select_track(track_id)
        vertex = project.document.character(project.character_id).pairs.get(track_id)
        if vertex is not None:
            project.select_vertex(vertex)

    def _remove(self, track_id: str, act: str) -> None:
        if self.project is not None and act == REMOVE.name:
            self.project.edit(characters.remove_pair, self.project.character_id, track_id)
