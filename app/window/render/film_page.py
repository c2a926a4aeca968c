"""The page of a film: controls, a frame of it, and where it goes."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QHBoxLayout, QVBoxLayout, QWidget

from app.actions import rendering
from app.actions.rendering import FilmOrder
from app.window.controls import Panel
from app.window.project import Project
from app.window.render.film_options import FilmOptions
from app.window.render.preview import Preview
from app.window.render.target import TargetLine
from imitation.progress import Progress

VIDEO = "Film (*.mp4)"


class FilmPage(QWidget):
    """Films all characters that are visible; ``asked`` names a command of the window."""

    asked = Signal(str)

    def __init__(self, project: Project) -> None:
        super().__init__()
        self.project = project
        column = QVBoxLayout(self)
        column.setContentsMargins(12, 12, 12, 12)
        column.setSpacing(12)
        inner = QHBoxLayout()
        inner.setSpacing(12)
        panel = Panel()
        panel.setFixedWidth(316)
        self.options = FilmOptions(project.range, project.frame_count)
        self.options.rows.setContentsMargins(12, 12, 12, 12)
        panel.column.addWidget(self.options)
        self.preview = Preview(project)
        inner.addWidget(panel)
        inner.addWidget(self.preview, 1)
        column.addLayout(inner, 1)
        self.target = TargetLine(project, "film", "Render")
        column.addWidget(self.target)
        self.options.changed.connect(self.refresh)
        self.preview.asked.connect(self.asked)
        self.target.wanted.connect(self._render)
        self._alpha: bool | None = None
        self.refresh()

    @property
    def order(self) -> FilmOrder:
        """The film that is chosen."""
        characters = tuple(each.id for each in self.project.document.characters if each.visible)
        return self.options.choices.order(characters, self.options.frames)

    def refresh(self) -> None:
        """Show the project and the choice as they are."""
        order = self.order
        if order.alpha != self._alpha:
            self._alpha = order.alpha
            name = self.project.document.name
            if order.alpha:
                self.target.suggest(name, "", "", folder=True)
            else:
                self.target.suggest(name, ".mp4", VIDEO, folder=False)
        self.target.write.setEnabled(bool(order.characters))
        self.preview.show_order(order)

    def _render(self) -> None:
        order, still = self.order, self.project.session.as_it_is()

        def write(target: Path, progress: Progress) -> Path:
            return rendering.write_film(still, order, target, progress)

        self.target.run("Rendering", write)

    def close_calls(self) -> None:
        """End the thread of the preview."""
        self.preview.close_calls()
