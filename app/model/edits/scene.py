"""Edits of the clip, masks, cameras, ground, scale and names."""

from __future__ import annotations

import math
from collections.abc import Iterable

import attrs

from app.model.document import Document
from app.model.edits.edit import Edit, checked_frame, checked_interval, checked_name, checked_pixel, checked_place
from app.model.frozen import FrozenMap
from app.model.values import Clip, KeyMask, Lasso, MediaRef, ModelError, Point2
from app.model.world import CameraChoice, CameraSource, GroundKind, KnownLength, SeenLength


def set_clip(document: Document, clip: Clip) -> Edit:
    """Set the filmed video; marks beyond the end of a shorter one are refused, not dropped."""
    if clip.frame_count < 1:
        raise ModelError("The clip has no frames: choose another file.")
    latest = max(
        [frame for track in document.tracks for frame in track.clicks]
        + [contact.span.last for track in document.tracks for contact in track.contacts]
        + list(document.masks),
        default=-1,
    )
    if latest >= clip.frame_count:
        raise ModelError(
            f"The new clip has {clip.frame_count} frames, but the project has marks up to frame {latest}: "
            "use the clip in a new project."
        )
    return Edit(attrs.evolve(document, clip=clip), "Set the clip")


def relink_clip(document: Document, media: MediaRef) -> Edit:
    """Say where the clip lies now."""
    if document.clip is None:
        raise ModelError("This project has no clip yet: add a video first.")
    return Edit(attrs.evolve(document, clip=attrs.evolve(document.clip, media=media)), "Find the clip again")


def rename(document: Document, name: str) -> Edit:
    """Give the project another name."""
    name = checked_name(name)
    return Edit(attrs.evolve(document, name=name), f"Rename the project to {name}")


def set_range(document: Document, first: int | None, last: int | None) -> Edit:
    """Set the in and out frame, or take them away (None)."""
    if first is None or last is None:
        return Edit(attrs.evolve(document, range=None), "Use the whole clip")
    interval = checked_interval(document, first, last)
    return Edit(attrs.evolve(document, range=interval), f"Set the range to {interval.first}-{interval.last}")


def add_lasso(document: Document, frame: int, points: Iterable[Point2], *, subtract: bool = False) -> Edit:
    """Add a lasso to the mask of a frame, or take it away from the mask."""
    frame = checked_frame(document, frame)
    outline = tuple((float(x), float(y)) for x, y in points)
    if not all(math.isfinite(x) and math.isfinite(y) for x, y in outline):
        raise ModelError(f"The lasso in frame {frame} has points that are not finite: draw it again.")
    key = document.masks.get(frame, KeyMask())
    grown = attrs.evolve(key, lassos=(*key.lassos, Lasso(outline, subtract)))
    label = "Cut the mask" if subtract else "Draw the mask"
    return Edit(attrs.evolve(document, masks=document.masks.with_item(frame, grown)), f"{label}, frame {frame}", frame)


def move_lasso_point(document: Document, frame: int, lasso: int, index: int, point: Point2) -> Edit:
    """Move one point of a lasso."""
    key = document.masks.get(frame)
    if key is None or not 0 <= lasso < len(key.lassos) or not 0 <= index < len(key.lassos[lasso].points):
        raise ModelError(f"The mask of frame {frame} has no such point.")
    outline = list(key.lassos[lasso].points)
    outline[index] = (float(point[0]), float(point[1]))
    lassos = list(key.lassos)
    lassos[lasso] = attrs.evolve(lassos[lasso], points=tuple(outline))
    masks = document.masks.with_item(frame, attrs.evolve(key, lassos=tuple(lassos)))
    return Edit(attrs.evolve(document, masks=masks), f"Move mask point, frame {frame}", frame)


def remove_mask(document: Document, frame: int) -> Edit:
    """Remove the key mask of a frame."""
    if frame not in document.masks:
        raise ModelError(f"There is no mask drawn in frame {frame}.")
    return Edit(attrs.evolve(document, masks=document.masks.without(frame)), f"Remove the mask, frame {frame}", frame)


def set_camera(
    document: Document, source: CameraSource, *, focal: float | None = None, file: MediaRef | None = None
) -> Edit:
    """Choose where the cameras come from."""
    if source not in ("solve", "static", "file"):
        raise ModelError(f"Cameras are solved, static or read from a file, not {source!r}.")
    if source == "file" and file is None:
        raise ModelError("Cameras from a file need the file: choose a COLMAP model or a transforms.json.")
    if focal is not None and not (math.isfinite(focal) and focal > 0):
        raise ModelError(f"The focal length must be a positive number of pixels, not {focal}.")
    choice = CameraChoice(source, focal, file, document.camera.unknown)
    words = {"solve": "Solve the cameras from the video", "static": "Use a static camera", "file": "Read the cameras"}
    return Edit(attrs.evolve(document, camera=choice), words[source])


def set_ground(
    document: Document,
    kind: GroundKind,
    *,
    plane_points: Iterable[Iterable[float]] = (),
    depth_tracks: Iterable[str] = (),
    depth: float | None = None,
) -> Edit:
    """Choose where contacts lie: local fit, measured background, plane of selected points, or constant depth."""
    if kind not in ("local", "background", "plane", "depth"):
        raise ModelError(f"The ground is local, background, plane or depth, not {kind!r}.")
    points = tuple(checked_place(point) for point in plane_points)
    if points and len(points) < 3:
        raise ModelError(f"A plane needs at least 3 selected points, but got {len(points)}: select more.")
    if depth is not None and not (math.isfinite(depth) and depth > 0):
        raise ModelError(f"A depth must be a positive number, not {depth}.")
    held = tuple(dict.fromkeys(depth_tracks))
    for track_id in held:
        document.track(track_id)
    world = attrs.evolve(document.world, ground=kind, plane_points=points, depth_tracks=held, depth=depth)
    words = {
        "local": "Fit the ground near each contact",
        "background": "Put contacts onto the measured background",
        "plane": "Use one ground plane",
        "depth": "Keep points at constant depth",
    }
    return Edit(attrs.evolve(document, world=world), words[kind])


def set_from_above(document: Document, from_above: bool) -> Edit:
    """Say whether the camera looks down on the subject."""
    label = "Film from above" if from_above else "Film from the side"
    return Edit(attrs.evolve(document, world=attrs.evolve(document.world, from_above=from_above)), label)


def set_horizon(document: Document, pitch: float | None, roll: float = 0.0) -> Edit:
    """Say how the camera is held in frame 0, degrees: downwards from the horizon, clockwise; None takes it as level."""
    for angle, name in ((pitch, "pitch"), (roll, "roll")):
        if angle is not None and not (math.isfinite(angle) and abs(angle) < 90):
            raise ModelError(f"The {name} must lie between -90 and 90 degrees, but is {angle}.")
    label = "Take the camera as level" if pitch is None and not roll else f"Tilt the camera by {pitch or 0:g} degrees"
    world = attrs.evolve(document.world, pitch=None if pitch is None else float(pitch), roll=float(roll))
    return Edit(attrs.evolve(document, world=world), label, 0)


def set_camera_height(document: Document, metres: float | None) -> Edit:
    """Say how high the first camera is above the ground, or forget it; it takes the place of another known length."""
    if metres is not None and not (math.isfinite(metres) and metres > 0):
        raise ModelError(f"The camera's height must be a positive number of metres, not {metres}.")
    label = "Forget the camera's height" if metres is None else f"Put the camera at {metres:g} m"
    world = attrs.evolve(document.world, height=None if metres is None else float(metres))
    if metres is not None:
        world = attrs.evolve(world, length=None, seen=None)
    return Edit(attrs.evolve(document, world=world), label, 0)


def set_length(document: Document, length: KnownLength | SeenLength | None) -> Edit:
    """Say how long the distance between two places is, or forget it; there is one known length at a time."""
    if length is None:
        world = attrs.evolve(document.world, length=None, seen=None)
        return Edit(attrs.evolve(document, world=world), "Forget the known length")
    if not (math.isfinite(length.metres) and length.metres > 0):
        raise ModelError(f"A known length must be a positive number of metres, not {length.metres}.")
    if math.dist(length.first, length.second) == 0:
        raise ModelError("The two ends of a known length are the same place: choose two different points.")
    label = f"Set a length of {length.metres:g} m"
    if isinstance(length, KnownLength):
        checked_place(length.first)
        checked_place(length.second)
        world = attrs.evolve(document.world, length=length, seen=None, height=None)
        return Edit(attrs.evolve(document, world=world), label)
    frame = checked_frame(document, length.frame)
    for point in (length.first, length.second):
        checked_pixel(document, point)
    if len(length.tracks) not in (0, 2):
        raise ModelError(f"A known length lies between two tracks, not {len(length.tracks)}.")
    for track_id in length.tracks:
        document.track(track_id)
    world = attrs.evolve(document.world, seen=length, length=None, height=None)
    return Edit(attrs.evolve(document, world=world), label, frame)


def clear_masks(document: Document) -> Edit:
    """Remove all masks."""
    return Edit(attrs.evolve(document, masks=FrozenMap()), "Remove all masks")
