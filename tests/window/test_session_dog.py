"""A whole session on a real clip: a filmed dog moves a lion, from an empty window to a file that is read back."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import cv2
import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from app.actions.session import Session
from app.formats import read_sequence
from app.window.shell import Shell
from tests.window.conftest import settle, wait_for
from tests.window.session_hands import CONTROL, LEFT, Hands, begin_of

pytestmark = [pytest.mark.window, pytest.mark.realdata, pytest.mark.slow, pytest.mark.xdist_group("window")]
FRAMES = 24
MARKS = Path(__file__).parent.parent / "realdata" / "dog.json"


def outline(mask: Path) -> list[tuple[float, float]]:
    """The subject's outline as a person would draw it: the largest part, in steps of some pixels."""
    picture = cv2.imread(str(mask), cv2.IMREAD_GRAYSCALE)
    parts, _ = cv2.findContours((picture > 0).astype(np.uint8), cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
    longest = max(parts, key=cv2.contourArea)[:, 0]
    return [(float(x), float(y)) for x, y in longest[::6]]


def test_a_filmed_dog_moves_a_lion_through_the_window(
    open_shell: Callable[[Session], Shell], shared_data: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The clicks of a person are made again with the mouse: points, corrections, contacts, what is hidden, pairs."""
    monkeypatch.setenv("HOME", str(tmp_path))
    marks = json.loads(MARKS.read_text())
    begin_of(shared_data / "davis_dog" / "clip.mp4", tmp_path / "dog.mp4", FRAMES)
    shell = open_shell(Session.new())
    hands = Hands(shell)
    hands.drop(tmp_path / "dog.mp4")
    wait_for(lambda: not shell.video.canvas.picture.isNull())
    settle()

    hands.lasso(outline(min((shared_data / "davis_dog" / "masks").glob("*.png"))))
    assert len(shell.project.document.masks[0].lassos) == 1
    clicks = {name: {int(at): place for at, place in each["clicks"].items()} for name, each in marks["tracks"].items()}
    for name, places in clicks.items():
        if hands.click_point(name, places[0]):
            hands.rename(name)
    assert len(hands.tracks) >= 12
    hands.quiet()

    corrected = 0
    for frame in sorted({frame for places in clicks.values() for frame in places if 0 < frame < FRAMES}):
        hands.go(frame)
        for name in hands.tracks:
            corrected += frame in clicks[name] and hands.correct(name, clicks[name][frame])
        hands.quiet()
    assert corrected >= 10
    for name, values in marks["tracks"].items():
        for first, last in values.get("occluded", ()):
            if name in hands.tracks and first < FRAMES and min(last, FRAMES - 1) - first < 4:
                hands.select(name)
                for frame in range(first, min(last, FRAMES - 1) + 1):
                    hands.go(frame)
                    hands.key(Qt.Key.Key_X)
                assert shell.project.document.track(hands.tracks[name]).occluded
        for first, last in values.get("contacts", ()):
            if name in hands.tracks and first < FRAMES:
                hands.contact(name, first, min(last, FRAMES - 1))
    planted = [track.name for track in shell.project.document.tracks if track.contacts]
    assert len(planted) >= 3

    hands.key(Qt.Key.Key_Return, CONTROL)
    hands.quiet(240)
    world = shell.project.result(shell.project.session.stages.world)
    assert world is not None, shell.video.errors.sentence.text()
    if shell.video.steps.fallbacks:
        QTest.mouseClick(shell.video.steps.fallbacks["plane"], LEFT)
        hands.quiet()

    hands.key(Qt.Key.Key_Home)
    hands.drop(shared_data / "characters" / "lion_sumner_2500.ply")
    wait_for(lambda: shell.character.mesh.viewport is not None and len(shell.character.mesh.viewport.vertices))
    settle()
    pairs = marks["characters"]["lion_sumner_2500"]["pairs"]
    todo = {name: vertex for name, vertex in pairs.items() if name in hands.tracks}
    paired = hands.pair_all(todo)
    assert len(paired) >= 8, paired
    hands.key(Qt.Key.Key_Escape)

    QTest.mouseClick(shell.character.inspector.run, LEFT)
    wait_for(hands.solved, 240)
    settle()
    before = hands.motion()
    assert np.isfinite(before).all()
    hands.go(12)
    hands.key(Qt.Key.Key_1)
    settle()
    nose = shell.project.document.characters[0].pairs[hands.tracks["nose"]]
    hands.pull(nose, -15, -20)
    wait_for(lambda: 12 in shell.project.document.characters[0].edits)
    wait_for(hands.solved, 240)
    settle()
    after = hands.motion()
    put = shell.project.document.characters[0].edits[12].moves[nose].place
    assert np.allclose(after[12, nose], put, atol=1e-6)
    assert not np.allclose(after[13, nose], before[13, nose], atol=1e-4)

    hands.answer(tmp_path / "dog.motionwright", lambda: hands.key(Qt.Key.Key_S, CONTROL))
    assert not shell.project.session.history.modified
    hands.answer(tmp_path / "lion.glb", lambda: hands.key(Qt.Key.Key_E, CONTROL))
    wait_for(lambda: "was written" in shell.character.mesh.errors.sentence.text(), 60)
    sequence = read_sequence(tmp_path / "lion.glb")
    assert len(sequence.vertices) == FRAMES
    spread = np.ptp(after, axis=(0, 1)).max()
    low, high = np.min(sequence.vertices, axis=(0, 1)), np.max(sequence.vertices, axis=(0, 1))
    assert (high - low).max() == pytest.approx(spread, rel=1e-3)
