"""Characters that stand in the filmed scene: hidden by it, shading it, lit and blurred as it is."""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor, wait
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, TypeVar

import attrs
import numpy as np
from numpy.typing import NDArray

from app.actions.moving import Moving, Placed, animated, floor, placed_contacts, solved_world
from app.actions.session import Session
from app.formats import Picture, write_image
from app.formats.atomic import explained
from app.stages.results import World
from app.stages.stage import Stage
from imitation.errors import InputError, NoSolution
from imitation.progress import Progress, silent

if TYPE_CHECKING:
    from imitation.depth import Background
    from imitation.rendering import Look, Matte, Renderer

SHUTTER = 0.5
"""Share of the frame time that a film camera's shutter is usually open."""
GRAIN_FRAMES = 5
MOST_WORKERS = 4
TICK = 0.05
"""Seconds between looks at whether a film is still wanted."""
SheetForm = Literal["png", "exr"]
Given = TypeVar("Given")
Made = TypeVar("Made")


@attrs.frozen
class Standing:
    """How characters are put into the scene.

    Attributes
    ----------
    occlusion : what stands before them hides them. shadow : their shadow falls on the measured background.
    plate : the filmed subject is taken out. remove_shadow : and the shadow that it casts, where it can be told.
    match_light : their light is guessed from the background's brightness and colour.
    shutter : share of the frame time that the shutter is open, 0 for sharp pictures.
    grain : grey levels of noise over them; None: as much as the film has.
    light_turn, light_lift : degrees by which the main light is turned, seen from above clockwise, and raised.
    brightness, shadow_strength : factors on the lights and on how dark shadows are.
    warmth : tone of the lights, -1 blue to 1 amber.
    """

    occlusion: bool = False
    shadow: bool = False
    plate: bool = False
    remove_shadow: bool = False
    match_light: bool = False
    shutter: float = 0.0
    grain: float | None = 0.0
    light_turn: float = 0.0
    light_lift: float = 0.0
    brightness: float = 1.0
    shadow_strength: float = 1.0
    warmth: float = 0.0

    @property
    def needs_depth(self) -> bool:
        """Whether the background must have been measured."""
        return self.occlusion or self.shadow or self.plate or self.match_light

    def stages(self, session: Session) -> tuple[Stage, ...]:
        """The stages that must have run."""
        return (session.stages.depth, session.stages.world) if self.needs_depth else ()


def without_depth(reason: NoSolution) -> NoSolution:
    """Say what a film can still have where the background has no depth."""
    cause = str(reason).split(":")[0].rstrip(".")
    return NoSolution(
        f"{cause}: leave out --occlusion, --shadow, --plate and --match-light; a soft shadow on the ground plane, "
        "--motion-blur and --grain need no depth."
    )


@attrs.frozen(eq=False)
class Back:
    """What characters are put into.

    Attributes
    ----------
    picture : uint8 (h, w, 3). ground : (h, w) depth of what takes the shadow, camera z, or None.
    hides : (h, w) depth of what hides them, NaN where nothing does, or None.
    """

    picture: Picture
    ground: NDArray[np.float32] | None
    hides: NDArray[np.float32] | None


@attrs.frozen(eq=False)
class Composition:
    """Characters in the filmed scene: gives any frame of the film, each by itself and always the same.

    Attributes
    ----------
    film : the frames. background : None where nothing of it is needed. grain : grey levels.
    """

    standing: Standing
    world: World
    film: Any
    background: Background | None
    motions: Sequence[Moving]
    renderers: Sequence[Renderer]
    contacts: Placed
    grain: float

    @classmethod
    def of(cls, session: Session, motions: Sequence[Moving], standing: Standing) -> Composition:
        """Gather what is needed; the stages of ``standing`` must have run."""
        from imitation.rendering import Renderer, grain_of

        world, film = solved_world(session), session.frames()
        background = _background(session, standing) if standing.needs_depth else None
        look = _look(standing, world, film, background)
        renderers = [Renderer(m.faces, film.size, colors=m.colors, look=look, up=world.normal) for m in motions]
        grain = standing.grain
        if grain is None:
            shown = range(0, len(film), max(1, len(film) // GRAIN_FRAMES))
            grain = float(np.median([grain_of(film[frame]) for frame in shown]))
        return cls(standing, world, film, background, motions, renderers, placed_contacts(session), grain)

    def __len__(self) -> int:
        return len(self.motions[0].vertices)

    def frame(self, frame: int, dim: float = 0.0) -> Picture:
        """One frame of the film, what is behind the characters faded by ``dim`` towards grey."""
        from imitation.rendering import add_grain

        back = self.back(frame)
        matte, picture = self._over(frame, back), back.picture
        if dim:
            picture = np.rint(picture + dim * (np.float32(96) - picture)).astype(np.uint8)
        out: Picture = matte.over(picture)
        return add_grain(out, matte.cover, self.grain, frame) if self.grain > 0 else out

    def sheet(self, frame: int) -> Matte:
        """Characters and shadows of one frame on a transparent sheet, with the film's grain."""
        from imitation.rendering import grained

        matte = self._over(frame, self.back(frame))
        return grained(matte, self.grain, frame) if self.grain > 0 else matte

    def back(self, frame: int) -> Back:
        """What is behind and before the characters in a frame."""
        picture, standing = self.film[frame], self.standing
        if self.background is None or not (standing.plate or standing.occlusion or standing.shadow):
            return Back(picture, None, None)
        # Where no frame sees the ground a plate's depth strays; a shadow needs a ground that is whole.
        ground = self.background.everywhere(frame).depth if standing.shadow else None
        if not (standing.plate or standing.occlusion):
            return Back(picture, ground, None)
        from imitation.depth import hiding_depth

        made = self.background.plate(frame)
        hides = hiding_depth(picture, made) if standing.occlusion else None
        return Back(made.picture if standing.plate else picture, ground, hides)

    def _over(self, frame: int, back: Back) -> Matte:
        from imitation.rendering import SINK, Layer, blurred, flattened, ground_shadow

        camera, size = self.world.cameras[frame], self.film.size
        ground = back.ground if self.standing.shadow else floor(self.world, self.contacts, frame)
        layers, reach = [], 0.0
        for moving, renderer in zip(self.motions, self.renderers, strict=True):
            pose = np.ascontiguousarray(moving.vertices[frame], np.float64)
            lights = renderer.lights(pose, camera)
            shadow = None
            if ground is not None:
                shadow = ground_shadow(pose, lights, camera, size, ground, renderer.look, renderer.up)
            drawn = blurred(
                renderer, moving.vertices, frame, camera, lights, shutter=self.standing.shutter,
                cameras=self.world.cameras,
            )  # fmt: skip
            layers.append(Layer(drawn, shadow))
            reach = max(reach, SINK * lights[0].radius)
        return flattened(layers, size[::-1], background=back.hides, tolerance=reach, soft=True)


def composited(session: Session, character_ids: Sequence[str], frame: int, standing: Standing) -> Picture:
    """Give one frame as the film will have it, for a preview.

    Reads results only and may run beside the thread that edits; for many frames keep a ``Composition``. Raises
    ``InputError`` where a character was not animated or the background not measured.
    """
    return Composition.of(session, animated(session, character_ids), standing).frame(frame)


def _background(session: Session, standing: Standing) -> Background:
    from app.actions.backgrounds import solved_background

    return solved_background(session, shadows=standing.plate and standing.remove_shadow)[0]


def _look(standing: Standing, world: World, film: Any, background: Background | None) -> Look:
    """The lights of the whole film: matched where asked, then as the user turns them."""
    from imitation.rendering import Look, adjusted_look, match_look

    look = Look()
    if standing.match_light and background is not None:
        middle = background.maps[len(background.maps) // 2]
        look = match_look(film[middle.frame], middle.depth, middle.camera, up=world.normal)
    return adjusted_look(
        look, world.cameras[0], world.normal, turn=standing.light_turn, lift=standing.light_lift,
        brightness=standing.brightness, shadow=standing.shadow_strength, warmth=standing.warmth,
    )  # fmt: skip


def in_order(
    make: Callable[[Given], Made], frames: Iterable[Given], tick: Callable[[], None] | None = None
) -> Iterator[Made]:
    """Make something of each frame, or of what is given for it, several at once, and give it in their order.

    No more is taken from ``frames`` than is being worked on. ``tick`` is called now and then while a frame is waited
    for; what it raises ends all: what is being worked on then is left to itself, nobody waits for it.
    """
    workers = max(1, min(MOST_WORKERS, os.cpu_count() or 1))
    pool, waiting = ThreadPoolExecutor(workers, "film"), deque[Future[Made]]()
    whole = False
    try:
        for frame in frames:
            waiting.append(pool.submit(make, frame))
            if len(waiting) > workers:
                yield _awaited(waiting.popleft(), tick)
        while waiting:
            yield _awaited(waiting.popleft(), tick)
        whole = True
    finally:
        pool.shutdown(wait=whole, cancel_futures=True)


def _awaited(future: Future[Made], tick: Callable[[], None] | None) -> Made:
    while tick is not None and not wait([future], timeout=TICK).done:
        tick()
    return future.result()


def write_sheets(
    folder: Path,
    sheets: Iterable[Matte],
    count: int,
    progress: Progress | None = None,
    *,
    first: int = 0,
    form: SheetForm = "png",
) -> None:
    """Write sheets as pictures with alpha, numbered from ``first`` on, for a compositing program.

    PNG in sRGB, colours not multiplied by alpha; EXR in linear light, multiplied.
    """
    from app.formats.exr import need_exr, write_exr

    if form == "exr":
        need_exr()
    report = progress or silent
    if folder.exists() and not folder.is_dir():
        raise InputError(f"The pictures cannot be written to {folder}: it is a file, not a folder.")
    with explained(folder):
        folder.mkdir(parents=True, exist_ok=True)
    for done, sheet in enumerate(sheets):
        name = f"{first + done:05d}.{form}"
        if form == "exr":
            write_exr(folder / name, sheet.linear())
        else:
            write_image(folder / name, sheet.rgba())
        report((done + 1) / count)
