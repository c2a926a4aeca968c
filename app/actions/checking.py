"""What is wrong with a motion: where it drifts from the video, where the mesh is stretched, where it sinks.

What is warned of, and why no more than that: a list in which every small thing stands is not read.

- A point drifts where it is over *both* what is seen (``DRIFT``) and what stands out of this clip (``LOOSE`` times the
  median of all its points and frames): pairs that fit a character loosely are everywhere as loose, and nothing is to
  be found by going from one to the next. Above ``TELLING`` it drifts whatever the others do, so that a motion which is
  wrong as a whole is not excused by its own median.
- Hidden, unsure and user-moved stretches count as nothing: there is no place there to drift from.
- What is shorter than ``BRIEF`` seconds is warned of only at ``FLASH`` times the limit: the eye does not see it else.
- A point, the mesh, the ground are one problem each, at its worst span; the others are counted. They mostly have one
  cause (a pair, a click), and the next check tells whether they went with it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Literal

import attrs
import numpy as np
from numpy.typing import NDArray

from app.actions.session import Session
from app.model.character import Character
from app.stages.results import Animation, Array, World
from imitation.errors import InputError

Kind = Literal["drift", "stretch", "ground", "background", "ambiguous"]
DRIFT = 3.0 / 540.0
"""Share of the picture's height that a vertex may be from its point: 3 pixels of a 540p film, which is seen."""
LOOSE = 6.0
"""Medians that a distance may have: of errors spread evenly round the points, one in a billion is farther away."""
TELLING = 3 * DRIFT
"""Share of the picture's height that no vertex may be from its point: about the width of a paw."""
BRIEF, FLASH = 0.1, 2.0
"""Seconds of which little is seen, and how many times over the limit it must be in them."""
STRETCH = 1.35
"""Edges a third longer, or as much shorter, are seen as such on fur and cloth."""
SUNK = 0.02
"""Share of the character's height that it may lie below the ground: a paw is softer than that."""
FLAT, NEAR = 0.08, 0.12
"""Shares of the character's height: contacts that differ by more stand on steps; so far round a foot a step reaches."""
SURE = 0.5
"""Confidence below which a point is a guess, from which nothing can drift."""
FEW = 0.01
"""Share of the vertices that may be stretched more: single folds in an armpit are not seen."""
JOIN = 2
"""Frames between two bad spans that do not part them."""


@attrs.frozen
class Problem:
    """Something that is over its limit, at the span of frames where it is so most.

    Attributes
    ----------
    kind : what. subject : the point or limb concerned, empty where it is the mesh. vertex : of the mesh.
    first, last : frames. worst : the frame to look at. value, limit : what was measured there, and what may be.
    text : a sentence for people. more : other spans (first, last) in which it is over its limit, in their order.
    """

    kind: Kind
    subject: str
    vertex: int
    first: int
    last: int
    worst: int
    value: float
    limit: float
    text: str
    more: tuple[tuple[int, int], ...] = ()

    @property
    def severity(self) -> float:
        """How many times over the limit."""
        return self.value / self.limit


@attrs.frozen(eq=False)
class Check:
    """A motion, measured.

    Attributes
    ----------
    problems : the worst first, one for each point and each kind.
    drift : track id -> (n,) pixels, NaN where the point is hidden, not sure, or the user moved its vertex.
    limit : pixels.
    stretch : (n, 2) length of edges over that at rest, which all but one vertex in a hundred keep within.
    sunk : (n,) deepest place below the ground, world units; zeros where no ground is known.
    """

    problems: tuple[Problem, ...]
    drift: Mapping[str, Array]
    limit: float
    stretch: Array
    sunk: Array


def drift_limit(session: Session, typical: float = 0.0) -> float:
    """Pixels that a vertex may be from its point, where ``typical`` is the median distance in this motion."""
    clip = session.document.clip
    seen = max(DRIFT * clip.height, 1.0) if clip is not None else 3.0
    return max(seen, min(LOOSE * typical, seen * TELLING / DRIFT))


def drift_in_frame(session: Session, character_id: str, frame: int, vertices: Array) -> dict[int, float]:
    """Pixels between paired vertices of a pose (v, 3) and where their points want them, by vertex.

    Guesses are left out, and so are all where the motion before any edit is not known.
    """
    solved: Any = session.ready(session.stages.base(character_id))
    if solved is None or frame >= len(solved) or len(vertices) != len(solved.rest):
        return {}
    keys = solved.keys
    seen = np.flatnonzero(keys.observed[frame] & (keys.confidence[frame] >= SURE))
    away = solved.cameras[frame].project(vertices[keys.vertices[seen]]) - keys.pixels[frame, seen]
    return dict(zip(keys.vertices[seen].tolist(), np.hypot(*away.T).tolist(), strict=True))


def check_motion(session: Session, character_id: str, *, heard: Callable[[], object] | None = None) -> Check:
    """Measure a whole motion; ``heard`` is called every frame and may raise to stop. It may run in any thread.

    Raises ``InputError`` where the character was not animated.
    """
    from imitation.geometry.stretch import VertexStretch

    document, stages = session.document, session.stages
    character = document.character(character_id)
    animated, solved = session.ready(stages.animation(character_id)), session.ready(stages.base(character_id))
    world = session.ready(stages.world)
    if not isinstance(animated, Animation) or solved is None or not isinstance(world, World):
        raise InputError(f"{character.name} has not been animated yet: animate it, then check it.")
    meter = VertexStretch(solved.rest, solved.faces)  # type: ignore[attr-defined]
    count = len(animated)
    stretch, sunk = np.ones((count, 2)), np.zeros(count)
    where = np.zeros((count, 2), np.int64)
    for frame in range(count):
        if heard is not None:
            heard()
        vertices = animated.vertices[frame]
        values = meter(vertices)
        stretch[frame] = np.quantile(values, (FEW, 1 - FEW))
        where[frame, 0] = int(np.argmax(np.abs(np.log(values))))
        deep = sunk_in_frame(session, world, frame, vertices)
        if deep is not None:
            where[frame, 1] = int(np.argmax(deep))
            sunk[frame] = deep[where[frame, 1]]
    drift = _drift(session, character, solved, animated)
    known = np.concatenate([each[np.isfinite(each)] for each in drift.values()] or [np.zeros(0)])
    limit = drift_limit(session, float(np.median(known)) if len(known) else 0.0)
    brief = BRIEF * (document.clip.fps if document.clip is not None else 0.0)
    names = {track.id: track.name for track in document.tracks}
    height = float(np.ptp(solved.rest[:, 2])) or 1.0  # type: ignore[attr-defined]
    found = _drifting(drift, limit, names, character)
    found += _stretched(stretch, where[:, 0])
    found += _sinking(sunk, SUNK * height, where[:, 1], metric=world.metric)
    found += _colliding(session, character, metric=world.metric)
    found = _gathered([each for each in found if _is_seen(each, brief)] + _ambiguous(session, character))
    order = sorted(found, key=lambda each: (-each.severity, each.first, each.subject))
    return Check(tuple(order), drift, limit, stretch, sunk)


def sunk_in_frame(session: Session, world: World, frame: int, vertices: Array) -> Array | None:
    """How far the vertices (v, 3) of a pose are below the ground (v,), world units; None where no ground is known.

    The ground is as high as the contacts; where they are of different heights, it is known under standing feet only.
    """
    from imitation.geometry.penetration import below_ground

    if session.document.world.ground == "depth":
        return None
    known = [
        each
        for track in session.document.tracks
        if track.contacts and isinstance(placed := session.ready(session.stages.contacts(track.id)), list)
        for each in placed
    ]
    size = float(np.ptp(vertices @ world.normal)) or 1.0
    levels = np.array([float(each.place @ world.normal) for each in known])
    if len(levels) and np.ptp(levels) > FLAT * size:
        # Steps: what is known is the ground under the feet that stand.
        places = [each.place for each in known if each.first <= frame <= each.last]
        return below_ground(vertices, places, world.normal, reach=NEAR * size) if places else np.zeros(len(vertices))
    if len(levels):
        return below_ground(vertices, [world.normal * float(np.median(levels))], world.normal)
    return below_ground(vertices, [world.normal * world.offset], world.normal) if world.grounded else None


def _deep(value: float, metric: bool) -> str:
    return f"{100 * value:.1f} cm" if metric else f"{value:.2g} units"


def _drift(session: Session, character: Character, solved: Any, animated: Animation) -> dict[str, Array]:
    from imitation.motion.rays import project_points

    keys = solved.keys
    away = project_points(solved.cameras, animated.vertices[:, keys.vertices]) - keys.pixels
    sure = keys.observed & (keys.confidence >= SURE)
    for number, name in enumerate(keys.names):
        followed: Any = session.ready(session.stages.track(name))
        if followed is not None and len(followed.state) == len(sure):
            sure[:, number] &= followed.state == "visible"
    pixels = np.where(sure, np.hypot(away[..., 0], away[..., 1]), np.nan)
    moved = {vertex for edit in character.edits.values() for vertex, move in edit.moves.items() if not move.muted}
    columns = {name: pixels[:, number] for number, name in enumerate(keys.names)}
    # Where the user moved the vertex of a point, the point is no longer what the motion should follow.
    return {
        name: np.full(len(pixels), np.nan) if character.pairs.get(name) in moved else column
        for name, column in columns.items()
    }


def spans(bad: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """First and last frame of each run of True (n,); runs that are close are one."""
    frames = np.flatnonzero(bad)
    if not len(frames):
        return []
    parts = np.split(frames, np.flatnonzero(np.diff(frames) > JOIN + 1) + 1)
    return [(int(part[0]), int(part[-1])) for part in parts]


def _when(first: int, last: int) -> str:
    return f"frame {first}" if first == last else f"frames {first}–{last}"


def _is_seen(problem: Problem, brief: float) -> bool:
    """Whether it lasts longer than ``brief`` frames, or is so large that it is seen in fewer."""
    return problem.last - problem.first + 1 > brief or problem.severity >= FLASH


def _gathered(found: list[Problem]) -> list[Problem]:
    """One problem for each point and kind: the worst, with the other spans."""
    groups: dict[tuple[str, str, int], list[Problem]] = {}
    for each in found:
        vertex = each.vertex if each.subject else -1  # two points may bear one name; the mesh is worst here or there
        groups.setdefault((each.kind, each.subject, vertex), []).append(each)
    return [_with_others(group) for group in groups.values()]


def _with_others(group: list[Problem]) -> Problem:
    worst = max(group, key=lambda each: (each.severity, -each.first))
    others = tuple((each.first, each.last) for each in group if each is not worst)
    if not others:
        return worst
    when = _when(worst.first, worst.last)
    many = "once more" if len(others) == 1 else f"{len(others)} times more"
    return attrs.evolve(worst, more=others, text=worst.text.replace(when, f"{when} and {many}", 1))


def _drifting(
    drift: Mapping[str, Array], limit: float, names: Mapping[str, str], character: Character
) -> list[Problem]:
    found = []
    for track, pixels in drift.items():
        for first, last in spans(np.nan_to_num(pixels) > limit):
            worst = first + int(np.nanargmax(pixels[first : last + 1]))
            value, name = float(pixels[worst]), names.get(track, track)
            text = f"{name} drifts {value:.1f} px, {_when(first, last)}"
            vertex = character.pairs.get(track, -1)
            found.append(Problem("drift", name, vertex, first, last, worst, value, limit, text))
    return found


def _stretched(stretch: Array, where: NDArray[np.int64]) -> list[Problem]:
    found, most = [], np.maximum(stretch[:, 1], 1 / np.maximum(stretch[:, 0], 1e-6))
    for first, last in spans(most > STRETCH):
        worst = first + int(np.argmax(most[first : last + 1]))
        value = float(most[worst])
        longer = stretch[worst, 1] >= value - 1e-12
        word = f"stretched to {100 * value:.0f} %" if longer else f"squeezed to {100 / value:.0f} %"
        text = f"Mesh {word}, {_when(first, last)}"
        found.append(Problem("stretch", "", int(where[worst]), first, last, worst, value, STRETCH, text))
    return found


def _sinking(sunk: Array, limit: float, where: NDArray[np.int64], *, metric: bool) -> list[Problem]:
    found = []
    for first, last in spans(sunk > limit):
        worst = first + int(np.argmax(sunk[first : last + 1]))
        value = float(sunk[worst])
        text = f"{_deep(value, metric)} below the ground, {_when(first, last)}"
        found.append(Problem("ground", "", int(where[worst]), first, last, worst, value, limit, text))
    return found


def _colliding(session: Session, character: Character, *, metric: bool) -> list[Problem]:
    """Where the character goes into the measured background, as far as that was computed."""
    met: Any = session.ready(session.stages.penetration(character.id))
    found = []
    for first, last in spans(met.depth > met.tolerance) if met is not None else ():
        worst = first + int(np.argmax(met.depth[first : last + 1]))
        value = float(met.depth[worst])
        text = f"{_deep(value, metric)} inside the background, {_when(first, last)}"
        vertex = int(met.vertex[worst])
        found.append(Problem("background", "", vertex, first, last, worst, value, float(met.tolerance), text))
    return found


def _ambiguous(session: Session, character: Character) -> list[Problem]:
    """Limbs that the video explains in two ways, where somebody has looked and no edit has decided yet."""
    spans_: Any = session.ready(session.stages.ambiguous(character.id))
    names = {track.id: track.name for track in session.document.tracks}
    found = []
    for span in spans_ or ():
        first, last, decide = int(span.first), int(span.last), int(span.decide)
        if any(first <= frame <= last for frame in character.edits):
            continue
        name = names.get(span.name, span.name)
        text = f"{name} may be nearer or farther, {_when(first, last)}: an edit decides"
        vertex = character.pairs.get(span.name, -1)
        found.append(Problem("ambiguous", name, vertex, first, last, decide, 1.0, 1.0, text))
    return found
