"""Stage: how far a character goes into the measured background, frame by frame."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from app.model.character import Character
from app.model.document import Document
from app.model.values import Clip
from app.stages import animation, depth, scene, tracking
from app.stages.context import Context
from app.stages.once import once
from app.stages.results import Animation, Masks, World
from app.stages.stage import Stage
from imitation import CameraPath
from imitation.progress import part

if TYPE_CHECKING:
    from imitation.depth import Penetration

REACH = 0.15
"""How far behind a surface a vertex still counts as inside it, as a share of the character's largest extent."""
SOFT = 0.02
"""What a vertex may be behind it, as a share of the same: depth is no better, and a paw is soft."""
STEP = 4


@once
def penetration(document: Document, character: Character) -> Stage:
    """How far a character goes into the background: needs its motion and the background's depth."""
    name, label = f"penetration/{character.id}", f"Where {character.name} meets the background"
    if document.clip is None:
        return Stage(name, label, _penetration, blocked=tracking.NO_CLIP)
    needs = (
        animation.animation(document, character), depth.depth(document), scene.cameras(document),
        tracking.masks(document), scene.world(document),
    )  # fmt: skip
    return Stage(name, label, _penetration, (document.clip,), needs, 2, weight=6.0)


def _penetration(
    context: Context, inputs: tuple[Clip], moved: Animation, maps: Any, cameras: CameraPath, masks: Masks | None,
    world: World,
) -> Penetration:  # fmt: skip
    from imitation.depth import Collider, joined_mesh, penetration

    context.progress(0.0)
    placed = [depth.map_in_world(each, world) for each in maps]
    mesh = joined_mesh(placed, step=STEP, progress=part(context.progress, 0.0, 0.4))
    size = float(np.ptp(np.asarray(moved.vertices[0]), axis=0).max())
    collider = Collider(mesh, REACH * size)
    return penetration(moved.vertices, collider, tolerance=SOFT * size, progress=part(context.progress, 0.4, 1.0))
