"""The controls of a film: what it shows, how characters stand in the scene, light, the look of film, which frames."""

from __future__ import annotations

from collections.abc import Sequence

import attrs
from PySide6.QtCore import Signal
from PySide6.QtWidgets import QCheckBox, QVBoxLayout, QWidget

from app.model.character import Character
from app.window.controls import Chooser, NumberField, NumberRange, Row, ScrollColumn, label, separator
from app.window.render.choices import remember, remembered
from app.window.render.page import WIDE

FORMS = (("Film (mp4)", "film"), ("PNG with alpha", "png"), ("EXR with alpha", "exr"))
VIEWS = (("Over the video", "video"), ("From the side", "side"), ("Both, side by side", "both"))
SWITCHES: dict[str, tuple[str, str]] = {
    "occlusion": ("Hidden by what stands before it", "What of the background is nearer hides the characters"),
    "shadow": ("Shadow on the background", "Their shadow falls on the measured background, steps and walls too"),
    "plate": ("Take the subject out", "The filmed subject is replaced by the background behind it"),
    "remove_shadow": (
        "Take its shadow out too",
        "Where a frame is darker beside the subject than other frames show it",
    ),
    "match_light": ("Light matched to the clip", "Direction, strength and colour of the light as in the background"),
    "blurred": ("Motion blur", "Blurred by their own motion while the shutter is open"),
    "grain": ("Grain of the film", "As much noise as the film has"),
    "points": ("Draw the tracked points", "The points that the motion was taken from"),
    "ranged": ("Only some frames", "From the first to the last frame given"),
}
NUMBERS: dict[str, tuple[str, NumberRange]] = {
    "light_turn": ("Turn the light", NumberRange(-180, 180, 1, 0, "°", 0)),
    "light_lift": ("Raise the light", NumberRange(-90, 90, 1, 0, "°", 0)),
    "brightness": ("Brightness", NumberRange(20, 300, 1, 0, "%", 100)),
    "warmth": ("Warmth", NumberRange(-100, 100, 1, 0, "%", 0)),
    "shadow_strength": ("Darkness of shadow", NumberRange(0, 200, 1, 0, "%", 100)),
    "shutter": ("Shutter open", NumberRange(1, 100, 1, 0, "%", 50)),
    "dim": ("Fade the film", NumberRange(0, 100, 1, 0, "%", 0)),
}
GROUPS: tuple[tuple[str, tuple[str, ...]], ...] = (
    ("In the scene", ("occlusion", "shadow", "plate", "remove_shadow")),
    ("Light", ("match_light", "light_turn", "light_lift", "brightness", "warmth", "shadow_strength")),
    ("Look of the film", ("blurred", "shutter", "grain", "dim", "points")),
)


class FilmOptions(ScrollColumn):
    """``changed`` says that something else is wanted; it is remembered at once."""

    changed = Signal()

    def __init__(self, frames: tuple[int, int], count: int) -> None:
        super().__init__()
        self.choices = remembered()
        self.characters: dict[str, QCheckBox] = {}
        self.form, self.view = Chooser(name="What is written"), Chooser(name="Which view")
        for text, value in FORMS:
            self.form.addItem(text, value)
        for text, kind in VIEWS:
            self.view.addItem(text, kind)
        for box, name in ((self.form, "form"), (self.view, "view")):
            box.setCurrentIndex(max(box.findData(getattr(self.choices, name)), 0))
            box.currentIndexChanged.connect(lambda _, box=box, name=name: self._set(name, box.currentData()))
        self.rows.addWidget(Row("Write", self.form, width=WIDE))
        self.rows.addWidget(Row("View", self.view, width=WIDE))
        self.cast = QVBoxLayout()
        self.cast.setSpacing(6)
        self.rows.addWidget(separator())
        self.rows.addWidget(label("Characters", "title"))
        self.rows.addLayout(self.cast)
        self.switches: dict[str, QCheckBox] = {}
        self.numbers: dict[str, NumberField] = {}
        self.lines: dict[str, QWidget] = {}
        for title, names in GROUPS:
            self._group(title, names)
        limits = NumberRange(0, max(count - 1, 0), 1, 0, "", None)
        self.first, self.last = NumberField(limits, frames[0]), NumberField(limits, frames[1])
        self.rows.addWidget(separator())
        self.rows.addWidget(label("Frames", "title"))
        self.rows.addWidget(self._switch("ranged"))
        for field, words in ((self.first, "First frame"), (self.last, "Last frame")):
            field.setAccessibleName(words)
            field.changed.connect(lambda _: self._tell())
        self.range_row = Row("First and last", self.first, self.last, width=WIDE)
        self.rows.addWidget(self.range_row)
        self.rows.addStretch(1)
        self._show_possible()

    def show_characters(self, known: Sequence[Character]) -> None:
        """Show who can be filmed; who was ticked or not stays so, newcomers are filmed where they are visible."""
        names = {each.id: each.name for each in known}
        if {id_: box.text() for id_, box in self.characters.items()} == names:
            return
        before = {id_: box.isChecked() for id_, box in self.characters.items()}
        for box in self.characters.values():
            self.cast.removeWidget(box)
            box.hide()
            box.deleteLater()
        self.characters = {}
        for each in known:
            box = QCheckBox(each.name)
            box.setChecked(before.get(each.id, each.visible))
            box.toggled.connect(lambda _: self._tell())
            self.characters[each.id] = box
            self.cast.addWidget(box)

    @property
    def filmed(self) -> tuple[str, ...]:
        """Ids of the characters that are ticked."""
        return tuple(id_ for id_, box in self.characters.items() if box.isChecked())

    def _group(self, title: str, names: tuple[str, ...]) -> None:
        self.rows.addWidget(separator())
        self.rows.addWidget(label(title, "title"))
        for name in names:
            self.rows.addWidget(self._switch(name) if name in SWITCHES else self._number(name))

    def _switch(self, name: str) -> QCheckBox:
        text, words = SWITCHES[name]
        box = QCheckBox(text)
        box.setToolTip(words)
        box.setChecked(getattr(self.choices, name))
        box.toggled.connect(lambda on: self._set(name, on))
        self.switches[name] = self.lines[name] = box  # type: ignore[assignment]
        return box

    def _number(self, name: str) -> QWidget:
        text, limits = NUMBERS[name]
        field = NumberField(limits, getattr(self.choices, name))
        field.setAccessibleName(f"{text}, {limits.unit}")
        field.changing.connect(lambda value: self._set(name, value))
        field.changed.connect(lambda value: self._set(name, value))
        self.numbers[name] = field
        self.lines[name] = Row(text, field, width=WIDE + 20)
        return self.lines[name]

    def _set(self, name: str, value: object) -> None:
        self.choices = attrs.evolve(self.choices, **{name: value})
        remember(self.choices)
        self._show_possible()
        self._tell()

    def _tell(self) -> None:
        self.changed.emit()

    @property
    def frames(self) -> tuple[int, int]:
        """First and last frame, in order."""
        first, last = round(self.first.value), round(self.last.value)
        return min(first, last), max(first, last)

    def _show_possible(self) -> None:
        """What has no meaning for the file or the view that is chosen cannot be changed."""
        chosen = self.choices
        film, filmed = not chosen.alpha, chosen.alpha or chosen.view != "side"
        self.view.setEnabled(film)
        for line in self.lines.values():
            line.setEnabled(filmed)
        for name in ("plate", "dim", "points"):
            self.lines[name].setEnabled(film and filmed)
        self.lines["remove_shadow"].setEnabled(film and filmed and chosen.plate)
        self.lines["shutter"].setEnabled(filmed and chosen.blurred)
        self.lines["ranged"].setEnabled(True)
        self.range_row.setEnabled(chosen.ranged)
