"""The whole way from tracks to a moving character (paper A, 3.2-3.6)."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from imitation.cameras import CameraPath
from imitation.motion.anchors import Loss
from imitation.motion.contacts import Contact
from imitation.motion.symmetry import Mirror
from imitation.progress import Progress, part
from imitation.propagation.base import Method, OnFrame, make_deformer, solve_base
from imitation.propagation.edits import check_places, commit_edit
from imitation.propagation.propagate import Imitation, propagate
from imitation.propagation.start import placed_frame, start_pose

if TYPE_CHECKING:
    from imitation.deformation import Deformer


def imitate(
    vertices: ArrayLike,
    faces: ArrayLike,
    cameras: CameraPath,
    tracks: Mapping[str, ArrayLike],
    pairs: Mapping[str, int],
    contacts: Mapping[str, Sequence[Contact]] | None = None,
    *,
    edits: Mapping[int, Mapping[int, ArrayLike]] | None = None,
    method: Method = "joint",
    confidence: Mapping[str, ArrayLike] | None = None,
    symmetry: Mapping[str, Mirror] | None = None,
    loss: Loss = "quadratic",
    alpha: float = 10.0,
    smooth: bool | None = None,
    muted: Collection[int] = (),
    follow: Mapping[int, str] | None = None,
    end: int | None = None,
    reach: Mapping[int, tuple[int | None, int | None]] | None = None,
    deformer: Deformer | None = None,
    on_frame: OnFrame | None = None,
    progress: Progress | None = None,
) -> Imitation:
    """Move a character as the filmed subject moves.

    Parameters
    ----------
    vertices, faces : the character (v, 3), (m, 3), aligned with the subject in frame 0, world.
    cameras : one camera a frame.
    tracks : name -> (n, 2) pixels, NaN where absent.
    pairs : track name -> vertex.
    contacts : track name -> intervals (first frame, last frame, place (3,) world) in which the point is planted.
    edits : frame -> {vertex: place (3,) world} as the user dragged them. Those of frame 0 pose the character before it
        is solved (`start_pose`), unless ``reach`` or ``end`` says how far they count.
    method : "joint" (default) or "paper", the printed route.
    confidence : track name -> (n,) in [0, 1].
    symmetry : track name -> mirror whose motion it follows where it is hidden, see `solve_base`.
    loss : "robust" lets an anchor's depth change suddenly (eq. 3).
    alpha : depth smoothing of the printed route (eq. 12).
    smooth, follow, end, reach : see `propagate`.
    muted : control vertices whose edits do not count for now.
    deformer : a prepared `Deformer` of this mesh, to be shared between calls.
    on_frame : called with (frame, vertices) as frames of the final pass are ready.

    Returns
    -------
    Imitation
        ``.vertices`` (n, v, 3), ``.key_points`` (n, k, 3), ``.report``.

    Raises
    ------
    InputError
        The parts do not fit each other; one sentence says which and what to do.
    """
    moves = {
        frame: {vertex: place for vertex, place in places.items() if vertex not in muted}
        for frame, places in (edits or {}).items()
    }
    moves = {frame: places for frame, places in moves.items() if places}
    if deformer is None:
        deformer = make_deformer(np.asarray(vertices, np.float64), np.asarray(faces, np.int32))
    share = 0.7 if moves else 1.0
    committed, start = {}, None
    if 0 in moves and 0 not in (reach or {}) and not (end is not None and len(moves) == 1):
        planted = [name for name in pairs if any(not first for first, _, _ in (contacts or {}).get(name, ()))]
        placed = placed_frame(vertices, faces, cameras[0], pairs, planted)
        committed[0] = commit_edit(placed, 0, moves[0], deformer=deformer)
        start = start_pose(placed, committed[0], deformer=deformer).vertices[0]
    base = solve_base(
        vertices, faces, cameras, tracks, pairs, contacts,
        method=method, confidence=confidence, symmetry=symmetry, start=start, loss=loss, alpha=alpha,
        deformer=deformer, progress=part(progress, 0.0, share), on_frame=None if moves else on_frame,
    )  # fmt: skip
    check_places(base, moves)
    for frame, places in moves.items():
        if frame not in committed:
            committed[frame] = commit_edit(base, frame, places, deformer=deformer)
    return propagate(
        base, committed,
        smooth=smooth, follow=follow, end=end, reach=reach, deformer=deformer,
        on_frame=on_frame if moves else None, progress=part(progress, share, 1.0),
    )  # fmt: skip
