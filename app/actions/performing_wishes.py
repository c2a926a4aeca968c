"""What a person can have written of a performance, as one wish and one call."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

import attrs

from app.actions.performing_export import PerformanceForm, export_performance
from app.actions.performing_frames import performance_frames
from app.actions.performing_path import write_path
from app.actions.session import Session
from imitation.errors import InputError
from imitation.progress import Progress, part, silent

WishForm = Literal["ply", "obj", "off", "glb", "npz", "animation", "film", "path"]


@attrs.frozen
class Wish:
    """What shall be written.

    Attributes
    ----------
    form : meshes as in ``export_performance``, a film, or nothing but ``path.json``.
    target : a folder for "ply", "obj", "off" and "glb", else a file.
    blended : with in-betweens at the cuts.
    path : write ``path.json`` too: inside the folder, or beside the file under its name.
    view, turntable, size, marks : of a film, as in ``film_performance``.
    """

    form: WishForm
    target: Path
    blended: bool = True
    path: bool = False
    view: float = 60.0
    turntable: bool = False
    size: tuple[int, int] = (960, 540)
    marks: bool = False

    @property
    def in_folder(self) -> bool:
        """Whether a folder is written."""
        return self.form in ("ply", "obj", "off", "glb")

    @property
    def path_file(self) -> Path:
        """Where ``path.json`` goes."""
        return self.target / "path.json" if self.in_folder else self.target.with_suffix(".path.json")


def write_wish(session: Session, wish: Wish, progress: Progress | None = None) -> str:
    """Write it; gives a sentence on what was written and what could not be kept. Safe in any thread.

    Raises ``InputError`` when the performance has not been composed, or cannot be written so.
    """
    report = progress or silent
    if wish.form == "path":
        write_path(session, wish.target)
        return f"Written: {wish.target.name}."
    most = part(report, 0.0, 0.98 if wish.path else 1.0)
    if wish.form == "film":
        from app.actions.performing_films import film_performance

        note = ""
        film_performance(
            session, wish.target, view=wish.view, turntable=wish.turntable, blended=wish.blended, size=wish.size,
            marks=wish.marks, progress=most,
        )  # fmt: skip
    else:
        form: PerformanceForm = wish.form
        _, note = export_performance(session, wish.target, form=form, blended=wish.blended, progress=most)
    written = [wish.target.name]
    if wish.path:
        write_path(session, wish.path_file)
        written.append(wish.path_file.name)
    return f"Written: {' and '.join(written)}. {note}".strip()


def why_no_animation(session: Session) -> str:
    """Say why the performance cannot be one animated GLB; empty where it can. Safe in any thread."""
    try:
        frames = performance_frames(session, blended=False)
    except InputError as error:
        return str(error)
    return "" if frames.moving else "The frames have faces of their own, which one animated GLB cannot hold."
