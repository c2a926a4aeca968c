"""Make the program known to the desktop."""

from __future__ import annotations

import click

from app.commands.console import Console


@click.command("install-desktop")
@click.option("--remove", is_flag=True, help="Take the menu entry, the icon and the file type away again.")
@click.pass_obj
def install_desktop(console: Console, remove: bool) -> None:
    """Put Motionwright into the desktop's menu, with its icon and the type of its project files (Linux)."""
    from app.actions import desktop

    paths = desktop.remove_desktop() if remove else desktop.install_desktop()
    if console.as_json:
        console.answer({"removed" if remove else "written": [str(path) for path in paths]})
    for path in paths:
        console.say(f"{'Removed' if remove else 'Wrote'} {path}")
    if not paths:
        console.say("There was nothing to remove.")
