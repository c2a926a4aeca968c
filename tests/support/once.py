"""What is costly to make and the same for many tests: made once in a run, whichever process needs it first."""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from pathlib import Path

import pytest

READY = "ready"
MOST = 600.0
"""Seconds that another process may take to make it."""


def built_once(factory: pytest.TempPathFactory, name: str, build: Callable[[Path], Path]) -> Path:
    """Give what ``build`` made in a folder of this name, shared by all processes of the run: copy it to change it.

    A fixture of the session is not enough: each process has its own, and so has each file that imports it.

    Parameters
    ----------
    build : takes the folder, gives what it made in there.
    """
    base = factory.getbasetemp()
    root = (base.parent if "PYTEST_XDIST_WORKER" in os.environ else base) / "once"
    root.mkdir(exist_ok=True)
    said, end = root / f"{name}.{READY}", time.monotonic() + MOST
    while not said.exists():
        try:
            (root / name).mkdir()
        except FileExistsError:
            assert time.monotonic() < end, f"another process did not make '{name}' in {MOST:.0f} s"
            time.sleep(0.05)
            continue
        try:
            made = build(root / name)
        except BaseException:
            (root / name).rename(root / f"{name} failed {os.getpid()} {time.monotonic_ns()}")
            raise
        beside = said.with_suffix(".part")
        beside.write_text(os.path.relpath(made, root), encoding="utf-8")
        beside.replace(said)
    return root / said.read_text(encoding="utf-8")
