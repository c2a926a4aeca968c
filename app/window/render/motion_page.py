"""The pages of a comparison and of a motion: of which character, what, and where it goes."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtWidgets import QCheckBox

from app.actions import rendering
from app.actions.films import COMPARISONS
from app.actions.rendering import FilmOrder
from app.model.character import Character
from app.window import files
from app.window.controls import Chooser, Row, ScrollColumn, label
from app.window.project import Project
from app.window.render.choices import remember_text, remembered_text
from app.window.render.page import VIDEO, WIDE, Page
from imitation.progress import Progress

NEED_POSE = ("naive_tracks", "key_poses")
FORMS: tuple[tuple[str, str, str], ...] = (
    ("Animated GLB", "glb", ".glb"),
    ("Universal Scene Description", "usd", ".usd"),
    ("NumPy arrays (npz)", "npz", ".npz"),
    ("Folder of PLY files", "ply", ""),
    ("Folder of OBJ files", "obj", ""),
)


class OfOneCharacter(Page):
    """A page about one character."""

    def __init__(self, project: Project, name: str, verb: str, words: str) -> None:
        self.options = ScrollColumn()
        super().__init__(project, self.options, name, verb)
        said = label(words, "label")
        said.setWordWrap(True)
        self.options.rows.addWidget(said)
        self.chooser = Chooser(name="Character")
        self.chooser.currentIndexChanged.connect(lambda _: self._shown and self.refresh())
        self.options.rows.addWidget(Row("Character", self.chooser, width=WIDE))
        self._shown: tuple[tuple[str, str], ...] = ()

    @property
    def character(self) -> Character | None:
        """Who is chosen."""
        chosen = self.chooser.currentData()
        return next((each for each in self.project.document.characters if each.id == chosen), None)

    def refresh(self) -> None:
        """Show the characters as they are."""
        known = tuple((each.id, each.name) for each in self.project.document.characters)
        if known != self._shown:
            chosen = self.chooser.currentData() or self.project.character_id
            self._shown = ()
            self.chooser.clear()
            for id_, name in known:
                self.chooser.addItem(name, id_)
            self.chooser.setCurrentIndex(max(self.chooser.findData(chosen), 0))
            self._shown = known
        self.target.write.setEnabled(self.character is not None)


class ComparePage(OfOneCharacter):
    """Our result beside the paper's comparisons."""

    def __init__(self, project: Project) -> None:
        super().__init__(
            project,
            "comparison",
            "Render",
            "The result beside what simpler methods give from the same project: over the video, and below it from the "
            "side.",
        )
        stored = remembered_text("variants", ",".join(COMPARISONS)).split(",")
        self.variants: dict[str, QCheckBox] = {}
        for name, text in COMPARISONS.items():
            box = QCheckBox(text[:1].upper() + text[1:])
            box.setChecked(name in stored)
            box.toggled.connect(lambda _: self._ticked())
            self.variants[name] = box
            self.options.rows.addWidget(box)
        self.options.rows.addStretch(1)
        self.target.wanted.connect(self._render)
        self.preview.asked.connect(self._compute)
        self.target.suggest(f"{project.document.name} compared", ".mp4", VIDEO, folder=False)

    @property
    def chosen(self) -> tuple[str, ...]:
        """Names of the comparisons that are ticked and can be had."""
        return tuple(name for name, box in self.variants.items() if box.isChecked() and box.isEnabled())

    def _ticked(self) -> None:
        remember_text("variants", ",".join(name for name, box in self.variants.items() if box.isChecked()))
        self.refresh()

    def refresh(self) -> None:
        """A comparison needs something to compare with; two of them need an edited pose."""
        super().refresh()
        character = self.character
        posed = character is not None and bool(character.edits)
        for name in NEED_POSE:
            self.variants[name].setEnabled(posed)
            self.variants[name].setToolTip("" if posed else "Needs a pose that was edited by hand")
        self.target.write.setEnabled(character is not None and bool(self.chosen))
        self.preview.show_comparison(character.id if character is not None else "", self.chosen)

    def _compute(self, command: str) -> None:
        """Compute the comparisons that are ticked, to see them here."""
        character = self.character
        if command == "comparisons" and character is not None:
            stages = self.project.session.stages
            wanted = (stages.comparison(character.id, each) for each in self.chosen)
            self.project.start("Computing the comparisons", *wanted)

    def _render(self) -> None:
        still, variants, character = self.project.session.as_it_is(), self.chosen, self.character
        assert character is not None

        def write(target: Path, progress: Progress) -> Path:
            return rendering.write_comparison(still, character.id, variants, target, progress)

        self.target.run("Comparing in", write)


class MotionPage(OfOneCharacter):
    """A character's motion for other programs."""

    icon = "export"
    plain = "The character in this frame."

    def __init__(self, project: Project) -> None:
        words = "The moving mesh for other programs, frame by frame at the clip's frame rate."
        super().__init__(project, "motion", "Export", words)
        self.form = Chooser(name="Form of the file")
        for text, form, suffix in FORMS:
            self.form.addItem(text, (form, suffix))
        stored = remembered_text("form", FORMS[0][1])
        self.form.setCurrentIndex(next((n for n, each in enumerate(FORMS) if each[1] == stored), 0))
        self.form.currentIndexChanged.connect(lambda _: self._formed())
        self.options.rows.addWidget(Row("Form", self.form, width=WIDE))
        self.options.rows.addStretch(1)
        self.target.wanted.connect(self._export)
        self._formed()

    def _formed(self) -> None:
        form, suffix = self.form.currentData()
        remember_text("form", form)
        self.target.suggest(f"{self.project.document.name} motion", suffix, files.EXPORT_FILTER, folder=not suffix)

    def refresh(self) -> None:
        """Show the character alone."""
        super().refresh()
        character = self.character
        self.preview.show_order(FilmOrder((character.id,) if character is not None else (), alpha=True))

    def _export(self) -> None:
        still, character = self.project.session.as_it_is(), self.character
        form, _ = self.form.currentData()
        assert character is not None

        def write(target: Path, progress: Progress) -> Path:
            return rendering.write_motion(still, character.id, target, form, progress)

        self.target.run("Exporting", write)
