"""Contacts put onto the measured surface: what the drag of an anchor shows, and what it means."""

from __future__ import annotations

from collections.abc import Sequence

from app.actions import snapping
from app.model.edits import contacts
from app.window.background_state import background_state
from app.window.canvas import TrackMark
from app.window.canvas.snap_layer import SnapMark
from app.window.project import Project
from app.window.video.background_layers import BackgroundLayers
from imitation.errors import NoSolution

ANCHOR = "anchor/"
Place = tuple[float, float]


def track_of(owner: str) -> str:
    """The track whose anchor is dragged; empty for anything else."""
    return owner.removeprefix(ANCHOR) if owner.startswith(ANCHOR) else ""


class ContactSnapping:
    """Shows and does the snap of a contact's anchor; the surface comes from the background's layers."""

    def __init__(self, background: BackgroundLayers) -> None:
        self.background = background
        self.dragged: tuple[str, Place] | None = None

    @property
    def possible(self) -> bool:
        """Whether there is a surface to snap to."""
        project = self.background.project
        return project is not None and background_state(project).ready

    def preview(self, frame: int, track_id: str, place: Place) -> SnapMark | None:
        """What is shown of the anchor of a track at a picture place."""
        project = self.background.project
        surface = self.background.surface(frame)
        if project is None or not self.possible:
            return None
        if surface is None:
            return SnapMark(place, "The surface of this frame is made …")
        before = snapping.anchor_pixel(project.session, track_id, frame)
        try:
            found = snapping.snap(surface, place)
        except NoSolution:
            return SnapMark(place, "No surface was measured here", None, before)
        world = project.result(project.session.stages.world)
        return SnapMark(place, snapping.distance_words(found, world), found.disc, before)

    def off(self, frame: int) -> str:
        """How far the selected point's contact lies from the surface; empty where that is not known."""
        project, surface = self.background.project, self.background.surface(frame)
        if project is None or surface is None or not project.track_id:
            return ""
        return snapping.off_words(project.session, project.track_id, frame, surface)

    def put(self, frame: int, track_id: str, place: Place) -> str:
        """Put the contact of a track onto the surface at a picture place; marks one where there is none.

        Gives a sentence where that cannot be.
        """
        project = self.background.project
        surface = self.background.surface(frame)
        if project is None or surface is None:
            return "The surface of this frame is not there yet: try again in a moment."
        try:
            found = snapping.snap(surface, place)
        except NoSolution as reason:
            return str(reason)
        where = tuple(float(value) for value in found.place)
        track = project.document.track(track_id)
        if any(frame in contact.span for contact in track.contacts):
            project.edit(contacts.place_contact, track_id, frame, where)
        else:
            project.edit(contacts.add_contact, track_id, frame, frame, place=where)
        return ""

    def put_selected(self, frame: int, marks: Sequence[TrackMark]) -> str:
        """Put the contact of the selected point onto the surface where the point is; a sentence where that fails."""
        project = self.background.project
        mark = next((each for each in marks if project is not None and each.name == project.track_id), None)
        place = mark.at(frame) if mark is not None else None
        if project is None or mark is None or place is None:
            return "Choose a point first that is in the picture: S then puts its contact onto the surface."
        if not self.possible:
            return "There is no surface yet: measure the background first."
        if self.background.surface(frame) is not None:
            return self.put(frame, mark.name, place)
        self.background.when_surface(frame, lambda: self.put(frame, mark.name, place))
        return "The surface of this frame is made …"


def free(project: Project, track_id: str, frame: int) -> None:
    """Leave a contact to the ground again."""
    project.edit(contacts.place_contact, track_id, frame, None)
