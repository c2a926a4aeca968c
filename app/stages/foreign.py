"""Motions of other projects: their finished results as sequences, read and never solved here."""

from __future__ import annotations

import hashlib
from fractions import Fraction
from pathlib import Path

import attrs
import numpy as np
from numpy.typing import NDArray

from app.formats import read_mesh
from app.formats.meshfile import MeshFile, check_mesh
from app.formats.tvm import FrameMesh, MeshFrames
from app.model.character import Character
from app.model.document import Document
from app.stages import animation
from app.stages.results import AlignedCharacter, Animation
from app.storage.folder import SUFFIX, ProjectFolder
from app.storage.results import ResultStore
from imitation.errors import InputError


@attrs.frozen
class ForeignMotion:
    """A character of another project, as that was saved.

    Attributes
    ----------
    mark : of all that is read; it changes with everything its motion depends on.
    done : whether its motion is there. begun : whether an earlier one is.
    """

    character: Character
    mark: str
    done: bool
    begun: bool


class ProjectMotion(MeshFrames):
    """The finished motion of one character; its frames are mapped from the project's results.

    Attributes
    ----------
    mark : see ``ForeignMotion``. character : its name.
    """

    moving = True
    up, unit = "z", 1.0
    form = "Motionwright project"

    def __init__(self, folder: ProjectFolder, document: Document, motion: ForeignMotion) -> None:
        self.name, self.mark = f"{motion.character.name} in {folder.path.name}", motion.mark
        self.character = motion.character.name
        self.fps = Fraction(document.clip.fps if document.clip is not None else 25.0).limit_denominator(100_000)
        store, character = ResultStore(folder.results), motion.character
        try:
            aligned = store.load(animation.alignment(document, character).key)
            animated = store.load(animation.animation(document, character).key)
        except KeyError as error:
            raise InputError(_unfinished(folder, motion)) from error
        if not isinstance(aligned, AlignedCharacter) or not isinstance(animated, Animation):
            raise InputError(_unfinished(folder, motion))
        self._vertices, self._faces = animated.vertices, aligned.faces
        if self._vertices.ndim != 3 or len(self._vertices) < 2:
            raise InputError(f"{self.name} has one frame only: a sequence needs at least two.")
        self._colours = _colours(folder, character, self._vertices.shape[1])
        check_mesh(MeshFile(self._vertices[0], self._faces, None, "z", self.name))

    def __len__(self) -> int:
        return len(self._vertices)

    def _frame(self, frame: int) -> FrameMesh:
        places = np.array(self._vertices[frame], np.float64)
        if not np.isfinite(places).all():
            raise InputError(f"Frame {frame} of {self.name} has vertices that are NaN or infinite.")
        return FrameMesh(places, self._faces, self._colours)


def is_project(path: Path) -> bool:
    """Whether a path is the folder of a project."""
    return path.is_dir() and (path.suffix == SUFFIX or (path / "project.json").is_file())


def foreign_motions(path: Path) -> list[ForeignMotion]:
    """Give the characters of a project as it was saved; raises ``InputError`` where it cannot be read."""
    folder = ProjectFolder.find(path)
    return _motions(folder, folder.load())


def open_motion(path: Path, mark: str | None = None, character: str | None = None) -> ProjectMotion:
    """Open the motion of one mark, or of the character of one id or name.

    Raises
    ------
    InputError
        No such project or character, a motion that was never made, or has changed since the mark was taken.
    """
    folder = ProjectFolder.find(path)
    document = folder.load()
    motions = _motions(folder, document)
    if mark is not None:
        found = next((each for each in motions if each.mark == mark), None)
        if found is None:
            raise InputError(
                f"The motion in {folder.path.name} has changed since it was added: animate it there and find it again."
            )
    else:
        found = next((each for each in motions if character in (each.character.id, each.character.name)), None)
        if found is None:
            known = ", ".join(each.character.name for each in motions) or "none yet"
            raise InputError(
                f"There is no character called {character} in {folder.path.name}: the characters are {known}."
            )
    return ProjectMotion(folder, document, found)


def finished(path: Path) -> list[ForeignMotion]:
    """Give the characters whose motion is there; raises ``InputError`` with what to do where there is none."""
    motions = foreign_motions(path)
    done = [each for each in motions if each.done]
    if done:
        return done
    folder = ProjectFolder.find(path)
    if not motions:
        raise InputError(f"{folder.path.name} has no character: open it, add one and run animate.")
    raise InputError(_unfinished(folder, next((each for each in motions if each.begun), motions[0])))


def _motions(folder: ProjectFolder, document: Document) -> list[ForeignMotion]:
    store = ResultStore(folder.results)
    found = []
    for character in document.characters:
        stages = (animation.alignment(document, character), animation.animation(document, character))
        rate = document.clip.fps if document.clip is not None else None
        read = (character.mesh.fingerprint, rate, *(stage.key for stage in stages))
        mark = hashlib.blake2b(repr(read).encode(), digest_size=16).hexdigest()
        done = all(stage.key in store for stage in stages)
        found.append(ForeignMotion(character, mark, done, store.knows(stages[1].name)))
    return found


def _unfinished(folder: ProjectFolder, motion: ForeignMotion) -> str:
    name = f"{motion.character.name} in {folder.path.name}"
    why = "was changed after its motion was made" if motion.begun else "was never animated"
    return f"{name} {why}: open it and run animate, then add it."


def _colours(folder: ProjectFolder, character: Character, count: int) -> NDArray[np.uint8] | None:
    """Colours a vertex; none where the mesh is not there any more: the motion does not need it."""
    try:
        colours = read_mesh(folder.locate(character.mesh)).colors
    except InputError:
        return None
    return colours if colours is not None and len(colours) == count else None
