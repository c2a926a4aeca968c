"""The measured background as pictures to look at, frame by frame: depth, how sure it is, and the clean plate."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import attrs
import numpy as np
from numpy.typing import NDArray

from app.actions.session import Session
from app.formats import Picture

if TYPE_CHECKING:
    from imitation.depth import DepthMap

Kind = Literal["depth", "confidence", "plate"]
SHADES = 128
MOST = 5
"""Key frames beside a depth's own that agree with it, from which on it looks as sure as it can."""
UNKNOWN = 70


@attrs.frozen(eq=False)
class Legend:
    """What the colours of a view stand for.

    Attributes
    ----------
    title : of the scale. colours : uint8 RGB (1, n, 3), left to right. ticks : share of the width and its text.
    """

    title: str
    colours: Picture
    ticks: tuple[tuple[float, str], ...]


@attrs.frozen(eq=False)
class View:
    """One frame of a view.

    Attributes
    ----------
    kind, frame : what it shows. picture : uint8 RGB (h, w, 3).
    invented : bool (h, w) where a plate was painted in because no frame sees the place; None where nothing was.
    note : a few words on how good it is.
    """

    kind: Kind
    frame: int
    picture: Picture
    invented: NDArray[np.bool_] | None = None
    note: str = ""


class BackgroundViews:
    """Makes views of a background that was measured; belongs to one thread.

    Raises ``InputError`` when the background was not measured yet.
    """

    def __init__(self, session: Session) -> None:
        from app.actions.backgrounds import solved_background

        self.known, self.world = solved_background(session)
        z = np.concatenate([each.depth[np.isfinite(each.depth)][::37] for each in self.known.maps])
        near, far = np.percentile(z, [1, 99]) if len(z) else (1.0, 2.0)
        self.near, self.far = float(near), max(float(far), 1.001 * float(near))
        self.top = max(1, min(MOST, len(self.known.maps) - 1))

    def view(self, kind: Kind, frame: int) -> View:
        """One frame of a view."""
        if kind == "plate":
            return self._plate(frame)
        known = self.known.depth(frame)
        whole = np.isfinite(known.depth)
        if kind == "depth":
            from app.actions.backgrounds import false_colour

            picture = false_colour(known.depth, self.near, self.far)
            return View(kind, frame, picture, note=f"{100 * whole.mean():.0f} % of the picture measured")
        sure = known.sure()
        note = f"{100 * sure.sum() / max(1, whole.sum()):.0f} % confirmed by two frames or more"
        return View(kind, frame, certainty(known.confidence, whole, self.top), note=note)

    def _plate(self, frame: int) -> View:
        made = self.known.plate(frame)
        hole = int(made.filled.sum() + made.invented.sum())
        if not hole:
            return View("plate", frame, made.picture, note="nothing is masked in this frame")
        filled = 100 * float(made.filled.sum()) / hole
        painted = f", {100 - filled:.1f} % painted in" if made.invented.any() else ""
        invented = made.invented if made.invented.any() else None
        return View("plate", frame, made.picture, invented, f"{filled:.1f} % seen in other frames{painted}")

    def legend(self, kind: Kind) -> Legend | None:
        """What the colours of a view stand for; a plate has the film's own."""
        if kind == "depth":
            from app.actions.backgrounds import false_colour

            inverse = np.linspace(1 / self.near, 1 / self.far, SHADES)
            unit = " m" if self.world.metric else ""
            ticks = tuple((share, f"{1 / inverse[round(share * (SHADES - 1))]:.3g}{unit}") for share in (0.0, 0.5, 1.0))
            title = "Distance" if self.world.metric else "Distance, scale unknown"
            return Legend(title, false_colour((1 / inverse)[None], self.near, self.far), ticks)
        if kind == "confidence":
            levels = np.minimum(np.arange(SHADES) * (self.top + 1) // SHADES, self.top).astype(np.uint8)[None]
            ends = ((0.0, "0"), (1.0, f"{self.top} or more" if self.top > 1 else "1"))
            return Legend("Frames that agree", certainty(levels, np.ones(levels.shape, bool), self.top), ends)
        return None

    def surface(self, frame: int) -> DepthMap:
        """What a contact may be put on: depth that other frames confirm, also behind the subject; NaN elsewhere."""
        known = self.known.everywhere(frame)
        return attrs.evolve(known, depth=np.where(known.confidence > 0, known.depth, np.float32(np.nan)))


def certainty(confidence: NDArray[np.uint8], known: NDArray[np.bool_], top: int) -> Picture:
    """How many frames agree (h, w) as a picture: violet none, yellow ``top`` or more, grey where nothing is known."""
    import cv2

    shades = np.rint(255.0 * np.minimum(confidence, top) / top).astype(np.uint8)
    picture: Picture = cv2.applyColorMap(shades, cv2.COLORMAP_VIRIDIS)[..., ::-1].copy()
    picture[~known] = UNKNOWN
    return picture
