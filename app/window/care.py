"""What is done for the open document without being asked: its title, autosaves, unsaved work, media that moved."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QSize, Qt, QTimer

from app.actions import lost_media, recovery
from app.actions.lost_media import LostMedium
from app.actions.recovery import UnsavedWork
from app.model.edits import scene
from app.window import files, settings
from app.window.notices import Notices
from app.window.project import Project
from app.window.work import details
from imitation.errors import InputError

if TYPE_CHECKING:
    from app.window.shell import Shell

THUMBNAIL = QSize(352, 198)
"""Pixels of the pictures of projects: twice the size they are shown in, for fine screens."""
LOST = "lost "
"""Begins the names of questions about media."""


class Care(QObject):
    """Belongs to one window; ``notices`` is where it asks."""

    def __init__(self, shell: Shell) -> None:
        super().__init__(shell)
        self.shell = shell
        self.notices = Notices()
        self.autosaver = QTimer(self)
        self.autosaver.timeout.connect(self.autosave)
        self._told = ""
        for place in (shell.bar, shell.welcome):
            place.project_wanted.connect(shell.files.open)
        shell.bar.name.renamed.connect(self._rename)

    def attach(self, project: Project) -> None:
        """Look after another project."""
        self.notices.drop_all()
        self._told = ""
        project.saved_changed.connect(self.show_title)
        self.show_title()
        self.set_pace()
        self.set_memory()
        session = project.session
        if session.titled:
            settings.remember_project(session.folder.path)
        if not session.look_again():
            self.notices.ask(
                "alone",
                f"{session.folder.path.name} is open in another window too: what is saved last is what stays.",
                ("Save as…", self.shell.files.save_as),
                ("Go on", lambda: None),
            )
        if not session.history.modified:  # else it was recovered a moment ago
            self._offer(recovery.pending(session))
        self.look_for_media()

    def detach(self) -> None:
        """The project is closed."""
        self.autosaver.stop()
        self.notices.drop_all()

    def show_title(self) -> None:
        """Name the project in the window's title, with the mark of unsaved changes."""
        project = self.shell.project
        if project is not None:
            self.shell.setWindowTitle(f"{project.document.name}[*] – Motionwright")
            self.shell.setWindowModified(project.session.history.modified)

    def keep_thumbnail(self) -> None:
        """Keep a small picture of what is seen, for the projects opened lately."""
        project, picture = self.shell.project, self.shell.picture
        if project is None or project.document.clip is None or picture is None or picture.isNull():
            return
        target = settings.thumbnail_of(project.session.folder.path)
        with contextlib.suppress(OSError):
            target.parent.mkdir(parents=True, exist_ok=True)
            smooth = Qt.TransformationMode.SmoothTransformation
            picture.scaled(THUMBNAIL, Qt.AspectRatioMode.KeepAspectRatio, smooth).save(str(target))

    def _rename(self, name: str) -> None:
        project = self.shell.project
        if project is not None:
            project.edit(scene.rename, name)
            self.shell.bar.show_document(project)

    def set_memory(self) -> None:
        """Let results take as much memory as the settings say."""
        project = self.shell.project
        if project is not None:
            project.session.cache.budget = settings.memory_megabytes() << 20

    # autosaves ---------------------------------------------------------------------------------------------------

    def set_pace(self) -> None:
        """Autosave as often as the settings say."""
        self.autosaver.start(1000 * settings.autosave_seconds())

    def autosave(self) -> None:
        """Write unsaved work beside the project; where that is not possible, say so once."""
        project = self.shell.project
        if project is None:
            return
        try:
            project.session.autosave()
        except (InputError, OSError) as error:
            if str(error) != self._told:
                self._told = str(error)
                self.notices.ask(
                    "autosave",
                    f"Unsaved work cannot be kept beside the project. {error}",
                    ("Save as…", self.shell.files.save_as),
                    ("Later", lambda: None),
                )

    # unsaved work ------------------------------------------------------------------------------------------------

    def offer_never_saved(self) -> None:
        """Ask about projects that were never saved and whose window did not end well."""
        self._offer(recovery.never_saved())

    def _offer(self, works: tuple[UnsavedWork, ...]) -> None:
        for work in works:
            self._ask_about(work)

    def _ask_about(self, work: UnsavedWork) -> None:
        titled = self.shell.project is not None and work.file.parent == self.shell.project.session.folder.path
        what = "This project has work that" if titled else "A project that has no place yet"
        held = recovery.what_it_holds(work.document)
        self.notices.ask(
            str(work.file),
            f"{what} was not saved when the program ended, {when_it_was(work)}: {held}.",
            ("Recover", lambda: self._recover(work, titled)),
            ("Throw away", lambda: self._throw_away(work)),
            ("Later", lambda: None),
        )

    def _recover(self, work: UnsavedWork, titled: bool) -> None:
        project = self.shell.project
        if titled and project is not None:
            self._guard(lambda: recovery.recover(project.session, work))
        elif self.shell.files.may_leave():
            self._guard(lambda: self.shell.open_session(recovery.take_up(work)))
        else:
            self._ask_about(work)

    def _throw_away(self, work: UnsavedWork) -> None:
        self.notices.ask(
            str(work.file),
            f"{recovery.what_it_holds(work.document)}: shall this unsaved work be gone for good?",
            ("Keep it", lambda: self._ask_about(work)),
            ("Throw away for good", lambda: self._guard(lambda: recovery.throw_away(work))),
        )

    def refuse(self, path: Path, error: Exception) -> None:
        """Say why a project cannot be opened; where an autosave lies beside what is damaged, offer that."""
        work = recovery.beside_damaged(path)
        if work is None:
            self.shell.tell(str(error), details(error))
            return
        self.shell.side.log.add(str(error), details(error))
        held = recovery.what_it_holds(work.document)
        self.notices.ask(
            "damaged",
            f"{work.file.parent.stem} cannot be opened; why stands among the messages. "
            f"An autosave of {when_it_was(work)} lies beside it: {held}.",
            ("Open the autosave as a copy", lambda: self._open_copy(work)),
            ("Later", lambda: None),
            level="error",
        )

    def _open_copy(self, work: UnsavedWork) -> None:
        if self.shell.files.may_leave():
            self._guard(lambda: self.shell.open_session(recovery.open_copy(work)))

    # media -------------------------------------------------------------------------------------------------------

    def look_for_media(self) -> None:
        """Look in the background whether all media are where they were."""
        project = self.shell.project
        if project is not None:
            document, folder = project.document, project.session.folder
            self.shell.calls.run(
                lambda: lost_media.lost_media(document, folder), lambda lost: self._ask_for_media(project, lost)
            )

    def _ask_for_media(self, project: Project, lost: tuple[LostMedium, ...]) -> None:
        if project is not self.shell.project:
            return
        for name in [name for name in self.notices.open if name.startswith(LOST)]:
            self.notices.drop(name)
        for each in lost:
            find = ("Find it…", lambda each=each: self._find(each))
            sentence, answers = f"{each.name} ({each.owner}) is not where it was.", [find, ("Later", lambda: None)]
            if each.found is not None:
                sentence += f" The same lies in {each.found.parent}."
                answers.insert(0, ("Use it", lambda each=each: self._relink(each, each.found)))
            self.notices.ask(LOST + each.media.path, sentence, *answers)

    def _find(self, lost: LostMedium) -> None:
        path = files.ask_medium(self.shell, lost)
        if path is None:
            self.look_for_media()
        else:
            self._relink(lost, path)

    def _relink(self, lost: LostMedium, path: Path | None) -> None:
        project = self.shell.project
        if project is None or path is None:
            return
        if self._guard(lambda: lost_media.relink(project.session, lost, path)):
            self.shell.pages.errors.hide()
            document, folder = project.document, project.session.folder
            self.shell.calls.run(
                lambda: lost_media.lost_media(document, folder, path.parent),
                lambda others: self._take_neighbours(project, others),
            )
        else:
            self.look_for_media()

    def _take_neighbours(self, project: Project, others: tuple[LostMedium, ...]) -> None:
        """What lies beside a medium that was found is taken without asking again."""
        if project is self.shell.project:
            for each in others:
                if each.found is not None:
                    self._guard(lambda each=each: lost_media.relink(project.session, each, each.found))
            self.look_for_media()
            self.shell.opened.keeper.keep_up()
            self.shell.refresh_soon()

    def _guard(self, call: Callable[[], object]) -> bool:
        try:
            call()
        except (InputError, ValueError, OSError) as error:
            self.shell.tell(str(error))
            return False
        return True


def when_it_was(work: UnsavedWork) -> str:
    """Day and time of an autosave as people say it."""
    return f"{work.when.day} {work.when:%B, %H:%M}"
