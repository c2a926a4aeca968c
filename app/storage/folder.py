"""The project folder: project.json, media/, results/, autosave.json."""

from __future__ import annotations

import shutil
from pathlib import Path

import attrs

from app.formats.atomic import explained, replacing
from app.formats.fingerprint import file_fingerprint, folder_fingerprint
from app.model.document import Document
from app.model.values import MediaRef
from app.storage.schema import document_from_json, document_to_json
from imitation.errors import InputError
from imitation.progress import Progress, silent

SUFFIX = ".motionwright"
COPIED = 4 << 20
"""Bytes of a medium that are copied between two looks whether to go on."""


@attrs.frozen
class ProjectFolder:
    """A folder ``name.motionwright`` that holds one project."""

    path: Path = attrs.field(converter=Path)

    @property
    def file(self) -> Path:
        """The saved document."""
        return self.path / "project.json"

    @property
    def autosave_file(self) -> Path:
        """The document as it was at the last autosave, there only while it is newer than the saved one."""
        return self.path / "autosave.json"

    @property
    def media(self) -> Path:
        """Copied media."""
        return self.path / "media"

    @property
    def results(self) -> Path:
        """Computed results by key; may be deleted at any time."""
        return self.path / "results"

    @classmethod
    def free(cls, path: Path) -> ProjectFolder:
        """Give the place of a new project, with the suffix; one that exists with a project inside is refused."""
        folder = cls(path if path.suffix == SUFFIX else path.with_name(path.name + SUFFIX))
        with explained(folder.path):
            there = folder.file.exists()
        if there:
            raise InputError(f"{folder.path} is a project already: open it, or choose another name.")
        return folder

    @classmethod
    def create(cls, path: Path, document: Document) -> ProjectFolder:
        """Make a new project folder; one that exists with a project inside is refused."""
        folder = cls.free(path)
        with explained(folder.path):
            folder.path.mkdir(parents=True, exist_ok=True)
        folder.save(document)
        return folder

    @classmethod
    def find(cls, path: Path) -> ProjectFolder:
        """Give the project folder at a path, which may also name its project.json or leave out the suffix."""
        for candidate in (
            path,
            path.parent if path.name == "project.json" else path,
            path.with_name(path.name + SUFFIX),
        ):
            folder = cls(candidate)
            if folder.file.is_file() or folder.autosave_file.is_file():
                return folder
        raise InputError(f"{path} is no Motionwright project: it has no project.json.")

    def load(self) -> Document:
        """Read the saved document."""
        return self.read(self.file)

    def save(self, document: Document) -> None:
        """Write the document and drop the autosave, which it supersedes."""
        _write(self.file, document_to_json(document))
        self.autosave_file.unlink(missing_ok=True)

    def autosave(self, document: Document) -> None:
        """Write the document beside the saved one."""
        _write(self.autosave_file, document_to_json(document))

    def recoverable(self) -> Document | None:
        """Give the autosaved document of a session that ended without saving, None where there is none to offer."""
        if not self.autosave_file.is_file():
            return None
        if self.file.is_file() and self.autosave_file.stat().st_mtime_ns < self.file.stat().st_mtime_ns:
            return None  # a save was cut off after the project was written, before the autosave was removed
        try:
            recovered = self.read(self.autosave_file)
        except InputError:
            return None
        if self.file.is_file() and document_to_json(recovered) == self.file.read_bytes():
            return None
        return recovered

    def copy_in(self, source: Path, progress: Progress | None = None) -> MediaRef:
        """Copy a file or a folder of files into media/ and give its reference; cancelled, nothing is left of it."""
        if not source.exists():
            raise InputError(f"{source} does not exist: check the path.")
        mark = fingerprint(source)
        target = self.media / source.name
        number = 2
        while target.exists() and fingerprint(target) != mark:
            target = self.media / f"{source.stem}-{number}{source.suffix}"
            number += 1
        if not target.exists():
            beside = target.with_name(f".{target.name}.part")
            try:
                with explained(target):
                    self.media.mkdir(exist_ok=True)
                    copy_files(source, beside, progress or silent)
                    beside.rename(target)
            finally:
                if beside.is_dir():
                    shutil.rmtree(beside, ignore_errors=True)
                beside.unlink(missing_ok=True)
        return MediaRef(target.relative_to(self.path).as_posix(), mark, linked=False)

    def link(self, source: Path) -> MediaRef:
        """Give a reference to a file outside the project."""
        if not source.exists():
            raise InputError(f"{source} does not exist: check the path.")
        return MediaRef(str(source.resolve()), fingerprint(source), linked=True)

    def locate(self, media: MediaRef) -> Path:
        """Find a medium: where the reference says, or moved along with the project folder.

        Raises ``InputError`` when it is not there; whether its content changed is for the caller to compare.
        """
        stated = Path(media.path)
        candidates = [stated if stated.is_absolute() else self.path / stated]
        if media.linked:
            candidates += [self.path.parent / stated.name, self.media / stated.name]
        for candidate in candidates:
            # Of another project only a motion is used: its own mark is looked at where that is opened.
            known = candidate == candidates[0] or candidate.suffix == SUFFIX
            if candidate.exists() and (known or fingerprint(candidate) == media.fingerprint):
                return candidate
        raise InputError(
            f"{stated.name} is missing: it was expected at {candidates[0]}; put it back, or say where it lies now "
            "(in the window, or with set --find FOLDER)."
        )

    def read(self, file: Path) -> Document:
        """Read a document of this project, the saved one or another."""
        try:
            data = file.read_bytes()
        except OSError as error:
            raise InputError(f"{file} cannot be read ({error.strerror}).") from error
        return document_from_json(data, str(file))


def size_of(path: Path) -> int:
    """Bytes of a file, or of the files of a folder; 0 where there is nothing."""
    if path.is_dir():
        return sum(file.stat().st_size for file in path.rglob("*") if file.is_file())
    return path.stat().st_size if path.exists() else 0


def copy_files(source: Path, target: Path, progress: Progress) -> None:
    """Copy a file, or the files of a folder, piece by piece; what was copied before a cancellation stays."""
    files = [file for file in source.rglob("*") if file.is_file()] if source.is_dir() else [source]
    total, done = max(size_of(source), 1), 0
    for file in sorted(files):
        place = target / file.relative_to(source) if source.is_dir() else target
        place.parent.mkdir(parents=True, exist_ok=True)
        with file.open("rb") as reading, place.open("wb") as writing:
            while part := reading.read(COPIED):
                writing.write(part)
                done += len(part)
                progress(min(done / total, 1.0))
        shutil.copystat(file, place)


def fingerprint(path: Path) -> str:
    """Give the fingerprint of a file, or of the files of a folder."""
    if path.is_dir():
        return folder_fingerprint(sorted(file for file in path.rglob("*") if file.is_file()))
    return file_fingerprint(path)


def _write(path: Path, data: bytes) -> None:
    with replacing(path) as beside:
        beside.write_bytes(data)
