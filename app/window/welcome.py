"""What an empty project shows: one sentence, one thing to do, the sample, and the projects opened lately."""

from __future__ import annotations

from datetime import datetime
from pathlib import Path

from PySide6.QtCore import QPointF, QSize, Qt, Signal
from PySide6.QtGui import QIcon, QPainter, QPixmap, QShowEvent
from PySide6.QtWidgets import QHBoxLayout, QToolButton, QVBoxLayout, QWidget

from app.window import icons, settings, theme
from app.window.controls import ErrorBar, Invitation, Panel, label
from app.window.controls.own_keys import PressKeys

CARD = QSize(176, 99)
SHOWN = 4
HOW = (
    "Motionwright follows points that you click on a filmed animal or person, and moves a character like it.",
    "Captured sequences of meshes are cut into motions and composed anew: drop a folder of them.",
)


class Welcome(Panel):
    """Lies where the picture will be. ``wanted`` names a command that is asked for, ``project_wanted`` a project."""

    wanted = Signal(str)
    project_wanted = Signal(object)
    HINT = "Drop a video, a mesh, a folder of pictures or meshes, or a project anywhere on the window."

    def __init__(self) -> None:
        super().__init__()
        self.errors = ErrorBar()
        self.column.addWidget(self.errors)
        body = Invitation("video", "Open a video, or drop one here.", *HOW)
        self.open = body.offer("Open a video", "add_clip", primary=True, icon="open")
        self.sample = body.offer("Open the sample", "sample", icon="sample")
        self.project = body.offer("Open a project", "open", icon="open")
        body.wanted.connect(self.wanted)
        body.below.addWidget(self._lately())
        self.column.addWidget(body, 1)

    def _lately(self) -> QWidget:
        self.lately = QWidget()
        column = QVBoxLayout(self.lately)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(10)
        heading = label("Opened lately", "title")
        heading.setAlignment(Qt.AlignmentFlag.AlignCenter)
        column.addWidget(heading)
        self._cards = QHBoxLayout()
        self._cards.setSpacing(12)
        column.addLayout(self._cards)
        self.cards: list[QToolButton] = []
        return self.lately

    def showEvent(self, event: QShowEvent) -> None:
        """Look which projects are still there."""
        self.show_lately(settings.recent_projects())
        super().showEvent(event)

    def show_lately(self, projects: list[Path]) -> None:
        """Show the projects opened lately, the last first."""
        while (item := self._cards.takeAt(0)) is not None:
            if (widget := item.widget()) is not None:
                widget.hide()
                widget.deleteLater()
        self.cards = [self._card(path) for path in projects[:SHOWN]]
        self._cards.addStretch(1)
        for card in self.cards:
            self._cards.addWidget(card)
        self._cards.addStretch(1)
        self.lately.setVisible(bool(self.cards))

    def _card(self, path: Path) -> QToolButton:
        card = QToolButton()
        card.setProperty("card", "true")
        card.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextUnderIcon)
        card.setIcon(QIcon(picture_of(path, self.devicePixelRatio())))
        card.setIconSize(CARD)
        card.setFixedSize(CARD.width() + 16, CARD.height() + 56)
        name = card.fontMetrics().elidedText(path.stem, Qt.TextElideMode.ElideRight, CARD.width())
        card.setText(f"{name}\n{when_saved(path)}")
        card.setToolTip(str(path))
        card.setAccessibleName(f"Open the project {path.stem}")
        card.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        PressKeys(card)
        card.clicked.connect(lambda: self.project_wanted.emit(path))
        return card


def picture_of(project: Path, ratio: float = 1.0) -> QPixmap:
    """The picture kept of a project when it was saved, on a ground of one size; without one, an icon.

    ratio : device pixels per pixel of the window.
    """
    made = QPixmap(CARD * ratio)
    made.setDevicePixelRatio(ratio)
    made.fill(theme.active().colour("canvas"))
    kept, smooth = QPixmap(str(settings.thumbnail_of(project))), Qt.TransformationMode.SmoothTransformation
    if kept.isNull():
        kept = icons.icon("video", "text3").pixmap(QSize(32, 32), ratio)
    else:
        kept = kept.scaled(CARD * ratio, Qt.AspectRatioMode.KeepAspectRatio, smooth)
        kept.setDevicePixelRatio(ratio)
    size = kept.deviceIndependentSize()
    painter = QPainter(made)
    painter.drawPixmap(QPointF((CARD.width() - size.width()) / 2, (CARD.height() - size.height()) / 2), kept)
    painter.end()
    return made


def when_saved(project: Path) -> str:
    """The day of the last save as people say it."""
    try:
        day = datetime.fromtimestamp((project / "project.json").stat().st_mtime).astimezone()
    except OSError:
        return ""
    days = (datetime.now().astimezone().date() - day.date()).days
    return {0: "today", 1: "yesterday"}.get(days, f"{day.day} {day:%B %Y}")
