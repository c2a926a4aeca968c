"""Media that are not where the project expects them: which they are, where they lie near by, and saying so."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from typing import Literal

import attrs

from app.actions.performing import find_again
from app.actions.session import Session
from app.formats import open_images, open_video, read_mesh
from app.formats.tvm import open_mesh_frames
from app.model.character import Character
from app.model.document import Document
from app.model.edits import Edit, characters, scene, sequences
from app.model.performance import CapturedSequence
from app.model.values import Clip, MediaRef
from app.stages.foreign import is_project, open_motion
from app.storage.folder import ProjectFolder, fingerprint
from imitation.errors import InputError

DEEP = 2
"""Levels of folders beside the project that are looked through."""
MANY = 5000
"""Entries after which the search is given up: a home folder is not read for minutes."""


@attrs.frozen
class LostMedium:
    """A medium that is not there.

    Attributes
    ----------
    kind : what uses it. id : of the character or the sequence; empty for the clip and the cameras.
    owner : its name for people ("the clip", "the mesh of Wolf").
    found : where the same file lies now, None where it was not found.
    """

    kind: Literal["clip", "character", "sequence", "camera"]
    id: str
    owner: str
    media: MediaRef
    found: Path | None = None

    @property
    def name(self) -> str:
        """The name of the file."""
        return Path(self.media.path).name


def lost_media(document: Document, folder: ProjectFolder, beside: Path | None = None) -> tuple[LostMedium, ...]:
    """Give what is missing, with the place where each lies now if that is beside the project, or in another folder."""
    lost = missing_media(document, folder)
    return tuple(attrs.evolve(each, found=look_for(each, beside or folder.path.parent)) for each in lost)


def missing_media(document: Document, folder: ProjectFolder) -> tuple[LostMedium, ...]:
    """Give what is missing, without looking for it."""
    return tuple(each for each in _all(document) if _missing(each.media, folder))


def look_for(lost: LostMedium, folder: Path) -> Path | None:
    """Give the same file or folder, told by its content, in a folder or somewhat below it."""
    for candidate in _named(folder, lost.name):
        try:
            if is_project(candidate):
                open_motion(candidate, lost.media.fingerprint).close()
                return candidate
            if fingerprint(candidate) == lost.media.fingerprint:
                return candidate
        except InputError:
            continue
    return None


def relink(session: Session, lost: LostMedium, path: Path) -> None:
    """Say where a medium lies now; what was solved from the same content stays solved.

    Raises ``InputError`` when the file is not one that the project's marks fit.
    """
    document = session.document
    if lost.kind == "clip":
        assert document.clip is not None
        _check_clip(document.clip, path)
        edit = scene.relink_clip(document, session.folder.link(path))
    elif lost.kind == "character":
        _check_mesh(document.character(lost.id), path)
        edit = characters.relink_character(document, lost.id, session.folder.link(path))
    elif lost.kind == "sequence":
        if not is_project(path):
            _check_sequence(document.sequence(lost.id), path)
        edit = sequences.relink_sequence(document, lost.id, find_again(session, lost.id, path))
    else:
        found = scene.set_camera(document, "file", file=session.folder.link(path))
        edit = Edit(found.document, "Find the cameras again")
    session.apply(edit)
    session.runner.try_again()


def find_in(session: Session, folder: Path) -> None:
    """Say of all media that are missing and lie in a folder, or somewhat below it, that they lie there now.

    Raises ``InputError`` when none of them does.
    """
    lost = lost_media(session.document, session.folder, folder)
    found = [each for each in lost if each.found is not None]
    if lost and not found:
        names = ", ".join(each.name for each in lost)
        raise InputError(f"{names} cannot be found in {folder}: name the folder that holds the same file.")
    for each in found:
        assert each.found is not None
        relink(session, each, each.found)


def _all(document: Document) -> Iterator[LostMedium]:
    if document.clip is not None:
        yield LostMedium("clip", "", "the clip", document.clip.media)
    for character in document.characters:
        yield LostMedium("character", character.id, f"the mesh of {character.name}", character.mesh)
    for sequence in document.sequences:
        if sequence.media is not None:
            yield LostMedium("sequence", sequence.id, f"the sequence {sequence.name}", sequence.media)
    if document.camera.file is not None and document.camera.source == "file":
        yield LostMedium("camera", "", "the cameras", document.camera.file)


def _missing(media: MediaRef, folder: ProjectFolder) -> bool:
    try:
        folder.locate(media)
    except InputError:
        return True
    return False


def _named(folder: Path, name: str) -> Iterator[Path]:
    """Every entry of a name in a folder and the folders below it, nearest first."""
    level, seen = [folder], 0
    for _ in range(DEEP + 1):
        below: list[Path] = []
        for each in level:
            try:
                entries = list(os.scandir(each))
            except OSError:
                continue
            seen += len(entries)
            if seen > MANY:
                return
            for entry in entries:
                if entry.name == name:
                    yield Path(entry.path)
                elif entry.is_dir(follow_symlinks=False) and not entry.name.startswith("."):
                    below.append(Path(entry.path))
        level = below


def _check_clip(clip: Clip, path: Path) -> None:
    with open_images(path, fps=clip.fps) if path.is_dir() else open_video(path) as source:
        has = (len(source), *source.size)
    if has != (clip.frame_count, clip.width, clip.height):
        raise InputError(
            f"{path.name} is another clip: it has {has[0]} frames of {has[1]} x {has[2]}, the project was made with "
            f"{clip.frame_count} of {clip.width} x {clip.height}; choose the file that was filmed then."
        )


def _check_mesh(character: Character, path: Path) -> None:
    count = len(read_mesh(path).vertices)
    used = [*character.pairs.values(), *(vertex for edit in character.edits.values() for vertex in edit.committed)]
    if used and max(used) >= count:
        raise InputError(
            f"{path.name} is another mesh: it has {count} vertices, but {character.name} is marked at vertex "
            f"{max(used)}; choose the file that was marked."
        )


def _check_sequence(sequence: CapturedSequence, path: Path) -> None:
    with open_mesh_frames(path, animation=sequence.animation) as frames:
        has = len(frames)
    if has != sequence.source_count:
        raise InputError(
            f"{path.name} is another sequence: it has {has} frames, not {sequence.source_count}; choose the one used "
            "then."
        )
