"""Key points: tracks paired with vertices, carried over to the target by their motion gradient (paper A, 3.3)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import attrs
import numpy as np
from numpy.typing import ArrayLike, NDArray

from imitation.cameras import CameraPath
from imitation.errors import InputError
from imitation.motion.anchors import Loss, anchor_depths
from imitation.motion.banded import Array
from imitation.motion.contacts import Contact, contact_places
from imitation.motion.polishing import denoise_tracks
from imitation.motion.rays import lift_points, project_points
from imitation.motion.transfer import transfer_track


@attrs.frozen(eq=False)
class KeyTracks:
    """The target's key points as the video constrains them.

    Attributes
    ----------
    names : names of the paired tracks, k of them.
    vertices : (k,) the paired vertices.
    start : (k, 3) their places in frame 0, world.
    pixels : (n, k, 2) transferred 2D tracks; gaps are filled.
    observed : (n, k) where the source's track is present.
    planted : (n, k) where the key point is in contact.
    places : (n, k, 3) transferred 3D tracks of the anchors (eq. 1-5), world; NaN for key points without contact.
    confidence : (n, k) in [0, 1]; 0 in gaps.
    noise : (k,) jitter that was taken out of the 2D tracks, standard deviation, pixels.
    """

    names: tuple[str, ...]
    vertices: NDArray[np.int64]
    start: Array
    pixels: Array
    observed: NDArray[np.bool_]
    planted: NDArray[np.bool_]
    places: Array
    confidence: Array
    noise: Array

    def __len__(self) -> int:
        return len(self.names)


def key_tracks(
    vertices: Array,
    cameras: CameraPath,
    tracks: Mapping[str, ArrayLike],
    pairs: Mapping[str, int],
    contacts: Mapping[str, Sequence[Contact]],
    *,
    confidence: Mapping[str, ArrayLike] | None = None,
    beta: float = 1e-4,
    loss: Loss = "quadratic",
    denoise: bool = True,
) -> KeyTracks:
    """Carry the tracks of all pairs to the target: 2D tracks by eq. 5 in the picture, anchors by eq. 5 in space.

    With ``denoise`` the tracks are freed of their jitter first; else that of frame 0 is carried through the clip.
    Frame 0 is the boundary value (eq. 6): there each key point is at its vertex. An anchor whose point is not in
    contact in frame 0 takes the vertex's depth there, else eq. 5 would carry an arbitrary offset through the clip.
    """
    count = len(cameras)
    names = tuple(pairs)
    _check_pairs(vertices, count, tracks, pairs, contacts)
    start = vertices[[pairs[name] for name in names]]
    source = np.stack([np.asarray(tracks[name], np.float64) for name in names], axis=1)
    observed: NDArray[np.bool_] = np.asarray(np.isfinite(source).all(axis=2))
    for name, present in zip(names, observed[0], strict=True):
        if not present:
            raise InputError(f'Track "{name}" has no position in frame 0; click the point there, or unpair it.')
    trust = _confidences(names, observed, confidence or {})
    filled = fill_gaps(source, observed)
    first = cameras[0].project(start)
    if not np.isfinite(first).all():
        hidden = names[int(np.argmin(np.isfinite(first).all(axis=1)))]
        raise InputError(
            f'The vertex of "{hidden}" is behind the camera in frame 0; align the character with the subject.'
        )
    noise = np.zeros(len(names))
    if denoise:
        filled, noise = denoise_tracks(filled, cameras, cameras[0].depth(start), diagonal(vertices), observed, trust)
    pixels = np.empty_like(filled)
    planted = np.zeros((count, len(names)), bool)
    places = np.full((count, len(names), 3), np.nan)
    for key, name in enumerate(names):
        if contacts.get(name):
            touched = contact_places(contacts[name], count, name)
            planted[:, key] = np.isfinite(touched).all(axis=1)
            anchored = _anchor_track(filled[:, key], cameras, touched, start[key], beta, loss)
            places[:, key] = transfer_track(anchored, {0: start[key]})
            pixels[:, key] = _project(cameras, places[:, key], name)
        else:
            pixels[:, key] = transfer_track(filled[:, key], {0: first[key]})
    keys = np.array([pairs[name] for name in names], np.int64)
    return KeyTracks(names, keys, start, pixels, observed, planted, places, trust, noise)


def diagonal(vertices: Array) -> float:
    """Length of the bounding box's diagonal, the unit of all weights."""
    return float(np.linalg.norm(np.ptp(vertices, axis=0)))


def fill_gaps(pixels: Array, observed: NDArray[np.bool_]) -> Array:
    """Bridge the gaps of 2D tracks (n, k, 2): linear in the offset from the centre of the tracks without gaps."""
    if observed.all():
        return pixels
    frames = np.arange(len(pixels))
    whole = observed.all(axis=0)
    centre = pixels[:, whole].mean(axis=1) if whole.any() else np.zeros((len(pixels), 2))
    filled = pixels.copy()
    for key in np.flatnonzero(~whole):
        present = observed[:, key]
        for axis in range(2):
            offset = pixels[present, key, axis] - centre[present, axis]
            filled[~present, key, axis] = centre[~present, axis] + np.interp(frames[~present], frames[present], offset)
    return filled


def _anchor_track(track: Array, cameras: CameraPath, touched: Array, start: Array, beta: float, loss: Loss) -> Array:
    """The anchor's 3D track (n, 3) of the source; a contact is one place in all its frames."""
    known = {int(frame): touched[frame] for frame in np.flatnonzero(np.isfinite(touched).all(axis=1))}
    if 0 not in known:
        known[0] = cameras[0].lift(track[0], cameras[0].depth(start))
    depth = anchor_depths(track, cameras, known, beta=beta, loss=loss)
    points = lift_points(cameras, track[:, None], depth[:, None])[:, 0]
    planted = np.isfinite(touched).all(axis=1)
    points[planted] = touched[planted]
    return points


def _project(cameras: CameraPath, points: Array, name: str) -> Array:
    pixels = project_points(cameras, points[:, None])[:, 0]
    if not np.isfinite(pixels).all():
        frame = int(np.argmin(np.isfinite(pixels).all(axis=1)))
        raise InputError(f'The anchor "{name}" passes behind the camera in frame {frame}; check its contacts.')
    return pixels


def _confidences(names: tuple[str, ...], observed: NDArray[np.bool_], confidence: Mapping[str, ArrayLike]) -> Array:
    trust = np.ones(observed.shape)
    for key, name in enumerate(names):
        if name in confidence:
            given = np.asarray(confidence[name], np.float64)
            if given.shape != (len(observed),):
                raise InputError(f'The confidence of "{name}" needs one number a frame, but has shape {given.shape}.')
            trust[:, key] = np.clip(np.nan_to_num(given), 0, 1)
    trust[~observed] = 0
    return trust


def _check_pairs(
    vertices: Array,
    count: int,
    tracks: Mapping[str, ArrayLike],
    pairs: Mapping[str, int],
    contacts: Mapping[str, Sequence[Contact]],
) -> None:
    if not pairs:
        raise InputError("No track is paired with a vertex; pair at least three tracks with the character.")
    used: dict[int, str] = {}
    for name, vertex in pairs.items():
        if name not in tracks:
            raise InputError(f'Pair "{name}" names no track; the tracks are {", ".join(sorted(tracks)) or "none"}.')
        if not 0 <= vertex < len(vertices):
            raise InputError(
                f'"{name}" is paired with vertex {vertex}, but the character has {len(vertices)} vertices.'
            )
        if vertex in used:
            raise InputError(f'"{used[vertex]}" and "{name}" are paired with the same vertex {vertex}; keep one pair.')
        used[vertex] = name
        shape = np.shape(tracks[name])
        if len(shape) != 2 or shape[1] != 2:
            raise InputError(f'Track "{name}" needs shape (frames, 2), but has {shape}.')
        if shape[0] != count:
            raise InputError(
                f'Track "{name}" has {shape[0]} frames but there are {count} cameras; both need one a frame.'
            )
    for name in contacts:
        if contacts[name] and name not in tracks:
            raise InputError(f'The contacts of "{name}" belong to no track; track that point or remove them.')
