"""What can be done with the thing under the mouse, as a menu with the keys that do the same."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QMenu, QWidget

from app.model.tracks import Track
from app.window.keys import BY_ID, shown_key


def picture_menu(parent: QWidget, do: Callable[[str], object], track: Track | None, part: str, frame: int) -> QMenu:
    """The menu of a point, of a part of a mask, or of the picture."""
    menu = QMenu(parent)
    menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)

    def entry(command: str, text: str = "", on: bool = True) -> None:
        key = shown_key(command)
        action = menu.addAction(f"{text or BY_ID[command].text}\t{key}" if key else text or BY_ID[command].text)
        action.setEnabled(on)
        action.triggered.connect(lambda _=False: do(command))

    if track is not None:
        menu.addSection(track.name)
        planted = any(frame in contact.span for contact in track.contacts)
        hidden = any(frame in interval for interval in track.occluded)
        clicked, gone = frame in track.clicks, any(frame in interval for interval in track.absent)
        entry("contact_here", "No contact in this frame" if planted else "Contact in this frame")
        entry("hide_point", "Not hidden in this frame" if hidden else "Hidden in this frame")
        entry("end_point", "End here", not clicked and not gone and frame > min(track.clicks))
        entry("draw_point", "Do not draw" if track.visible else "Draw again")
        entry("rename_point", "Rename")
        entry("delete", "Remove this click" if clicked and len(track.clicks) > 1 else "Delete point")
    elif part:
        entry("delete", "Remove this corner" if part.startswith("corner") else "Remove this lasso")
        entry("clear_masks")
    else:
        entry("tool_point")
        entry("tool_lasso")
        entry("propose_contacts")
    menu.addSeparator()
    entry("next_problem")
    entry("fit", "Show the whole picture")
    return menu
