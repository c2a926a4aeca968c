"""The commands of the project menu: they ask, call the actions, and say what went wrong."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject

from app.actions import bringing, collecting
from app.actions.kinds import kind_of
from app.actions.session import Session
from app.model.edits import scene
from app.stages.job import Job
from app.storage.folder import SUFFIX, size_of
from app.window import files, settings
from app.window.project import Project
from app.window.waiting import wait_for
from app.window.work import details
from imitation.errors import Cancelled, InputError

if TYPE_CHECKING:
    from app.window.shell import Shell


LARGE = 64 << 20
"""Bytes from which on a clip is looked through in the background."""


class FileCommands(QObject):
    """Belongs to one window."""

    def __init__(self, shell: Shell) -> None:
        super().__init__(shell)
        self.shell = shell
        self._awaited: dict[Job, Callable[[Project, object], object]] = {}

    def command(self, name: str) -> bool:
        """Do a command; says whether it was one."""
        handlers: dict[str, Callable[[], object]] = {
            "new": self.new,
            "open": lambda: self._with(files.ask_project(self.shell), self.open),
            "sample": self.sample,
            "sample_performance": self.sample_performance,
            "save": self.save,
            "save_as": self.save_as,
            "save_as_whole": self.save_as_whole,
            "collect": self.collect,
            "add_clip": lambda: self._with(files.ask_clip(self.shell), self.add_clip),
            "add_sequence": self.add_sequence,
            "add_character": lambda: self._with(files.ask_mesh(self.shell), self.add_character),
            "export": self.export,
        }
        if name not in handlers:
            return False
        handlers[name]()
        return True

    def _with(self, path: Path | None, call: Callable[[Path], object]) -> None:
        if path is not None:
            call(path)

    def take(self, path: Path) -> None:
        """Do what a dropped file asks for."""
        handlers: dict[str, Callable[[Path], object]] = {
            "project": self.open,
            "mesh": self.add_character,
            "clip": self.add_clip,
            "sequence": self.take_sequence,
            "cameras": self.use_cameras,
        }
        handler = handlers.get(kind_of(path))
        if handler is None:
            self.shell.tell(f"{path.name} is no video, mesh, sequence, camera file or project: drop one of these.")
        else:
            handler(path)

    # projects ----------------------------------------------------------------------------------------------------

    def new(self) -> None:
        """Begin an empty project."""
        if self.may_leave():
            self._guard(lambda: self.shell.open_session(Session.new()))

    def open(self, path: Path) -> None:
        """Open a project; the window asks about unsaved work of a run that ended badly."""
        if not self.may_leave():
            return
        try:
            session = Session.open(path)
        except (InputError, OSError) as error:
            self.shell.care.refuse(path, error)
        else:
            self._guard(lambda: self.shell.open_session(session))

    def sample(self) -> None:
        """Open the sample project, as one that has no place yet."""
        from app.window.sample import sample_session

        if self.may_leave():
            self._guard(lambda: self.shell.open_session(sample_session()))

    def sample_performance(self) -> None:
        """Open the sample and let motions of its hound be made, which are one database with its filmed walk."""
        from app.window.sample_performance import open_sample_performance

        if self.may_leave():
            self._guard(lambda: open_sample_performance(self.shell))

    def save(self) -> bool:
        """Save where the project lies, or ask where."""
        project = self.shell.project
        if project is None:
            return False
        return self._saved(project, project.session.save) if project.session.titled else self.save_as()

    def save_as(self) -> bool:
        """Ask for a place and save there; media stay where they are, and the window asks whether they shall."""
        return self._ask_elsewhere(self._offer_media)

    def save_as_whole(self) -> bool:
        """Ask for a place, save there, and copy all media into the project."""
        return self._ask_elsewhere(self.collect)

    def _offer_media(self) -> None:
        project = self.shell.project
        linked = collecting.linked_media(project.document) if project is not None else ()
        if project is None or not linked:
            return
        first = Path(linked[0].path).name
        which = f"{first} stays where it is" if len(linked) == 1 else f"{len(linked)} media stay where they are"
        size = collecting.linked_size(project.document, project.session.folder)
        self.shell.care.notices.ask(
            "collect",
            f"Saved. {which}, and the project remembers where.",
            (f"Copy into the project ({in_megabytes(size)})", self.collect),
            ("Leave there", lambda: None),
            level="note",
        )

    def collect(self) -> None:
        """Copy media that lie outside into the project, in the background; one entry of the history."""
        project = self.shell.project
        if project is None:
            return
        document, folder = project.document, project.session.folder
        if not collecting.linked_media(document):
            self.shell.tell_note("All media lie in the project already.")
            return
        job = project.call("Copying media", lambda tell: collecting.copied_media(document, folder, folder, tell))
        self.when_done(project, job, self._collected)

    def _collected(self, project: Project, copies: collecting.Copies) -> None:
        self._guard(lambda: project.session.apply(collecting.use_copies(project.document, copies)))
        if project.session.titled and self._saved(project, project.session.save):
            self.shell.tell_note("All media lie in the project now.")

    def _ask_elsewhere(self, then: Callable[[], object]) -> bool:
        project = self.shell.project
        path = files.ask_place(self.shell, project) if project is not None else None
        return project is not None and path is not None and self._save_elsewhere(project, path, then)

    def _save_elsewhere(self, project: Project, path: Path, then: Callable[[], object]) -> bool:
        """Save at another place, then go on; what is being written would be stopped by it, so that is asked first."""
        if project is not self.shell.project or self._still_written(project, path, then):
            return False
        if project.document.name == "Untitled":
            project.edit(scene.rename, path.name.removesuffix(SUFFIX))
        if not self._saved(project, lambda: self._save_at(project, path)):
            return False
        settings.remember_project(project.session.folder.path)
        self.shell.opened.keeper.keep_up()
        then()
        return True

    def _still_written(self, project: Project, path: Path, then: Callable[[], object]) -> bool:
        jobs = project.writing()
        if jobs:
            go_on = partial(self._save_elsewhere, project, path, then)
            more = f", and {len(jobs) - 1} more" if len(jobs) > 1 else ""
            self.shell.care.notices.ask(
                "writing",
                f"{jobs[0].label}{more} is still under way; saving at another place now would stop it.",
                ("Save when it is done", lambda: project.when_written(go_on)),
                ("Stop it and save now", lambda: project.stop_writing(go_on)),
                ("Do not save", lambda: None),
            )
        return bool(jobs)

    def _save_at(self, project: Project, path: Path) -> None:
        """Save at another place; many media are copied there first, with a bar."""
        session = project.session
        if size_of(session.folder.media) > LARGE:
            wait_for(self.shell, "Copying media", lambda tell: session.send_media(path, tell))
        session.save_as(path)

    def _saved(self, project: Project, save: Callable[[], object]) -> bool:
        """Save, show it, and keep a small picture for the welcome; where it fails, say why and offer another place."""
        notices = self.shell.care.notices
        try:
            save()
        except Cancelled:
            return False
        except (InputError, OSError) as error:
            self.shell.side.log.add(str(error), details(error))
            notices.ask(
                "save",
                f"The project was not saved. {error}",
                ("Save as…", self.save_as),
                ("Try again", self.save),
                ("Later", lambda: None),
                level="error",
            )
            return False
        for name in ("save", "autosave", "collect"):
            notices.drop(name)
        self.shell.care.keep_thumbnail()
        project.saved_changed.emit()
        return True

    def when_done(self, project: Project, job: Job, done: Callable[[Project, object], object]) -> None:
        """Call ``done`` in the window's thread when a job has ended well."""
        self._awaited[job] = done
        project.job_ended.connect(self._ended)
        if job.state != "running" and job not in project.progress:
            self._ended(job)

    def _ended(self, job: Job) -> None:
        done, project = self._awaited.pop(job, None), self.shell.project
        if done is not None and project is not None and job.state == "done":
            done(project, job.value)

    def autosave(self) -> None:
        """Write unsaved work beside the project."""
        self.shell.care.autosave()

    def may_leave(self) -> bool:
        """Whether the open project may be closed; asks where it has unsaved changes."""
        project = self.shell.project
        if project is None or not project.session.history.modified:
            return True
        answer = files.ask_unsaved(self.shell, project.document.name)
        if answer == "save":
            return self.save()
        return answer == "discard"

    # bringing in and out -----------------------------------------------------------------------------------------

    def add_clip(self, path: Path) -> None:
        """Take a video into the project; a large one is looked through in the background."""
        project = self.shell.project
        if project is None:
            return
        session, large = project.session, path.is_dir() or size_of(path) > LARGE
        if not large:
            self._guard(lambda: bringing.add_clip(session, path))
            return
        job = project.call(f"Reading {path.name}", lambda _: bringing.read_clip(session, path))
        take = bringing.take_clip
        self.when_done(project, job, lambda project, clip: self._guard(lambda: take(project.session, clip, path.stem)))

    def use_cameras(self, path: Path) -> None:
        """Take the cameras from another program's file."""
        project = self.shell.project
        if project is not None:
            self._guard(lambda: bringing.use_camera_file(project.session, path))

    def take_sequence(self, path: Path) -> None:
        """Take a captured sequence into the project and show it."""
        self.shell.show_workspace("performance")
        self.shell.performance.library.add(path)

    def add_sequence(self) -> None:
        """Show the Motion graph, which asks for a sequence."""
        self.shell.show_workspace("performance")
        self.shell.performance.library.show_add_menu()

    def add_character(self, path: Path) -> None:
        """Take a mesh into the project and show it."""
        project = self.shell.project
        if project is None:
            return
        added: list[str] = []
        self._guard(lambda: added.append(bringing.add_character(project.session, path)))
        if added:
            project.select_character(added[0])
            self.shell.show_workspace("character")

    def export(self) -> None:
        """Write the motion of the chosen character."""
        project = self.shell.project
        if project is None:
            return
        character = next((each for each in project.document.characters if each.id == project.character_id), None)
        if character is None:
            self.shell.tell("There is no character to export yet: add one and solve its motion.")
            return
        path = files.ask_export(self.shell, character.name)
        if path is None:
            return
        from app.actions.rendering import write_motion

        still = project.session.as_it_is()
        job = project.call(
            f"Exporting {path.name}", lambda progress: write_motion(still, character.id, path, None, progress)
        )
        self.when_done(project, job, lambda *_: self.shell.tell_note(f"{character.name} was written to {path.name}."))

    def _guard(self, call: Callable[[], object]) -> None:
        try:
            call()
        except (InputError, ValueError, OSError) as error:
            self.shell.tell(str(error), details(error))


def in_megabytes(size: int) -> str:
    """A size as people say it."""
    return f"{size / 1e9:.1f} GB" if size >= 1e9 else f"{max(size / 1e6, 0.1):.1f} MB"
