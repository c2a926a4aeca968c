"""A whole session on the sample's clip and mesh, from an empty window to files that were read back."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from app.actions.sample import sample_folder
from app.actions.session import Session
from app.window.shell import Shell
from tests.window.conftest import settle, wait_for
from tests.window.session_hands import CONTROL, LEFT, Hands, begin_of

pytestmark = [pytest.mark.window, pytest.mark.slow, pytest.mark.xdist_group("window")]
FRAMES, SHRINK = 24, 2
SKIPPED = ("right front hip", "right hind hip", "right flank")


def made() -> dict[str, object]:
    """What the sample's maker knows, for the smaller clip: clicks, lassos, contacts, pairs."""
    values = json.loads((sample_folder() / "sample.json").read_text())

    def small(place: list[float]) -> tuple[float, float]:
        return (place[0] + 0.5) / SHRINK - 0.5, (place[1] + 0.5) / SHRINK - 0.5

    return {
        "clicks": {
            name: {int(frame): small(place) for frame, place in clicks.items() if int(frame) < FRAMES}
            for name, clicks in values["clicks"].items()
            if name not in SKIPPED
        },
        "lasso": [small(place) for place in values["lassos"]["0"]],
        "contacts": {
            name: [(first, min(last, FRAMES - 1)) for first, last in spans if first < FRAMES - 2]
            for name, spans in values["contacts"].items()
        },
        "pairs": {name: at for name, at in values["characters"]["hound"]["pairs"].items() if name not in SKIPPED},
    }


def test_from_an_empty_window_to_an_exported_motion(
    open_shell: Callable[[Session], Shell], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Drop, lasso, click, correct, end, contacts, run, mesh, pairs, solve, pose, undo on the way, save, export."""
    monkeypatch.setenv("HOME", str(tmp_path))
    known = made()
    begin_of(sample_folder() / "clip.mp4", tmp_path / "walk.mp4", FRAMES, SHRINK)
    shell = open_shell(Session.new())
    assert shell.pages.currentWidget() is shell.welcome
    hands = Hands(shell)

    hands.drop(tmp_path / "walk.mp4")
    wait_for(lambda: not shell.video.canvas.picture.isNull())
    assert shell.project.frame_count == FRAMES
    settle()

    hands.lasso(known["lasso"])
    assert len(shell.project.document.masks[0].lassos) == 1
    for name, clicks in known["clicks"].items():
        if hands.click_point(name, clicks[0]):
            hands.rename(name)
    assert len(hands.tracks) >= 10
    hands.quiet()
    states = [shell.project.state(shell.project.session.stages.track(each)) for each in hands.tracks.values()]
    assert set(states) == {"fresh"}

    hands.go(20)
    corrected = [name for name in hands.tracks if hands.correct(name, known["clicks"][name][20])]
    hands.quiet()
    for name in corrected:
        clicked = shell.project.document.track(hands.tracks[name]).clicks[20]
        assert np.hypot(*np.subtract(clicked, known["clicks"][name][20])) < 1.0, name
    hands.go(21)
    hands.key(Qt.Key.Key_V)
    hands.choose("tail tip")
    hands.key(Qt.Key.Key_E)
    assert [(gap.first, gap.last) for gap in shell.project.document.track(hands.tracks["tail tip"]).absent] == [
        (21, FRAMES - 1)
    ]

    for name, spans in known["contacts"].items():
        for first, last in spans if name in hands.tracks else ():
            hands.contact(name, first, last)
    found = {name: shell.project.document.track(track).contacts for name, track in hands.tracks.items()}
    marked = {name: [(c.span.first, c.span.last) for c in contacts] for name, contacts in found.items() if contacts}
    assert marked == {name: spans for name, spans in known["contacts"].items() if name in hands.tracks}

    hands.key(Qt.Key.Key_Return, CONTROL)
    hands.quiet()
    world = shell.project.result(shell.project.session.stages.world)
    assert world is not None, shell.video.errors.sentence.text()
    assert shell.project.state(shell.project.session.stages.masks) == "fresh"

    hands.key(Qt.Key.Key_Home)
    hands.drop(sample_folder() / "hound.ply")
    wait_for(lambda: shell.character.isVisible() and shell.character.mesh.viewport is not None)
    wait_for(lambda: len(shell.character.mesh.viewport.vertices))
    settle()
    hands.pick(shell.character.inspector.up, "Z up")
    assert shell.project.document.characters[0].alignment.up == "z"
    settle()
    todo = {name: vertex for name, vertex in known["pairs"].items() if name in hands.tracks}
    paired = hands.pair_all(todo)
    assert len(paired) >= 8, paired
    hands.key(Qt.Key.Key_Escape)
    assert not shell.character.tracks.pair_button.isChecked()

    QTest.mouseClick(shell.character.inspector.run, LEFT)
    wait_for(hands.solved, 120)
    settle()
    before, pairs = hands.motion(), shell.project.document.characters[0].pairs
    camera = world.cameras[10]
    wrong = []
    for name in paired:
        positions = shell.video.reading.track(shell.project.document.track(hands.tracks[name])).positions
        wrong.append(np.hypot(*(camera.project(before[10, pairs[hands.tracks[name]]]) - positions[10])))
    assert np.median(wrong) < 6.0, f"the character is not on the points: {np.round(wrong, 1)}"

    hands.go(10)
    hands.key(Qt.Key.Key_1)
    settle()
    nose = pairs[hands.tracks["nose"]]
    hands.pull(nose, 12, -24)
    wait_for(lambda: 10 in shell.project.document.characters[0].edits)
    hands.key(Qt.Key.Key_Z, CONTROL)
    assert not shell.project.document.characters[0].edits
    hands.quiet()
    assert np.array_equal(hands.motion(), before), "undo while it spread gives the motion from before, to the bit"
    hands.key(Qt.Key.Key_Z, CONTROL | Qt.KeyboardModifier.ShiftModifier)
    wait_for(hands.solved, 120)
    settle()
    after = hands.motion()
    assert not np.allclose(after[11, nose], before[11, nose], atol=1e-4)
    put = shell.project.document.characters[0].edits[10].moves[nose].place
    assert np.allclose(after[10, nose], put, atol=1e-6)

    place = tmp_path / "walk.motionwright"
    hands.answer(place, lambda: hands.key(Qt.Key.Key_S, CONTROL))
    assert not shell.project.session.history.modified
    assert shell.project.session.folder.path == place
    exported = tmp_path / "walk.npz"
    hands.answer(exported, lambda: QTest.mouseClick(shell.bar.export, LEFT))
    wait_for(exported.exists, 60)
    wait_for(lambda: "was written" in shell.character.mesh.errors.sentence.text(), 60)
    with np.load(exported) as stored:
        assert np.allclose(stored["vertices"], after, atol=1e-5)
    document = shell.project.document
    again = Session.open(place)
    assert again.document == document
    again.close()
