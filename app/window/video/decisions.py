"""What a gesture that has ended over the picture means, by the tool in hand."""

from __future__ import annotations

from typing import TYPE_CHECKING

from app.window.canvas.gestures import Cancelled, Chosen, Drawn, Moved, Moving, Placed
from app.window.project import Project
from app.window.video import edits_by_mouse, scene_picking
from app.window.video.contact_snapping import track_of
from app.window.video.mask_editing import is_part, moved
from app.window.video.tools import HINTS

if TYPE_CHECKING:
    from app.window.video.workspace import VideoWorkspace


def move_mask(page: VideoWorkspace, event: Moving) -> None:
    """Show the mask as it would be if the mouse were let go now."""
    assert page.project is not None
    edit = moved(page.project.document, page.frame, event.owner, event.place, event.start)
    page.shown.mask_moving = edit.document.masks[page.frame]


def decided(page: VideoWorkspace, event: object) -> None:
    """Do what a gesture means, and say what the mouse does next."""
    project = page.project
    assert project is not None
    if _chosen(page, project, event) or _done(page, project, event):
        return
    if isinstance(event, Cancelled | Chosen | Moved):
        page.hint.emit(HINTS[page.tool])


def _done(page: VideoWorkspace, project: Project, event: object) -> bool:
    """An edit of what was drawn, placed or dragged; says whether the hint was given."""
    frame, scale = page.frame, page.canvas.view.scale
    if page.tool == "ground" and isinstance(event, Placed | Drawn):
        scene_picking.choose(project, page.shown, page._marks, frame, event, scale)
    elif isinstance(event, Moved) and is_part(event.owner):
        edits_by_mouse.move_mask_part(project, frame, event.owner, event.place, event.start)
        page.shown.mask_part = ""
    elif isinstance(event, Moved) and track_of(event.owner):
        sentence = page.snapping.put(frame, track_of(event.owner), event.place)
        page.hint.emit(sentence or HINTS["contact"])
        return True
    elif isinstance(event, Moved):
        project.select_track(event.owner)
        edits_by_mouse.correct(project, event.owner, frame, event.place)
    elif isinstance(event, Placed):
        edits_by_mouse.add_point(project, frame, event.place)
    elif isinstance(event, Drawn):
        edits_by_mouse.draw_mask(project, frame, event.points, event.mode, scale)
    return False


def _chosen(page: VideoWorkspace, project: Project, event: object) -> bool:
    """A click on something that is there; says whether the hint was given."""
    if not isinstance(event, Chosen):
        return False
    if is_part(event.owner):
        project.select_track("")
        page.shown.mask_part = event.owner
        page.hint.emit("Delete removes the chosen corner, or the whole lasso where its edge or inside is chosen.")
        return True
    page.shown.mask_part = ""
    track = track_of(event.owner) or event.owner
    project.select_track(track)
    if page.tool != "contact" or not track:
        return False
    page.contact_start, sentence = edits_by_mouse.mark_contact(project, track, page.frame, page.contact_start)
    page.hint.emit(sentence or HINTS["contact"])
    return True
