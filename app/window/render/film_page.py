"""The page of a film."""

from __future__ import annotations

from pathlib import Path

from app.actions import rendering
from app.actions.rendering import FilmOrder
from app.window.project import Project
from app.window.render.film_options import FilmOptions
from app.window.render.page import VIDEO, Page
from imitation.progress import Progress


class FilmPage(Page):
    """Films the characters that are ticked."""

    def __init__(self, project: Project) -> None:
        self.options = FilmOptions(project.range, project.frame_count)
        super().__init__(project, self.options, "film", "Render")
        self.options.changed.connect(self.refresh)
        self.target.wanted.connect(self._render)
        self._alpha: bool | None = None

    @property
    def order(self) -> FilmOrder:
        """The film that is chosen."""
        return self.options.choices.order(self.options.filmed, self.options.frames)

    def refresh(self) -> None:
        """Show the project and the choice as they are."""
        self.options.show_characters(self.project.document.characters)
        order = self.order
        if order.alpha != self._alpha:
            self._alpha = order.alpha
            suffix, listed = ("", "") if order.alpha else (".mp4", VIDEO)
            self.target.suggest(self.project.document.name, suffix, listed, folder=order.alpha)
        self.target.write.setEnabled(bool(order.characters))
        self.preview.show_order(order)

    def _render(self) -> None:
        order, still = self.order, self.project.session.as_it_is()

        def write(target: Path, progress: Progress) -> Path:
            return rendering.write_film(still, order, target, progress)

        self.target.run("Rendering", write)
