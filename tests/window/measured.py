"""The small project with its background measured: the exact depth of the world it was filmed in, put into its place."""

from __future__ import annotations

import numpy as np

from app.actions.session import Session
from imitation.depth import DepthMap
from tests.window.small_project import small_clip

KEYS = (0, 8, 16, 23)


def measure(session: Session) -> None:
    """Put exact depth of some key frames where the engine would leave it; needs solved cameras."""
    clip, stages = small_clip(), session.stages
    path = session.result(stages.cameras)
    session.result(stages.world)
    maps = []
    for frame in KEYS:
        depth = clip.depth(frame).astype(np.float32)
        known = np.isfinite(depth) & (depth < 40)
        sure = np.where(known, 3, 0).astype(np.uint8)
        maps.append(DepthMap(frame, np.where(known, depth, np.float32(np.nan)), sure, path[frame]))  # type: ignore[index]
    session.cache.put(stages.depth, maps)
