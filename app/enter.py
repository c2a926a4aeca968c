"""How the program begins: Ctrl+C while it is still being loaded ends it as quietly as any later one."""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import NoReturn

STOPPED = 130


def main() -> NoReturn:
    """Enter from the command line."""
    _enter("main")


def gui_main() -> NoReturn:
    """Enter from a desktop, without a console."""
    _enter("gui_main")


def _enter(name: str) -> NoReturn:
    try:
        # Here, not at the top: loading takes a moment in which nobody else would take the interrupt.
        from app.commands import main as commands

        begin: Callable[[], None] = getattr(commands, name)
        begin()
    except KeyboardInterrupt:
        sys.stderr.write("\nStopped before anything was begun.\n")
        raise SystemExit(STOPPED) from None
    raise SystemExit(0)
