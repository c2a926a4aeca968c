"""Another project dropped on the library of the Motion graph: its finished motion is a sequence; refusals are told."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from app.actions.session import Session
from app.window.shell import Shell
from tests.window.conftest import wait_for
from tests.window.performance_parts import composed as composed
from tests.window.performance_parts import composed_project as composed_project
from tests.window.performance_parts import drop, label_of, quiet

pytestmark = [pytest.mark.window, pytest.mark.xdist_group("window")]


def test_a_dropped_project_gives_its_motion(composed: Shell, small_project: Path) -> None:
    """Dropped on the library it is added, undone and done again in one step, and the open project stays open."""
    library, place = composed.pages.in_sight.library, composed.project.session.folder.path
    names = [each.name for each in composed.project.document.sequences]
    drop(library, small_project)
    assert small_project.name in library.header.caption.text()
    wait_for(lambda: len(composed.project.document.sequences) == len(names) + 1)
    made = composed.project.document.sequences[-1]
    other = Session.open(small_project)
    character = other.document.characters[0]
    other.close()
    assert made.name == character.name
    assert made.media is not None
    assert made.media.path == str(small_project)
    assert composed.project.session.folder.path == place
    assert label_of(composed) == f"Add {made.name}"
    quiet(composed)
    QTest.keyClick(composed, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    assert [each.name for each in composed.project.document.sequences] == names
    quiet(composed)


def test_a_project_without_a_motion_says_what_to_do(composed: Shell, small_project: Path, tmp_path: Path) -> None:
    """One sentence, and nothing is added."""
    bare = tmp_path / "bare.motionwright"
    shutil.copytree(small_project, bare)
    shutil.rmtree(bare / "results")
    before = composed.project.document
    drop(composed.pages.in_sight.library, bare)
    bar = composed.pages.errors
    wait_for(lambda: bar.isVisible())
    assert "was never animated: open it and run animate" in bar.sentence.text()
    assert composed.project.document is before
    quiet(composed)
