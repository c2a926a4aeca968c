"""Fixtures of program tests: a filmed project that is solved once, and the user's folders out of the way."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.commands.main import run
from tests.app.filmed import write_film
from tests.support.once import built_once


@pytest.fixture(scope="session")
def solved_project(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A project made and solved through the command line; not to be changed, copy it."""
    return built_once(tmp_path_factory, "film", _solve)


def _solve(folder: Path) -> Path:
    film, _, marks = write_film(folder)
    project = folder / "film.motionwright"
    assert run(["new", str(project), "--clip", str(film), "--marks", str(marks)]) == 0
    assert run(["--quiet", "animate", str(project)]) == 0
    return project


@pytest.fixture(autouse=True)
def private_folders(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Keep the user's own settings and unsaved projects out of the tests."""
    for variable in ("XDG_STATE_HOME", "XDG_CONFIG_HOME"):
        monkeypatch.setenv(variable, str(tmp_path / variable.lower()))
