"""Verbs on performances: add, analyse, compose, evaluate, export, info."""

from __future__ import annotations

import click

from app.commands.lazy import LazyGroup

VERBS = {
    "add": "app.commands.perform_sequences:add",
    "analyse": "app.commands.perform_sequences:analyse",
    "evaluate": "app.commands.perform_sequences:evaluate",
    "compose": "app.commands.perform_compose:compose",
    "export": "app.commands.perform_compose:export",
    "info": "app.commands.perform_compose:info",
}


@click.group(cls=LazyGroup, verbs=VERBS)
def perform() -> None:
    """Compose performances of captured sequences (meshes whose every frame has faces of its own)."""
