"""The commands of the project menu: they ask, call the actions, and say what went wrong."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from app.actions import bringing
from app.actions.session import Session
from app.window import files, settings
from app.window.work import details
from imitation.errors import InputError

if TYPE_CHECKING:
    from app.window.shell import Shell


class FileCommands:
    """Belongs to one window."""

    def __init__(self, shell: Shell) -> None:
        self.shell = shell

    def command(self, name: str) -> bool:
        """Do a command; says whether it was one."""
        handlers: dict[str, Callable[[], object]] = {
            "new": self.new,
            "open": lambda: self._with(files.ask_project(self.shell), self.open),
            "sample": self.sample,
            "sample_performance": self.sample_performance,
            "save": self.save,
            "save_as": self.save_as,
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
        kind = files.kind_of(path)
        if kind == "project":
            self.open(path)
        elif kind == "mesh":
            self.add_character(path)
        elif kind == "clip":
            self.add_clip(path)
        else:
            self.shell.tell(f"{path.name} is neither a video nor a mesh nor a project.")

    # projects ----------------------------------------------------------------------------------------------------

    def new(self) -> None:
        """Begin an empty project."""
        if self.may_leave():
            self._guard(lambda: self.shell.open_session(Session.new()))

    def open(self, path: Path) -> None:
        """Open a project; unsaved work of a run that ended badly is taken along, as an entry that undo takes back."""
        if self.may_leave():
            self._guard(lambda: self._opened(Session.open(path, recover=True)))

    def _opened(self, session: Session) -> None:
        settings.remember_project(session.folder.path)
        self.shell.open_session(session)
        if session.history.undo_label is not None:
            self.shell.tell_note("Unsaved work of the last run was recovered. Undo goes back to the saved project.")

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
        return project.save() if project.session.titled else self.save_as()

    def save_as(self) -> bool:
        """Ask for a place and save there."""
        project = self.shell.project
        path = files.ask_place(self.shell, project) if project is not None else None
        if project is None or path is None or not project.save(path):
            return False
        settings.remember_project(project.session.folder.path)
        return True

    def autosave(self) -> None:
        """Write unsaved work beside the project."""
        project = self.shell.project
        if project is not None:
            self._guard(project.session.autosave)

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
        """Take a video into the project."""
        project = self.shell.project
        if project is not None:
            self._guard(lambda: bringing.add_clip(project.session, path))

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
        from app.actions.results import export_animation

        session = project.session
        self.shell.calls.run(
            lambda: export_animation(session, character.id, path),
            lambda _: self.shell.tell_note(f"{character.name} was written to {path.name}."),
            lambda error: self.shell.tell(str(error), details(error)),
        )

    def _guard(self, call: Callable[[], object]) -> None:
        try:
            call()
        except (InputError, ValueError, OSError) as error:
            self.shell.tell(str(error), details(error))
