"""Steps from older project files to the present form, one function a version."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

VERSION = 1
"""The version that this program writes."""

STEPS: dict[int, Callable[[dict[str, Any]], dict[str, Any]]] = {}
"""Version -> function that turns a file of it into one of the next version."""


def migrate(body: dict[str, Any]) -> dict[str, Any]:
    """Bring a project file up to the present version."""
    for version in range(body["version"], VERSION):
        body = {**STEPS[version](body), "version": version + 1}
    return body
