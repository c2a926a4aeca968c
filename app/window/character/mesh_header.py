"""The buttons over the 3D view: how one looks, what is compared, what is drawn around the character."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from PySide6.QtCore import QPoint, Qt, Signal
from PySide6.QtGui import QAction
from PySide6.QtWidgets import QButtonGroup, QHBoxLayout, QMenu, QSizePolicy, QSlider, QToolButton, QWidget

from app.window.controls import icon_button, toggle
from app.window.viewport.layers import FILM_ONLY, LAYERS, SPACE_ONLY, Layers

LOOKS = (("orbit", "Orbit", "orbit"), ("camera", "Camera", "camera"), ("side", "Side", "side"))
HEATS = (("", "Own colours"), ("stretch", "Stretch"), ("sunk", "Below the surface"))
BEFORE = "before"
WORDY = 620
"""Pixels of width from which the looks are written out beside their icons."""


class MeshHeader(QWidget):
    """``looked`` names a look, ``layer`` a layer that is switched, ``compared`` the comparisons chosen."""

    looked = Signal(str)
    layer = Signal(str, bool)
    compared = Signal(object)
    heated = Signal(str)
    faded = Signal(int)
    ghosted = Signal(bool)
    parted = Signal(bool)
    before = Signal(bool)
    fitted = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Preferred)
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(4)
        self.looks = QButtonGroup(self)
        self.look_buttons: dict[str, QToolButton] = {}
        for name, text, icon in LOOKS:
            each = toggle(icon, text, lambda on, name=name: self.looked.emit(name) if on else None, key=f"look_{name}")
            each.setAccessibleName(text)
            self.looks.addButton(each)
            self.look_buttons[name] = each
            row.addWidget(each)
        self.split_button = self._small("split", "Camera and side at once", self.parted, "split")
        self.before_button = self._small("before", "Before the edits", self.before, "before_after")
        self.ghost_button = self._small("ghosts", "Ghosts of neighbouring frames", self.ghosted, "ghosts")
        self.compare_button = icon_button("compare", "Compare with the paper's other ways", self._show_compare)
        self.heat_button = icon_button("heat", "Heat maps", self._show_heat, "heat")
        self.layer_button = icon_button("layers", "What is drawn", self._show_layers)
        for widget in (self.split_button, self.before_button, self.ghost_button):
            row.addWidget(widget)
        for widget in (self.compare_button, self.heat_button, self.layer_button):
            row.addWidget(widget)
        self.opacity = QSlider(Qt.Orientation.Horizontal)
        self.opacity.setRange(10, 100)
        self.opacity.setValue(100)
        self.opacity.setFixedWidth(56)
        self.opacity.setToolTip("How solid the character is over the film")
        self.opacity.setAccessibleName("Opacity of the character")
        self.opacity.valueChanged.connect(self.faded)
        row.addWidget(self.opacity)
        row.addWidget(icon_button("fit", "Show everything", self.fitted.emit, "fit"))
        self.layers, self.over_film, self.following = Layers(), False, True
        self.missing: Callable[[], Mapping[str, str]] = dict
        self.variants: list[str] = []
        self.heat = ""

    def _small(self, icon: str, text: str, signal: Signal, key: str) -> QToolButton:
        made = toggle(icon, text, signal.emit, key=key)  # type: ignore[attr-defined]
        made.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonIconOnly)
        made.setAccessibleName(text)
        return made

    def fit_width(self, width: int) -> None:
        """Write the looks out where there is room."""
        wordy = Qt.ToolButtonStyle.ToolButtonTextBesideIcon
        style = wordy if width >= WORDY else Qt.ToolButtonStyle.ToolButtonIconOnly
        for each in self.look_buttons.values():
            if each.toolButtonStyle() != style:
                each.setToolButtonStyle(style)

    # menus -------------------------------------------------------------------------------------------------------

    def _menu(self) -> QMenu:
        menu = QMenu(self)
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        return menu

    def _entry(self, menu: QMenu, text: str, on: bool, why: str = "") -> QAction:
        action = menu.addAction(f"{text}  ·  {why}" if why else text)
        action.setCheckable(True)
        action.setChecked(on and not why)
        action.setEnabled(not why)
        return action

    def layer_menu(self) -> QMenu:
        """The layers of the present look, each to be shown or hidden."""
        menu = self._menu()
        menu.addSection("Over the film" if self.over_film else "In space")
        missing = self.missing()
        for name, text in LAYERS:
            if name in (SPACE_ONLY if self.over_film else FILM_ONLY):
                continue
            on = self.layers.on(name, over_film=self.over_film)
            action = self._entry(menu, text, on, missing.get(name, ""))
            action.toggled.connect(lambda on, name=name: self.layer.emit(name, on))
        if not self.over_film:
            menu.addSeparator()
            self._entry(menu, "Keep the character in view", self.following).toggled.connect(self._follow)
        return menu

    def _follow(self, on: bool) -> None:
        self.following = on

    def compare_menu(self) -> QMenu:
        """What can be shown beside the result."""
        menu = self._menu()
        menu.addSection("Beside the result")
        for name in _variants():
            action = self._entry(menu, title_of(name), name in self.variants)
            action.toggled.connect(lambda on, name=name: self._vary(name, on))
        menu.addSeparator()
        menu.addAction("All of them", lambda: self.choose_all(True))
        menu.addAction("None", lambda: self.choose_all(False))
        return menu

    def heat_menu(self) -> QMenu:
        """What the colours of the mesh may stand for."""
        menu = self._menu()
        for name, text in HEATS:
            action = self._entry(menu, text, name == self.heat)
            action.triggered.connect(lambda _=False, name=name: self.choose_heat(name))
        return menu

    def _vary(self, name: str, on: bool) -> None:
        kept = [each for each in self.variants if each != name]
        wanted = {*kept, name} if on else set(kept)
        self.variants = [each for each in _variants() if each in wanted]
        self.compared.emit(list(self.variants))

    def choose_all(self, on: bool) -> None:
        """Compare with everything there is, or with nothing."""
        self.variants = _variants() if on else []
        self.compared.emit(list(self.variants))

    def choose_heat(self, name: str) -> None:
        """Let the colours stand for something else."""
        self.heat = name
        self.heated.emit(name)

    def next_heat(self) -> None:
        """The next map, and the character's own colours after the last."""
        names = [name for name, _ in HEATS]
        self.choose_heat(names[(names.index(self.heat) + 1) % len(names)])

    def _show_compare(self) -> None:
        self._below(self.compare_menu(), self.compare_button)

    def _show_heat(self) -> None:
        self._below(self.heat_menu(), self.heat_button)

    def _show_layers(self) -> None:
        self._below(self.layer_menu(), self.layer_button)

    def _below(self, menu: QMenu, owner: QWidget) -> None:
        menu.popup(owner.mapToGlobal(QPoint(0, owner.height() + 2)))


def _variants() -> list[str]:
    """What can be compared with; the films' own list, which is loaded late."""
    from app.actions.films import COMPARISONS

    return [BEFORE, *COMPARISONS]


def title_of(variant: str) -> str:
    """What a comparison is called."""
    from app.actions.films import COMPARISONS

    text = "before the edits" if variant == BEFORE else COMPARISONS[variant]
    return text[0].upper() + text[1:]
