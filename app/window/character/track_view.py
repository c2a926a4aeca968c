"""The video beside the character: the tracks, to compare with and to pair with vertices."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QImage

from app.window.canvas import Canvas
from app.window.canvas.gestures import Chosen, DragGesture, Gesture
from app.window.controls import Panel, icon_button, set_tooltip, toggle
from app.window.frames import FrameLoader
from app.window.picture_layers import Shown, layers, track_at, track_marks
from app.window.picture_notes import PictureNotes
from app.window.project import Project
from app.window.reading import Reading


class TrackView(Panel):
    """A picture in which tracks are chosen but not changed.

    ``chosen`` and ``pointed`` give a track, empty for none; ``pairing`` that pairing by two clicks is wanted or not.
    """

    pairing = Signal(bool)
    chosen = Signal(str)
    pointed = Signal(str)

    def __init__(self) -> None:
        super().__init__("Video", " ")
        self.project: Project | None = None
        self.reading: Reading | None = None
        self.shown = Shown(names=False, masks=False)
        self.frame = 0
        self._marks: tuple = ()
        self.canvas = Canvas(self._begin)
        self.canvas.happened.connect(self._happened)
        self.canvas.hovered.connect(self._hovered)
        bar = self.header.row
        self.pair_button = toggle("link", "Pair", self._pair)
        set_tooltip(self.pair_button, "Click a point here and its place on the character, either first", "pair")
        self.names_button = toggle("labels", "Names", self._names)
        self.magnifier_button = toggle("magnifier", "", self._magnify, key="Z")
        self.magnifier_button.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonIconOnly)
        self.magnifier_button.setAccessibleName("Magnifier")
        for widget in (self.pair_button, self.names_button, self.magnifier_button):
            bar.addWidget(widget)
        bar.addWidget(icon_button("fit", "Show the whole picture", self.canvas.fit))
        self.column.addWidget(self.canvas, 1)
        self.notes = PictureNotes(self.canvas)

    def attach(self, project: Project, loader: FrameLoader | None) -> None:
        """Take another project."""
        self.project, self.reading = project, Reading(project)
        if loader is None:
            self.canvas.show_picture(QImage())

    def show_picture(self, frame: int, picture: QImage) -> None:
        """Show a frame."""
        self.frame = frame
        self.canvas.show_picture(picture)

    def refresh(self) -> None:
        """Show the tracks as they are."""
        project, reading = self.project, self.reading
        if project is None or reading is None:
            return
        self._marks = track_marks(project, reading, self.frame, self.shown)
        self.canvas.show_layers(layers(project, self._marks, self.frame, self.shown))
        clip = project.document.clip
        character = next((each for each in project.document.characters if each.id == project.character_id), None)
        paired = len(character.pairs) if character else 0
        self.header.caption.setText(f"{paired} of {len(project.document.tracks)} paired" if clip else "")
        if clip is not None:
            self.notes.show_frame(self.frame, clip.frame_count, self.frame / max(clip.fps, 1e-9))

    def next_track(self) -> None:
        """Select the track after the selected one."""
        if self.project is not None:
            self.project.select_next_track()
            self.chosen.emit(self.project.track_id)

    def _begin(self, place: tuple[float, float], keys: Qt.KeyboardModifier) -> Gesture | None:
        owner = track_at(self._marks, self.frame, place, self.canvas.view.scale)
        return DragGesture(owner, place, slack=1e9)

    def _happened(self, event: object) -> None:
        if isinstance(event, Chosen) and self.project is not None:
            self.chosen.emit(event.owner)

    def _hovered(self, place: tuple[float, float] | None) -> None:
        found = track_at(self._marks, self.frame, place, self.canvas.view.scale) if place is not None else ""
        if found != self.shown.hovered:
            self.highlight(found)
            self.pointed.emit(found)

    def highlight(self, track_id: str) -> None:
        """Light a track that is pointed at, here or elsewhere; empty for none."""
        if track_id != self.shown.hovered:
            self.shown.hovered = track_id
            self.refresh()

    def _pair(self, on: bool) -> None:
        self.pairing.emit(on)

    def _names(self, on: bool) -> None:
        self.shown.names = on
        self.refresh()

    def _magnify(self, on: bool) -> None:
        self.canvas.magnify = on
        self.canvas.update()
