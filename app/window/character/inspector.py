"""What is known of the character and of the selected vertex, and what can be done with them."""

from __future__ import annotations

from collections.abc import Mapping

from PySide6.QtCore import Signal

from app.model.character import Character
from app.model.edits import characters
from app.window.character.frame_section import FrameSection
from app.window.character.handles_of import vertex_titles
from app.window.character.move_section import MoveSection
from app.window.character.name_chooser import NameChooser
from app.window.character.pair_section import PairSection
from app.window.character.place_section import PlaceSection
from app.window.character.vertex_section import Place3, VertexSection
from app.window.controls import Row, ScrollColumn
from app.window.project import Project


class CharacterInspector(ScrollColumn):
    """Shows one character; every change is an edit of the document."""

    go = Signal(int)
    propagate = Signal()
    on_release = Signal(bool)

    def __init__(self) -> None:
        super().__init__()
        self.project: Project | None = None
        self.character: Character | None = None
        self.name = NameChooser()
        self.chooser = self.name.chooser
        self.chooser.activated.connect(self._choose)
        self.name.renamed.connect(self._rename)
        self.vertex = VertexSection()
        self.moves, self.fit = MoveSection(), FrameSection()
        self.pairs, self.place_in_first = PairSection(), PlaceSection()
        self.rows.addWidget(Row("Character", self.name))
        for section in (self.vertex, self.moves, self.fit, self.pairs, self.place_in_first):
            self.rows.addWidget(section)
        self.rows.addStretch(1)
        self.moves.go.connect(self.go)
        self.moves.propagate.connect(self.propagate)
        self.moves.on_release.connect(self.on_release)
        self.fit.chosen.connect(self._choose_vertex)
        self.vertex_name, self.follows, self.place = self.vertex.name, self.vertex.follows, self.vertex.place
        self.mute_button, self.unmove_button = self.vertex.mute_button, self.vertex.unmove_button
        self.automatic, self.run, self.forget = self.moves.automatic, self.moves.run, self.moves.forget
        self.frames, self.scale, self.up = self.moves.list, self.place_in_first.scale, self.place_in_first.up

    def show_character(self, project: Project, place: Place3 | None, *, mode: str = "", copied: bool = False) -> None:
        """Show the selected character, and the place of its selected vertex in the frame shown."""
        self.project = project
        document = project.document
        names = [each.name for each in document.characters]
        if names != [self.chooser.itemText(number) for number in range(self.chooser.count())]:
            self.chooser.clear()
            self.chooser.addItems(names)
        ids = [each.id for each in document.characters]
        self.character = None
        if project.character_id in ids:
            self.chooser.setCurrentIndex(ids.index(project.character_id))
            self.character = document.characters[ids.index(project.character_id)]
        self.setEnabled(self.character is not None)
        if self.character is None:
            return
        self.vertex.show_vertex(project, self.character, place)
        self.moves.show_moves(project, self.character, copied=copied)
        self.pairs.show_pairs(project, self.character)
        self.place_in_first.show_place(project, self.character, mode)

    def show_fit(self, away: Mapping[int, float], limit: float, stretch: tuple[float, float] | None) -> None:
        """Show how well the pose in sight fits: pixels by vertex, and the least and largest stretch."""
        project, character = self.project, self.character
        if project is not None and character is not None:
            self.fit.show_fit(away, vertex_titles(project, character, away), limit, stretch)

    def _choose(self, index: int) -> None:
        if self.project is not None:
            self.project.select_character(self.project.document.characters[index].id)

    def _rename(self, name: str) -> None:
        if self.project is not None and self.character is not None:
            self.project.edit(characters.rename_character, self.character.id, name)

    def _choose_vertex(self, vertex: int) -> None:
        if self.project is not None:
            self.project.select_vertex(vertex)
