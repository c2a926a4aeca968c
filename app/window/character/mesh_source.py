"""The mesh of a character as its file holds it, read in the background."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QObject, Signal

from app.model.character import Character
from app.window.background_call import BackgroundCalls
from app.window.project import Project
from app.window.work import details


@dataclass(frozen=True, eq=False)
class Shape:
    """Triangles, colours, and the vertices (v, 3) standing upright at the origin until they are placed."""

    standing: NDArray[np.float64]
    faces: NDArray[np.int32]
    colours: NDArray[np.uint8] | None


class MeshSource(QObject):
    """Reads each mesh once."""

    loaded = Signal()

    def __init__(self, project: Project, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.project = project
        self._shapes: dict[tuple[str, str], Shape] = {}
        self._asked: set[tuple[str, str]] = set()
        self._calls = BackgroundCalls(self)

    def shape(self, character: Character) -> Shape | None:
        """The mesh of a character where it has been read; ``loaded`` comes when it has."""
        key = (character.mesh.fingerprint, character.alignment.up)
        if key not in self._shapes and key not in self._asked:
            self._asked.add(key)
            media = self.project.session.media
            self._calls.run(
                lambda: _upright(media.mesh(character.mesh), character.alignment.up),
                lambda shape: self._keep(key, shape),
                lambda error: self.project.failed.emit(str(error), details(error)),
            )
        return self._shapes.get(key)

    def _keep(self, key: tuple[str, str], shape: Shape) -> None:
        self._shapes[key] = shape
        self.loaded.emit()

    def close(self) -> None:
        """Wait for the file that is being read."""
        self._calls.close()


def _upright(mesh: object, up: str) -> Shape:
    vertices = np.asarray(mesh.vertices, np.float64)  # type: ignore[attr-defined]
    faces = np.ascontiguousarray(mesh.faces, np.int32)  # type: ignore[attr-defined]
    colours = getattr(mesh, "colors", None)
    turned = {"z": vertices, "y": vertices[:, [0, 2, 1]] * (1, -1, 1), "x": vertices[:, [1, 2, 0]]}[up]
    height = float(np.ptp(turned[:, 2])) or 1.0
    middle = np.append(turned[:, :2].mean(0), turned[:, 2].min())
    return Shape((turned - middle) / height, faces, None if colours is None else np.asarray(colours)[:, :3])
