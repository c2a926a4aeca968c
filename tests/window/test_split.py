"""The line between workspace and timeline, and the lanes of a low window."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest

from app.window.settings import settings
from app.window.shell import Shell
from app.window.timeline import Bar, Curve, Diamond, Lane, Row
from app.window.timeline.lanes import layout, total_height
from app.window.timeline.summary import LINE, summaries
from tests.window.conftest import drag, settle


def test_the_height_chosen_by_hand_is_kept_for_its_workspace(shell: Shell) -> None:
    """What is dragged in one tab holds there, also in another run, and not in the other tab."""
    settle(100)
    automatic = shell.split.sizes()[1]
    handle = shell.split.handle(1)
    # The line moves along under the mouse, so that the steps add up.
    drag(handle, (handle.width() / 2, 4), (handle.width() / 2, 16))
    settle(50)
    chosen = shell.split.sizes()[1]
    assert chosen < automatic - 20
    shell.do("character")
    settle(100)
    assert abs(shell.split.sizes()[1] - chosen) > 20
    shell.do("video")
    settle(100)
    assert abs(shell.split.sizes()[1] - chosen) <= 1
    assert int(str(settings().value("split/video"))) == chosen
    QTest.mouseDClick(shell.split.handle(1), Qt.MouseButton.LeftButton)
    settle(100)
    assert abs(shell.split.sizes()[1] - automatic) <= 1


def test_a_low_window_shows_every_lane_in_one_line(shell: Shell) -> None:
    """Below 800 pixels the picture keeps its room; a taller window shows the lanes in full again."""
    shell.resize(1180, 720)
    settle(150)
    assert shell.timeline.lanes.compact
    assert all(each.height == LINE + 2 for each in shell.timeline.lanes.placed)
    assert shell.pages.height() > 400
    axis = shell.timeline.lanes.axis
    QTest.mouseClick(shell.timeline.lanes, Qt.MouseButton.LeftButton, pos=QPoint(round(axis.x(5)), 12))
    assert shell.project is not None
    assert shell.project.frame == 5, "a low timeline seeks as well"
    shell.resize(1440, 900)
    settle(150)
    assert not shell.timeline.lanes.compact


def test_a_summary_keeps_what_asks_for_a_look() -> None:
    """One line holds the bars and marks of all rows, and where a curve is too high; nothing in it can be dragged."""
    tracks = Lane(
        "tracks",
        "Tracks",
        "points",
        rows=(
            Row("a", (Bar(0, 9, "ok"),), (Diamond(0), Diamond(4))),
            Row("b", (Bar(0, 5, "ok"), Bar(6, 9, "warn", "hatch")), (Diamond(4),), selected=True),
        ),
        edits=("retime",),
    )
    values = np.array([0.1, 0.2, 3.0, 4.0, 0.1, np.nan, 2.0])
    short, curve = summaries([tracks, Lane("fit", "Fit", "camera", curve=Curve(values, 1.0))])
    assert [mark.frame for mark in short.rows[0].diamonds] == [0, 4]
    assert short.rows[0].id == "b"
    assert short.rows[0].bars[-1].style == "hatch"
    assert not short.edits
    assert [(bar.first, bar.last) for bar in curve.rows[0].bars if bar.colour == "err"] == [(2, 3), (6, 6)]
    assert [(bar.first, bar.last) for bar in curve.rows[0].bars if bar.style == "line"] == [(0, 4), (6, 6)]
    assert total_height(layout([short, curve])) < total_height(layout([tracks]))
