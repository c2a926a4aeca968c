"""Commands of the window itself, and where every other command goes."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject
from PySide6.QtGui import QAction, QKeySequence
from PySide6.QtWidgets import QApplication

from app.model.edits import scene
from app.window import settings, theme
from app.window.background_state import measure
from app.window.controls import renew_tooltips
from app.window.key_map import key_map
from app.window.keys import COMMANDS, keys_of

if TYPE_CHECKING:
    from app.window.key_sheet import KeySheet
    from app.window.settings_dialog import SettingsDialog
    from app.window.shell import Shell


class Dispatch(QObject):
    """Asks the workspace in sight first, then time, files, and the window; belongs to one window."""

    def __init__(self, shell: Shell) -> None:
        super().__init__(shell)
        self.shell = shell
        self._actions = {command.id: QAction(command.text, shell) for command in COMMANDS}
        for name, action in self._actions.items():
            action.triggered.connect(lambda _=False, name=name: self.do(name))
            shell.addAction(action)
        self._bind()
        key_map().changed.connect(self._bind_again)

    def _bind(self) -> None:
        for name, action in self._actions.items():
            action.setShortcuts([QKeySequence(key) for key in keys_of(name)])

    def _bind_again(self) -> None:
        self._bind()
        renew_tooltips(self.shell)
        if self.shell.project is not None:
            self.shell.bar.show_document(self.shell.project)

    def do(self, name: str) -> None:
        """Do a command."""
        shell = self.shell
        if name == "cancel" and shell.timeline.lanes.cancel():
            return
        if not shell.pages.welcoming and shell.pages.in_sight.command(name):
            return
        if shell.navigator.command(name) or shell.timeline.command(name) or shell.files.command(name):
            return
        handler = self._handlers().get(name)
        if handler is not None:
            handler()

    def _handlers(self) -> dict[str, Callable[[], object]]:
        shell = self.shell
        if shell.opened is None:
            return {}
        project, keeper = shell.opened.project, shell.opened.keeper
        return {
            "undo": project.undo,
            "redo": project.redo,
            "cancel": project.cancel_work,
            "cancel_work": project.cancel_work,
            "propagate": keeper.run_missing,
            "clear_masks": lambda: project.edit(scene.clear_masks),
            "measure_background": partial(measure, project),
            "render": self._render,
            **{page: partial(shell.show_workspace, page) for page in shell.pages.names},
            "inspector": self._fold,
            "history": lambda: shell.side.ask_for("history"),
            "log": lambda: shell.side.ask_for("log"),
            "light": self.switch_look,
            "keys": self._keys,
            "settings": self._settings,
        }

    def _fold(self) -> None:
        aside = self.shell.in_sight().aside
        if aside is not None and not self.shell.pages.welcoming:
            aside.toggle()

    def _render(self) -> None:
        from app.window.render import open_render

        open_render(self.shell)

    def _keys(self) -> None:
        from app.window.key_sheet import KeySheet

        self._show(KeySheet)

    def _settings(self) -> None:
        from app.window.settings_dialog import SettingsDialog

        self._show(SettingsDialog)

    def _show(self, kind: type[KeySheet | SettingsDialog]) -> None:
        """Show a sheet; the one that is open already comes to the front."""
        sheet = self.shell.findChild(kind) or kind(self.shell)
        sheet.show()
        sheet.raise_()
        sheet.activateWindow()

    def switch_look(self) -> None:
        """Change between dark and light, now and at the next start."""
        application = QApplication.instance()
        look = theme.LIGHT if theme.active().name == "dark" else theme.DARK
        theme.apply(application, look)  # type: ignore[arg-type]
        settings.settings().setValue("look", look.name)
        self.shell.timeline.lanes.refresh()
        self.shell.refresh_soon()
