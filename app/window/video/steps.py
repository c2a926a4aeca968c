"""What this project needs next: a short list of steps with their states, and one button."""

from __future__ import annotations

from dataclasses import dataclass

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QHBoxLayout, QLabel, QPushButton, QToolButton, QVBoxLayout, QWidget

from app.window import icons
from app.window.background_state import background_state
from app.window.controls import Elided, button, icon_button, label
from app.window.project import Project
from app.window.video.ground_edits import Fallback


@dataclass(frozen=True)
class Step:
    """One step: its state is done, todo, running, stale, failed or optional; ``action`` has a button of its own."""

    title: str
    text: str
    state: str
    action: str = ""


ICONS = {
    "done": ("solution", "ok"),
    "running": ("run", "accent"),
    "stale": ("warning", "warn"),
    "failed": ("error", "err"),
    "todo": ("point", "text3"),
    "optional": ("note", "text3"),
}


ACTIONS = {
    "measure": ("run", "Measure the background"),
    "stop": ("cancel", "Stop measuring the background"),
    "contacts": ("contact", "Put contacts onto the measured background"),
}


def steps(project: Project) -> list[Step]:
    """The steps of a project in order."""
    document, stages = project.document, project.session.stages
    masks = len(document.masks)
    made = [
        Step("Masks", f"{masks} drawn" if masks else "draw round the subject", "done" if masks else "optional"),
        _points(project),
    ]
    path = project.result(stages.cameras)
    state = project.state(stages.cameras)
    if path is not None:
        text = {"ok": "solved", "static": "stands still", "rotation": "only turns", "planar": "flat scene"}
        worst = "failed" if path.verdict == "failed" else "done"
        made.append(Step("Camera", text.get(path.verdict, "failed"), worst))
    else:
        made.append(Step("Camera", _words(state), _state(state)))
    made.append(_ground(project))
    background = background_state(project)
    made.append(Step("Background", background.text, background.state, background.action))
    if document.characters:
        character = document.character(project.character_id) if project.character_id else document.characters[0]
        pairs = len(character.pairs)
        paired = "done" if pairs >= 3 else "todo"
        made.append(Step("Pairs", f"{pairs} of {len(document.tracks)} points", paired))
        state = project.motion_state(character.id)
        made.append(Step("Motion", _words(state), _state(state)))
    else:
        made.append(Step("Character", "add a mesh", "todo"))
    return made


def _points(project: Project) -> Step:
    tracks = project.document.tracks
    if not tracks:
        return Step("Points", "click some on the subject", "todo")
    states = [project.state(project.session.stages.track(track.id)) for track in tracks]
    fresh = states.count("fresh")
    if fresh == len(states):
        return Step("Points", f"{fresh} followed", "done")
    state = "running" if "running" in states else "failed" if "failed" in states else "stale"
    return Step("Points", f"{fresh} of {len(states)} followed", state)


def _ground(project: Project) -> Step:
    """Where contacts lie: solved, chosen, or to be assumed because the camera shows no parallax."""
    stages = project.session.stages
    world, path = project.result(stages.world), project.result(stages.cameras)
    if world is None:
        state = project.state(stages.world)
        return Step("Ground", _words(state), _state(state))
    scale = "in metres" if world.metric else "scale unknown"
    if world.grounded:
        return Step("Ground", f"laid, {scale}", "done")
    flat = path is not None and path.verdict in ("static", "rotation") and project.document.world.ground == "local"
    return Step("Ground", "no parallax: choose one" if flat else "constant depth", "optional" if flat else "done")


def _state(state: str) -> str:
    known = {"fresh": "done", "running": "running", "stale": "stale", "failed": "failed"}
    return known.get(state, "todo")


def _words(state: str) -> str:
    words = {"fresh": "up to date", "running": "being solved", "stale": "out of date", "failed": "failed"}
    return words.get(state, "waits for the steps above" if state == "blocked" else "not solved yet")


class StepList(QWidget):
    """Shows the steps; ``run`` asks for everything that is missing, ``ground`` for the choice of ground and scale.

    ``assume`` names the fallback that was taken where the pictures do not tell, ``asked`` the action of a step.
    """

    run = Signal()
    ground = Signal()
    assume = Signal(str)
    asked = Signal(str)

    def __init__(self) -> None:
        super().__init__()
        self._column = QVBoxLayout(self)
        self._column.setContentsMargins(0, 0, 0, 0)
        self._column.setSpacing(2)
        self._rows: list[tuple[QLabel, QLabel, Elided, QToolButton]] = []
        self._shown: list[Step] = []
        self._offered: tuple[Fallback, ...] = ()
        self.offer = QWidget()
        offer = QVBoxLayout(self.offer)
        offer.setContentsMargins(0, 4, 0, 2)
        offer.setSpacing(4)
        self.lead = label("", "label")
        self.lead.setWordWrap(True)
        offer.addWidget(self.lead)
        self._buttons = QHBoxLayout()
        self._buttons.setSpacing(6)
        offer.addLayout(self._buttons)
        self.fallbacks: dict[str, QPushButton] = {}
        self.offer.hide()
        self._column.addWidget(self.offer)
        self.button = button("Run what is missing", self.run.emit, primary=True, name="run")
        self._column.addSpacing(4)
        self.ground_button = icon_button("ground", "Choose ground and scale", self.ground.emit, "B")
        last = QHBoxLayout()
        last.setSpacing(6)
        last.addWidget(self.button, 1)
        last.addWidget(self.ground_button)
        self._column.addLayout(last)

    def show_steps(self, steps_: list[Step], *, brief: bool = False) -> None:
        """Show the steps as they stand; ``brief`` says of all that are done in one line, to leave room for a point."""
        done = [step for step in steps_ if step.state == "done" and not step.action] if brief else []
        if len(done) > 1:
            left = [step for step in steps_ if step not in done]
            steps_ = [Step("Done", ", ".join(step.title.lower() for step in done), "done"), *left]
        if steps_ == self._shown:
            return
        self._shown = steps_
        for number, widgets in enumerate(self._rows):
            for widget in widgets:
                widget.setVisible(number < len(steps_))
        while len(self._rows) < len(steps_):
            row = QHBoxLayout()
            row.setSpacing(8)
            widgets = (QLabel(), label("", "value"), Elided("", "label"), self._small_button())
            widgets[0].setFixedSize(18, 20)
            widgets[1].setFixedWidth(76)
            for widget in widgets:
                row.addWidget(widget)
            self._column.insertLayout(len(self._rows), row)
            self._rows.append(widgets)
        for widgets, step in zip(self._rows, steps_, strict=False):
            name, token = ICONS[step.state]
            widgets[0].setPixmap(icons.pixmap(name, token, 16))
            widgets[1].setText(step.title)
            widgets[2].setText(step.text)
            self._show_action(widgets[3], step.action)
        missing = any(step.state in ("todo", "stale", "failed") and not step.action for step in steps_)
        self.button.setEnabled(missing)

    def _small_button(self) -> QToolButton:
        made = icon_button("run", "")
        made.setFixedSize(24, 20)
        made.clicked.connect(lambda: self.asked.emit(str(made.property("action"))))
        return made

    def _show_action(self, made: QToolButton, action: str) -> None:
        made.setVisible(bool(action))
        if action and made.property("action") != action:
            name, words = ACTIONS[action]
            made.setProperty("action", action)
            made.setIcon(icons.icon(name, "text2", "text2"))
            made.setToolTip(words)
            made.setAccessibleName(words)

    def show_fallbacks(self, lead: str, offered: tuple[Fallback, ...]) -> None:
        """Offer what can be assumed in place of what the pictures do not tell, with the reason."""
        if offered == self._offered:
            return
        self._offered = offered
        for old in self.fallbacks.values():
            self._buttons.removeWidget(old)
            old.hide()
            old.deleteLater()
        self.fallbacks = {}
        self.lead.setText(lead)
        for each in offered:
            made = button(each.text, lambda kind=each.kind: self.assume.emit(kind))
            made.setToolTip(each.words)
            self.fallbacks[each.kind] = made
            self._buttons.addWidget(made, 1)
        self.offer.setVisible(bool(offered))
