"""Steps from older project files to the present form, one function a version."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

VERSION = 2
"""The version that this program writes."""


def _several_depth_tracks(body: dict[str, Any]) -> dict[str, Any]:
    """Version 1 kept one track at a constant depth, version 2 several."""
    document = body.get("document")
    if not isinstance(document, dict):
        return body
    world = document.get("world")
    if not isinstance(world, dict) or "depth_track" not in world:
        return body
    one = world["depth_track"]
    kept = {key: value for key, value in world.items() if key != "depth_track"}
    kept["depth_tracks"] = [] if one is None else [one]
    return {**body, "document": {**document, "world": kept}}


STEPS: dict[int, Callable[[dict[str, Any]], dict[str, Any]]] = {1: _several_depth_tracks}
"""Version -> function that turns a file of it into one of the next version."""


def migrate(body: dict[str, Any]) -> dict[str, Any]:
    """Bring a project file up to the present version."""
    for version in range(body["version"], VERSION):
        body = {**STEPS[version](body), "version": version + 1}
    return body
