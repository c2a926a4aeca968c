"""The neighbourhood of the selected point in five frames: drift is seen at a glance, a click jumps there."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from PySide6.QtCore import QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QFont, QImage, QMouseEvent, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QSizePolicy, QWidget

from app.model.tracks import Track
from app.window import fonts, theme
from app.window.project import Project
from app.window.reading import Reading

SIDE, REACH = 74, 18.0


@dataclass(frozen=True)
class Window:
    """One picture of the column: frame, place of the point, what it is, how sure."""

    frame: int
    place: tuple[float, float] | None
    caption: str
    note: str
    clicked: bool
    present: bool = False


def window_frames(track: Track, frame: int, count: int) -> list[tuple[int, str]]:
    """The click before, halfway, now, halfway, the click after; ends of the clip where there is no click."""
    before = [click for click in track.clicks if click < frame]
    after = [click for click in track.clicks if click > frame]
    left, right = (before[-1] if before else 0), (after[0] if after else count - 1)
    rows = [
        (left, "click before" if before else "first frame"),
        ((left + frame) // 2, "halfway"),
        (frame, "now"),
        ((frame + right + 1) // 2, "halfway"),
        (right, "click after" if after else "last frame"),
    ]
    return [
        (at, text)
        for number, (at, text) in enumerate(rows)
        if number == 2 or (at != frame and at not in {other for other, _ in rows[:number]})
    ]


def windows_of(project: Project, reading: Reading, frame: int) -> list[Window]:
    """The windows of the selected point round a frame; none where no point is selected."""
    track = next((each for each in project.document.tracks if each.id == project.track_id), None)
    if track is None or not project.frame_count:
        return []
    known = reading.track(track)
    made = []
    for at, caption in window_frames(track, frame, project.frame_count):
        x, y = known.positions[at]
        place = (float(x), float(y)) if x == x else None
        note = f"sure {known.confidence[at]:.2f}" if known.state[at] else "not solved"
        clicked = at in track.clicks
        made.append(Window(at, place, caption, "by you" if clicked else note, clicked, at == frame))
    return made


class PointWindows(QWidget):
    """Draws the windows one under the other."""

    chosen = Signal(int)

    def __init__(self) -> None:
        super().__init__()
        self.windows: list[Window] = []
        self.picture: Callable[[int], QImage | None] = lambda frame: None
        self.setFixedWidth(174)
        self.setSizePolicy(QSizePolicy.Policy.Fixed, QSizePolicy.Policy.Expanding)
        self.setMouseTracking(True)

    def sizeHint(self) -> QSize:
        """Room for five windows."""
        return QSize(174, 5 * (SIDE + 10) + 30)

    def show_windows(self, windows: list[Window]) -> None:
        """Show other windows."""
        self.windows = windows
        self.update()

    def _step(self) -> float:
        return min((self.height() - 36) / max(len(self.windows), 1), SIDE + 12.0)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Go to the frame of the window that was clicked."""
        index = int((event.position().y() - 34) // self._step())
        if 0 <= index < len(self.windows):
            self.chosen.emit(self.windows[index].frame)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the windows with a cross-hair each."""
        look = theme.active()
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setFont(fonts.font(fonts.CAPTION, QFont.Weight.DemiBold))
        painter.setPen(look.colour("text2"))
        painter.drawText(QRectF(12, 8, 150, 20), Qt.AlignmentFlag.AlignVCenter, "Point window")
        if not self.windows:
            painter.setFont(fonts.font(fonts.CAPTION))
            painter.setPen(look.colour("text3"))
            words = "Choose a point to see it in the frames around."
            painter.drawText(QRectF(12, 36, 148, 60), int(Qt.TextFlag.TextWordWrap), words)
        step = self._step()
        side = min(SIDE, step - 8)
        for number, each in enumerate(self.windows):
            self._window(painter, each, QRectF(12, 34 + number * step, side, side))
        painter.end()

    def _window(self, painter: QPainter, window: Window, box: QRectF) -> None:
        look = theme.active()
        if window.present:
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(look.colour("raised"))
            painter.drawRoundedRect(QRectF(6, box.top() - 5, self.width() - 12, box.height() + 10), 5, 5)
        painter.fillRect(box, look.colour("canvas"))
        picture = self.picture(window.frame)
        if picture is not None and window.place is not None:
            x, y = window.place
            source = QRectF(x + 0.5 - REACH, y + 0.5 - REACH, 2 * REACH, 2 * REACH)
            painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform)
            painter.drawImage(box, picture, source)
            middle = box.center()
            for colour, width in ((look.colour("canvas", 190), 3.0), (look.colour("#FFFFFF"), 1.0)):
                painter.setPen(QPen(colour, width))
                painter.drawLine(middle - QPointF(6, 0), middle + QPointF(6, 0))
                painter.drawLine(middle - QPointF(0, 6), middle + QPointF(0, 6))
        token = "edit" if window.clicked else "line2"
        painter.setPen(QPen(look.colour(token), 2.0 if window.present else 1.2))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.drawRoundedRect(box, 3, 3)
        left = box.right() + 10
        lines = (
            (str(window.frame), "edit" if window.clicked else "text", QFont.Weight.DemiBold, fonts.BODY),
            (window.caption, "text2", QFont.Weight.Normal, fonts.CAPTION),
            (window.note, "text3", QFont.Weight.Normal, fonts.CAPTION),
        )
        top = box.center().y() - 27
        for text, colour, weight, size in lines:
            painter.setFont(fonts.font(size, weight))
            painter.setPen(look.colour(colour))
            painter.drawText(QRectF(left, top, self.width() - left - 4, 18), Qt.AlignmentFlag.AlignVCenter, text)
            top += 18
