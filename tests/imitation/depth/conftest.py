"""One small filmed room and its depth, shared by the tests."""

from __future__ import annotations

import attrs
import pytest

from imitation.depth import Background, DepthMap, background_depth
from tests.imitation.depth.scenes import World, filmed_room

KEYS = [0, 3, 6, 9, 12, 15]


@attrs.frozen(eq=False)
class Solved:
    """A filmed room, the depth of its key frames, and all that follows."""

    world: World
    maps: list[DepthMap]
    background: Background


@pytest.fixture(scope="session")
def solved() -> Solved:
    """A room filmed small, in 16 frames over 1.3 m, a blob in front of it."""
    world = filmed_room(3, (256, 144), 16)
    maps = background_depth(world.frames, world.cameras, masks=world.masks, frames_to_solve=KEYS)
    return Solved(world, maps, Background(world.frames, world.cameras, maps, masks=world.masks))
