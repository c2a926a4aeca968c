"""How the program begins: Ctrl+C while it is still being loaded ends it as quietly as any later one."""

from __future__ import annotations

import sys

STOPPED = 130


def main() -> None:
    """Enter from the command line."""
    _enter("main")


def gui_main() -> None:
    """Enter from a desktop, without a console."""
    _enter("gui_main")


def _enter(name: str) -> None:
    try:
        # Here, not at the top: loading takes a moment in which nobody else would take the interrupt.
        from app.commands import main as commands

        getattr(commands, name)()
    except KeyboardInterrupt:
        sys.stderr.write("\nStopped before anything was begun.\n")
        raise SystemExit(STOPPED) from None
