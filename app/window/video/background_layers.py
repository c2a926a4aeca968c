"""The measured background over the picture: made in a thread of its own, kept for frames looked at lately."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject, QTimer, Signal

from app.actions.background_views import Kind
from app.actions.session import Session
from app.window import settings
from app.window.background_state import background_state, measure, measuring, stop
from app.window.canvas import as_image
from app.window.canvas.backdrop import Backdrop, Scale
from app.window.canvas.gestures import DragGesture
from app.window.newest_call import NewestCall
from app.window.project import Project
from app.window.video import ground_edits
from app.window.video.background_bar import KINDS, BackgroundBar

if TYPE_CHECKING:
    from imitation.depth import DepthMap

WIPE = "wipe"
GRAB = 9.0
"""Pixels round the line of the wipe within which a press takes hold of it."""
KEPT = 24
REST = 70
"""Milliseconds that a frame rests before its layer is made: while the clip plays, none is."""
Key = tuple[str, str, str]


class BackgroundLayers(QObject):
    """Gives the layer of a frame as soon as it is made; ``ready`` says that something more can be shown."""

    ready = Signal()

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.bar = BackgroundBar()
        self.bar.changed.connect(self.ready)
        self.bar.asked.connect(self.ask)
        self.project: Project | None = None
        self.share = float(str(settings.settings().value("video/background_line", 0.5)))
        self.lit = False
        self._calls: NewestCall | None = None
        self._made: OrderedDict[tuple[Any, ...], Any] = OrderedDict()
        self._scales: dict[tuple[Key, Kind], Scale | None] = {}
        self._views: tuple[Key, Any] | None = None
        self._refused: tuple[Key, str] | None = None
        self._then: tuple[int, Callable[[], object]] | None = None
        self._told = -1
        self._waiting: tuple[int, list[Kind | str]] = (0, [])
        self._rest = QTimer(self)
        self._rest.setSingleShot(True)
        self._rest.setInterval(REST)
        self._rest.timeout.connect(lambda: self._want(*self._waiting))

    def attach(self, project: Project) -> None:
        """Show the background of another project."""
        self.detach()
        self.project = project
        self._calls = NewestCall("background", self)
        self._calls.answered.connect(self._answered)
        self._calls.refused.connect(self._failed)
        project.work_progressed.connect(self._progressed)

    def detach(self) -> None:
        """Forget the project and end the thread."""
        self._rest.stop()
        if self._calls is not None:
            self._calls.close()
            self._calls.deleteLater()
        self._calls, self.project, self._views, self._refused, self._then = None, None, None, None, None
        self._made.clear()
        self._scales.clear()

    # what is shown -----------------------------------------------------------------------------------------------

    def show(self, frame: int, *, shown: bool, surface: bool) -> Backdrop | None:
        """The layer of a frame as far as it is there; what is missing, and the surface where wanted, is asked for."""
        project = self.project
        self.bar.setVisible(shown)
        if project is None or not (shown or surface):
            return None
        state, job = background_state(project), measuring(project)
        kind, note = self.bar.kind, ""
        backdrop = None
        if state.ready:
            wanted: list[Kind | str] = [kind] if shown else []
            if surface:
                wanted.append("surface")
            self._want_soon(frame, wanted)
            found = self._made.get((self._key(), frame, kind)) if shown else None
            note = found[1] if found is not None else self._reason() or f"{KINDS[kind][0]} of frame {frame} is made …"
            if found is not None:
                backdrop = self._backdrop(kind, found)
        if shown:
            self.bar.show_state(state, note, project.progress[job][0] if job is not None else None)
        return backdrop

    def _backdrop(self, kind: Kind, found: Any) -> Backdrop:
        picture, _, outlines = found
        wipe = self.share * picture.width() - 0.5 if self.bar.wipe.isChecked() else None
        title = KINDS[kind][0]
        scale = self._scales.get((self._key(), kind))
        return Backdrop(picture, self.bar.opacity.value / 100, wipe, outlines, scale, title, self.lit)

    def surface(self, frame: int) -> DepthMap | None:
        """The surface in a frame, if it is there already."""
        return self._made.get((self._key(), frame, "surface")) if self.project is not None else None

    def when_surface(self, frame: int, then: Callable[[], object]) -> None:
        """Ask for the surface of a frame, and do something once it is there, unless something else is asked before."""
        self._then = (frame, then)
        self._want(frame, ["surface"])

    def _reason(self) -> str:
        return self._refused[1] if self._refused is not None and self._refused[0] == self._key() else ""

    def _key(self) -> Key:
        assert self.project is not None
        stages = self.project.session.stages
        return stages.depth.key, stages.world.key, stages.masks.key

    # making ------------------------------------------------------------------------------------------------------

    def _want_soon(self, frame: int, kinds: list[Kind | str]) -> None:
        """Ask for what is missing of a frame once it has been in sight for a moment."""
        key = self._key()
        if all((key, frame, kind) in self._made for kind in kinds):
            self._rest.stop()
        elif not self._rest.isActive() or self._waiting != (frame, kinds):
            self._waiting = (frame, kinds)
            self._rest.start()

    def _want(self, frame: int, kinds: list[Kind | str]) -> None:
        if self.project is None or self._calls is None:
            return
        key = self._key()
        missing = tuple(kind for kind in kinds if (key, frame, kind) not in self._made)
        if not missing or self._reason():
            return
        still = self.project.session.as_it_is()
        self._calls.want((key, frame, missing), lambda: self._make(key, still, frame, missing))

    def _make(self, key: Key, session: Session, frame: int, kinds: tuple[Kind | str, ...]) -> dict[Any, Any]:
        """Make what is missing; runs in the thread of the calls, which alone touches the views."""
        from app.actions.background_views import BackgroundViews

        if self._views is None or self._views[0] != key:
            self._views = (key, BackgroundViews(session))
        views, made = self._views[1], {}
        for kind in kinds:
            if kind == "surface":
                made["surface"] = views.surface(frame)
                continue
            view, legend = views.view(kind, frame), views.legend(kind)
            made[kind] = (as_image(view.picture), view.note, outlines_of(view.invented))
            strip = None if legend is None else Scale(legend.title, as_image(legend.colours), legend.ticks)
            made[("scale", kind)] = strip
        return made

    def _answered(self, wish: Any, made: dict[Any, Any]) -> None:
        key, frame, _ = wish
        for kind, value in made.items():
            if isinstance(kind, tuple):
                self._scales[(key, kind[1])] = value
            else:
                self._made[(key, frame, kind)] = value
        while len(self._made) > KEPT:
            self._made.popitem(last=False)
        if self._then is not None and self.surface(self._then[0]) is not None:
            (_, then), self._then = self._then, None
            then()
        self.ready.emit()

    def _failed(self, wish: Any, error: BaseException) -> None:
        self._refused = (wish[0], str(error))
        self.ready.emit()

    def _progressed(self) -> None:
        """Say so when another per cent is measured."""
        job = measuring(self.project) if self.project is not None else None
        share = round(100 * self.project.progress[job][0]) if job is not None and self.project is not None else -1
        if share != self._told:
            self._told = share
            self.ready.emit()

    def ask(self, command: str) -> None:
        """Begin to measure, stop, or put contacts onto what was measured."""
        if self.project is not None:
            if command == "contacts":
                ground_edits.choose(self.project, "background")
            else:
                {"measure": measure, "stop": stop}[command](self.project)

    # the line of the wipe ----------------------------------------------------------------------------------------

    def line_at(self, backdrop: Backdrop | None, place: tuple[float, float], scale: float) -> bool:
        """Whether the line of the wipe is under a picture place."""
        return backdrop is not None and backdrop.wipe is not None and abs(place[0] - backdrop.wipe) * scale <= GRAB

    def drag_of(self, backdrop: Backdrop, place: tuple[float, float]) -> DragGesture:
        """The drag of the line that begins with a press on it."""
        return DragGesture(WIPE, (float(backdrop.wipe or 0.0), place[1]), 0.0)

    def move_line(self, x: float, width: int, *, done: bool) -> None:
        """Put the line at a column of a picture of a width; remembered where the drag is done."""
        self.share = min(max((x + 0.5) / max(width, 1), 0.0), 1.0)
        if done:
            settings.settings().setValue("video/background_line", self.share)


def outlines_of(mask: Any) -> tuple[Any, ...]:
    """Polygons round what a mask (h, w) holds; none where there is no mask."""
    if mask is None:
        return ()
    from app.window.picture_layers import outline

    return tuple(outline(mask))
