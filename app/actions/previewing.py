"""One frame of a film before it is written; what does not change from look to look is kept."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import attrs

from app.actions.background_views import BackgroundViews, Kind
from app.actions.compositing import Composition, Standing
from app.actions.films import comparison_frame, film_frame
from app.actions.moving import animated
from app.actions.rendering import FilmOrder
from app.actions.session import Session
from app.formats import Picture

if TYPE_CHECKING:
    from imitation.depth import Background, DepthMap, Plate

KEPT = 6


class Remembered:
    """A background whose plates and depths of the last frames are kept: light is turned more often than time."""

    def __init__(self, known: Background) -> None:
        self.known, self.maps = known, known.maps
        self._made: OrderedDict[tuple[str, int], Any] = OrderedDict()

    def plate(self, frame: int) -> Plate:
        """The frame without the subject."""
        made: Plate = self._once("plate", frame)
        return made

    def everywhere(self, frame: int) -> DepthMap:
        """Depth of a frame, also behind the subject."""
        made: DepthMap = self._once("everywhere", frame)
        return made

    def _once(self, what: str, frame: int) -> Any:
        key = (what, frame)
        if key not in self._made:
            self._made[key] = getattr(self.known, what)(frame)
        self._made.move_to_end(key)
        while len(self._made) > KEPT:
            self._made.popitem(last=False)
        return self._made[key]


class Previewer:
    """Makes frames of a film as they will be written; belongs to one thread."""

    def __init__(self) -> None:
        self._background: tuple[tuple[str, ...], Remembered] | None = None
        self._scene: tuple[Any, Composition] | None = None
        self._views: tuple[tuple[str, ...], BackgroundViews] | None = None

    def picture(self, session: Session, order: FilmOrder, frame: int) -> Picture:
        """One frame; for pictures with alpha the characters and their shadows over a chequered ground.

        Raises ``InputError`` where a result that it needs is missing.
        """
        scene = self._composition(session, order)
        if order.alpha:
            return chequered(scene.sheet(frame).rgba())
        return film_frame(session, scene, frame, view=order.view, dim=order.dim, points=order.points)

    def comparison(self, session: Session, character_id: str, variants: Sequence[str], frame: int) -> Picture:
        """One frame of a comparison, with those of the variants that are computed."""
        there = [each for each in variants if session.stages.comparison(character_id, each) in session.cache]
        return comparison_frame(session, character_id, frame, there)

    def background(self, session: Session, kind: Kind, frame: int) -> Picture:
        """One frame of the plate, or of the depth in false colour."""
        stages = session.stages
        key = (stages.depth.key, stages.world.key, stages.masks.key)
        if self._views is None or self._views[0] != key:
            self._views = (key, BackgroundViews(session))
        return self._views[1].view(kind, frame).picture

    def _composition(self, session: Session, order: FilmOrder) -> Composition:
        keys = tuple(stage.key for stage in order.stages(session))
        key = (keys, session.stages.world.key, order.standing, order.characters)
        if self._scene is not None and self._scene[0] == key:
            return self._scene[1]
        scene = Composition.of(session, animated(session, order.characters), order.standing)
        if scene.background is not None:
            scene = attrs.evolve(scene, background=self._remembered(session, scene.background))
        self._scene = (key, scene)
        return scene

    def _remembered(self, session: Session, known: Background) -> Any:
        stages = session.stages
        key = (stages.depth.key, stages.world.key, stages.masks.key, str(known.shadows))
        if self._background is None or self._background[0] != key:
            self._background = (key, Remembered(known))
        return self._background[1]


def lacking(session: Session, order: FilmOrder) -> str:
    """What a film has to wait for: motion, motion of some of the characters, background, or nothing."""
    missing = [each for each in order.characters if session.stages.animation(each) not in session.cache]
    if missing or not order.characters:
        return "some motion" if len(missing) < len(order.characters) else "motion"
    return "background" if any(each not in session.cache for each in order.stages(session)) else ""


def within_reach(session: Session, order: FilmOrder) -> FilmOrder | None:
    """As much of an order as can be shown from the results that are there; None where nothing can."""
    there = tuple(each for each in order.characters if session.stages.animation(each) in session.cache)
    if not there:
        return None
    order = attrs.evolve(order, characters=there)
    return without_background(order) if lacking(session, order) == "background" else order


def without_background(order: FilmOrder) -> FilmOrder:
    """The same order as far as it can be had before the background is measured."""
    plain = attrs.evolve(order.standing, occlusion=False, shadow=False, plate=False, match_light=False)
    assert isinstance(plain, Standing)
    return attrs.evolve(order, standing=plain)


def chequered(sheet: Picture, cell: int = 12) -> Picture:
    """A picture with alpha (h, w, 4) over a chequered ground, to be looked at."""
    import numpy as np

    rows, columns = np.indices(sheet.shape[:2]) // cell
    ground = np.where((rows + columns) % 2, 96, 128).astype(np.float32)[..., None]
    alpha = sheet[..., 3:].astype(np.float32) / 255
    done: Picture = np.rint(alpha * sheet[..., :3] + (1 - alpha) * ground).astype(np.uint8)
    return done
