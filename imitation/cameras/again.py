"""Points found again wherever they should show, so that each is seen from as far apart as the clip allows.

A followed corner is lost after some frames and begun anew, as another point: its rays meet at small angles, and depth
and focal length are weakly fixed. Once all cameras are known, it is also known where the point shows in other frames
and how its patch looks there: the patch of one frame, seen as a small plane that faces that camera, is warped and
fitted (inverse compositional Lucas-Kanade with free gain; Baker & Matthews 2004). All places of a point that are
found at once come from one patch and cannot drift.
"""

from __future__ import annotations

from functools import partial

import attrs
import numpy as np
from numpy.typing import NDArray

from imitation.cameras.adjust import Bundle
from imitation.cameras.clip import Clip
from imitation.cameras.patience import patiently
from imitation.geometry.projection import Array
from imitation.progress import Progress, part, silent

ALIKE = 0.85  # correlation of the fitted patch with the picture
STRAY = 2.5  # pixels from where the cameras say
STRETCH = 1.6  # a patch that is longer or shorter by more looks too different
SMOOTH = 0.7  # pixels: noise and the kinks of bilinear sampling
MOST = 20  # frames a point keeps, evenly spread; more cost an adjustment much and fix the point little better


@attrs.frozen(eq=False)
class _Patches:
    """What each point looks like in the middle one of the frames that saw it.

    Attributes
    ----------
    frame : (p,). pixels : (p, 2), the patch's middle there.
    grey : (p, s, s), the patch, s odd.
    """

    frame: NDArray[np.int64]
    pixels: Array
    grey: NDArray[np.float32]


def _smooth(clip: Clip, frame: int) -> NDArray[np.float32]:
    import cv2

    smooth: NDArray[np.float32] = cv2.GaussianBlur(clip.grey(frame).astype(np.float32), (0, 0), SMOOTH)
    return smooth


def _patches(clip: Clip, bundle: Bundle, progress: Progress) -> _Patches:
    import cv2

    from imitation.cameras.again_kernels import REACH

    ends = np.searchsorted(bundle.point, np.arange(len(bundle.points) + 1))
    middle = (ends[:-1] + ends[1:]) // 2
    frame, pixels = bundle.camera[middle], bundle.pixels[middle]
    size = 2 * REACH + 1
    grey = np.zeros((len(frame), size, size), np.float32)
    for t in range(len(bundle.R)):
        progress(t / len(bundle.R))
        picture = _smooth(clip, t)
        for point in np.flatnonzero(frame == t):
            x, y = pixels[point]
            grey[point] = cv2.getRectSubPix(picture, (size, size), (float(x), float(y)))
    return _Patches(frame, pixels, grey)


@attrs.frozen(eq=False)
class _Views:
    """Where the points show, and how their patches lie there: ``there(t)``."""

    bundle: Bundle
    corners: Array  # (3, p, 3): the patch's middle and one pixel to its right and below, on its plane

    @classmethod
    def of(cls, bundle: Bundle, patches: _Patches) -> _Views:
        R, T = bundle.R[patches.frame], bundle.T[patches.frame]
        depth = np.einsum("nj,nj->n", R[:, 2], bundle.points) + T[:, 2]
        corners = []
        for off in ((0.0, 0.0), (1.0, 0.0), (0.0, 1.0)):
            ray = np.concatenate(
                [(patches.pixels + off - bundle.centre) / bundle.focal, np.ones((len(depth), 1))], axis=1
            )
            corners.append(np.einsum("nji,nj->ni", R, ray * depth[:, None] - T))
        return cls(bundle, np.stack(corners))

    def there(self, t: int) -> tuple[Array, Array, NDArray[np.bool_]]:
        """Pixels (p, 2), the warp (p, 2, 2) from the patch to frame ``t``, and which points lie before the camera."""
        b = self.bundle

        def seen(points: Array) -> tuple[Array, Array]:
            local = points @ b.R[t].T + b.T[t]
            with np.errstate(divide="ignore", invalid="ignore"):
                return b.focal * local[..., :2] / local[..., 2:] + b.centre, local[..., 2]

        pixels, depth = seen(b.points)
        (origin, right, below), around = seen(self.corners)
        warp = np.stack([right - origin, below - origin], axis=2)
        return pixels, warp, (depth > 0) & (around > 0).all(0)


def _shown(clip: Clip, bundle: Bundle, views: _Views) -> NDArray[np.bool_]:
    """Which points should show in which frames (p, n), much as in their patch's."""
    from imitation.cameras.again_kernels import RADIUS

    count, (width, height) = len(bundle.R), clip.working_size
    edge = RADIUS + 2
    shown = np.zeros((len(bundle.points), count), bool)
    for t in range(count):
        pixels, warp, before = views.there(t)
        inside = before & (pixels >= edge).all(1) & (pixels <= np.array([width, height]) - 1 - edge).all(1)
        stretch = np.linalg.svd(np.where(inside[:, None, None], warp, 0.0), compute_uv=False)
        inside &= (stretch[:, 0] < STRETCH) & (stretch[:, 1] > 1 / STRETCH)
        inside &= np.linalg.det(np.where(inside[:, None, None], warp, 1.0)) > 0
        allowed = clip.background(t)
        if allowed is not None:
            here = np.flatnonzero(inside)
            column, row = np.rint(pixels[here]).astype(int).T
            inside[here] = allowed[row, column] > 0
        shown[:, t] = inside
    return shown


def _spread(chosen: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """At most ``MOST`` of each row's chosen frames, evenly spread; rows begin differently, so that no frame is left."""
    total = np.maximum(chosen.sum(1, keepdims=True), 1)
    place = (np.cumsum(chosen, axis=1) + np.arange(len(chosen))[:, None]) * MOST
    kept: NDArray[np.bool_] = chosen & ((total <= MOST) | (place // total != (place - MOST) // total))
    return kept


def found_again(clip: Clip, bundle: Bundle, *, settle: bool, progress: Progress | None = None) -> Bundle:
    """Look for each point in the frames that should show it; give the bundle with the places that were found.

    Parameters
    ----------
    bundle : adjusted, pixels of the working size.
    settle : fit the patch in frames that saw the point already, too, and take those places instead.
    """
    from imitation.cameras.again_kernels import fit

    report = progress or silent
    patches = _patches(clip, bundle, part(report, 0.0, 0.3))
    views = _Views.of(bundle, patches)
    count = len(bundle.R)
    seen = np.zeros((len(bundle.points), count), bool)
    seen[bundle.point, bundle.camera] = True
    own = np.zeros_like(seen)
    own[np.arange(len(seen)), patches.frame] = True
    shown = patiently(partial(_shown, clip, bundle, views), partial(report, 0.3))
    chosen = _spread(shown | seen)
    wanted = chosen & shown & ~own if settle else chosen & ~seen
    cameras, points, places = [], [], []
    for t in range(count):
        report(0.4 + 0.6 * t / count)
        here = np.flatnonzero(wanted[:, t])
        pixels, warp, _ = views.there(t)
        place, alike = np.zeros((len(here), 2)), np.zeros(len(here))
        fit(patches.grey[here], _smooth(clip, t), np.linalg.inv(warp[here]), pixels[here], place, alike)
        good = (alike > ALIKE) & (np.linalg.norm(place - pixels[here], axis=1) < STRAY)
        cameras.append(np.full(int(good.sum()), t))
        points.append(here[good])
        places.append(place[good])
    camera, point = np.concatenate(cameras), np.concatenate(points)
    old = ~np.isin(bundle.point * count + bundle.camera, point * count + camera)
    old &= (chosen | own)[bundle.point, bundle.camera]
    return Bundle.of(
        bundle.focal,
        bundle.centre,
        bundle.R,
        bundle.T,
        bundle.points,
        np.concatenate([bundle.camera[old], camera]),
        np.concatenate([bundle.point[old], point]),
        np.concatenate([bundle.pixels[old], *places]),
    )
