"""``perform add --animation``: several animations of one GLB as sequences of a project."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from app.actions.performing_frames import sequence_footage
from app.actions.session import Session
from app.commands.main import BAD_INPUT
from tests.app.commands.test_perform import answer, refused
from tests.app.formats.test_posed_glb import Arm


def _two(tree: dict[str, Any]) -> None:
    """The same file with a second animation, that moves one joint alone."""
    wave = tree["animations"][0]
    tree["animations"].append({**wave, "name": "bend", "channels": wave["channels"][:1]})


def test_each_animation_is_a_sequence_of_its_own(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Added by name and by number, kept in the project, and read again from it as chosen."""
    path = Arm().write(tmp_path / "arm.glb", _two)
    added = answer(capsys, "add", tmp_path / "film", path, "--animation", "wave", "--animation", "2")["added"]
    assert [each["name"] for each in added] == ["arm wave", "arm 2"]
    session = Session.open(tmp_path / "film")
    try:
        first, second = (sequence_footage(session, each.id) for each in session.document.sequences)
        assert np.abs(first[4].vertices - second[4].vertices).max() > 0.05
    finally:
        session.close()


def test_an_animation_that_is_not_meant_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """One that is not there, and one of two files; without a choice the others are named."""
    path = Arm().write(tmp_path / "arm.glb", _two)
    assert "no animation run" in refused(capsys, BAD_INPUT, "add", tmp_path / "a", path, "--animation", "run")
    assert "which file" in refused(capsys, BAD_INPUT, "add", tmp_path / "b", path, path, "--animation", "wave")
    note = answer(capsys, "add", tmp_path / "c", path)["added"][0]["note"]
    assert "2 animations (wave, bend): wave is taken" in note
