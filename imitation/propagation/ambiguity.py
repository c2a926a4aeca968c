"""Where the base solution could as well be another pose, and which frame's edit decides."""

from __future__ import annotations

import numpy as np

from imitation.motion.ambiguity import AmbiguousSpan, find_ambiguous, limb_parents, spans_of
from imitation.motion.keys import diagonal
from imitation.motion.lifting import LiftSettings, prepare_lift
from imitation.motion.rays import depths_of
from imitation.progress import Progress
from imitation.propagation.base import Base, key_pairs


def ambiguous_spans(base: Base, *, progress: Progress | None = None) -> list[AmbiguousSpan]:
    """Flag limbs and frames whose pose mirrored in depth explains the video about as well.

    Nothing is changed: which of two such poses is the true one the video does not say. The span's ``decide`` is the
    frame whose edit settles most. Meant for bodies seen from in front or at an angle; slow drift of a trunk is no
    mirror image and is not found.

    Returns
    -------
    Spans by key point, in the order of the base solution's names.
    """
    size = diagonal(base.rest)
    # Key points that only follow their mirror have no ray of their own.
    seen = np.flatnonzero(base.keys.observed.any(axis=0))
    pixels, places = base.keys.pixels[:, seen], base.keys.places[:, seen]
    start, lifted = base.keys.start[seen], base.lifted[:, seen]
    anchors = np.where(base.keys.planted[:, seen], depths_of(base.cameras, places), np.nan)
    anchors[0] = base.cameras[0].depth(start)
    pairs = key_pairs(base.rest, base.faces, base.keys.vertices[seen])
    depths = depths_of(base.cameras, lifted)
    prepared = prepare_lift(pixels, base.cameras, start, pairs, size, anchors, None, depths, LiftSettings())
    flags, other = find_ambiguous(*prepared, limb_parents(start, pairs), progress)
    return spans_of(flags, other, tuple(base.keys.names[key] for key in seen), size)
