"""The page of the measured background: clean plates as a film, its mesh, its depth."""

from __future__ import annotations

from pathlib import Path

from app.actions import rendering
from app.window.controls import Chooser, Row, ScrollColumn, label
from app.window.project import Project
from app.window.render.choices import remember_text, remembered_text
from app.window.render.page import VIDEO, WIDE, Page
from imitation.progress import Progress

KINDS: tuple[tuple[str, str, str, str], ...] = (
    ("Clean plates (mp4)", "plate", ".mp4", VIDEO),
    ("Mesh (PLY)", "mesh", ".ply", "Mesh (*.ply)"),
    ("Mesh (GLB)", "mesh", ".glb", "Mesh (*.glb)"),
    ("Mesh (OBJ)", "mesh", ".obj", "Mesh (*.obj)"),
    ("Depth maps (folder)", "depth", "", ""),
)
WORDS = {
    "plate": "The clip without its subject: behind it what other frames see, the rest painted in.",
    "mesh": "What several frames confirm of the background, coloured as filmed, in the project's units.",
    "depth": "A picture in false colour for each key frame, and all depths as exact arrays in depth.npz.",
}


class BackgroundPage(Page):
    """Writes what is known of the background; it is measured first where it is missing."""

    plain = "As it will be written."

    def __init__(self, project: Project) -> None:
        self.options = ScrollColumn()
        super().__init__(project, self.options, "background", "Write")
        self.kind = Chooser(name="What is written of the background")
        for text, *rest in KINDS:
            self.kind.addItem(text, tuple(rest))
        stored = remembered_text("background", KINDS[0][0])
        self.kind.setCurrentIndex(max(self.kind.findText(stored), 0))
        self.kind.currentIndexChanged.connect(lambda _: self._chosen())
        self.options.rows.addWidget(Row("Write", self.kind, width=WIDE))
        self.words = label("", "label")
        self.words.setWordWrap(True)
        self.options.rows.addWidget(self.words)
        self.options.rows.addStretch(1)
        self.target.wanted.connect(self._write)
        self._suggest()

    def _suggest(self) -> None:
        kind, suffix, listed = self.kind.currentData()
        self.words.setText(WORDS[kind])
        self.target.suggest(f"{self.project.document.name} background", suffix, listed, folder=not suffix)

    def _chosen(self) -> None:
        remember_text("background", self.kind.currentText())
        self._suggest()
        self.refresh()

    def refresh(self) -> None:
        """Show the plate or the depth of the frame in sight."""
        kind, *_ = self.kind.currentData()
        self.target.write.setEnabled(self.project.document.clip is not None)
        self.preview.show_background("plate" if kind == "plate" else "depth")

    def _write(self) -> None:
        still = self.project.session.as_it_is()
        kind, *_ = self.kind.currentData()

        def write(target: Path, progress: Progress) -> Path:
            return rendering.write_background(still, kind, target, progress)

        self.target.run("Writing", write)
