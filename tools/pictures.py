"""Write docs/pictures/demo.png, the picture on top of the README, from what ``make demo`` left in out/."""

from __future__ import annotations

import sys
from contextlib import closing
from pathlib import Path

import numpy as np

from app.actions.films import still
from app.actions.session import Session
from app.formats import write_image
from imitation.rendering import label, side_by_side

FRAME = 44


def main() -> None:
    """Put the filmed frame, both characters over it and the fox from the side beside each other."""
    import cv2

    project = Path(sys.argv[1] if len(sys.argv) > 1 else "out/sample.motionwright")
    with closing(Session.open(project)) as session:
        filmed = session.frames()[FRAME]
        width = filmed.shape[1]
        shown = {each.name: still(session, each.id, FRAME, ()) for each in session.document.characters}
    over = {name: picture[:, :width] for name, picture in shown.items()}
    tiles = [
        label(filmed, "filmed by hand"),
        *(label(np.ascontiguousarray(picture), f"{name}: moved by the film") for name, picture in over.items()),
        label(np.ascontiguousarray(shown["fox"][:, -width:]), "fox from the side"),
    ]
    tiles = [cv2.resize(tile, (640, 360), interpolation=cv2.INTER_AREA) for tile in tiles]
    target = Path("docs/pictures/demo.png")
    target.parent.mkdir(exist_ok=True)
    write_image(target, side_by_side(tiles, columns=2))
    print(f"Wrote {target}")


if __name__ == "__main__":
    main()
