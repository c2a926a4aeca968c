"""The library of sequences: dropped, read in the background, corrected, renamed, removed; by mouse and keys."""

from __future__ import annotations

import math
import shutil
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QMimeData, QPoint, Qt, QUrl
from PySide6.QtGui import QDragEnterEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QComboBox

from app.formats.tvm import FrameMesh, open_mesh_frames, write_mesh_frames
from app.window.controls import NumberField
from app.window.performance.sequence_cards import LEFT as TEXT
from app.window.shell import Shell
from tests.window.conftest import at, drag, settle, wait_for
from tests.window.performance_parts import CONTROL, LEFT, PLAIN, drop, label_of, pick, quiet
from tests.window.performance_parts import composed as composed
from tests.window.performance_parts import composed_project as composed_project
from tests.window.small_performance import write_take

pytestmark = [pytest.mark.window, pytest.mark.xdist_group("window")]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A dozen PLY files of a walk, which say neither rate nor axes nor unit."""
    place = tmp_path_factory.mktemp("files")
    source = open_mesh_frames(write_take(place, "Walk"))
    frames = [source[frame] for frame in range(12)]
    source.close()
    bare = (FrameMesh(each.vertices, each.faces, each.colours) for each in frames)
    write_mesh_frames(place / "steps", bare, form="ply", fps=15, count=12, name="steps")
    return place / "steps"


def library(shell: Shell) -> object:
    """The library in sight."""
    return shell.pages.in_sight.library


def add(shell: Shell, path: Path) -> object:
    """Drop a sequence; gives it once it is there."""
    count = len(shell.project.document.sequences)
    drop(library(shell), path)
    assert "reading" in library(shell).header.caption.text()
    wait_for(lambda: len(shell.project.document.sequences) == count + 1)
    return shell.project.document.sequences[-1]


def type_number(field: NumberField, text: str) -> None:
    """Click a number and type another."""
    QTest.mouseClick(field, LEFT, PLAIN, field.rect().center())
    QTest.keyClicks(field, text)
    QTest.keyClick(field, Qt.Key.Key_Return)


def choose(box: QComboBox, text: str) -> None:
    """Choose an entry of a box by its keys."""
    box.setFocus()
    for _ in range(box.count()):
        QTest.keyClick(box, Qt.Key.Key_Up)
    for _ in range(box.findText(text)):
        QTest.keyClick(box, Qt.Key.Key_Down)
    assert box.currentText() == text


def unfold(shell: Shell, number: int) -> None:
    """Open a section below the cards."""
    section = library(shell).sections[number]
    if not section.opened:
        QTest.mouseClick(section.head, LEFT)
    settle(20)


def test_a_dropped_folder_is_read_and_its_guesses_are_confirmed(composed: Shell, folder: Path) -> None:
    """It is analysed without being asked for; what was guessed is said until somebody says it is right."""
    made = add(composed, folder)
    assert label_of(composed) == "Add steps"
    assert made.guessed == ("fps", "up", "unit")
    assert made.fps == 15.0, "played at the rate of the first sequence"
    shown = library(composed)
    card = shown.cards.cards[-1]
    assert card.warnings == ("guessed: 25 fps, Z up, metres", "filmed at 25 fps, played at 15")
    assert composed.pages.in_sight.state.sequence_id == made.id
    quiet(composed)
    assert shown.cards.cards[-1].strip, "the motions were found"
    unfold(composed, 0)
    facts = shown.facts
    assert "vertices" in facts.statistics.text()
    QTest.mouseClick(facts.ticks["up"], LEFT)
    assert composed.project.document.sequences[-1].guessed == ("fps", "unit")
    type_number(facts.rate, "15")
    assert composed.project.document.sequences[-1].source_fps == 15.0
    QTest.mouseClick(facts.ticks["unit"], LEFT)
    assert composed.project.document.sequences[-1].guessed == ()
    assert shown.cards.cards[-1].warnings == ()
    for _ in range(4):
        QTest.keyClick(composed, Qt.Key.Key_Z, CONTROL)
    assert [each.name for each in composed.project.document.sequences] == ["Walk", "Gym"]
    quiet(composed)


def test_front_by_a_click_and_by_a_number(composed: Shell) -> None:
    """The performer of the first frame faces whoever looks at it; the number can be typed, and forgotten."""
    page = composed.pages.in_sight
    page.state.select_sequence(composed.project.document.sequences[0].id)
    unfold(composed, 0)
    facts = page.library.facts
    QTest.mouseClick(facts.here, LEFT)
    assert page.state.shows == "source"
    assert composed.project.document.sequences[0].front is None
    wait_for(lambda: page.preview.shown == 0 and page.preview.frame is not None)
    viewport = page.preview.view.viewport
    before = viewport.orbit.azimuth
    drag(viewport, (200, 150), (140, 150))
    assert viewport.orbit.azimuth != before
    QTest.mouseClick(facts.here, LEFT)
    wanted = (math.degrees(viewport.orbit.azimuth) + 180) % 360 - 180
    assert composed.project.document.sequences[0].front == pytest.approx(wanted)
    assert label_of(composed) == "Turn the front of Walk"
    type_number(facts.front, "-30")
    assert composed.project.document.sequences[0].front == -30.0
    QTest.mouseClick(facts.found, LEFT)
    assert composed.project.document.sequences[0].front is None
    QTest.mouseClick(facts.level, LEFT, PLAIN, QPoint(8, facts.level.height() // 2))
    assert composed.project.document.sequences[0].level
    assert label_of(composed) == "Level the ground of Walk"
    quiet(composed)


def test_cards_are_chosen_renamed_and_removed(composed: Shell) -> None:
    """By mouse and keys; removing takes the key motions along, and undo brings all back."""
    page = composed.pages.in_sight
    cards, state = page.library.cards, page.state
    first, second = composed.project.document.sequences
    QTest.mouseClick(cards, LEFT, PLAIN, cards.box(second.id).center().toPoint())
    assert state.sequence_id == second.id
    cards.setFocus()
    QTest.keyClick(cards, Qt.Key.Key_Up)
    assert state.sequence_id == first.id
    top = cards.box(first.id).top()
    QTest.mouseDClick(cards, LEFT, PLAIN, at(TEXT + 20, top + 14))
    assert cards.field is not None
    QTest.keyClicks(cards.field, "Stroll")
    QTest.keyClick(cards.field, Qt.Key.Key_Return)
    assert label_of(composed) == "Rename Walk to Stroll"
    assert cards.field is None
    QTest.keyClick(cards, Qt.Key.Key_F4)
    QTest.keyClicks(cards.field, "Something else")
    QTest.keyClick(cards.field, Qt.Key.Key_Escape)
    settle(20)
    assert composed.project.document.sequences[0].name == "Stroll"
    keys = composed.project.document.performance.keys
    cards.setFocus()
    QTest.keyClick(cards, Qt.Key.Key_Delete)
    assert label_of(composed) == "Delete Stroll"
    assert len(composed.project.document.performance.keys) < len(keys)
    assert [each.id for each in cards.cards] == [second.id]
    QTest.keyClick(composed, Qt.Key.Key_Z, CONTROL)
    assert composed.project.document.performance.keys == keys
    assert [each.id for each in cards.cards] == [first.id, second.id]
    quiet(composed)


def test_a_sequence_chosen_elsewhere_is_seen_among_the_cards(composed: Shell) -> None:
    """Choosing a motion of a sequence whose card lies below scrolls to it."""
    cards = library(composed).cards
    for each in composed.project.document.sequences:
        library(composed).state.select_sequence(each.id)
        settle()
        box = cards.box(each.id).toRect()
        assert cards.visibleRegion().boundingRect().contains(box.center()), each.name


def test_structure_is_chosen(composed: Shell) -> None:
    """Method, sensitivity, longest repeat and beta are edits; what hangs on them is found anew."""
    page = composed.pages.in_sight
    page.state.select_sequence(composed.project.document.sequences[1].id)
    unfold(composed, 1)
    form = page.library.structure
    assert form.reason.text()
    type_number(form.period, "2")
    assert composed.project.document.sequences[1].structure.longest_period == 2.0
    type_number(form.sensitivity, "0.4")
    assert label_of(composed) == "Find motions of Gym by sensitivity 0.4"
    quiet(composed)
    choose(form.method, "As printed")
    assert composed.project.document.sequences[1].structure.method == "paper"
    assert form.beta_row.isVisible()
    quiet(composed)
    assert form.beta.value > 0
    type_number(form.beta, "0.2")
    assert composed.project.document.sequences[1].structure.beta == 0.2
    QTest.mouseClick(form.derive, LEFT)
    assert composed.project.document.sequences[1].structure.beta is None
    QTest.mouseClick(form.cyclic, LEFT, PLAIN, QPoint(8, form.cyclic.height() // 2))
    assert composed.project.document.sequences[1].structure.force_cyclic
    quiet(composed)


def test_what_cannot_be_read_is_told(composed: Shell, tmp_path: Path, folder: Path) -> None:
    """A sentence, nothing is added; another sequence's files are refused where one is found again."""
    project = composed.project.session.folder.path
    data = QMimeData()
    data.setUrls([QUrl.fromLocalFile(str(project))])
    enter = QDragEnterEvent(QPoint(40, 60), Qt.DropAction.CopyAction, data, LEFT, PLAIN)
    enter.setAccepted(False)
    library(composed).dragEnterEvent(enter)
    assert not enter.isAccepted(), "a project is opened by the window"
    empty = tmp_path / "nothing here"
    empty.mkdir()
    drop(library(composed), empty)
    bar = composed.pages.errors
    wait_for(lambda: bar.isVisible())
    assert "holds no PLY" in bar.sentence.text()
    assert len(composed.project.document.sequences) == 2
    walk = composed.project.document.sequences[0]
    library(composed).find_again(walk.id, folder)
    wait_for(lambda: "12 frames" in bar.sentence.text())
    assert composed.project.document.sequences[0].media == walk.media
    moved = tmp_path / "Walk moved.npz"
    shutil.copy(composed.project.session.folder.locate(walk.media), moved)
    library(composed).find_again(walk.id, moved)
    wait_for(lambda: label_of(composed) == "Find Walk again")
    assert composed.project.document.sequences[0].media.path == str(moved)
    quiet(composed)


def test_the_menus_offer_what_there_is(composed: Shell) -> None:
    """Motions are hidden and shown; the add menu names folders and files."""
    shown = library(composed)
    walk = composed.project.document.sequences[0]
    pick(shown.menu_for(walk.id), "Hide its motions")
    assert label_of(composed) == "Hide Walk"
    assert shown.cards.cards[0].hidden
    pick(shown.menu_for(walk.id), "Show its motions")
    assert not shown.cards.cards[0].hidden
    QTest.mouseClick(shown.add_button, LEFT)
    settle(20)
    menu = QApplication.activePopupWidget()
    assert [each.text() for each in menu.actions()][:2] == [
        "Folder of meshes, one a frame…",
        "File: npz, animated GLB or USD…",
    ]
    menu.close()
    pick(shown.menu_for(walk.id), "Play as captured")
    assert composed.pages.in_sight.state.playback.playing
    composed.pages.in_sight.state.playback.stop()


def test_a_characters_motion_joins(shell: Shell) -> None:
    """What was imitated from a film is a sequence like any other: added by the menu, analysed, looked at in 3D."""
    QTest.keyClick(shell, Qt.Key.Key_F3)
    page = shell.pages.in_sight
    hound = shell.project.document.characters[0]
    pick(page.library.add_menu(), f"Motion of {hound.name}")
    made = shell.project.document.sequences[0]
    assert made.character == hound.id
    assert label_of(shell) == f"Add {made.name}"
    quiet(shell, 120)
    assert page.library.cards.cards[0].strip
    assert not page.library.facts.rate.isEnabled(), "the film has the rate"
    page.state.show_source(made.id, 5)
    wait_for(lambda: page.preview.shown == 5)
    animated = shell.project.result(shell.project.session.stages.animation(hound.id))
    np.testing.assert_allclose(page.preview.frame.vertices, animated.vertices[5], atol=1e-5)
    assert "the same faces in every frame" in page.library.facts.statistics.text()
