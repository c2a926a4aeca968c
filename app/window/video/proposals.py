"""Contacts that the program proposes: kept beside the document until they are accepted."""

from __future__ import annotations

from app.actions import proposing
from app.model.edits import contacts
from app.model.values import Interval
from app.window.project import Project
from imitation.errors import InputError


class ContactProposals:
    """What was proposed for one project."""

    def __init__(self) -> None:
        self.found: dict[str, list[Interval]] = {}

    def find(self, project: Project) -> str:
        """Look for contacts in all tracks that are followed; gives a sentence that says what was found."""
        self.found, reason = {}, ""
        for track in project.document.tracks:
            try:
                spans = proposing.proposed_contacts(project.session, track.id)
            except InputError as error:
                reason = str(error)
                continue
            if spans:
                self.found[track.id] = spans
        count = self.count(project)
        if count:
            return f"{count} contacts proposed, hatched in the timeline: double-click accepts one, Shift+Return all."
        return reason or "No further contacts were found."

    def open(self, project: Project) -> dict[str, list[Interval]]:
        """Those of tracks that are still there and not marked yet."""
        tracks = {track.id: track for track in project.document.tracks}
        return {
            name: left
            for name, spans in self.found.items()
            if name in tracks and (left := [span for span in spans if not contacts.marked(tracks[name], span)])
        }

    def count(self, project: Project) -> int:
        """How many are open."""
        return sum(len(spans) for spans in self.open(project).values())

    def accept(self, project: Project) -> str:
        """Accept all that are open as one entry; gives a sentence."""
        count = proposing.accept_all(project.session, self.open(project))
        return f"{count} contacts accepted." if count else "No contacts are proposed."
