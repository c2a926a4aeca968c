"""Dense depth of the background (paper A, 3.1): two sweeps over each key frame, the second led by its neighbours."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import attrs
import numpy as np
from numpy.typing import NDArray

from imitation.cameras.path import CameraPath
from imitation.depth.agreement import agreeing
from imitation.depth.checks import Range, check_input, find_range, range_near
from imitation.depth.depthmap import DepthMap, resized
from imitation.depth.edges import with_edges
from imitation.depth.lead import lead
from imitation.depth.pictures import LONGEST, Pictures
from imitation.depth.plain import plain_surfaces, with_planes
from imitation.depth.projection import consensus, projected_inverse
from imitation.depth.semiglobal import semiglobal
from imitation.depth.spans import likely_planes
from imitation.depth.sweep import NEUTRAL, geometry, sweep
from imitation.depth.views import choose_views, key_frames
from imitation.errors import InputError
from imitation.progress import Progress, part, silent

PLANES, PLANES_LARGE = 144, 160
COARSE = 2 / 3  # of the planes, in the first pass, which only leads the second
AVERAGED = 8  # other maps, the nearest in time, that a map is averaged with where they agree
FILLING = 6  # the same that fill in what no view shows
LEADERS = 10  # other maps, the nearest in time, that lead the second pass
STRAYED = 3.0  # steps of the search off the plane of a plain surface that the second pass does not believe
LARGE = 700  # pixels on the longest side from which there are more planes


@attrs.frozen(eq=False)
class Sketch:
    """Depth of one frame after a pass, at working size.

    Attributes
    ----------
    frame : which frame. inverse : float32 (h, w) inverse depth, everywhere.
    seen : bool (h, w) whether any view shows the place; elsewhere it is only what lies around.
    step : difference of inverse depths between two planes of the search.
    """

    frame: int
    inverse: NDArray[np.float32]
    seen: NDArray[np.bool_]
    step: float

    @property
    def measured(self) -> NDArray[np.float32]:
        """Inverse depth (h, w), 0 where no view shows the place."""
        return np.where(self.seen, self.inverse, np.float32(0))


class DepthSolver:
    """Depth of the frames of one clip, a frame at a time: ``first`` for all, then ``second``, then ``finish``.

    Each call depends on its arguments only, so that frames can be spread over machines; threads may share a solver,
    whose frames are then read once.

    Parameters
    ----------
    frames, cameras, masks : see ``background_depth``.
    longest : working size, pixels on the longest side.
    reach : depths to search; found here where None.
    planes : how many depths are tried, evenly spaced in inverse depth.
    progress : of finding the range; may raise ``Cancelled``.
    """

    def __init__(
        self,
        frames: Sequence[Any],
        cameras: CameraPath,
        masks: Sequence[Any] | None = None,
        *,
        longest: int = LONGEST,
        reach: Range | None = None,
        planes: int | None = None,
        progress: Progress = silent,
    ) -> None:
        check_input(frames, cameras, masks)
        self.pictures = Pictures(frames, cameras, masks, longest)
        self.reach = reach or find_range(frames, cameras, masks, progress)
        count = planes or (PLANES_LARGE if max(self.pictures.size) > LARGE else PLANES)
        self._count = count
        self.sigma = 1.0 * max(1.0, max(self.pictures.size) / 480)

    def planes(self, frame: int, share: float = 1.0) -> NDArray[np.float32]:
        """Inverse depths that are tried in a frame, evenly spaced over what is seen near it; or a share of them."""
        reach = range_near(self.pictures.cameras, frame, self.reach)
        return np.linspace(1 / reach.far, 1 / reach.near, round(share * self._count)).astype(np.float32)

    def key_frames(self) -> list[int]:
        """Frames whose depth serves all others."""
        return key_frames(self.pictures.cameras, self.reach.middle)

    def views(self, frame: int, keys: Sequence[int]) -> list[int]:
        """The frames in which a frame's depth is measured."""
        middle = range_near(self.pictures.cameras, frame, self.reach).middle
        return choose_views(self.pictures.cameras, frame, set(keys), self.pictures.full, middle)

    def first(self, frame: int, keys: Sequence[int], progress: Progress = silent) -> Sketch:
        """Depth from the pictures alone; coarse where there are other frames that a second pass can learn from."""
        return self._pass(frame, keys, {}, COARSE if set(keys) - {frame} else 1.0, progress)

    def second(self, frame: int, sketches: Mapping[int, Sketch], progress: Progress = silent) -> Sketch:
        """Depth from the pictures and from what the first pass found in the other frames."""
        return self._pass(frame, list(sketches), sketches, 1.0, progress)

    def finish(self, frame: int, sketches: Mapping[int, Sketch]) -> DepthMap:
        """The depth map of a frame, with the number of the others that agree, at the size of the frames."""
        import cv2

        pictures, sketch = self.pictures, sketches[frame]
        camera = pictures.camera(frame)
        others = [s for f, s in sketches.items() if f != frame]
        count = agreeing(
            sketch.measured, camera, [s.measured for s in others], [pictures.camera(s.frame) for s in others],
            1.5 * sketch.step,
        )  # fmt: skip
        layers = self._layers(frame, others, max(FILLING, AVERAGED))
        inverse, count = self._filled(sketch, count, layers[:FILLING])
        inverse = self._edged(self._averaged(inverse, sketch, layers[:AVERAGED]), frame, list(sketches))
        inverse = resized(inverse, pictures.full, 3 * sketch.step)
        confidence = cv2.resize(count, pictures.full, interpolation=cv2.INTER_NEAREST_EXACT)
        depth = (1 / inverse).astype(np.float32)
        if pictures.masks is not None:
            hidden = np.asarray(pictures.masks[frame]).astype(bool)
            depth[hidden], confidence[hidden] = np.nan, 0
        middle = float(np.median(sketch.inverse))
        return DepthMap(frame, depth, confidence, pictures.cameras[frame], sketch.step / middle)

    def _edged(self, inverse: NDArray[np.float32], frame: int, keys: Sequence[int]) -> NDArray[np.float32]:
        """The same with steps of depth where the pictures have them."""
        pictures, views = self.pictures, self.views(frame, keys)
        hidden = pictures.hidden(frame)
        settled = plain_surfaces(pictures.shown(frame), hidden)[0] > 0
        return with_edges(
            inverse, pictures.colour(frame), hidden, settled, pictures.camera(frame),
            np.stack([pictures.colour(v) for v in views]), np.stack([pictures.hidden(v) for v in views]),
            [pictures.camera(v) for v in views],
        )  # fmt: skip

    def _layers(self, frame: int, others: Sequence[Sketch], most: int) -> NDArray[np.float32]:
        """What the maps nearest in time bring to a frame, nearest first: inverse depths (k, h, w), 0 where none."""
        pictures = self.pictures
        near = sorted(others, key=lambda each: (abs(each.frame - frame), each.frame))[:most]
        layers = np.empty((len(near), *pictures.size[::-1]), np.float32)
        for layer, each in zip(layers, near, strict=True):
            layer[:] = projected_inverse(
                each.measured, pictures.camera(each.frame), pictures.camera(frame), pictures.size
            )
        return layers

    def _averaged(
        self, inverse: NDArray[np.float32], sketch: Sketch, layers: NDArray[np.float32]
    ) -> NDArray[np.float32]:
        """The mean of a map and of what agrees with it in the maps nearest in time.

        What disagrees does not vote: brought from another frame, near surfaces reach over their edges.
        """
        total, number = inverse.copy(), np.ones_like(inverse)
        for layer in layers:
            same = (layer > 0) & (np.abs(layer - inverse) <= 1.5 * sketch.step)
            total[same] += layer[same]
            number[same] += 1
        return total / number

    def _filled(
        self, sketch: Sketch, count: NDArray[np.uint8], layers: NDArray[np.float32]
    ) -> tuple[NDArray[np.float32], NDArray[np.uint8]]:
        """What no view shows, such as the edge of the first picture, from the other maps, where these know it."""
        if sketch.seen.all() or not len(layers):
            return sketch.inverse, count
        brought, support = consensus(layers, 1.5 * sketch.step)
        lent = ~sketch.seen & (brought > 0)
        return np.where(lent, brought, sketch.inverse), np.where(lent, support, count).astype(np.uint8)

    def _pass(
        self, frame: int, keys: Sequence[int], sketches: Mapping[int, Sketch], share: float, progress: Progress
    ) -> Sketch:
        """One pass with a share of the planes, led by what is known of all frames, where there is anything."""
        import cv2

        progress(0.0)
        pictures = self.pictures
        views = self.views(frame, keys)

        def pose(t: int) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
            camera = pictures.camera(t)
            return camera.K, camera.R, camera.T

        planes, signals = self.planes(frame, share), []
        for view in views:
            progress(0.0)  # reading a frame takes a moment: a pass that is no longer wanted ends between two
            signals.append(pictures.signal(view))
        others = [each for each in sketches.values() if each.frame != frame]
        prior = spans = None
        if others:
            nothing = np.zeros(pictures.size[::-1], np.float32)
            prior = np.stack([sketches[v].measured if v in sketches else nothing for v in views])
            layers = self._layers(frame, others, LEADERS)
            own = [sketches[frame].measured] if frame in sketches else []
            spans = likely_planes(np.stack([*layers, *own]), planes) if own else None
            progress(0.01)
        volume = sweep(
            pictures.signal(frame), pictures.hidden(frame), np.stack(signals),
            geometry(pose(frame), [pose(v) for v in views]), planes, prior, self.sigma, spans,
            part(progress, 0.02, 0.75),
        )  # fmt: skip
        untold = volume == NEUTRAL
        if others:
            lead(volume, layers, planes, 1.0)
        picture, hidden = pictures.shown(frame), pictures.hidden(frame)
        calm = cv2.medianBlur(picture, 3)  # single noisy pixels are no edges
        calm[hidden > 0] = 128
        plane = semiglobal(volume, calm, progress=part(progress, 0.78, 0.97))
        # Led by the other maps, single pixels know more than a plane of this frame alone, unless they are far off it.
        plane = with_planes(plane, volume, picture, hidden, STRAYED if others else 0.0)
        step = float(planes[1] - planes[0])
        chosen = np.rint(plane).astype(np.int64)[..., None]
        seen = ~np.take_along_axis(untold, chosen, axis=2)[..., 0]
        return Sketch(frame, (planes[0] + plane * np.float32(step)).astype(np.float32), seen, step)


def background_depth(
    frames: Sequence[Any],
    cameras: CameraPath,
    *,
    masks: Sequence[Any] | None = None,
    frames_to_solve: Sequence[int] | None = None,
    longest: int = LONGEST,
    progress: Progress | None = None,
) -> list[DepthMap]:
    """Dense depth of the static background in a sparse set of frames (paper A, 3.1).

    A plane sweep over up to eight views at several baselines, semi-global matching, then the same again with what
    the other solved frames found as a prior. Differs from Zhang et al. 2009, the paper's reference [33], which
    optimises by belief propagation over all frames.

    Parameters
    ----------
    frames : sequence of uint8 RGB (h, w, 3); read a frame at a time, few are kept.
    cameras : one a frame, pixels of the frames; ``x_cam = R x + T``.
    masks : sequence of bool (h, w), True on the subject and its shadow; left out, and its rim with it.
    frames_to_solve : which frames, or None for key frames chosen by baseline. A lone frame has no others to agree
        with: its confidence is 0.
    longest : larger frames are solved at this size (pixels on the longest side) and the depth brought back.
    progress : gets fractions in [0, 1]; may raise ``Cancelled``.

    Returns
    -------
    list of DepthMap
        ``frame``, ``depth`` (h, w) camera z in world units, NaN under the mask, ``confidence`` (h, w), how many of the
        other solved frames agree; in the order of the frames.

    Raises
    ------
    InputError
        Frames, cameras and masks that do not belong together, or masks that cover everything.
    NoSolution
        No parallax (a camera that stands still or only turns, a flat or infinitely far background).
    """
    report = progress or silent
    report(0.0)
    solver = DepthSolver(frames, cameras, masks, longest=longest)
    chosen = solver.key_frames() if frames_to_solve is None else sorted(set(map(int, frames_to_solve)))
    for frame in chosen:
        if not 0 <= frame < len(frames):
            raise InputError(f"Frame {frame} cannot be solved: the clip has frames 0 to {len(frames) - 1}.")
    steps = [part(report, 0.49 * k / len(chosen), 0.49 * (k + 1) / len(chosen)) for k in range(2 * len(chosen))]
    sketches = {frame: solver.first(frame, chosen, step) for frame, step in zip(chosen, steps, strict=False)}
    if len(chosen) > 1:
        second = zip(chosen, steps[len(chosen) :], strict=True)
        sketches = {frame: solver.second(frame, sketches, step) for frame, step in second}
    maps = [solver.finish(frame, sketches) for frame in chosen]
    report(1.0)
    return maps
