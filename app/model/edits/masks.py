"""Edits of the lassos of a key mask: their corners, and each as a whole."""

from __future__ import annotations

import math
from collections.abc import Callable

import attrs

from app.model.document import Document
from app.model.edits.edit import Edit, checked_frame
from app.model.values import KeyMask, Lasso, ModelError, Point2


def insert_lasso_point(document: Document, frame: int, lasso: int, after: int, point: Point2) -> Edit:
    """Add a corner to a lasso behind its corner ``after``."""

    def grown(old: Lasso) -> Lasso:
        _corner(old, after, frame)
        return attrs.evolve(old, points=(*old.points[: after + 1], _finite(point), *old.points[after + 1 :]))

    return _changed(document, frame, lasso, grown, "Add mask point")


def remove_lasso_point(document: Document, frame: int, lasso: int, index: int) -> Edit:
    """Remove a corner of a lasso; three are always left."""

    def smaller(old: Lasso) -> Lasso:
        _corner(old, index, frame)
        if len(old.points) == 3:
            raise ModelError(f"The lasso in frame {frame} has only three points: delete it as a whole.")
        return attrs.evolve(old, points=(*old.points[:index], *old.points[index + 1 :]))

    return _changed(document, frame, lasso, smaller, "Remove mask point")


def move_lasso(document: Document, frame: int, lasso: int, by: Point2) -> Edit:
    """Move a lasso as a whole by pixels."""
    dx, dy = _finite(by)
    return _changed(
        document,
        frame,
        lasso,
        lambda old: attrs.evolve(old, points=tuple((x + dx, y + dy) for x, y in old.points)),
        "Move the lasso",
    )


def remove_lasso(document: Document, frame: int, lasso: int) -> Edit:
    """Remove one lasso; the frame's key mask goes with its last one that adds."""
    key = _key(document, frame, lasso)
    left = key.lassos[:lasso] + key.lassos[lasso + 1 :]
    if any(not each.subtract for each in left):
        masks = document.masks.with_item(frame, attrs.evolve(key, lassos=left))
    else:
        masks = document.masks.without(frame)
    return Edit(attrs.evolve(document, masks=masks), f"Remove the lasso, frame {frame}", frame)


def retime_mask(document: Document, frame: int, to: int) -> Edit:
    """Move the key mask of a frame to another frame that has none."""
    if frame not in document.masks:
        raise ModelError(f"There is no mask drawn in frame {frame}.")
    to = checked_frame(document, to)
    if to in document.masks:
        raise ModelError(f"Frame {to} has a mask already: remove one of the two.")
    masks = document.masks.without(frame).with_item(to, document.masks[frame])
    return Edit(attrs.evolve(document, masks=masks), f"Move the mask from frame {frame} to {to}", to)


def _changed(document: Document, frame: int, lasso: int, change: Callable[[Lasso], Lasso], verb: str) -> Edit:
    key = _key(document, frame, lasso)
    lassos = list(key.lassos)
    lassos[lasso] = change(lassos[lasso])
    masks = document.masks.with_item(frame, attrs.evolve(key, lassos=tuple(lassos)))
    return Edit(attrs.evolve(document, masks=masks), f"{verb}, frame {frame}", frame)


def _key(document: Document, frame: int, lasso: int) -> KeyMask:
    key = document.masks.get(frame)
    if key is None or not 0 <= lasso < len(key.lassos):
        raise ModelError(f"The mask of frame {frame} has no such lasso.")
    return key


def _corner(lasso: Lasso, index: int, frame: int) -> None:
    if not 0 <= index < len(lasso.points):
        raise ModelError(f"The mask of frame {frame} has no such point.")


def _finite(point: Point2) -> Point2:
    x, y = float(point[0]), float(point[1])
    if not (math.isfinite(x) and math.isfinite(y)):
        raise ModelError(f"A mask point must be two finite numbers, but got ({x}, {y}).")
    return x, y
