"""From posed key frames to a pose for every frame: points from followed corners, poses from points."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import attrs
import numpy as np
from numpy.typing import NDArray

from imitation.cameras.follow import Tracks
from imitation.cameras.mapping import Model
from imitation.geometry.projection import Array
from imitation.progress import Progress, silent

Index = NDArray[np.int64]
Pose = tuple[Array, Array]

FEWEST = 12  # points that a pose must agree with
NEAR = 2.0  # pixels
NARROW = np.radians(0.6)  # rays closer than this fix no point


@attrs.frozen(eq=False)
class Sightings:
    """Which corner is seen in which frame where, all frames in one table, sorted by corner, then frame."""

    corner: Index
    frame: Index
    pixels: Array

    @classmethod
    def of(cls, tracks: Tracks) -> Sightings:
        """The table of followed corners."""
        corner = np.concatenate(tracks.ids)
        frame = np.repeat(np.arange(len(tracks)), [len(i) for i in tracks.ids])
        order = np.lexsort((frame, corner))
        return cls(corner[order], frame[order].astype(np.int64), np.concatenate(tracks.pixels)[order])


def triangulate(
    poses: Mapping[int, Pose], focal: float, centre: Array, sightings: Sightings
) -> tuple[Array, NDArray[np.bool_]]:
    """Points (c, 3) nearest to the rays of each corner's posed frames, and which of them are sound.

    Sound: two frames at least, rays ``NARROW`` apart, in front of the cameras, seen within ``NEAR`` pixels.
    """
    corners = int(sightings.corner.max()) + 1 if len(sightings.corner) else 0
    count = int(sightings.frame.max()) + 1 if len(sightings.frame) else 0
    R, T, known = np.zeros((count, 3, 3)), np.zeros((count, 3)), np.zeros(count, bool)
    for posed, (rotation, translation) in poses.items():
        if posed < count:
            R[posed], T[posed], known[posed] = rotation, translation, True
    used = known[sightings.frame]
    corner, frame, pixels = sightings.corner[used], sightings.frame[used], sightings.pixels[used]
    local = np.concatenate([(pixels - centre) / focal, np.ones((len(pixels), 1))], axis=1)
    rays = np.einsum("nji,nj->ni", R[frame], local)
    rays /= np.linalg.norm(rays, axis=1, keepdims=True)
    centres = -np.einsum("nji,nj->ni", R[frame], T[frame])
    across = np.eye(3) - rays[:, :, None] * rays[:, None, :]
    weight = np.ones(len(rays))
    points = np.zeros((corners, 3))
    for _ in range(3):  # the distance to a ray counts by its angle, so nearer cameras count more
        A, b = np.zeros((corners, 3, 3)), np.zeros((corners, 3))
        weighted = across * weight[:, None, None]
        np.add.at(A, corner, weighted)
        np.add.at(b, corner, np.einsum("nij,nj->ni", weighted, centres))
        scale = np.trace(A, axis1=1, axis2=2)[:, None, None] + 1e-12
        points = np.linalg.solve(A / scale + 1e-12 * np.eye(3), b[..., None] / scale)[..., 0]
        weight = 1 / np.maximum(((points[corner] - centres) ** 2).sum(1), 1e-12)
    seen = np.einsum("nij,nj->ni", R[frame], points[corner]) + T[frame]
    with np.errstate(divide="ignore", invalid="ignore"):
        error = np.linalg.norm(focal * seen[:, :2] / seen[:, 2:] + centre - pixels, axis=1)
    bad = ~(error < NEAR) | (seen[:, 2] <= 0)
    sound = np.bincount(corner, minlength=corners) >= 2
    sound &= np.bincount(corner, weights=bad, minlength=corners) == 0
    mean = np.zeros((corners, 3))
    np.add.at(mean, corner, rays)
    mean /= np.maximum(np.linalg.norm(mean, axis=1, keepdims=True), 1e-12)
    spread = np.zeros(corners)
    np.maximum.at(spread, corner, np.linalg.norm(rays - mean[corner], axis=1))
    return points, sound & (2 * spread > NARROW)


def resect(points: Array, pixels: Array, focal: float, centre: Array) -> tuple[Pose, NDArray[np.bool_]] | None:
    """The pose that sees points (k, 3) at pixels (k, 2), and which it agrees with; None where too few do."""
    import cv2

    if len(points) < FEWEST:
        return None
    K = np.array([[focal, 0, centre[0]], [0, focal, centre[1]], [0, 0, 1.0]])
    cv2.setRNGSeed(0)
    try:
        found, turn, shift, inliers = cv2.solvePnPRansac(
            points,
            pixels,
            K,
            None,
            iterationsCount=300,
            reprojectionError=NEAR,
            confidence=0.9999,
            flags=cv2.SOLVEPNP_SQPNP,
        )
    except cv2.error:  # points all but in line: its null space is larger than it allows for
        return None
    if not found or inliers is None or len(inliers) < FEWEST:
        return None
    chosen = inliers.ravel()
    turn, shift = cv2.solvePnPRefineLM(points[chosen], pixels[chosen], K, None, turn, shift)
    R = cv2.Rodrigues(turn)[0]
    seen = points @ R.T + shift.ravel()
    with np.errstate(divide="ignore", invalid="ignore"):
        error = np.linalg.norm(focal * seen[:, :2] / seen[:, 2:] + centre - pixels, axis=1)
    good = (error < NEAR) & (seen[:, 2] > 0)
    if good.sum() < max(FEWEST, 0.25 * len(points)):
        return None
    return (R, shift.ravel()), good


def pose_all(
    model: Model,
    tracks: Tracks,
    centre: Array,
    *,
    rescue: Callable[[int], tuple[Array, Array]] | None = None,
    progress: Progress | None = None,
) -> tuple[dict[int, Pose], list[int]]:
    """Poses of all frames, those next to posed frames first; and the frames that had to be interpolated.

    ``rescue(frame)`` gives points (k, 3) and pixels (k, 2) of a frame in which too few corners survived.
    """
    report = progress or silent
    sightings = Sightings.of(tracks)
    poses = dict(model.poses)
    points, sound = triangulate(poses, model.focal, centre, sightings)
    waiting = [t for t in range(len(tracks)) if t not in poses]
    first, failed = len(waiting), set[int]()
    since = 0
    while waiting:
        frame = min(waiting, key=lambda t: (min(abs(t - p) for p in poses), t))
        waiting.remove(frame)
        report(1 - len(waiting) / first)
        known = sound[tracks.ids[frame]]
        found = resect(points[tracks.ids[frame][known]], tracks.pixels[frame][known], model.focal, centre)
        if found is None and rescue is not None:
            found = resect(*rescue(frame), model.focal, centre)
        if found is None:
            failed.add(frame)
            continue
        poses[frame] = found[0]
        since += 1
        # Beyond the last key frame, and in gaps, new corners must become points before the next frame needs them.
        outside = frame < min(model.poses) or frame > max(model.poses)
        if since >= (3 if outside else 20):
            points, sound = triangulate(poses, model.focal, centre, sightings)
            since = 0
        if not waiting and failed and since:
            waiting, failed, since = sorted(failed), set(), 0
            points, sound = triangulate(poses, model.focal, centre, sightings)
    for frame in sorted(failed):
        poses[frame] = between(poses, frame)
    return poses, sorted(failed)


def between(poses: Mapping[int, Pose], frame: int) -> Pose:
    """The pose of a frame from its nearest posed neighbours: place and turn in between, or that of the only one."""
    from scipy.spatial.transform import Rotation, Slerp

    left = [t for t in poses if t < frame]
    right = [t for t in poses if t > frame]
    if not left or not right:
        return poses[max(left) if left else min(right)]
    a, b = max(left), min(right)
    share = (frame - a) / (b - a)
    R = Slerp([0, 1], Rotation.from_matrix(np.stack([poses[a][0], poses[b][0]])))(share).as_matrix()
    place = (1 - share) * -poses[a][0].T @ poses[a][1] + share * -poses[b][0].T @ poses[b][1]
    return R, -R @ place
