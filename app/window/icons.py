"""Icons by meaning: every part of the window asks for what it shows, and only this table names the drawings."""

from __future__ import annotations

from functools import cache
from importlib.resources import as_file, files

from PySide6.QtCore import QSize
from PySide6.QtGui import QIcon, QPixmap

from app.window.drawings import Drawing

NAMES = {
    "video": "movie-open-outline",
    "character": "cat",
    "graph": "graph-outline",
    "performance": "graph-outline",
    "undo": "undo",
    "log": "message-text-outline",
    "redo": "redo",
    "cancel": "close-circle-outline",
    "close": "close",
    "export": "export-variant",
    "open": "folder-open-outline",
    "save": "content-save-outline",
    "sample": "movie-star-outline",
    "menu": "menu",
    "select": "cursor-default-outline",
    "lasso": "lasso",
    "point": "crosshairs-gps",
    "contact": "shoe-print",
    "pan": "hand-back-right-outline",
    "keys": "keyboard-outline",
    "first": "skip-previous",
    "previous_mark": "rewind",
    "previous": "step-backward",
    "play": "play",
    "pause": "pause",
    "next": "step-forward",
    "next_mark": "fast-forward",
    "last": "skip-next",
    "fit": "fit-to-screen-outline",
    "fit_time": "arrow-expand-horizontal",
    "paths": "vector-polyline",
    "labels": "tag-outline",
    "magnifier": "magnify-plus-outline",
    "masks": "vector-polygon",
    "onion": "circle-multiple-outline",
    "layers": "layers-triple-outline",
    "hidden": "eye-off-outline",
    "seen": "eye-outline",
    "length": "ruler",
    "ground": "square-opacity",
    "camera": "video-3d",
    "orbit": "orbit",
    "side": "angle-right",
    "grid": "grid",
    "ghosts": "layers-outline",
    "background": "image-outline",
    "wipe": "compare",
    "render": "filmstrip",
    "tracks": "vector-polyline",
    "pose": "human-handsup",
    "solution": "check-circle-outline",
    "reprojection": "chart-line-variant",
    "error": "alert-circle-outline",
    "warning": "alert-outline",
    "note": "information-outline",
    "reset": "restore",
    "delete": "trash-can-outline",
    "rename": "pencil-outline",
    "run": "play",
    "propagate": "arrow-expand-horizontal",
    "go": "arrow-right",
    "add": "plus",
    "copy": "content-copy",
    "paste": "content-paste",
    "gizmo_move": "cursor-move",
    "gizmo_rotate": "rotate-3d-variant",
    "gizmo_scale": "arrow-expand-all",
    "split": "view-split-vertical",
    "fold_away": "chevron-right",
    "unfold": "chevron-left",
    "before": "select-compare",
    "compare": "compare-horizontal",
    "heat": "thermometer",
    "link": "link-variant",
    "unlink": "link-variant-off",
    "history": "history",
    "magnet": "magnet",
    "transition": "transit-connection-variant",
    "key_motion": "key-variant",
    "filter": "filter-variant",
    "forbid": "cancel",
    "loop": "repeat",
    "align": "walk",
    "blend": "blur-linear",
    "hard_cut": "content-cut",
    "sequence": "folder-plus-outline",
    "follow": "run",
    "matrix": "view-grid-outline",
    "textons": "view-week-outline",
    "unfolded": "menu-down",
    "folded": "menu-right",
    "right": "check",
    "add_sequence": "folder-plus-outline",
}


@cache
def icon(name: str, token: str = "text2", checked: str = "accent") -> QIcon:
    """The icon of a meaning in the colour of a token, of another token where it is switched on."""
    return QIcon(Drawing(NAMES[name], token, checked, "line2"))


def pixmap(name: str, token: str = "text2", size: int = 16) -> QPixmap:
    """The same as a picture of a size in pixels."""
    return icon(name, token).pixmap(QSize(size, size))


@cache
def application_icon() -> QIcon:
    """The program's own mark."""
    with as_file(files("resources") / "icons" / "motionwright.svg") as path:
        return QIcon(str(path))
