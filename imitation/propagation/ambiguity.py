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
    anchors = np.where(base.keys.planted, depths_of(base.cameras, base.keys.places), np.nan)
    anchors[0] = base.cameras[0].depth(base.keys.start)
    depths = depths_of(base.cameras, base.lifted)
    pairs = key_pairs(base.rest, base.faces, base.keys)
    prepared = prepare_lift(
        base.keys.pixels, base.cameras, base.keys.start, pairs, size, anchors, None, depths, LiftSettings()
    )
    parents = limb_parents(base.keys.start, pairs)
    flags, other = find_ambiguous(*prepared, parents, progress)
    return spans_of(flags, other, base.keys.names, size)
