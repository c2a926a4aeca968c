"""The paper's comparisons, from the same base solution and edits."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Literal, get_args

import numpy as np
from numpy.typing import ArrayLike

from imitation.errors import InputError
from imitation.motion.banded import Array
from imitation.progress import Progress, silent
from imitation.propagation.base import Base, make_deformer
from imitation.propagation.edits import check_places, edited_pose
from imitation.propagation.propagate import propagate

if TYPE_CHECKING:
    from imitation.deformation import Deformer

Variant = Literal["naive_tracks", "first_pass", "key_poses", "anchors_only"]


def compare(
    base: Base,
    edits: Mapping[int, Mapping[int, ArrayLike]],
    variant: Variant,
    *,
    deformer: Deformer | None = None,
    progress: Progress | None = None,
) -> Array:
    """Animate the character as the paper's comparisons do.

    Parameters
    ----------
    base : the base solution.
    edits : frame -> committed positions, as for `propagate`.
    variant :
        "naive_tracks" - key points run straight from edited frame to edited frame, their motion is lost (Fig. 5 c);
        "first_pass" - control vertices without a track are left out (Fig. 9 d-f);
        "key_poses" - the edited poses are interpolated by differential coordinates, the video is not used (Fig. 12 c);
        "anchors_only" - 3D anchors without 2D tracks (Fig. 14 b).

    Returns
    -------
    (n, v, 3) vertices, world.

    Raises
    ------
    InputError
        An unknown variant, no edited frame for "naive_tracks" or "key_poses", no anchor for "anchors_only".
    """
    if variant not in get_args(Variant):
        raise InputError(f'There is no comparison "{variant}"; choose one of {", ".join(get_args(Variant))}.')
    check_places(base, edits)
    deformer = deformer or make_deformer(base.rest, base.faces)
    if variant == "first_pass":
        return propagate(base, edits, two_pass=False, deformer=deformer, progress=progress).vertices
    if variant == "anchors_only":
        return _anchors_only(base, deformer, progress or silent)
    if not any(edits.values()):
        raise InputError(f'The comparison "{variant}" needs at least one edited frame; edit a pose first.')
    poses = {0: base.vertices[0]}
    poses |= {f: edited_pose(base, f, edits[f], deformer=deformer) for f in sorted(edits) if edits[f]}
    if variant == "naive_tracks":
        return _naive_tracks(base, poses, deformer, progress or silent)
    from imitation.propagation.key_poses import interpolate_poses

    return interpolate_poses(base.rest, base.faces, poses, len(base), progress)


def _naive_tracks(base: Base, poses: Mapping[int, Array], deformer: Deformer, report: Progress) -> Array:
    frames = sorted(poses)
    keys = base.keys.vertices
    corners = np.stack([poses[frame][keys] for frame in frames])
    time = np.arange(len(base))
    tracks = np.empty((len(base), len(keys), 3))
    for key in range(len(keys)):
        for axis in range(3):
            tracks[:, key, axis] = np.interp(time, frames, corners[:, key, axis])
    result = np.empty_like(base.vertices)
    pose = base.vertices[0]
    for frame in range(len(base)):
        report(frame / len(base))
        points = dict(zip(keys.tolist(), tracks[frame], strict=True))
        pose = deformer.solve(points, start=pose)
        result[frame] = poses.get(frame, pose)
    report(1.0)
    return result


def _anchors_only(base: Base, deformer: Deformer, report: Progress) -> Array:
    anchored = np.flatnonzero(base.keys.planted.any(axis=0))
    if not len(anchored):
        raise InputError('The comparison "anchors_only" needs a track with contacts; mark a contact first.')
    places = base.keys.places[:, anchored]
    result, pose = np.empty_like(base.vertices), base.vertices[0]
    for frame in range(len(base)):
        report(frame / len(base))
        points = dict(zip(base.keys.vertices[anchored].tolist(), places[frame], strict=True))
        pose = deformer.solve(points, start=pose)
        result[frame] = pose
    report(1.0)
    return result
