"""Open the window."""

from __future__ import annotations

from pathlib import Path

import click

from app.commands.project import PATH


@click.command()
@click.argument("project", type=PATH, required=False)
@click.option("--empty", is_flag=True, help="Begin with an empty project instead of the sample.")
@click.option(
    "--viewport", type=click.Choice(["auto", "gl", "raster"]), help="What draws in 3D.  [default: as in the settings]"
)
@click.pass_context
def gui(context: click.Context, project: Path | None, empty: bool, viewport: str | None) -> None:
    """Open the window on a project, on a video or mesh for a new one, or on the sample."""
    from app.window.application import open_window

    context.exit(open_window(project, sample=project is None and not empty, viewport=viewport))  # type: ignore[arg-type]
