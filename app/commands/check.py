"""Say whether a file can be used, and what is in it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from app.actions.inspect import inspect
from app.commands.console import Console
from app.commands.project import PATH


@click.command()
@click.argument("files", type=PATH, nargs=-1, required=True)
@click.pass_obj
def check(console: Console, files: tuple[Path, ...]) -> None:
    """Say whether files can be used: videos, folders of pictures, meshes, sequences, camera models, projects."""
    values: dict[str, Any] = {}
    for file in files:
        found = inspect(file)
        values[str(file)] = found
        described = ", ".join(f"{key} {value}" for key, value in found.items() if key != "kind")
        console.say(f"{file}: {found['kind']}, {described}")
    if console.as_json:
        console.answer(values)
