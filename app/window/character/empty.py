"""What the 3D panel shows before there is a character: one sentence, one thing to do."""

from __future__ import annotations

from app.window.controls import Invitation

HOW = "It will move as the filmed subject does. A mesh can be dropped here as well."


class Empty(Invitation):
    """Invites a mesh, and says where points come from while there are none."""

    def __init__(self) -> None:
        super().__init__("character", "Choose a character mesh.", HOW, "No tracks yet: add points in Video (F1).")
        self.choose = self.offer("Choose a mesh…", "add_character", primary=True, icon="character")
        self.sample = self.offer("Open the sample", "sample", icon="sample")

    def show_missing(self, characters: bool, tracks: bool) -> None:
        """Say what there is not yet."""
        self.more[-1].setVisible(not tracks)
