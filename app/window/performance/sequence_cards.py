"""The captured sequences as cards: picture, name, length, their motions as a coloured strip, what is to be known."""

from __future__ import annotations

from collections.abc import Callable
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
)
from PySide6.QtWidgets import QLineEdit, QSizePolicy

from app.window import fonts, icons, theme
from app.window.performance.keyed_view import PLAIN, KeyedView, paint_ring

GAP, LEFT, LINE = 6, 74, 18
ROOMY = 3
"""Of more sequences than so many each card is lower."""


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
    low : whether it is lower, where there are many: name and caption stand in one line.
    """

    id: str
    name: str
    caption: str
    strip: tuple[Piece, ...] = ()
    state: str = ""
    tone: str = "text3"
    warnings: tuple[str, ...] = ()
    hidden: bool = False
    low: bool = False

    @property
    def base(self) -> int:
        """Pixels without the warnings."""
        return 50 if self.low else 70

    @property
    def picture(self) -> int:
        """Pixels of the picture's side."""
        return 40 if self.low else 54

    @property
    def strip_room(self) -> tuple[int, int]:
        """Top and height of the strip."""
        return (30, 10) if self.low else (47, 12)

    @property
    def height(self) -> int:
        """Pixels."""
        return self.base + LINE * len(self.warnings) + (4 if self.warnings else 0)


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


class SequenceCards(KeyedView):
    """Cards to choose from; Up and Down choose, Return plays, F4 renames, Delete removes."""

    chosen = Signal(str)
    played = Signal(str)
    renamed = Signal(str, str)
    removed = Signal(str)
    menu_wanted = Signal(str, QPoint)

    def __init__(self) -> None:
        super().__init__("Sequences")
        self.cards: tuple[Card, ...] = ()
        self.pictures: dict[str, QImage] = {}
        self.selected = ""
        self._hover = ""
        self.field: NameField | None = None
        moves: dict[Qt.Key, Callable[[int], int]] = {
            Qt.Key.Key_Up: lambda place: place - 1,
            Qt.Key.Key_Down: lambda place: place + 1,
            Qt.Key.Key_Home: lambda place: 0,
            Qt.Key.Key_End: lambda place: len(self.cards) - 1,
        }
        for key, to in moves.items():
            self.keys[PLAIN, key] = lambda to=to: self._move(to)  # type: ignore[misc]
        for key in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            self.keys[PLAIN, key] = lambda: self.selected and self.played.emit(self.selected)
        self.keys[PLAIN, Qt.Key.Key_F4] = lambda: self.rename(self.selected)
        self.keys[PLAIN, Qt.Key.Key_Delete] = lambda: self.selected and self.removed.emit(self.selected)
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
        """Show which card the mouse is over."""
        found = self.at(event.position().y())
        if found != self._hover:
            self._hover = found
            self.update()

    def words_at(self, place: QPoint) -> str:
        """All of what may be shortened on a card."""
        found = self.at(place.y())
        card = next((each for each in self.cards if each.id == found), None)
        lines = [card.name, card.caption, card.state, *card.warnings] if card is not None else []
        return "\n".join(line for line in lines if line)

    def leaveEvent(self, event: QEvent) -> None:
        """Nothing is under the mouse."""
        self._hover = ""
        self.update()

    def contextMenuEvent(self, event: QContextMenuEvent) -> None:
        """Ask for what can be done with a card; by the keyboard with the chosen one."""
        if event.reason() == QContextMenuEvent.Reason.Keyboard:
            place = self.box(self.selected).center().toPoint()
            if self.selected:
                self.menu_wanted.emit(self.selected, self.mapToGlobal(place))
            return
        found = self.at(event.pos().y())
        if found:
            self.menu_wanted.emit(found, event.globalPos())

    def _move(self, to: Callable[[int], int]) -> None:
        """Choose the card that a rule gives from the place of the chosen one."""
        order = [card.id for card in self.cards]
        if self.selected in order:
            self.chosen.emit(order[min(max(to(order.index(self.selected)), 0), len(order) - 1)])

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
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(look.colour("hover" if chosen or card.id == self._hover else "raised"))
        painter.drawRoundedRect(box.adjusted(1, 1, -1, -1), 5, 5)
        if chosen:
            painter.setBrush(look.colour("accent"))
            painter.drawRoundedRect(QRectF(box.left() + 1, box.top() + 1, 3.5, box.height() - 2), 1.7, 1.7)
        if chosen and self.ringed and self.hasFocus():
            paint_ring(painter, box)
        painter.save()
        painter.translate(box.topLeft())
        self._picture(painter, card)
        painter.setOpacity(0.55 if card.hidden else 1.0)
        right = box.width() - 10
        name = QRectF(LEFT, 5 if card.low else 6, right - LEFT, 18)
        if card.low:
            said, tone = (card.state, card.tone) if card.state else (card.caption.split(" · ")[0], "text3")
            _two(painter, name, card.name, said, tone, strong=True)
        else:
            _text(painter, name, card.name, "text", fonts.BODY, QFont.Weight.DemiBold)
            _two(painter, QRectF(LEFT, 25, right - LEFT, 18), card.caption, card.state, card.tone)
        self._strip(painter, card, QRectF(LEFT, card.strip_room[0], right - LEFT, card.strip_room[1]))
        for number, warning in enumerate(card.warnings):
            top = card.base - 4 + LINE * number
            painter.drawPixmap(12, top + 1, icons.pixmap("warning", "warn", 14))
            _text(painter, QRectF(32, top, right - 32, LINE), warning, "text2", fonts.CAPTION)
        painter.restore()

    def _picture(self, painter: QPainter, card: Card) -> None:
        picture = self.pictures.get(card.id)
        box = QRectF(10 + (54 - card.picture) / 2, (card.base - card.picture) / 2, card.picture, card.picture)
        if picture is None or picture.isNull():
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(theme.active().colour("panel"))
            painter.drawRoundedRect(box, 4, 4)
        else:
            painter.drawImage(box, picture)

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


def _two(painter: QPainter, box: QRectF, left: str, right: str, tone: str, *, strong: bool = False) -> None:
    """A name or caption, and what is said at the right end: that gives way where there is no room for both."""
    face = fonts.font(fonts.CAPTION)
    size, weight = (fonts.BODY, QFont.Weight.DemiBold) if strong else (fonts.CAPTION, QFont.Weight.Normal)
    room = box.width() - QFontMetricsF(fonts.font(size, weight)).horizontalAdvance(left) - 12
    _text(painter, box, left, "text" if strong else "text3", size, weight)
    if right and room > 24:
        painter.setFont(face)
        shown = QFontMetricsF(face).elidedText(right, Qt.TextElideMode.ElideRight, room)
        painter.setPen(theme.active().colour(tone))
        painter.drawText(box, int(Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignRight), shown)
