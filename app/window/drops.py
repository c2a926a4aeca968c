"""Files dragged over the window: what a drop would do is said while they hang, and done when they fall."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QMimeData, QRectF, Qt
from PySide6.QtGui import QDragEnterEvent, QDropEvent, QFontMetricsF, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QWidget

from app.actions.kinds import Kind, kind_of
from app.model.document import Document
from app.window import fonts, icons, theme

if TYPE_CHECKING:
    from app.window.shell import Shell

ICONS: dict[str, str] = {
    "project": "open",
    "clip": "video",
    "mesh": "character",
    "sequence": "graph",
    "cameras": "camera",
    "": "error",
}
SHOWN = 5
"""Files that are named one by one."""


class Drops(QWidget):
    """Lies over the window while something is dragged over it; the mouse goes through."""

    def __init__(self, shell: Shell) -> None:
        super().__init__(shell)
        self.shell = shell
        self.lines: list[tuple[Kind, str]] = []
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.setAttribute(Qt.WidgetAttribute.WA_NoSystemBackground)
        self.hide()

    def enter(self, event: QDragEnterEvent) -> None:
        """Say what would be done with what is dragged; what nothing can be done with is taken too, to say so."""
        paths = local_paths(event.mimeData())
        if not paths:
            return
        document = self.shell.project.document if self.shell.project is not None else None
        kinds = [(path, kind_of(path)) for path in paths]
        self.lines = what_a_drop_does(kinds, document)
        event.acceptProposedAction()
        self.setGeometry(self.shell.rect())
        self.raise_()
        self.show()

    def leave(self) -> None:
        """Nothing hangs over the window any more."""
        self.hide()

    def drop(self, event: QDropEvent) -> None:
        """Do what was said: a project is opened, all else is taken into the one that is open."""
        self.hide()
        paths = local_paths(event.mimeData())
        project = next((path for path in paths if kind_of(path) == "project"), None)
        for path in paths if project is None else [project]:
            self.shell.files.take(path)
        event.acceptProposedAction()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the sentences on a card in the middle."""
        look = theme.active()
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.fillRect(self.rect(), look.colour("window", 200))
        painter.setPen(QPen(look.colour("accent"), 2))
        painter.drawRoundedRect(QRectF(self.rect()).adjusted(8, 8, -8, -8), 8, 8)
        face = fonts.font(fonts.BODY)
        painter.setFont(face)
        metrics = QFontMetricsF(face)
        height = max(metrics.height(), 20) + 12
        width = max(metrics.horizontalAdvance(text) for _, text in self.lines) + 84
        width = min(width, self.width() - 80.0)
        card = QRectF(0, 0, width, height * len(self.lines) + 32)
        card.moveCenter(QRectF(self.rect()).center())
        painter.setBrush(look.colour("raised"))
        painter.setPen(QPen(look.colour("line2"), 1))
        painter.drawRoundedRect(card, 8, 8)
        top = card.top() + 16
        for kind, text in self.lines:
            token = "accent" if kind else "text3"
            painter.drawPixmap(
                int(card.left() + 20), int(top + (height - 18) / 2), icons.pixmap(ICONS[kind], token, 18)
            )
            painter.setPen(look.colour("text" if kind else "text3"))
            room = QRectF(card.left() + 50, top, card.width() - 70, height)
            shown = metrics.elidedText(text, Qt.TextElideMode.ElideMiddle, room.width())
            painter.drawText(room, Qt.AlignmentFlag.AlignVCenter, shown)
            top += height
        painter.end()


def local_paths(data: QMimeData) -> list[Path]:
    """The files and folders of this machine among what is dragged."""
    return [Path(url.toLocalFile()) for url in data.urls() if url.isLocalFile()]


def what_a_drop_does(kinds: list[tuple[Path, Kind]], document: Document | None) -> list[tuple[Kind, str]]:
    """One sentence for each thing that is dropped; of several projects, or several clips, only one can be used."""
    project = next((path for path, kind in kinds if kind == "project"), None)
    if project is not None:
        lines: list[tuple[Kind, str]] = [("project", f"Open the project {project.stem}")]
        return lines + [("", "One project at a time: the others are left") for _ in kinds[1:2]]
    lines = [(kind, _sentence(path, kind, document)) for path, kind in kinds]
    if len(lines) > SHOWN:
        lines = [*lines[: SHOWN - 1], (lines[SHOWN][0], f"and {len(lines) - SHOWN + 1} more")]
    return lines


def _sentence(path: Path, kind: Kind, document: Document | None) -> str:
    name = path.name
    if kind == "clip":
        clip = document.clip if document is not None else None
        instead = f" instead of {Path(clip.media.path).name}" if clip is not None else ""
        return f"Use {name} as the clip{instead}" + (", a folder of pictures" if path.is_dir() else "")
    if kind == "mesh":
        return f"Add {name} as a character"
    if kind == "sequence":
        return f"Add {name} as a sequence" + (", a folder of meshes" if path.is_dir() else "")
    if kind == "cameras":
        return f"Use {name} as the cameras, in place of solving them"
    return f"{name} is nothing that can be used here"
