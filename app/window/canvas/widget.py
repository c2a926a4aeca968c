"""The picture with its layers: zoom at the mouse, pan, fit, and one gesture at a time."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QPointF, QRectF, Qt, Signal
from PySide6.QtGui import QImage, QKeyEvent, QMouseEvent, QPainter, QPaintEvent, QResizeEvent, QWheelEvent
from PySide6.QtWidgets import QSizePolicy, QWidget

from app.window import theme
from app.window.canvas import magnifier
from app.window.canvas.gestures import Gesture
from app.window.canvas.overlays import Overlay
from app.window.canvas.view import View, fitted

Place = tuple[float, float]


def as_image(frame: NDArray[np.uint8]) -> QImage:
    """A Qt picture of an RGB frame (h, w, 3); the pixels are copied."""
    rows = np.ascontiguousarray(frame)
    height, width = rows.shape[:2]
    return QImage(rows.data, width, height, 3 * width, QImage.Format.Format_RGB888).copy()


class Canvas(QWidget):
    """A picture with layers. ``begin`` says which gesture a press starts; its events come by ``happened``."""

    happened = Signal(object)
    hovered = Signal(object)
    view_changed = Signal(float)
    menu_wanted = Signal(object, object)

    def __init__(
        self, begin: Callable[[Place, Qt.KeyboardModifier], Gesture | None], parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self._begin = begin
        self.view = View()
        self._fit = True
        self._picture = QImage()
        self._layers: tuple[Overlay, ...] = ()
        self._gesture: Gesture | None = None
        self._pan: QPointF | None = None
        self._mouse: QPointF | None = None
        self.magnify = False
        self.panning = False
        self.setMouseTracking(True)
        self.setFocusPolicy(Qt.FocusPolicy.ClickFocus)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.setMinimumSize(200, 140)
        self.setAttribute(Qt.WidgetAttribute.WA_OpaquePaintEvent)

    @property
    def picture(self) -> QImage:
        """The picture shown."""
        return self._picture

    def show_picture(self, picture: QImage) -> None:
        """Show another picture; the view stays unless the size differs."""
        changed = picture.size() != self._picture.size()
        self._picture = picture
        if changed:
            self._fit = True
        self._refit()
        self.update()

    def show_layers(self, layers: Sequence[Overlay]) -> None:
        """Show other layers, the first at the bottom."""
        self._layers = tuple(layers)
        self.update()

    def fit(self) -> None:
        """Show the whole picture."""
        self._fit = True
        self._refit()
        self.update()

    def _refit(self) -> None:
        if self._fit and not self._picture.isNull():
            self._set_view(fitted((self._picture.width(), self._picture.height()), (self.width(), self.height())))

    def _set_view(self, view: View) -> None:
        if view != self.view:
            self.view = view
            self.view_changed.emit(view.scale)
            self.update()

    def cancel(self) -> bool:
        """Give up the gesture under way; says whether there was one."""
        gesture, self._gesture = self._gesture, None
        if gesture is None:
            return False
        self._tell(gesture.cancel())
        return True

    @property
    def busy(self) -> bool:
        """Whether a gesture is under way."""
        return self._gesture is not None

    def _tell(self, event: object | None) -> None:
        if event is not None:
            self.happened.emit(event)

    def _place(self, position: QPointF) -> Place:
        x, y = self.view.to_picture((position.x(), position.y()))
        return float(x), float(y)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Begin panning or the gesture of the tool in use."""
        middle = event.button() == Qt.MouseButton.MiddleButton
        if middle or (self.panning and event.button() == Qt.MouseButton.LeftButton):
            self._pan = event.position()
            self.setCursor(Qt.CursorShape.ClosedHandCursor)
        elif event.button() == Qt.MouseButton.RightButton and self._gesture is None and not self._picture.isNull():
            self.menu_wanted.emit(self._place(event.position()), event.globalPosition().toPoint())
        elif event.button() == Qt.MouseButton.LeftButton and not self._picture.isNull():
            self._gesture = self._begin(self._place(event.position()), event.modifiers())
            if self._gesture is not None:
                self._tell(self._gesture.press(self._place(event.position())))

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Pan, go on with the gesture, or say what the mouse is over."""
        self._mouse = event.position()
        if self._pan is not None:
            step = event.position() - self._pan
            self._pan, self._fit = event.position(), False
            self._set_view(self.view.panned(step.x(), step.y()))
        elif self._gesture is not None:
            self._tell(self._gesture.move(self._place(event.position())))
        else:
            self.hovered.emit(self._place(event.position()))
        if self.magnify:
            self.update()

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """End panning or the gesture."""
        if self._pan is not None and event.button() in (Qt.MouseButton.MiddleButton, Qt.MouseButton.LeftButton):
            self._pan = None
            self.unsetCursor()
        elif self._gesture is not None and event.button() == Qt.MouseButton.LeftButton:
            gesture, self._gesture = self._gesture, None
            self._tell(gesture.release(self._place(event.position())))

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        """Show the whole picture."""
        self._gesture = None
        self.fit()

    def wheelEvent(self, event: QWheelEvent) -> None:
        """Zoom at the mouse."""
        self._fit = False
        place = event.position()
        self._set_view(self.view.zoomed(1.0015 ** event.angleDelta().y(), place.x(), place.y()))
        event.accept()

    def leaveEvent(self, event: object) -> None:
        """Forget where the mouse was."""
        self._mouse = None
        self.hovered.emit(None)
        self.update()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Escape gives up a gesture; everything else goes to the workspace."""
        if event.key() == Qt.Key.Key_Escape and self.cancel():
            return
        super().keyPressEvent(event)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Keep showing the whole picture where that was wanted."""
        self._refit()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the picture, then the layers, then the loupe."""
        painter = QPainter(self)
        painter.fillRect(self.rect(), theme.active().colour("canvas"))
        if not self._picture.isNull():
            painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform, self.view.scale < 3)
            width, height = self._picture.width() * self.view.scale, self._picture.height() * self.view.scale
            painter.drawImage(QRectF(self.view.x, self.view.y, width, height), self._picture)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        size = (self.width(), self.height())
        for layer in self._layers:
            layer.paint(painter, self.view, size)
        if self.magnify and self._mouse is not None and not self._picture.isNull():
            magnifier.paint(painter, self._picture, self._place(self._mouse), self._mouse, size)
        painter.end()
