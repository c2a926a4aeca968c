"""The background behind the subject: depth and colour from the frames that see it (paper A, 3.1)."""

from __future__ import annotations

from collections.abc import Sequence
from threading import Lock
from typing import Any

import attrs
import numpy as np
from numpy.typing import ArrayLike, NDArray

from imitation.cameras.path import CameraPath
from imitation.depth.alignment import aligned
from imitation.depth.colours import Lenders, choose_depth, gains, gather
from imitation.depth.depthmap import DepthMap, resized, scaled_camera
from imitation.depth.filling import extended, nearest_of, painted, seamless, touched, voted
from imitation.depth.pictures import GROWTH, Pictures
from imitation.depth.projection import Wanted, consensus, inverse_of, projected_inverse
from imitation.depth.rim import between_parts, depth_along
from imitation.depth.shadow import DARK, darkest_round, round_subject, shadow_of
from imitation.depth.sharpness import LEAST, blurred_alike, ring_of, sharp_first, speeds
from imitation.errors import InputError
from imitation.geometry.projection import Array, Camera

SOURCES = 10  # key frames whose depth is brought to a frame
DONORS = 28  # frames whose colours are looked at, near ones first
APART = 6  # frames: from nearer ones what lies in the subject's shadow is not taken, it is there in them too
SAME = 0.3  # steps of the search; on two clips 0.15 to 1 give the same to 0.1 dB
NEAREST = 8  # of them that see a place give its colour
GROUND = 480  # pixels on the longest side at which depth under a shadow is brought over: shadows are soft
NEARER = 3.0  # steps of the search by which a frame must see something nearer, not to be asked for what lies behind
KEPT = 4  # depths of other frames that stay in memory
UNSURE = -1  # in place of a least confidence: only what no other frame confirms


@attrs.frozen(eq=False)
class Plate:
    """A frame without the subject.

    Attributes
    ----------
    frame : which frame.
    picture : uint8 RGB (h, w, 3).
    depth : of the background everywhere, also behind the subject.
    filled : bool (h, w) where the picture was filled from other frames.
    invented : bool (h, w) where no frame sees the background and it was painted in from around.
    """

    frame: int
    picture: NDArray[np.uint8]
    depth: DepthMap
    filled: NDArray[np.bool_]
    invented: NDArray[np.bool_]


class Background:
    """All that is known of a clip's background: gives any frame's depth and clean plate.

    Parameters
    ----------
    frames : sequence of uint8 RGB (h, w, 3).
    cameras : one a frame.
    maps : depth of the key frames, at the frames' size.
    masks : sequence of bool (h, w), True on the subject and its shadow, or None.
    longest : pixels on the longest side at which depth behind the subject is chosen: half as many again as those at
        which it was measured serve nearly as well as all. None: as large as the frames. Colours are never reduced.
    shadows : plates are without the subject's own shadow too, where the masks leave it out.
    """

    def __init__(
        self,
        frames: Sequence[Any],
        cameras: CameraPath,
        maps: Sequence[DepthMap],
        *,
        masks: Sequence[Any] | None = None,
        longest: int | None = None,
        shadows: bool = False,
    ) -> None:
        if not maps:
            raise InputError("A background needs the depth of at least one frame.")
        if len(cameras) != len(frames):
            raise InputError(f"There are {len(cameras)} cameras for {len(frames)} frames; give one a frame.")
        self.maps = sorted(maps, key=lambda each: each.frame)
        self.pictures = Pictures(frames, cameras, masks, longest=1 << 20)
        if self.maps[0].depth.shape != self.pictures.size[::-1]:
            raise InputError(
                f"The depth maps are {self.maps[0].depth.shape[::-1]} pixels, but the frames are {self.pictures.size}."
            )
        self.shadows = shadows
        self._chosen_at, self._ground_at = self._reduced(longest), self._reduced(GROUND)
        self._last: tuple[DepthMap, ...] = ()  # depths asked for last, of no key frame: their plates ask again
        self._fronts: dict[int, NDArray[np.float32]] = {}
        self._views: dict[tuple[int, bool, tuple[int, int]], Camera] = {}
        self._lock = Lock()
        self._inverse: dict[tuple[int, int, tuple[int, int]], NDArray[np.float32]] = {}
        middle = float(np.nanmedian(self.maps[len(self.maps) // 2].depth))
        self._speed = speeds(cameras, range(len(cameras)), self.pictures.size, middle)
        self.step = float(np.median([each.tolerance * float(np.nanmedian(1 / each.depth)) for each in self.maps]))
        """Difference of inverse depths between two planes of the search, of the middle one of the maps."""
        self.tolerance = SAME * self.step
        """Difference of inverse depths that counts as the same surface."""

    def depth(self, frame: int) -> DepthMap:
        """Depth of any frame as far as the key frames give it: a key frame's own, else by projection (not filled)."""
        for each in (*self.maps, *self._last):
            if each.frame == frame:
                return each
        near = self._nearest(frame, 6)
        layers = np.stack([self._brought(each, frame, 1, self.pictures.size) for each in near])
        rank = 1 / (1 + 0.15 * np.arange(len(near)))
        inverse, support = consensus(layers, self.tolerance, rank.astype(np.float32))
        open_ = inverse <= 0
        if open_.any():
            # Where nothing is confirmed, what the nearest key frames hold is better than nothing.
            asked = Wanted.of(open_)
            spare = np.stack([self._brought(each, frame, UNSURE, self.pictures.size, asked)[open_] for each in near])
            inverse[open_] = consensus(spare[:, None], self.tolerance, rank.astype(np.float32))[0][0]
        made = self._map(frame, inverse, support)
        self._last = (made, *self._last[: KEPT - 1])
        return made

    def plate(self, frame: int) -> Plate:
        """The frame without the subject, with depth everywhere."""
        own = self.depth(frame)
        picture = self.pictures.colour(frame)
        with np.errstate(divide="ignore"):
            inverse = np.nan_to_num(1 / own.depth, nan=0.0).astype(np.float32)
        hole, inverse = self._hole(frame, picture, inverse)
        wanted = hole | (inverse <= 0)
        donors = self._donors(frame)
        lenders = self._lenders(donors, picture, hole, inverse, frame)
        rows, columns = np.nonzero(wanted)
        found = self._behind(frame, wanted, lenders)[rows, columns]
        if hole.any():
            ring = ring_of(hole, inverse > 0)
            lenders = attrs.evolve(lenders, astray=aligned(picture, ring, inverse, self.camera(frame), lenders))

        def coloured(
            rows: NDArray[np.int64], columns: NDArray[np.int64], at: NDArray[np.float32], least: int = 0,
            pictures: NDArray[np.uint8] = lenders.stack,
        ) -> tuple[NDArray[np.float32], NDArray[np.int32]]:  # fmt: skip
            """Colours in the nearest frames that are farther away than ``least``."""
            use = [k for k, donor in enumerate(donors) if abs(donor - frame) > least] or list(range(len(donors)))
            theirs = attrs.evolve(lenders, stack=pictures)
            return gather(
                rows, columns, at, self.camera(frame), theirs if len(use) == len(donors) else theirs.of(use), NEAREST
            )

        colour, seen = coloured(rows, columns, found)
        inverse[rows, columns] = found
        fill = picture.astype(np.float32)
        known = ~wanted
        known[rows[seen > 0], columns[seen > 0]] = True
        lent = hole[rows, columns] & (seen > 0)
        fill[rows[lent], columns[lent]] = colour[lent]
        if self._speed[frame] >= LEAST * max(self.pictures.size) / 960:
            fill = blurred_alike(picture, fill, hole, known, inverse, self.pictures.cameras, frame, coloured)
        filled = np.zeros_like(hole)
        filled[rows[lent], columns[lent]] = True
        if self.shadows:
            shaded, bare = self._shadow(frame, picture, hole, filled, inverse, lenders.stack, coloured)
            dimmed = filled & (fill.sum(axis=-1) < DARK * bare.sum(axis=-1))
            fill[shaded | dimmed] = bare[shaded | dimmed]
            hole, filled = hole | shaded, filled | shaded
        invented = hole & ~filled
        done = picture.copy()
        done[hole] = np.clip(np.rint(fill[hole]), 0, 255).astype(np.uint8)
        done = seamless(picture, painted(done, invented), hole)
        support = np.where(hole, 0, own.confidence).astype(np.uint8)
        support[rows[lent], columns[lent]] = np.minimum(seen[lent], 255)
        inverse = self._carried_on(inverse, invented, self._chosen_at)
        depth = attrs.evolve(self._map(frame, inverse, support), invented=invented)
        return Plate(frame, done, depth, filled, invented)

    def everywhere(self, frame: int) -> DepthMap:
        """Depth of any frame also behind the subject, as far as other key frames see it there; the picture is not read.

        Only depth that at least one other key frame confirms counts, the rest is taken from around: for shadows over
        the frame as it was filmed. A plate chooses behind the subject by colour too.
        """
        own = self.depth(frame)
        weak = ~np.isfinite(own.depth) | (own.confidence == 0)
        if not weak.any():
            return own
        small = touched(weak, self._ground_at)
        asked = Wanted.of(small)
        layers = np.stack([self._brought(each, frame, 1, self._ground_at, asked) for each in self._spread(frame)])
        brought, votes = consensus(layers, self.tolerance)
        found, votes = self._enlarged(brought), nearest_of(votes, self.pictures.size)
        with np.errstate(divide="ignore"):
            inverse = np.nan_to_num(1 / own.depth, nan=0.0).astype(np.float32)
        taken = weak & (found > 0)
        support = np.where(taken, votes, own.confidence).astype(np.uint8)
        left = weak & ~taken
        return self._map(frame, self._carried_on(np.where(taken, found, inverse), left, self._ground_at), support)

    def place(self, frame: int, pixel: ArrayLike, *, radius: float | None = None) -> tuple[Array, float]:
        """Where the ray of a frame's pixel meets the background, seen there or in other frames only; see ``DepthMap``.

        A foot hides the ground it stands on: key frames in which it is elsewhere show it. Only depth that another key
        frame confirms counts.

        Parameters
        ----------
        pixel : (2,) x, y. radius : pixels round it that are asked; None: 8 at a width of 960, at least 4.

        Returns
        -------
        place : (3,) world. residual : rms distance from a plane along the rays, world units.

        Raises
        ------
        NoSolution
            No depth is known round the pixel.
        """
        spot, size = np.asarray(pixel, np.float64), self.pictures.size
        reach = radius or max(4.0, 8 * max(size) / 960)
        wanted = np.zeros(size[::-1], bool)
        if spot.shape == (2,) and np.isfinite(spot).all():
            left, top = np.maximum(np.floor(spot - reach), 0).astype(int)
            right, bottom = np.maximum(np.ceil(spot + reach) + 1, 0).astype(int)
            wanted[top:bottom, left:right] = True
        own = [each for each in self.maps if each.frame == frame]
        sources = own + [each for each in self._spread(frame) if each.frame != frame]
        asked = Wanted.of(wanted)
        layers = np.stack([self._brought(each, frame, 1, size, asked) for each in sources])
        found = self._map(frame, *consensus(layers, self.tolerance))
        return found.place(spot, radius=reach)

    def camera(self, frame: int) -> Camera:
        """A frame's camera."""
        return self.pictures.cameras[frame]

    def _brought(
        self,
        source: DepthMap,
        frame: int,
        least: int,
        size: tuple[int, int],
        wanted: Wanted | None = None,
    ) -> NDArray[np.float32]:
        """Inverse depth (h, w) that a key frame gives to another frame's wanted pixels, at a size (width, height)."""
        inverse = self._known(source, least, size)
        return projected_inverse(inverse, self._view(source, size), self._view(frame, size), size, wanted)

    def _known(self, source: DepthMap, least: int, size: tuple[int, int]) -> NDArray[np.float32]:
        """Inverse depth of a key frame, 0 where it has none of this confidence, at a size; kept."""
        key = source.frame, least, size
        if key not in self._inverse:
            inverse = inverse_of(source, max(least, 0))
            if least == UNSURE:
                inverse[source.confidence > 0] = 0
            self._inverse[key] = resized(inverse, size, 2 * self.tolerance)
        return self._inverse[key]

    def _reduced(self, longest: int | None) -> tuple[int, int]:
        width, height = self.pictures.size
        share = min(1.0, (longest or max(width, height)) / max(width, height))
        return round(share * width), round(share * height)

    def _view(self, seen: DepthMap | int, size: tuple[int, int]) -> Camera:
        """The camera of a key frame's map, or of a frame, for pictures of a size; kept."""
        key = (seen.frame, True, size) if isinstance(seen, DepthMap) else (seen, False, size)
        view = self._views.get(key)
        if view is None:
            view, full = seen.camera if isinstance(seen, DepthMap) else self.camera(seen), self.pictures.size
            if size != full:
                view = scaled_camera(view, (size[0] / full[0], size[1] / full[1]))
            self._views[key] = view
        return view

    def _enlarged(self, inverse: NDArray[np.float32]) -> NDArray[np.float32]:
        """Reduced inverse depths at the size of the frames, edges kept."""
        return resized(inverse, self.pictures.size, 2 * self.tolerance)

    def _carried_on(
        self, inverse: NDArray[np.float32], hole: NDArray[np.bool_], size: tuple[int, int]
    ) -> NDArray[np.float32]:
        """Inverse depth (h, w) everywhere: in the hole, and where there is none, from around, worked out at a size."""
        missing = hole | (inverse <= 0)
        if not missing.any():
            return inverse
        small = touched(hole, size)
        around = self._enlarged(extended(nearest_of(inverse, size), small, small))
        return np.where(missing, around, inverse).astype(np.float32)

    def _map(self, frame: int, inverse: NDArray[np.float32], support: NDArray[np.uint8]) -> DepthMap:
        with np.errstate(divide="ignore"):
            depth = np.where(inverse > 0, 1 / inverse, np.nan).astype(np.float32)
        return DepthMap(frame, depth, support, self.camera(frame), self.maps[0].tolerance)

    def _nearest(self, frame: int, count: int) -> list[DepthMap]:
        return sorted(self.maps, key=lambda each: (abs(each.frame - frame), each.frame))[:count]

    def _donors(self, frame: int) -> list[int]:
        """Frames to take colours from: the near ones, and some over the whole clip; near and sharp ones first."""
        others = [t for t in range(len(self.pictures)) if t != frame]
        others.sort(key=lambda t: (abs(t - frame), t))
        near, rest = others[: DONORS // 2], others[DONORS // 2 :]
        step = max(1, -(-len(rest) // (DONORS - len(near)))) if rest else 1
        chosen, longest = near + rest[::step], max(self.pictures.size)
        return sharp_first(chosen, frame, self._speed[chosen], float(self._speed[frame]), longest)

    def _lenders(
        self, donors: Sequence[int], picture: NDArray[np.uint8], hole: NDArray[np.bool_],
        inverse: NDArray[np.float32], frame: int,
    ) -> Lenders:  # fmt: skip
        """The donors' pictures, as bright as a frame, and what they themselves see in front."""
        stack = np.stack([self.pictures.colour(t) for t in donors])
        hidden = np.stack([self.pictures.hidden(t) for t in donors])
        poses = [self.camera(t) for t in donors]
        scale = gains(picture, hole, inverse, self.camera(frame), stack, hidden, poses)
        front = np.stack([self._front(t) for t in donors])
        return Lenders(stack, hidden, poses, scale, front, NEARER * self.step)

    def _front(self, frame: int) -> NDArray[np.float32]:
        """Inverse depth of what a frame sees, 0 where not known, at a reduced size; kept."""
        front = self._fronts.get(frame)
        if front is None:
            near, size = self._nearest(frame, 4), self._ground_at
            own = [each for each in near if each.frame == frame]
            layers = [self._known(each, 1, size) for each in own] or [
                self._brought(each, frame, 1, size) for each in near
            ]
            front = layers[0] if own else consensus(np.stack(layers), self.tolerance)[0]
            with self._lock:
                # Films are made by several threads.
                while len(self._fronts) >= 3 * DONORS:
                    del self._fronts[next(iter(self._fronts))]
                self._fronts[frame] = front
        return front

    def _hole(
        self, frame: int, picture: NDArray[np.uint8], inverse: NDArray[np.float32]
    ) -> tuple[NDArray[np.bool_], NDArray[np.float32]]:
        """What is to be filled (h, w), less what stands before the subject and parts its mask; and inverse depth."""
        mask, hidden = self.pictures.mask(frame), self.pictures.hidden(frame)
        spared = between_parts(picture, mask, hidden, GROWTH * max(self.pictures.size))
        return (hidden > 0) & ~spared, depth_along(inverse, picture, (hidden > 0) & (mask == 0), spared)

    def _shadow(
        self, frame: int, picture: NDArray[np.uint8], hole: NDArray[np.bool_], filled: NDArray[np.bool_],
        inverse: NDArray[np.float32], stack: NDArray[np.uint8], coloured: Any,
    ) -> tuple[NDArray[np.bool_], NDArray[np.float32]]:  # fmt: skip
        """Where the subject's own shadow lies beside the hole, and what farther frames show (h, w, 3), 0 if none."""
        bare, darkest = np.zeros(picture.shape, np.float32), np.zeros(picture.shape, np.float32)
        known, box = np.zeros_like(hole), round_subject(self.pictures.mask(frame))
        asked = filled.copy()
        asked[box] |= ~hole[box] & (inverse[box] > 0)
        rows, columns = np.nonzero(asked)
        colour, seen = coloured(rows, columns, inverse[asked], APART)
        known[rows, columns] = seen >= 3
        bare[rows, columns] = colour * (seen >= 3)[:, None]
        lowest = np.stack([darkest_round(each) for each in stack])
        darkest[rows, columns], _ = coloured(rows, columns, inverse[asked], APART, lowest)
        shaded, subject = np.zeros_like(hole), hole[box].astype(np.uint8)
        beside = known[box] & ~hole[box]
        shaded[box] = shadow_of(picture[box], bare[box], darkest[box], beside, subject, picture.shape[1])
        return shaded & known & ~hole, bare

    def _behind(self, frame: int, wanted: NDArray[np.bool_], lenders: Lenders) -> NDArray[np.float32]:
        """Inverse depth (h, w) of the pixels wanted, 0 where none is found."""
        sources, size = self._spread(frame), self._chosen_at
        small = touched(wanted, size)
        rows, columns = np.nonzero(small)
        asked = Wanted.of(small)
        loose, firm = (
            np.stack([self._brought(each, frame, least, size, asked)[rows, columns] for each in sources], axis=1)
            for least in (0, 3)
        )
        known = np.stack([self._known(each, 1, size) for each in sources])
        knowing = [self._view(each, size) for each in sources]
        inverse = choose_depth(
            rows, columns, loose, firm, self._view(frame, size), lenders, self.tolerance, known,
            knowing,
        )  # fmt: skip
        found = np.zeros(size[::-1], np.float32)
        found[rows, columns] = voted(inverse, rows, columns, size, self.tolerance)
        return self._enlarged(found)

    def _spread(self, frame: int) -> list[DepthMap]:
        """Key frames that give depth behind the subject: the nearest, and some from farther away on both sides."""
        order = self._nearest(frame, len(self.maps))
        near = order[: SOURCES // 2]
        rest = order[SOURCES // 2 :]
        step = max(1, -(-len(rest) // (SOURCES - len(near))))
        return near + rest[::step]
