"""The captured sequences as cards: picture, name, length, their motions as a coloured strip, what is to be known."""

from __future__ import annotations

from dataclasses import dataclass

from PySide6.QtCore import QEvent, QPoint, QRectF, QSize, Qt, Signal
from PySide6.QtGui import (
    QContextMenuEvent,
    QFont,
    QFontMetricsF,
    QImage,
    QKeyEvent,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QPen,
)
from PySide6.QtWidgets import QLineEdit, QSizePolicy, QWidget

from app.window import fonts, icons, theme

GAP, PICTURE, LEFT, BASE, LINE = 6, 54, 74, 70, 18
STRIP = (47, 12)
"""Top and height of the strip in its card."""


@dataclass(frozen=True)
class Piece:
    """A texton on the strip: shares of the sequence and a colour; a dim one is the whole of a motion."""

    first: float
    last: float
    colour: str
    dim: bool = False


@dataclass(frozen=True)
class Card:
    """One sequence as it is shown.

    state : a few words, empty where there is nothing to say; tone : token of its colour.
    warnings : sentences below the strip. hidden : its motions are not shown in the graph.
    """

    id: str
    name: str
    caption: str
    strip: tuple[Piece, ...] = ()
    state: str = ""
    tone: str = "text3"
    warnings: tuple[str, ...] = ()
    hidden: bool = False

    @property
    def height(self) -> int:
        """Pixels."""
        return BASE + LINE * len(self.warnings) + (4 if self.warnings else 0)


class NameField(QLineEdit):
    """A name that is typed; Escape leaves it as it was."""

    given_up = Signal()

    def event(self, event: QEvent) -> bool:
        """Keep Escape from the window."""
        if isinstance(event, QKeyEvent) and event.key() == Qt.Key.Key_Escape:
            if event.type() == QEvent.Type.KeyPress:
                self.given_up.emit()
            event.accept()
            return True
        return super().event(event)


class SequenceCards(QWidget):
    """Cards to choose from; Up and Down choose, Return plays, F4 renames, Delete removes."""

    chosen = Signal(str)
    played = Signal(str)
    renamed = Signal(str, str)
    removed = Signal(str)
    menu_wanted = Signal(str, QPoint)

    def __init__(self) -> None:
        super().__init__()
        self.cards: tuple[Card, ...] = ()
        self.pictures: dict[str, QImage] = {}
        self.selected = ""
        self._hover = ""
        self.field: NameField | None = None
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setMouseTracking(True)
        self.setAccessibleName("Sequences")
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.setFixedHeight(0)

    def show_cards(self, cards: tuple[Card, ...], pictures: dict[str, QImage], selected: str) -> None:
        """Show other cards."""
        if selected != self.selected or [each.id for each in cards] != [each.id for each in self.cards]:
            self.end_renaming()
        self.cards, self.pictures, self.selected = cards, pictures, selected
        self.setFixedHeight(sum(card.height + GAP for card in cards))
        self.update()

    def sizeHint(self) -> QSize:
        """As high as the cards."""
        return QSize(240, self.height())

    def box(self, sequence_id: str) -> QRectF:
        """Where a card stands."""
        top = 0.0
        for card in self.cards:
            if card.id == sequence_id:
                return QRectF(0, top, self.width(), card.height)
            top += card.height + GAP
        return QRectF()

    def at(self, y: float) -> str:
        """The card at a height; empty for none."""
        return next((card.id for card in self.cards if self.box(card.id).top() <= y < self.box(card.id).bottom()), "")

    # mouse and keys ----------------------------------------------------------------------------------------------

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Choose a card."""
        found = self.at(event.position().y())
        self.end_renaming()
        if found and event.button() in (Qt.MouseButton.LeftButton, Qt.MouseButton.RightButton):
            self.chosen.emit(found)

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        """Rename by its name, else play it as captured."""
        found = self.at(event.position().y())
        if not found or event.button() != Qt.MouseButton.LeftButton:
            return
        inside = event.position().y() - self.box(found).top()
        if event.position().x() >= LEFT and inside < 28:
            self.rename(found)
        else:
            self.played.emit(found)

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Show all of what is shortened."""
        found = self.at(event.position().y())
        if found != self._hover:
            self._hover = found
            card = next((each for each in self.cards if each.id == found), None)
            lines = [card.name, card.caption, card.state, *card.warnings] if card is not None else []
            self.setToolTip("\n".join(line for line in lines if line))
            self.update()

    def leaveEvent(self, event: QEvent) -> None:
        """Nothing is under the mouse."""
        self._hover = ""
        self.update()

    def contextMenuEvent(self, event: QContextMenuEvent) -> None:
        """Ask for what can be done with a card."""
        found = self.at(event.pos().y())
        if found:
            self.menu_wanted.emit(found, event.globalPos())

    def event(self, event: QEvent) -> bool:
        """Keep the keys of the list while it has the focus."""
        own = (Qt.Key.Key_Up, Qt.Key.Key_Down, Qt.Key.Key_Return, Qt.Key.Key_F4, Qt.Key.Key_Delete)
        if event.type() == QEvent.Type.ShortcutOverride and isinstance(event, QKeyEvent) and event.key() in own:
            event.accept()
            return True
        return super().event(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Move, play, rename, remove."""
        order = [card.id for card in self.cards]
        key = event.key()
        if not order or self.selected not in order:
            super().keyPressEvent(event)
        elif key in (Qt.Key.Key_Up, Qt.Key.Key_Down):
            step = 1 if key == Qt.Key.Key_Down else -1
            self.chosen.emit(order[min(max(order.index(self.selected) + step, 0), len(order) - 1)])
        elif key == Qt.Key.Key_Return:
            self.played.emit(self.selected)
        elif key == Qt.Key.Key_F4:
            self.rename(self.selected)
        elif key == Qt.Key.Key_Delete:
            self.removed.emit(self.selected)
        else:
            super().keyPressEvent(event)

    def rename(self, sequence_id: str) -> None:
        """Type another name in its place."""
        self.end_renaming()
        card = next((each for each in self.cards if each.id == sequence_id), None)
        if card is None:
            return
        field = self.field = NameField(card.name, self)
        field.setAccessibleName("Name of the sequence")
        top = self.box(sequence_id).top()
        field.setGeometry(LEFT - 9, round(top) + 3, self.width() - LEFT + 3, 28)
        field.selectAll()
        field.returnPressed.connect(lambda: self._take_name(sequence_id))
        field.given_up.connect(self.end_renaming)
        field.editingFinished.connect(lambda: self._take_name(sequence_id))
        field.show()
        field.setFocus(Qt.FocusReason.OtherFocusReason)

    def _take_name(self, sequence_id: str) -> None:
        field = self.field
        if field is None:
            return
        name = field.text().strip()
        self.end_renaming()
        card = next((each for each in self.cards if each.id == sequence_id), None)
        if card is not None and name and name != card.name:
            self.renamed.emit(sequence_id, name)

    def end_renaming(self) -> bool:
        """Leave the name as it is; says whether it was being typed."""
        field, self.field = self.field, None
        if field is not None:
            field.hide()
            field.deleteLater()
            self.setFocus(Qt.FocusReason.OtherFocusReason)
        return field is not None

    # drawing -----------------------------------------------------------------------------------------------------

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the cards."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform)
        for card in self.cards:
            self._paint(painter, card, self.box(card.id))
        painter.end()

    def _paint(self, painter: QPainter, card: Card, box: QRectF) -> None:
        look = theme.active()
        chosen = card.id == self.selected
        focused = chosen and self.hasFocus()
        painter.setPen(QPen(look.colour("accent"), 2.0 if focused else 1.4) if chosen else Qt.PenStyle.NoPen)
        painter.setBrush(look.colour("hover" if chosen or card.id == self._hover else "raised"))
        painter.drawRoundedRect(box.adjusted(1, 1, -1, -1), 5, 5)
        painter.save()
        painter.translate(box.topLeft())
        self._picture(painter, card)
        painter.setOpacity(0.55 if card.hidden else 1.0)
        right = box.width() - 10
        _text(painter, QRectF(LEFT, 6, right - LEFT, 18), card.name, "text", fonts.BODY, QFont.Weight.DemiBold)
        _two(painter, QRectF(LEFT, 25, right - LEFT, 18), card.caption, card.state, card.tone)
        self._strip(painter, card, QRectF(LEFT, STRIP[0], right - LEFT, STRIP[1]))
        for number, warning in enumerate(card.warnings):
            top = BASE - 4 + LINE * number
            painter.drawPixmap(12, top + 1, icons.pixmap("warning", "warn", 14))
            _text(painter, QRectF(32, top, right - 32, LINE), warning, "text2", fonts.CAPTION)
        painter.restore()

    def _picture(self, painter: QPainter, card: Card) -> None:
        picture = self.pictures.get(card.id)
        if picture is None or picture.isNull():
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(theme.active().colour("panel"))
            painter.drawRoundedRect(QRectF(10, 8, PICTURE, PICTURE), 4, 4)
        else:
            painter.drawImage(QRectF(10, 8, PICTURE, PICTURE), picture)

    def _strip(self, painter: QPainter, card: Card, room: QRectF) -> None:
        look = theme.active()
        painter.setPen(Qt.PenStyle.NoPen)
        if not card.strip:
            painter.setBrush(look.colour("panel"))
            painter.drawRoundedRect(room, 2, 2)
            return
        apart = 1.5 if len(card.strip) * 5 < room.width() else 0.4
        for piece in card.strip:
            left = room.left() + room.width() * piece.first
            width = max(room.width() * (piece.last - piece.first) - apart, 0.8)
            painter.setBrush(look.colour(piece.colour, 70 if piece.dim else 255))
            painter.drawRoundedRect(QRectF(left, room.top(), width, room.height()), 1.5, 1.5)


def _text(
    painter: QPainter, box: QRectF, text: str, token: str, size: int, weight: QFont.Weight = QFont.Weight.Normal
) -> None:
    face = fonts.font(size, weight)
    painter.setFont(face)
    painter.setPen(theme.active().colour(token))
    shown = QFontMetricsF(face).elidedText(text, Qt.TextElideMode.ElideRight, box.width())
    painter.drawText(box, Qt.AlignmentFlag.AlignVCenter, shown)


def _two(painter: QPainter, box: QRectF, left: str, right: str, tone: str) -> None:
    """A caption, and a state at the right end that gives way where there is no room for both."""
    face = fonts.font(fonts.CAPTION)
    room = box.width() - QFontMetricsF(face).horizontalAdvance(left) - 12
    _text(painter, box, left, "text3", fonts.CAPTION)
    if right and room > 24:
        shown = QFontMetricsF(face).elidedText(right, Qt.TextElideMode.ElideRight, room)
        painter.setPen(theme.active().colour(tone))
        painter.drawText(box, int(Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignRight), shown)
