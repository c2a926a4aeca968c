"""A session: one open project with its history, its folder, its results and its workers. Knows no window."""

from __future__ import annotations

import contextlib
import copy
import shutil
import threading
import uuid
from collections.abc import Callable
from concurrent.futures import Executor
from pathlib import Path

from app.actions.collecting import copied_media, with_media_at
from app.actions.places import unsaved_folder
from app.formats import FrameSource
from app.formats.atomic import explained
from app.model.document import Document
from app.model.edits import Edit
from app.model.history import History, Version
from app.model.values import MediaRef
from app.stages.cache import ResultCache
from app.stages.job import Job, Listener
from app.stages.media import Media
from app.stages.project import Stages
from app.stages.runner import Runner
from app.stages.stage import Stage
from app.storage.folder import SUFFIX, ProjectFolder, copy_files
from app.storage.lock import FolderLock
from app.storage.results import ResultStore
from imitation.errors import InputError
from imitation.progress import Progress

Changed = Callable[[Document, Document], None]


class Session:
    """Everything that window, command line and scripts do to a project goes through one of these.

    Edits, undo and saving belong to one thread; jobs run in others and touch results only.

    Attributes
    ----------
    history : the versions of the document.
    folder : where the project lies; a private place until it is saved for the first time.
    titled : whether the user has chosen a place.
    alone : False where another running program has the project open.
    """

    def __init__(
        self, document: Document, folder: ProjectFolder, *, titled: bool, executor: Executor | None = None
    ) -> None:
        self.history = History(document)
        self.folder, self.titled = folder, titled
        self._executor = executor
        self._listeners: list[Changed] = []
        self._stages: tuple[Document, Stages] | None = None
        self._thread = threading.get_ident()
        self.alone = True
        self._begin()

    @classmethod
    def new(cls, path: Path | None = None, *, name: str = "Untitled", executor: Executor | None = None) -> Session:
        """Begin a project at a path, or at a private place until it is saved."""
        if path is not None:
            document = Document(name=path.name.removesuffix(SUFFIX) if name == "Untitled" else name)
            return cls(document, ProjectFolder.create(path, document), titled=True, executor=executor)
        document = Document(name=name)
        place = unsaved_folder() / f"{uuid.uuid4().hex}{SUFFIX}"
        return cls(document, ProjectFolder.create(place, document), titled=False, executor=executor)

    @classmethod
    def open(cls, path: Path, *, recover: bool = False, executor: Executor | None = None) -> Session:
        """Open a project; with ``recover`` its autosaved document, as unsaved work on top of the saved one."""
        folder = ProjectFolder.find(path)
        saved = folder.load() if folder.file.is_file() else Document()
        session = cls(saved, folder, titled=True, executor=executor)
        if recover and (document := folder.recoverable()) is not None:
            session.recover(document)
        return session

    @property
    def document(self) -> Document:
        """The present document."""
        return self.history.document

    @property
    def stages(self) -> Stages:
        """The stages of the present document."""
        if self._stages is None or self._stages[0] is not self.document:
            self._stages = (self.document, Stages(self.document))
        return self._stages[1]

    def subscribe(self, listener: Changed) -> Callable[[], None]:
        """Call ``listener(before, after)`` after every change of the document; gives a function that stops it."""
        self._listeners.append(listener)
        return lambda: self._listeners.remove(listener)

    def apply(self, edit: Edit, *, gesture: str | None = None) -> Document:
        """Do an edit; edits of one ``gesture`` become one entry of the history."""
        before = self.document
        after = self.history.apply(edit.document, edit.label, gesture=gesture, frame=edit.frame)
        self._tell(before)
        return after

    def undo(self) -> Version:
        """Take the last edit back and give the entry that was taken back."""
        before = self.document
        version = self.history.undo()
        self._tell(before)
        return version

    def redo(self) -> Version:
        """Do the edit again that was taken back and give its entry."""
        before = self.document
        version = self.history.redo()
        self._tell(before)
        return version

    def jump(self, index: int) -> None:
        """Go to a version of the history."""
        before = self.document
        self.history.jump(index)
        self._tell(before)

    def frames(self) -> FrameSource:
        """Give the frames of the clip."""
        if self.document.clip is None:
            raise InputError("This project has no clip yet: add a video first.")
        return self.media.frames(self.document.clip)

    def as_it_is(self) -> Session:
        """A session on the document of this moment, with the same results and workers: later edits do not reach it.

        For what goes on in another thread, such as a film being written.
        """
        still = copy.copy(self)
        still.history, still._listeners, still._stages = History(self.document), [], None
        return still

    def start(self, label: str, targets: tuple[Stage, ...], listener: Listener | None = None) -> Job:
        """Compute what is missing for these stages in the background."""
        return self.runner.start(label, targets, listener)

    def result(self, stage: Stage, listener: Listener | None = None) -> object:
        """Give a stage's result; computes it here if it is not there."""
        return self.runner.run(stage.label, (stage,), listener)[0]

    def ready(self, stage: Stage) -> object | None:
        """Give a stage's result if it is there, None otherwise; never computes."""
        try:
            value: object = self.cache.get(stage)
        except KeyError:
            return None
        return value

    def bring_in(self, source: Path, *, copy: bool = False) -> MediaRef:
        """Take a file into the project, copied or linked."""
        return self.folder.copy_in(source) if copy else self.folder.link(source)

    def save(self) -> None:
        """Write the project where it lies."""
        if not self.titled:
            raise InputError("This project has no place yet: choose where to save it.")
        self.folder.save(self.document)
        self.history.mark_saved()

    def save_as(self, path: Path, *, with_media: bool = False) -> None:
        """Write the project to another folder and go on there; linked media are copied along when asked for."""
        target = _new_folder(path)
        held = target.media.is_dir()
        try:
            with explained(target.path):
                document = self.document
                if with_media:
                    document = with_media_at(document, copied_media(document, self.folder, target))
                if self.folder.media.is_dir():
                    shutil.copytree(self.folder.media, target.media, dirs_exist_ok=True, copy_function=_unless_there)
            target.save(document)
        except BaseException:
            _take_back(target, media=not held)
            raise
        former, was_titled = self.folder, self.titled
        self._end()
        if not was_titled and former.results.is_dir():
            shutil.move(former.results, target.results)
        if not was_titled:
            shutil.rmtree(former.path, ignore_errors=True)
        self.folder, self.titled = target, True
        self._begin()
        if document is not self.document:
            self.history.apply(document, "Copy media into the project")
        self.history.mark_saved()

    def send_media(self, path: Path, progress: Progress) -> None:
        """Copy the project's own media to a place where ``save_as`` will find them; safe in any thread.

        Cancelled or failed, the place is free as it was.
        """
        target = ProjectFolder.free(path)
        held, there = target.media.is_dir(), target.path.is_dir()
        try:
            with explained(target.path):
                copy_files(self.folder.media, target.media, progress)
        except BaseException:
            if not held:
                shutil.rmtree(target.media, ignore_errors=True)
            if not there:
                shutil.rmtree(target.path, ignore_errors=True)
            raise

    def autosave(self) -> bool:
        """Write unsaved work beside the saved project; False when there is none, and none is left to recover then.

        Where another program has the project open nothing is written: what lies there is that one's.
        """
        if not self.alone:
            return False
        if not self.history.modified:
            self.forget_autosave()
            return False
        self.folder.autosave(self.document)
        return True

    def recover(self, document: Document) -> None:
        """Take up a document that was autosaved, as one entry of the history."""
        before = self.document
        self.history.apply(document, "Recover unsaved work")
        self._tell(before)

    def forget_autosave(self) -> None:
        """Leave nothing to recover: there is no unsaved work, or the person chose to throw it away."""
        if self.alone:
            with explained(self.folder.path):
                self.folder.autosave_file.unlink(missing_ok=True)

    def look_again(self) -> bool:
        """Whether no other program has the project open now; one that had it may have closed it since."""
        if not self.alone:
            self.alone = self._lock.take()
        return self.alone

    def close(self) -> None:
        """Stop all work and close all files; what was not saved stays recoverable only if it was autosaved."""
        self._end()
        if not self.titled:
            shutil.rmtree(self.folder.path, ignore_errors=True)

    def _begin(self) -> None:
        self._lock = FolderLock(self.folder.path)
        self.alone = self._lock.take()
        self.media = Media(self.folder.locate)
        store = ResultStore(self.folder.results)
        store.sweep()
        self.cache = ResultCache(store)
        self.runner = Runner(self.cache, self.media, self._executor)

    def _end(self) -> None:
        self.runner.close()
        self.media.close()
        # At once, not when Python next looks for garbage: in the window it never looks at what was there at the start.
        self.cache.empty()
        self._lock.let_go()

    def _tell(self, before: Document) -> None:
        if before is not self.document:
            for listener in tuple(self._listeners):
                listener(before, self.document)


def _new_folder(path: Path) -> ProjectFolder:
    return ProjectFolder.create(path, Document())


def _unless_there(source: str, target: str) -> None:
    """Copy a file that was not sent ahead."""
    old, new = Path(source), Path(target)
    if not new.is_file() or _stamp(old) != _stamp(new):
        shutil.copy2(old, new)


def _stamp(file: Path) -> tuple[int, int]:
    status = file.stat()
    return status.st_size, int(status.st_mtime)


def _take_back(folder: ProjectFolder, *, media: bool) -> None:
    """Remove a project that could not be written whole; what was in its folder before stays."""
    folder.file.unlink(missing_ok=True)
    if media:
        shutil.rmtree(folder.media, ignore_errors=True)
    with contextlib.suppress(OSError):
        folder.path.rmdir()
