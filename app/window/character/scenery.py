"""Fetches the measured background as a mesh when it is to be seen."""

from __future__ import annotations

from PySide6.QtCore import QObject, Signal

from app.window.background_call import BackgroundCalls
from app.window.project import Project
from app.window.viewport.layers import Layers
from imitation.errors import InputError


class Scenery(QObject):
    """``found`` gives vertices, triangles and colours; ``told`` a sentence where there is no mesh."""

    found = Signal(object)
    told = Signal(str)

    def __init__(self, project: Project, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.project = project
        self._calls = BackgroundCalls(self)
        self._asked = ""

    def _key(self) -> str:
        stages = self.project.session.stages
        return f"{stages.depth.key} {stages.world.key}"

    def known(self) -> bool:
        """Whether the background has been measured."""
        stages = self.project.session.stages
        return stages.depth in self.project.session.cache and stages.world in self.project.session.cache

    def missing(self) -> dict[str, str]:
        """Layers that cannot be shown, and why."""
        return {} if self.known() else {"background": "not measured yet"}

    def keep_up(self, layers: Layers, *, over_film: bool) -> None:
        """Fetch the mesh once, where its layer is on and it has been measured."""
        if not layers.on("background", over_film=over_film) or not self.known() or self._key() == self._asked:
            return
        from app.actions.scenery import background_for_view

        self._asked = self._key()
        session = self.project.session
        self._calls.run(
            lambda: background_for_view(session),
            lambda mesh: self.found.emit((mesh.vertices, mesh.faces, mesh.colors)),
            self._fail,
        )

    def _fail(self, error: BaseException) -> None:
        sentence = str(error) if isinstance(error, InputError) else "The background cannot be shown as a mesh."
        self.told.emit(sentence)

    def close(self) -> None:
        """Wait for what is being fetched."""
        self._calls.close()
