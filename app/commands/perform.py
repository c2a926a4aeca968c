"""Verbs on performances: add, analyse, compose, evaluate, export, info."""

from __future__ import annotations

import importlib

import click

VERBS = {
    "add": "app.commands.perform_sequences:add",
    "analyse": "app.commands.perform_sequences:analyse",
    "evaluate": "app.commands.perform_sequences:evaluate",
    "compose": "app.commands.perform_compose:compose",
    "export": "app.commands.perform_compose:export",
    "info": "app.commands.perform_compose:info",
}


class PerformVerbs(click.Group):
    """Loads a verb's module when the verb is used."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Give the verbs in the order of work."""
        return list(VERBS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Load one verb."""
        if cmd_name not in VERBS:
            return None
        module, _, name = VERBS[cmd_name].partition(":")
        command: click.Command = getattr(importlib.import_module(module), name)
        return command


@click.group(cls=PerformVerbs)
def perform() -> None:
    """Compose performances of captured sequences (meshes whose every frame has faces of its own)."""
