"""Where the selected point's contact lies in this frame, and how to put it onto the measured surface."""

from __future__ import annotations

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QHBoxLayout, QVBoxLayout, QWidget

from app.actions.snapping import contact_words
from app.model.tracks import Track
from app.window.background_state import background_state
from app.window.controls import button, icon_button, label
from app.window.project import Project

UNPLACED = "not placed yet"


class ContactInfo(QWidget):
    """Hidden where the point has no contact in the frame. ``asked`` names what is wanted: snap or free.

    off : how far the contact is from the measured surface, in words, where that is known.
    """

    asked = Signal(str)

    def __init__(self) -> None:
        super().__init__()
        self.off = ""
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(6)
        self.text = label("", "label")
        self.text.setWordWrap(True)
        column.addWidget(self.text)
        row = QHBoxLayout()
        row.setSpacing(6)
        self.snap = button("Onto the surface", lambda: self.asked.emit("snap"), name="magnet")
        self.snap.setToolTip("Put the contact where the point meets the measured background in this frame  (S)")
        words = "Forget the place that was given: the ground below the point counts again"
        self.free = icon_button("reset", words, lambda: self.asked.emit("free"))
        row.addWidget(self.snap, 1)
        row.addWidget(self.free)
        column.addLayout(row)
        self.hide()

    def show_contact(self, project: Project, track: Track, frame: int) -> None:
        """Show the contact of a track in a frame."""
        contact = next((each for each in track.contacts if frame in each.span), None)
        self.setVisible(contact is not None)
        if contact is None:
            return
        first, last = contact.span.first, contact.span.last
        where = contact_words(project.session, track.id, frame) or UNPLACED
        off = f"; {self.off}" if self.off else ""
        self.text.setText(f"Contact {first} – {last}: {where}{off}.")
        self.snap.setEnabled(background_state(project).ready)
        self.free.setEnabled(contact.place is not None)
