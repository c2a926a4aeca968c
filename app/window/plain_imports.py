"""Imports as Python makes them, in place of those that PySide puts there."""

from __future__ import annotations

import builtins


def use_plain_imports() -> None:
    """Take away what PySide does after every import: it reads the source of the module that was loaded.

    It looks for modules that want Qt's names in another form (``from __feature__ import snake_case``). None of ours
    does, and reading a thousand sources takes a fifth of the time until the first 3D picture.
    """
    builtins.__import__ = getattr(builtins, "__orig_import__", builtins.__import__)
