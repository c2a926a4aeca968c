"""The pages of a comparison and of a motion: what, of which character, and where it goes."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from PySide6.QtWidgets import QCheckBox, QComboBox, QVBoxLayout, QWidget

from app.actions import rendering
from app.actions.films import COMPARISONS
from app.window import files
from app.window.controls import Panel, Row, label
from app.window.project import Project
from app.window.render.choices import remember_text, remembered_text
from app.window.render.film_page import VIDEO
from app.window.render.target import TargetLine
from imitation.progress import Progress

WIDE = 108
FORMS: tuple[tuple[str, str, str], ...] = (
    ("Animated GLB", "glb", ".glb"),
    ("Universal Scene Description", "usd", ".usd"),
    ("NumPy arrays (npz)", "npz", ".npz"),
    ("Folder of PLY files", "ply", ""),
    ("Folder of OBJ files", "obj", ""),
)


class OfOneCharacter(QWidget):
    """A page about one character, and a line for its file."""

    def __init__(self, project: Project, name: str, verb: str, words: str) -> None:
        super().__init__()
        self.project = project
        column = QVBoxLayout(self)
        column.setContentsMargins(12, 12, 12, 12)
        column.setSpacing(12)
        panel = Panel()
        self.rows = QVBoxLayout()
        self.rows.setContentsMargins(16, 16, 16, 16)
        self.rows.setSpacing(10)
        panel.column.addLayout(self.rows)
        said = label(words, "label")
        said.setWordWrap(True)
        self.rows.addWidget(said)
        self.character = QComboBox()
        self.character.setAccessibleName("Character")
        self.rows.addWidget(Row("Character", self.character, width=WIDE))
        column.addWidget(panel, 1)
        self.target = TargetLine(project, name, verb)
        column.addWidget(self.target)
        self._shown: tuple[Any, ...] = ()

    def refresh(self) -> None:
        """Show the characters as they are."""
        known = tuple((each.id, each.name) for each in self.project.document.characters)
        if known != self._shown:
            chosen = self.character.currentData() or self.project.character_id
            self._shown = known
            self.character.clear()
            for id_, name in known:
                self.character.addItem(name, id_)
            self.character.setCurrentIndex(max(self.character.findData(chosen), 0))
        self.target.write.setEnabled(bool(known))

    def close_calls(self) -> None:
        """Nothing goes on by itself here."""


class ComparePage(OfOneCharacter):
    """Our result beside the paper's comparisons."""

    def __init__(self, project: Project) -> None:
        super().__init__(
            project,
            "comparison",
            "Render",
            "The result beside what simpler methods give from the same project: over the video, and below it from the "
            "side. What is missing is computed first.",
        )
        stored = remembered_text("variants", ",".join(COMPARISONS)).split(",")
        self.variants: dict[str, QCheckBox] = {}
        for name, text in COMPARISONS.items():
            box = QCheckBox(text[:1].upper() + text[1:])
            box.setChecked(name in stored)
            box.toggled.connect(lambda _: self._chosen())
            self.variants[name] = box
            self.rows.addWidget(box)
        self.rows.addStretch(1)
        self.target.wanted.connect(self._render)
        self.target.suggest(f"{project.document.name} compared", ".mp4", VIDEO, folder=False)
        self.refresh()

    @property
    def chosen(self) -> tuple[str, ...]:
        """Names of the comparisons that are ticked."""
        return tuple(name for name, box in self.variants.items() if box.isChecked())

    def _chosen(self) -> None:
        remember_text("variants", ",".join(self.chosen))
        self.refresh()

    def refresh(self) -> None:
        """A comparison needs something to compare with."""
        super().refresh()
        self.target.write.setEnabled(bool(self._shown) and bool(self.chosen))

    def _render(self) -> None:
        still, variants = self.project.session.as_it_is(), self.chosen
        character = str(self.character.currentData())

        def write(target: Path, progress: Progress) -> Path:
            return rendering.write_comparison(still, character, variants, target, progress)

        self.target.run("Comparing in", write)


class MotionPage(OfOneCharacter):
    """A character's motion for other programs."""

    def __init__(self, project: Project) -> None:
        super().__init__(
            project,
            "motion",
            "Export",
            "The moving mesh for other programs, at the clip's frame rate, in metres.",
        )
        self.form = QComboBox()
        self.form.setAccessibleName("Form of the file")
        for text, form, suffix in FORMS:
            self.form.addItem(text, (form, suffix))
        stored = remembered_text("form", FORMS[0][1])
        self.form.setCurrentIndex(next((n for n, each in enumerate(FORMS) if each[1] == stored), 0))
        self.form.currentIndexChanged.connect(lambda _: self._formed())
        self.rows.addWidget(Row("Form", self.form, width=WIDE))
        self.rows.addStretch(1)
        self.target.wanted.connect(self._export)
        self._formed()
        self.refresh()

    def _formed(self) -> None:
        form, suffix = self.form.currentData()
        remember_text("form", form)
        self.target.suggest(self.project.document.name, suffix, files.EXPORT_FILTER, folder=not suffix)

    def _export(self) -> None:
        still, character = self.project.session.as_it_is(), str(self.character.currentData())
        form, _ = self.form.currentData()

        def write(target: Path, progress: Progress) -> Path:
            return rendering.write_motion(still, character, target, form, progress)

        self.target.run("Exporting", write)
