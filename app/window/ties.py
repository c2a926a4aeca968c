"""How the parts of a window hang together: a page that was just made, and timers that fire once."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QTimer

if TYPE_CHECKING:
    from app.window.shell import Shell
    from app.window.workspaces import Workspace


def once(parent: QObject, milliseconds: int, call: Callable[[], object]) -> QTimer:
    """A timer that calls once, so long after its last start."""
    timer = QTimer(parent)
    timer.setSingleShot(True)
    timer.setInterval(milliseconds)
    timer.timeout.connect(call)
    return timer


def tie(shell: Shell, page: Workspace) -> None:
    """Tie a workspace that was just made to its window and to what is open."""
    page.hint.connect(shell.show_hint)
    page.wanted.connect(shell.do)
    page.run_wanted.connect(lambda: shell.do("propagate"))
    page.lanes_changed.connect(shell.lanes_soon)
    page.fit(shell.width())
    page.asleep = not shell.seen
    if page is shell.pages.workspaces.get("character"):
        shell.character.inspector.go.connect(shell.navigator.go)
        shell.character.inspector.on_release.connect(shell.propagate_on_release)
    if shell.opened is not None:
        page.attach(shell.opened.project, shell.opened.loader)
        page.attach_clip(shell.opened.project, shell.opened.loader)
        if shell.shown is not None:
            page.show_picture(*shell.shown)
