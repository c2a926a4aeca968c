"""History: the versions of the document. Undo is going back to one, exact by construction."""

from __future__ import annotations

import attrs

from app.model.document import Document
from app.model.values import ModelError


@attrs.frozen(eq=False)
class Version:
    """One entry of the history.

    Attributes
    ----------
    label : what the person did, as they would say it ("Move left paw, frame 42").
    gesture : entries of one drag or typing share it and become one entry; None stands alone.
    frame : where the edit shows, so that undo can point there.
    """

    document: Document
    label: str
    gesture: str | None = None
    frame: int | None = None


class History:
    """The versions in order, the present one among them, and which of them is saved."""

    def __init__(self, document: Document, label: str = "Open") -> None:
        self._versions = [Version(document, label)]
        self._present = 0
        self._saved: Version | None = self._versions[0]
        self._open_gesture: str | None = None

    @property
    def document(self) -> Document:
        """The present document."""
        return self._versions[self._present].document

    @property
    def versions(self) -> tuple[Version, ...]:
        """All versions, oldest first, those that redo reaches included."""
        return tuple(self._versions)

    @property
    def present(self) -> int:
        """Index of the present version."""
        return self._present

    @property
    def saved(self) -> Version | None:
        """The version that lies in the project folder; None where it was dropped with a cut-off branch."""
        return self._saved

    @property
    def undo_label(self) -> str | None:
        """What undo takes back, None at the beginning."""
        return self._versions[self._present].label if self._present else None

    @property
    def redo_label(self) -> str | None:
        """What redo does again, None at the end."""
        following = self._present + 1
        return self._versions[following].label if following < len(self._versions) else None

    @property
    def modified(self) -> bool:
        """Whether the present version differs from the saved one."""
        return self._versions[self._present] is not self._saved

    def apply(
        self, document: Document, label: str, *, gesture: str | None = None, frame: int | None = None
    ) -> Document:
        """Make a document the present one, as a new entry or as the going-on of the open gesture.

        A document equal in every value makes no entry. A cut-off redo branch is dropped.
        """
        if document is self.document or document == self.document:
            return self.document
        present = self._versions[self._present]
        goes_on = gesture is not None and gesture == self._open_gesture and present.gesture == gesture
        del self._versions[self._present + 1 :]
        version = Version(document, label, gesture, frame)
        if goes_on and self._present:
            if document == self._versions[self._present - 1].document:
                del self._versions[self._present]
                self._present -= 1
            else:
                self._versions[self._present] = version
        else:
            self._versions.append(version)
            self._present += 1
        self._open_gesture = gesture
        return self.document

    def close_gesture(self) -> None:
        """End the open gesture: what follows is a new entry, even under the same gesture name."""
        self._open_gesture = None

    def undo(self) -> Version:
        """Go back one version and give the entry that was taken back."""
        if not self._present:
            raise ModelError("There is nothing to undo.")
        self._open_gesture = None
        taken = self._versions[self._present]
        self._present -= 1
        return taken

    def redo(self) -> Version:
        """Go forward one version and give the entry that was done again."""
        if self._present + 1 >= len(self._versions):
            raise ModelError("There is nothing to redo.")
        self._open_gesture = None
        self._present += 1
        return self._versions[self._present]

    def jump(self, index: int) -> Document:
        """Make the version at this index the present one."""
        if not 0 <= index < len(self._versions):
            raise ModelError(f"There is no version {index} in the history of {len(self._versions)}.")
        self._open_gesture = None
        self._present = index
        return self.document

    def mark_saved(self) -> None:
        """Say that the present version is what lies in the project folder."""
        self._open_gesture = None
        self._saved = self._versions[self._present]
