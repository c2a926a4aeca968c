"""One frame of the film as it will be written, made in a thread of its own while the controls are turned."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from PySide6.QtCore import QRectF, Signal
from PySide6.QtGui import QImage, QPainter, QPaintEvent
from PySide6.QtWidgets import QHBoxLayout, QSizePolicy, QVBoxLayout, QWidget

from app.actions.background_views import Kind
from app.actions.rendering import FilmOrder
from app.window import theme
from app.window.canvas import as_image, fitted, marks
from app.window.controls import Elided, NumberField, NumberRange, button, label
from app.window.newest_call import NewestCall
from app.window.project import Project

LACKING = {
    "motion": ("The motion is not solved yet: rendering solves it first.", "Solve the motion", "propagate"),
    "some motion": (
        "Motions that are not solved yet are left out; rendering solves them first.",
        "Solve the motion",
        "propagate",
    ),
    "comparison": (
        "What is not computed yet is left out; rendering computes it first.",
        "Compute them now",
        "comparisons",
    ),
    "unmeasured": (
        "The background has not been measured yet: writing measures it first.",
        "Measure the background",
        "measure",
    ),
    "nobody": ("Choose a character to film.", "", ""),
    "background": (
        "Shown without occlusion, shadow, plate and matched light: the background has not been measured yet.",
        "Measure the background",
        "measure",
    ),
}


class Picture(QWidget):
    """A picture as large as it fits, with a plate of a few words."""

    def __init__(self) -> None:
        super().__init__()
        self.picture, self.note = QImage(), ""
        self.setMinimumSize(360, 220)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.setAccessibleName("Preview of the frame")

    def show_picture(self, picture: QImage) -> None:
        """Show another picture."""
        self.picture = picture
        self.update()

    def say(self, note: str) -> None:
        """Show a few words on it."""
        if note != self.note:
            self.note = note
            self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the picture and the plate."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.fillRect(self.rect(), theme.active().colour("canvas"))
        size = (self.width(), self.height())
        if not self.picture.isNull():
            view = fitted((self.picture.width(), self.picture.height()), size)
            painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform)
            wide, high = self.picture.width() * view.scale, self.picture.height() * view.scale
            painter.drawImage(QRectF(view.x, view.y, wide, high), self.picture)
        if self.note:
            marks.plate(painter, size[0] / 2, size[1] - 22, self.note, theme.DARK.colour("text"), align="centre")
        painter.end()


class Preview(QWidget):
    """Shows the frame in sight under an order; ``asked`` names the command that gets what is missing.

    ``plain`` is said where nothing is missing.
    """

    asked = Signal(str)

    def __init__(self, project: Project, plain: str) -> None:
        super().__init__()
        self.project, self.plain = project, plain
        self.shown: tuple[Any, ...] | None = None
        self._previewer: Any = None
        self._calls = NewestCall("preview", self)
        self._calls.answered.connect(self._answered)
        self._calls.refused.connect(self._refused)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(8)
        self.picture = Picture()
        column.addWidget(self.picture, 1)
        row = QHBoxLayout()
        row.setSpacing(8)
        self.frame = NumberField(NumberRange(0, max(project.frame_count - 1, 0), 1, 0, "", None), project.frame)
        self.frame.setFixedWidth(64)
        self.frame.setAccessibleName("Frame that is shown")
        self.frame.changing.connect(lambda value: project.show_frame(round(value)))
        self.frame.changed.connect(lambda value: project.show_frame(round(value)))
        self.words = Elided("", "label")
        self.help = button("", self._ask, name="run")
        row.addWidget(label("Frame", "label"))
        row.addWidget(self.frame)
        row.addWidget(self.words, 1)
        row.addWidget(self.help)
        column.addLayout(row)
        self._command = ""
        self._lack("")

    def _ask(self) -> None:
        self.asked.emit(self._command)

    def show_order(self, order: FilmOrder) -> None:
        """Show another film, or the same where a frame or a result is another one now."""
        from app.actions.previewing import lacking, within_reach

        project = self.project
        self._lack(lacking(project.session, order) if order.characters else "nobody")
        made = within_reach(project.session, order)
        if made is None:
            self.show_nothing()
            return
        stages, still, frame = project.session.stages, project.session.as_it_is(), project.frame
        keys = tuple(stage.key for stage in made.stages(project.session))
        wish = (made, frame, keys, stages.world.key, stages.masks.key)
        self.show(wish, lambda previewer: previewer.picture(still, made, frame))

    def show_comparison(self, character: str, variants: tuple[str, ...]) -> None:
        """Show a comparison as far as it is computed."""
        project = self.project
        stages, still, frame = project.session.stages, project.session.as_it_is(), project.frame
        if not character or stages.animation(character) not in still.cache:
            self._lack("motion" if character else "nobody")
            self.show_nothing()
            return
        there = tuple(each for each in variants if stages.comparison(character, each) in still.cache)
        self._lack("" if there == variants else "comparison")
        wish = (character, there, frame, stages.animation(character).key, stages.world.key)
        self.show(wish, lambda previewer: previewer.comparison(still, character, there, frame))

    def show_background(self, kind: Kind) -> None:
        """Show the measured background of the frame in sight."""
        project = self.project
        stages, still, frame = project.session.stages, project.session.as_it_is(), project.frame
        if stages.depth not in still.cache or stages.world not in still.cache:
            self._lack("unmeasured")
            self.show_nothing()
            return
        self._lack("")
        wish = (kind, frame, stages.depth.key, stages.world.key, stages.masks.key)
        self.show(wish, lambda previewer: previewer.background(still, kind, frame))

    def show(self, wish: tuple[Any, ...], make: Callable[[Any], Any]) -> None:
        """Make a picture unless it is the one that is shown."""
        self.frame.set_value(self.project.frame)
        if wish == self.shown:
            self._calls.forget()
            self.picture.say("")
            return
        self.picture.say("being made …")
        self._calls.want(wish, lambda: self._make(make))

    def show_nothing(self) -> None:
        """There is nothing to show yet."""
        self.shown = None
        self._calls.forget()
        self.frame.set_value(self.project.frame)
        self.picture.show_picture(QImage())
        self.picture.say("Nothing to show yet")

    def _make(self, make: Callable[[Any], Any]) -> QImage:
        from app.actions.previewing import Previewer

        if self._previewer is None:
            self._previewer = Previewer()
        return as_image(make(self._previewer))

    def _answered(self, wish: tuple[Any, ...], picture: QImage) -> None:
        self.shown = wish
        self.picture.show_picture(picture)
        self.picture.say("being made …" if self._calls.busy else "")

    def _refused(self, wish: tuple[Any, ...], error: BaseException) -> None:
        self.shown = None
        self.picture.show_picture(QImage())
        self.picture.say("No preview")
        self.words.setText(str(error))

    def _lack(self, what: str) -> None:
        sentence, text, self._command = LACKING.get(what, (self.plain, "", ""))
        self.words.setText(sentence)
        self.help.setText(text)
        self.help.setVisible(bool(text))

    def close_calls(self, *, wait: bool) -> None:
        """End the thread; ``wait`` until it has ended."""
        self._calls.close(wait=wait)
