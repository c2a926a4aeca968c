"""The bar over the picture that chooses what is shown of the measured background, and how."""

from __future__ import annotations

from typing import get_args

from PySide6.QtCore import QSize, Qt, Signal
from PySide6.QtWidgets import QButtonGroup, QFrame, QHBoxLayout, QProgressBar, QPushButton, QToolButton

from app.actions.background_views import Kind
from app.window import icons, settings
from app.window.background_state import BackgroundState
from app.window.controls import Elided, NumberField, NumberRange, button, label, toggle

KINDS: dict[str, tuple[str, str]] = {
    "depth": ("Depth", "How far the background is away, in false colour"),
    "confidence": ("Confidence", "How many other key frames agree with the depth"),
    "plate": ("Clean plate", "The frame without its subject"),
}
ACTIONS = {
    "measure": ("Measure the background", "run", "Its depth, in key frames; it takes a while and can be stopped"),
    "stop": ("Stop", "cancel", "Stop measuring"),
    "contacts": ("Put contacts on it", "contact", "Contacts lie where their points meet the measured surface"),
}
OPACITY = NumberRange(5, 100, 1, 0, "%", 80)


class BackgroundBar(QFrame):
    """``changed`` says that something else is to be shown; ``asked`` names a command: measure or stop."""

    changed = Signal()
    asked = Signal(str)

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("backgroundBar")
        self.setFixedHeight(38)
        row = QHBoxLayout(self)
        row.setContentsMargins(12, 4, 8, 4)
        row.setSpacing(6)
        kept = settings.settings()
        self._group = QButtonGroup(self)
        self.kinds: dict[str, QToolButton] = {}
        for kind, (text, words) in KINDS.items():
            each = QToolButton()
            each.setProperty("toggle", "true")
            each.setText(text)
            each.setToolTip(words)
            each.setCheckable(True)
            each.setFocusPolicy(Qt.FocusPolicy.TabFocus)
            self._group.addButton(each)
            self.kinds[kind] = each
            each.clicked.connect(lambda _=False, kind=kind: self._choose(kind))
            row.addWidget(each)
        stored = str(kept.value("video/background_kind", "depth"))
        self.kinds[stored if stored in get_args(Kind) else "depth"].setChecked(True)
        row.addSpacing(6)
        self.caption = label("Opacity", "label")
        row.addWidget(self.caption)
        self.opacity = NumberField(OPACITY, float(str(kept.value("video/background_opacity", OPACITY.default))))
        self.opacity.setAccessibleName("Opacity of the background over the frame, per cent")
        self.opacity.setFixedWidth(58)
        self.opacity.changing.connect(lambda _: self.changed.emit())
        self.opacity.changed.connect(self._keep_opacity)
        row.addWidget(self.opacity)
        wiped = str(kept.value("video/background_wipe", "false")) == "true"
        self.wipe = toggle("wipe", "Wipe", self._switch_wipe, on=wiped)
        self.wipe.setToolTip("Show it right of a line that is dragged over the frame")
        row.addWidget(self.wipe)
        row.addSpacing(6)
        self.note = Elided("", "caption")
        row.addWidget(self.note, 1)
        self.progress = QProgressBar()
        self.progress.setRange(0, 1000)
        self.progress.setTextVisible(False)
        self.progress.setFixedWidth(96)
        row.addWidget(self.progress)
        self.action: QPushButton = button("", self._ask, name="run")
        row.addWidget(self.action)
        self._command = ""

    @property
    def kind(self) -> Kind:
        """What is chosen."""
        return next(kind for kind in get_args(Kind) if self.kinds[kind].isChecked())

    def _choose(self, kind: str) -> None:
        settings.settings().setValue("video/background_kind", kind)
        self.changed.emit()

    def _keep_opacity(self, value: float) -> None:
        settings.settings().setValue("video/background_opacity", value)
        self.changed.emit()

    def _switch_wipe(self, on: bool) -> None:
        settings.settings().setValue("video/background_wipe", "true" if on else "false")
        self.changed.emit()

    def _ask(self) -> None:
        self.asked.emit(self._command)

    def show_state(self, state: BackgroundState, note: str, fraction: float | None) -> None:
        """Show how measuring stands; ``note`` is said of the picture shown, ``fraction`` what is measured so far."""
        self.note.setText(note if state.ready else state.sentence)
        for each in (*self.kinds.values(), self.caption, self.opacity, self.wipe):
            each.setEnabled(state.ready)
        self.progress.setVisible(fraction is not None)
        self.progress.setValue(round(1000 * (fraction or 0.0)))
        self.action.setVisible(bool(state.action))
        if state.action != self._command:
            self._command = state.action
            text, icon, words = ACTIONS.get(state.action, ("", "run", ""))
            self.action.setText(text)
            self.action.setToolTip(words)
            self.action.setIcon(icons.icon(icon, "text", "text"))
            self.action.setIconSize(QSize(16, 16))
