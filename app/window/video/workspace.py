"""The Video workspace: watch, click points, correct them, draw masks, mark contacts."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

from PySide6.QtCore import Qt
from PySide6.QtGui import QImage
from PySide6.QtWidgets import QHBoxLayout, QMenu

from app.model.document import Document
from app.model.values import KeyMask
from app.window import settings
from app.window.canvas import Canvas
from app.window.canvas.gestures import Drawing, Gesture, Moved, Moving
from app.window.controls import ErrorBar, Panel, icon_button, label, toggle
from app.window.frames import FrameLoader
from app.window.lanes_of import VIDEO_LEGEND, video_lanes
from app.window.picture_layers import Shown, layers, missing_evidence, track_at, track_marks
from app.window.picture_notes import PictureNotes
from app.window.project import Project
from app.window.reading import Reading
from app.window.timeline import Lane
from app.window.timeline.transport import Entry
from app.window.video import edits_by_mouse, ground_edits, scene_picking
from app.window.video.background_layers import WIPE, BackgroundLayers
from app.window.video.contact_snapping import ContactSnapping, free, track_of
from app.window.video.decisions import decided, move_mask
from app.window.video.mask_editing import is_part, part_at
from app.window.video.picture_menu import picture_menu
from app.window.video.point_windows import PointWindows, windows_of
from app.window.video.proposals import ContactProposals
from app.window.video.right_column import RightColumn
from app.window.video.tool_strip import ToolStrip
from app.window.video.tools import HINTS, LAYERS, NARROW, Tool, gesture_for
from app.window.workspaces import Workspace

PLAIN = Qt.CursorShape.CrossCursor
CURSORS = {"pan": Qt.CursorShape.OpenHandCursor, "select": Qt.CursorShape.ArrowCursor}


class VideoWorkspace(Workspace):
    """Shows a frame with its marks; what the mouse does becomes edits."""

    def __init__(self) -> None:
        super().__init__()
        self.project: Project | None = None
        self.reading: Reading | None = None
        self.loader: FrameLoader | None = None
        self.shown = Shown(names=False)
        for name, _, _ in LAYERS:
            stored = settings.settings().value(f"video/{name}")
            setattr(self.shown, name, getattr(self.shown, name) if stored is None else str(stored).lower() == "true")
        self.frame = 0
        self.tool: Tool = "select"
        self.proposals = ContactProposals()
        self.contact_start: tuple[str, int] | None = None
        self._marks: tuple = ()
        self.background = BackgroundLayers(self)
        self.snapping = ContactSnapping(self.background)
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(0)
        self.strip = ToolStrip()
        self.strip.chosen.connect(self._choose_tool)
        self.tool_buttons = self.strip.buttons
        row.addWidget(self.strip)
        row.addSpacing(8)
        row.addWidget(self._middle(), 1)
        self.right = self.aside = self._right()
        row.addWidget(self.right)
        self._choose_tool("select")

    # building ----------------------------------------------------------------------------------------------------

    def _middle(self) -> Panel:
        self.panel = Panel("Video", " ")
        bar = self.panel.header.row
        self.layer_buttons = {
            name: toggle(icon, text, lambda on, name=name: self._switch(name, on), on=getattr(self.shown, name))
            for name, icon, text in LAYERS
        }
        self.paths_button, self.masks_button = self.layer_buttons["paths"], self.layer_buttons["masks"]
        self.onion_button, self.names_button = self.layer_buttons["onion"], self.layer_buttons["names"]
        self.camera_button, self.grid_button = self.layer_buttons["camera"], self.layer_buttons["grid"]
        self.magnifier_button = toggle("magnifier", "Magnifier", self._magnify, key="Z")
        self.zoom = label("100 %", "label")
        self.zoom.setFixedWidth(44)
        self.zoom.setAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
        self.canvas = Canvas(self._begin)
        for widget in (
            *self.layer_buttons.values(),
            self.magnifier_button,
            self.zoom,
            icon_button("fit", "Show the whole picture", self.canvas.fit, "F"),
        ):
            bar.addWidget(widget)
        self.errors = ErrorBar()
        self.panel.column.addWidget(self.errors)
        self.panel.column.addWidget(self.background.bar)
        self.background.ready.connect(self.refresh)
        inner = QHBoxLayout()
        inner.setSpacing(0)
        self.windows = PointWindows()
        self.windows.chosen.connect(self._go)
        inner.addWidget(self.canvas, 1)
        inner.addWidget(self.windows)
        self.panel.column.addLayout(inner, 1)
        self.notes = PictureNotes(self.canvas)
        self.canvas.happened.connect(self._happened)
        self.canvas.hovered.connect(self._hovered)
        self.canvas.menu_wanted.connect(lambda place, where: self.menu_at(place).popup(where))
        self.canvas.view_changed.connect(lambda scale: self.zoom.setText(f"{100 * scale:.0f} %"))
        return self.panel

    def _right(self) -> RightColumn:
        column = RightColumn()
        self.inspector, self.scene, self.steps = column.inspector, column.scene, column.steps
        self.accept_button, self.propose_button = column.accept_button, column.propose_button
        self.inspector.go.connect(self._go)
        self.inspector.list.chosen.connect(lambda name: self.project and self.project.select_track(name))
        self.scene.cleared.connect(self._choose_nothing)
        self.steps.run.connect(self.run_wanted)
        self.steps.assume.connect(self._assume)
        self.steps.asked.connect(self.background.ask)
        self.inspector.contact_info.asked.connect(lambda wish: self.command(f"{wish}_contact"))
        self.steps.ground.connect(lambda: self._choose_tool("ground"))
        self.propose_button.clicked.connect(lambda: self.command("propose_contacts"))
        self.accept_button.clicked.connect(lambda: self.command("accept_contacts"))
        return column

    # showing -----------------------------------------------------------------------------------------------------

    def attach_clip(self, project: Project, loader: FrameLoader | None) -> None:
        """Take another clip, or another project with its clip."""
        self.project, self.reading, self.loader = project, Reading(project), loader
        self.shown.before = self.shown.compared = {}
        self.proposals = ContactProposals()
        self.contact_start = None
        self.background.attach(project)
        if loader is not None:
            loader.also_ready.connect(lambda _: self.windows.update())
            self.windows.picture = loader.peek
        else:
            self.canvas.show_picture(QImage())
        self.refresh()

    def detach(self) -> None:
        """End the thread that makes the layers of the background."""
        self.background.detach()

    def lanes(self) -> list[Lane]:
        """Pictures and masks, tracks, contacts with those proposed, reprojection."""
        return video_lanes(self.project, self.proposals.open(self.project)) if self.project is not None else []

    def legend(self) -> Sequence[Entry]:
        """Give the legend of the lanes."""
        return VIDEO_LEGEND

    def say(self, sentence: str) -> None:
        """Say something in passing, over the picture."""
        self.notes.say(sentence)

    def show_picture(self, frame: int, picture: QImage) -> None:
        """Show a frame; picture and marks change together, so that they never belong to different frames."""
        if frame != self.frame:
            self.shown.mask_part = ""
        self.frame = frame
        self.canvas.show_picture(picture)
        self.refresh(moved=True)

    def document_changed(self, before: Document, after: Document) -> None:
        """Keep the old paths of tracks that have to be solved again, then show what there is."""
        if self.reading is not None:
            edits_by_mouse.keep_old_paths(self.shown, self.reading, before, after)
        if before.masks is not after.masks:
            self.shown.mask_part = ""
        self.refresh()

    def showEvent(self, event: object) -> None:
        """Show what has changed when the workspace comes into sight, and say what the mouse does."""
        self.refresh()
        self.hint.emit(HINTS[self.tool])

    def resizeEvent(self, event: object) -> None:
        """Where there is little room the switches over the picture are icons alone."""
        narrow = self.width() < NARROW
        style = Qt.ToolButtonStyle.ToolButtonIconOnly if narrow else Qt.ToolButtonStyle.ToolButtonTextBesideIcon
        for each in (*self.layer_buttons.values(), self.magnifier_button):
            if each.toolButtonStyle() != style:
                each.setToolButtonStyle(style)

    def refresh(self, *, moved: bool = False) -> None:
        """Show the project as it is, or what another frame changes; nothing is read for a page that nobody sees."""
        project, reading = self.project, self.reading
        if project is None or reading is None or not self.looked_at():
            return
        edits_by_mouse.drop_old_paths(self.shown, reading, project)
        frame = self.frame
        self._marks = track_marks(project, reading, frame, self.shown)
        self._show_background()
        self.canvas.show_layers(layers(project, self._marks, frame, self.shown))
        clip = project.document.clip
        if clip is not None:
            self.panel.header.caption.setText(f"{clip.width} × {clip.height}")
            self.notes.show_frame(frame, clip.frame_count, frame / max(clip.fps, 1e-9))
        self.notes.setVisible(clip is not None)
        self._show_windows()
        known = next((reading.track(each) for each in project.document.tracks if each.id == project.track_id), None)
        if self.tool == "ground":
            scene_picking.keep_valid(project, self.shown)
            self.scene.show_scene(project, self.shown.picked, self.shown.picked_tracks, frame)
        self.inspector.show_track(project, known, frame)
        self.inspector.show_points([(each, reading.track(each)) for each in project.document.tracks])
        self.right.show_proposals(self.proposals.count(project))
        self.right.show_needs(project, moved=moved)
        self.canvas.update()

    def _show_background(self) -> None:
        """The measured background over the picture, and where an anchor under the mouse would lie on it."""
        shown, held = self.shown, self.snapping.dragged
        if held is None and self.tool == "contact" and shown.hovered:
            mark = next((each for each in self._marks if each.name == shown.hovered), None)
            place = mark.at(self.frame) if mark is not None else None
            held = (shown.hovered, place) if place is not None else None
        sounded = held is not None or (self.tool == "contact" and bool(self.project and self.project.track_id))
        shown.backdrop = self.background.show(self.frame, shown=shown.background, surface=sounded)
        self.inspector.contact_info.off = self.snapping.off(self.frame) if sounded else ""
        shown.snap = self.snapping.preview(self.frame, *held) if held is not None else None

    def _show_windows(self) -> None:
        project, reading = self.project, self.reading
        assert project is not None
        assert reading is not None
        self.windows.show_windows(windows_of(project, reading, self.frame))
        if self.loader is not None:
            self.loader.also([each.frame for each in self.windows.windows])

    def _switch(self, name: str, on: bool) -> None:
        setattr(self.shown, name, on)
        if name in self.layer_buttons:
            settings.settings().setValue(f"video/{name}", on)
        if on and name in ("camera", "grid") and self.project is not None:
            self.notes.say(missing_evidence(self.project, name))
        self.refresh()

    def _magnify(self, on: bool) -> None:
        self.canvas.magnify = on
        self.canvas.update()

    def _go(self, frame: int) -> None:
        if self.project is not None:
            self.project.show_frame(frame)

    # the mouse ---------------------------------------------------------------------------------------------------

    def _choose_tool(self, name: Tool) -> None:
        self.tool = name
        self.contact_start = None
        self.tool_buttons[name].setChecked(True)
        self.shown.choosing = name == "ground"
        self.right.show_scene(name == "ground")
        self.canvas.panning = name == "pan"
        self.canvas.setCursor(CURSORS.get(name, PLAIN))
        self.hint.emit(HINTS[name])
        self.refresh()

    def _choose_nothing(self) -> None:
        scene_picking.clear(self.shown)
        self.refresh()

    def _assume(self, kind: str) -> None:
        if kind == "points":
            self._choose_tool("ground")
        elif self.project is not None:
            ground_edits.choose(self.project, kind)

    def _begin(self, place: tuple[float, float], keys: Qt.KeyboardModifier) -> Gesture | None:
        backdrop = self.shown.backdrop
        if backdrop is not None and self.background.line_at(backdrop, place, self.canvas.view.scale):
            return self.background.drag_of(backdrop, place)
        return gesture_for(
            self.tool,
            self._marks,
            self.frame,
            place,
            self.canvas.view.scale,
            adding=bool(keys & Qt.KeyboardModifier.ShiftModifier),
            subtracting=bool(keys & Qt.KeyboardModifier.AltModifier),
            key=self._mask(),
            anchors=self.snapping.possible,
        )

    def menu_at(self, place: tuple[float, float]) -> QMenu:
        """Choose what is under a place, and give the menu of what can be done with it."""
        project, scale = self.project, self.canvas.view.scale
        track = track_at(self._marks, self.frame, place, scale)
        part = "" if track else part_at(self._mask(), place, scale, whole=True)
        chosen = None
        if project is not None:
            project.select_track(track)
            self.shown.mask_part = part
            self.refresh()
            chosen = project.document.track(track) if track else None
        return picture_menu(self, self.command, chosen, part, self.frame)

    def _mask(self) -> KeyMask | None:
        """The mask drawn in this frame, where masks are seen."""
        seen = self.project is not None and self.shown.masks and self.shown.marks
        return self.project.document.masks.get(self.frame) if self.project is not None and seen else None

    def _hovered(self, place: tuple[float, float] | None) -> None:
        lit = place is not None and self.background.line_at(self.shown.backdrop, place, self.canvas.view.scale)
        if lit != self.background.lit:
            self.background.lit = lit
            self.canvas.setCursor(Qt.CursorShape.SplitHCursor if lit else CURSORS.get(self.tool, PLAIN))
            self.refresh()
        found = track_at(self._marks, self.frame, place, self.canvas.view.scale) if place is not None else ""
        if found != self.shown.hovered:
            self.shown.hovered = found
            self.refresh()

    def _happened(self, event: object) -> None:
        if self.project is None:
            return
        if isinstance(event, Drawing):
            self.shown.drawing = event.points
            self.shown.subtracting = event.subtracting
        elif isinstance(event, Moving) and is_part(event.owner):
            self.shown.mask_part = event.owner
            move_mask(self, event)
        elif isinstance(event, Moving | Moved) and event.owner == WIPE:
            self.background.move_line(event.place[0], self.canvas.picture.width(), done=isinstance(event, Moved))
        elif isinstance(event, Moving) and track_of(event.owner):
            self.snapping.dragged = (track_of(event.owner), event.place)
            self.hint.emit("Let go to put the contact onto the surface here; Esc leaves it where it is.")
        elif isinstance(event, Moving):
            self.shown.dragged = (event.owner, event.place)
            self.project.select_track(event.owner)
            self.hint.emit("Let go to correct the point here; Esc puts it back.")
        else:
            self.shown.dragged, self.shown.drawing, self.shown.mask_moving = None, (), None
            self.snapping.dragged = None
            decided(self, event)
        self.refresh()

    def _proposed(self, sentence: str) -> None:
        self.notes.say(sentence)
        self.lanes_changed.emit()

    # commands ----------------------------------------------------------------------------------------------------

    def command(self, name: str) -> bool:
        """Do a command of this workspace; says whether it was one."""
        if name == "tool_contact" and self.tool == "contact" and self.project is not None:
            self.contact_start, sentence = edits_by_mouse.contact_by_key(self.project, self.frame, self.contact_start)
            self.hint.emit(sentence or HINTS["contact"])
        elif name.startswith("tool_"):
            self._choose_tool(name.removeprefix("tool_"))  # type: ignore[arg-type]
        elif name.startswith("layer_"):
            self.layer_buttons[name.removeprefix("layer_")].toggle()
        elif name == "cancel":
            if self.canvas.cancel():
                return True
            if self.tool == "select":
                return False
            self._choose_tool("select")
        elif self.project is not None and self.inspector.command(name):
            if name == "rename_point" and self.right.folded:
                self.right.unfold()
                self.inspector.command(name)
        elif name in (handlers := self._handlers()):
            handlers[name]()
        else:
            return False
        return True

    def _handlers(self) -> dict[str, Callable[[], object]]:
        project, frame = self.project, self.frame
        if project is None:
            return {}
        return {
            "fit": self.canvas.fit,
            "magnifier": self.magnifier_button.toggle,
            "overlay": lambda: self._switch("marks", not self.shown.marks),
            "delete": lambda: edits_by_mouse.delete(project, frame, self.shown.mask_part),
            "next_problem": lambda: self.notes.say(edits_by_mouse.next_problem(project)),
            "propose_contacts": lambda: self._proposed(self.proposals.find(project)),
            "accept_contacts": lambda: self._proposed(self.proposals.accept(project)),
            "snap_contact": lambda: self.say(self.snapping.put_selected(frame, self._marks)),
            "free_contact": lambda: free(project, project.track_id, frame),
            "next_track": project.select_next_track,
            **{
                f"nudge_{way}": partial(edits_by_mouse.nudge, project, self.reading, frame, *step)
                for way, step in edits_by_mouse.STROKES.items()
            },
        }
