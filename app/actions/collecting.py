"""Media that lie outside the project: how large they are, and copying them in."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

import attrs

from app.model.document import Document
from app.model.edits import Edit
from app.model.values import MediaRef
from app.stages.foreign import is_project
from app.storage.folder import ProjectFolder, size_of
from imitation.errors import InputError
from imitation.progress import Progress, part

Copies = Mapping[MediaRef, MediaRef]


def linked_media(document: Document) -> tuple[MediaRef, ...]:
    """Give the media that lie outside the project, each once; motions of other projects are none: they stay there."""
    found: list[MediaRef] = []

    def note(media: MediaRef) -> MediaRef:
        if media.linked and not is_project(Path(media.path)):
            found.append(media)
        return media

    _each(document, note)
    return tuple(dict.fromkeys(found))


def linked_size(document: Document, folder: ProjectFolder) -> int:
    """Bytes of the media outside the project; what is missing counts nothing."""
    total = 0
    for media in linked_media(document):
        try:
            total += size_of(folder.locate(media))
        except (InputError, OSError):
            continue
    return total


def copied_media(
    document: Document, source: ProjectFolder, target: ProjectFolder, progress: Progress | None = None
) -> Copies:
    """Copy what lies outside a project into the media of another, or of itself; the document stays as it is.

    Safe in any thread. Raises ``InputError`` where something is missing or the disk is full.
    """
    linked = linked_media(document)
    places = [source.locate(media) for media in linked]
    sizes = [size_of(place) + 1 for place in places]
    total, done, copies = sum(sizes), 0, {}
    for media, place, size in zip(linked, places, sizes, strict=True):
        copies[media] = target.copy_in(place, part(progress, done / total, (done + size) / total))
        done += size
    return copies


def with_media_at(document: Document, copies: Copies) -> Document:
    """Give the document with its media where the copies lie."""
    return _each(document, lambda media: copies.get(media, media))


def linked_from(document: Document, folder: ProjectFolder) -> Document:
    """Give the document with the media of a project's folder as files outside, for a copy that lies elsewhere."""

    def link(media: MediaRef) -> MediaRef:
        return media if media.linked else attrs.evolve(media, path=str(folder.path.resolve() / media.path), linked=True)

    return _each(document, link)


def use_copies(document: Document, copies: Copies) -> Edit:
    """Let the project use the copies of its media."""
    return Edit(with_media_at(document, copies), "Copy media into the project")


def _each(document: Document, change: Callable[[MediaRef], MediaRef]) -> Document:
    """Put every medium of a document through a function."""
    clip = document.clip
    if clip is not None:
        clip = attrs.evolve(clip, media=change(clip.media))
    characters = tuple(attrs.evolve(each, mesh=change(each.mesh)) for each in document.characters)
    sequences = tuple(
        each if each.media is None else attrs.evolve(each, media=change(each.media)) for each in document.sequences
    )
    camera = document.camera
    if camera.file is not None:
        camera = attrs.evolve(camera, file=change(camera.file))
    return attrs.evolve(document, clip=clip, characters=characters, sequences=sequences, camera=camera)
