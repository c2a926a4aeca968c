"""What gestures in the Video workspace mean: edits of the document."""

from __future__ import annotations

from app.actions import proposing
from app.model.document import Document
from app.model.edits import contacts, scene, tracks
from app.window.picture_layers import Shown
from app.window.project import Project
from app.window.reading import Reading
from app.window.video import mask_editing

Place = tuple[float, float]
WAYS = {"left": (-1, 0), "right": (1, 0), "up": (0, -1), "down": (0, 1)}
STROKES = {
    **{way: (0.25 * x, 0.25 * y) for way, (x, y) in WAYS.items()},
    **{f"{way}_far": (2.5 * x, 2.5 * y) for way, (x, y) in WAYS.items()},
}
"""Pixels of the film that a stroke of a key moves a point by."""


def add_point(project: Project, frame: int, place: Place) -> None:
    """Begin a track with a click and select it."""
    known = {track.id for track in project.document.tracks}
    if project.edit(tracks.add_track, frame, place):
        project.select_track(next(track.id for track in project.document.tracks if track.id not in known))


def correct(project: Project, track_id: str, frame: int, place: Place) -> None:
    """Put a track's point somewhere in a frame."""
    project.edit(tracks.set_click, track_id, frame, place)


def nudge(project: Project, reading: Reading | None, frame: int, dx: float, dy: float) -> None:
    """Move the selected point by a fraction of a pixel; strokes in a row are one entry."""
    track = next((each for each in project.document.tracks if each.id == project.track_id), None)
    if track is None or reading is None:
        return
    x, y = track.clicks.get(frame) or reading.track(track).positions[frame]
    if x == x:
        place = (float(x) + dx, float(y) + dy)
        project.edit(tracks.set_click, track.id, frame, place, gesture=f"nudge {track.id} {frame}")


def draw_mask(project: Project, frame: int, points: tuple[Place, ...], mode: str, scale: float) -> None:
    """Add a lasso to the mask of a frame, take one away from it, or begin it anew: one entry.

    The line keeps the corners it needs within 1.5 pixels of the screen at this scale, so that it can be edited.
    """
    points = mask_editing.simplified(points, 1.5 / scale)
    gesture = f"lasso {id(points)}"
    if mode == "new" and frame in project.document.masks:
        project.edit(scene.remove_mask, frame, gesture=gesture)
    project.edit(scene.add_lasso, frame, points, subtract=mode == "subtract", gesture=gesture)
    project.close_gesture()


def mark_contact(
    project: Project, track_id: str, frame: int, start: tuple[str, int] | None
) -> tuple[tuple[str, int] | None, str]:
    """Two marks make a contact; a click inside one removes it. Gives the open mark and what to do next."""
    track = project.document.track(track_id)
    if start is not None and start[0] == track_id:
        project.edit(contacts.add_contact, track_id, start[1], frame)
        return None, ""
    if any(frame in contact.span for contact in track.contacts):
        project.edit(contacts.remove_contact, track_id, frame)
        return None, ""
    return (track_id, frame), f"Contact of {track.name} begins at frame {frame}: click it in the last such frame."


def contact_by_key(project: Project, frame: int, start: tuple[str, int] | None) -> tuple[tuple[str, int] | None, str]:
    """The Contact key, pressed with that tool in hand: the selected point stands in this frame, or not.

    A contact that was begun by a click ends here instead. Gives the open mark, none, and what to do next.
    """
    if start is not None and start[0] == project.track_id:
        return mark_contact(project, project.track_id, frame, start)
    if not project.track_id:
        return None, "Choose a point first: C then marks that it stands on the ground in a frame, or not."
    project.edit(contacts.toggle_contact, project.track_id, frame)
    return None, ""


def move_mask_part(project: Project, frame: int, part: str, place: Place, start: Place) -> None:
    """Put a corner, an edge or the whole of a lasso somewhere."""
    project.edit(mask_editing.moved, frame, part, place, start)


def delete(project: Project, frame: int, part: str = "") -> None:
    """Delete the selected part of a mask, else the click of this frame, or the track where it has no other."""
    if part and frame in project.document.masks:
        project.edit(mask_editing.removed, frame, part)
        return
    track = next((each for each in project.document.tracks if each.id == project.track_id), None)
    if track is None:
        if frame in project.document.masks:
            project.edit(scene.remove_mask, frame)
    elif frame in track.clicks and len(track.clicks) > 1:
        project.edit(tracks.remove_click, track.id, frame)
    else:
        project.edit(tracks.delete_track, track.id)


def next_problem(project: Project) -> str:
    """Go to the frame that needs a click most, of the selected point or of all; a sentence where there is none."""
    found = proposing.click_wanted(project.session, project.track_id)
    if found is None:
        return "No frame asks for a click: points that are still followed come later."
    project.select_track(found[0])
    project.show_frame(found[1])
    return ""


def keep_old_paths(shown: Shown, reading: Reading, before: Document, after: Document) -> None:
    """Remember the paths of tracks whose clicks change, to show them until the new ones are there."""
    if before.tracks is not after.tracks:
        shown.compared = {}
    was = {track.id: track for track in before.tracks}
    kept = dict(shown.before)
    for track in after.tracks:
        old = was.get(track.id)
        if old is not None and old.clicks != track.clicks and track.id not in kept:
            known = reading.last(track.id)
            if known is not None and known.complete:
                kept[track.id] = known.positions
    ids = {track.id for track in after.tracks}
    shown.before = {track_id: path for track_id, path in kept.items() if track_id in ids}


def drop_old_paths(shown: Shown, reading: Reading, project: Project) -> None:
    """Once a track is solved again its old path is only compared with: thin, until the next edit or another choice."""
    if shown.before:
        done = {track.id for track in project.document.tracks if reading.track(track).complete}
        shown.compared = {**shown.compared, **{name: path for name, path in shown.before.items() if name in done}}
        shown.before = {track_id: path for track_id, path in shown.before.items() if track_id not in done}
    if shown.compared and project.track_id not in shown.compared:
        shown.compared = {}
