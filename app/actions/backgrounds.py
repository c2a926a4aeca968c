"""The background of a clip: its depth, the frames without the subject, and its mesh, as files."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.actions.results import rate
from app.actions.session import Session
from app.formats import Picture, write_image, write_mesh, write_video
from app.formats.atomic import explained, replacing
from app.stages.depth import background, map_in_world
from app.stages.results import Masks, World
from imitation import CameraPath
from imitation.depth import Background, DepthMap, joined_mesh
from imitation.errors import InputError
from imitation.progress import Progress, silent


def solved_background(session: Session, *, shadows: bool = False) -> tuple[Background, World]:
    """Give the background of the clip in the user's world; its depth must have been computed.

    ``shadows``: its plates are without the subject's own shadow too.
    """
    stages = session.stages
    maps: Any = session.ready(stages.depth)
    cameras, masks, world = (session.ready(stage) for stage in (stages.cameras, stages.masks, stages.world))
    if maps is None or not isinstance(cameras, CameraPath) or not isinstance(world, World):
        raise InputError("The background has no depth yet: run depth first.")
    held = masks if isinstance(masks, Masks) else None
    placed = [map_in_world(each, world) for each in maps]
    return background(session.frames(), placed, world.cameras, held, shadows=shadows), world


def false_colour(depth: NDArray[np.floating], near: float, far: float) -> Picture:
    """Depth (h, w) as a picture (h, w, 3): red near, blue far, even in inverse depth; grey where unknown."""
    import cv2

    with np.errstate(divide="ignore", invalid="ignore"):
        level = (1 / depth - 1 / far) / max(1 / near - 1 / far, 1e-12)
    shades = np.rint(255 * np.clip(np.nan_to_num(level), 0, 1)).astype(np.uint8)
    picture: Picture = cv2.applyColorMap(shades, cv2.COLORMAP_TURBO)[..., ::-1].copy()
    picture[~np.isfinite(depth)] = 70
    return picture


def write_depth(session: Session, folder: Path) -> list[Path]:
    """Write each key frame's depth as a false-colour PNG and all as exact arrays (depth.npz, world units)."""
    known, _ = solved_background(session)
    z = np.concatenate([each.depth[np.isfinite(each.depth)][::37] for each in known.maps])
    near, far = (float(v) for v in np.percentile(z, [1, 99]))
    if folder.exists() and not folder.is_dir():
        raise InputError(f"The maps cannot be written to {folder}: it is a file, not a folder.")
    with explained(folder):
        folder.mkdir(parents=True, exist_ok=True)
    written = []
    for each in known.maps:
        written.append(folder / f"depth-{each.frame:05d}.png")
        write_image(written[-1], false_colour(each.depth, near, far))
    written.append(folder / "depth.npz")
    with replacing(written[-1]) as beside:
        np.savez_compressed(
            beside,
            frames=np.array([each.frame for each in known.maps]),
            depth=np.stack([each.depth for each in known.maps]),
            confidence=np.stack([each.confidence for each in known.maps]),
        )
    return written


def write_background_mesh(session: Session, target: Path) -> tuple[int, int]:
    """Write the background as one mesh in the world (PLY, OBJ, GLB, by suffix); gives vertices and triangles."""
    known, _ = solved_background(session)
    mesh = joined_mesh(known.maps, [known.pictures.colour(each.frame) for each in known.maps])
    if not len(mesh.faces):
        raise InputError("No part of the background is confirmed by several frames, so that there is no mesh of it.")
    write_mesh(target, mesh.vertices, mesh.faces, mesh.colors)
    return len(mesh.vertices), len(mesh.faces)


def plate_film(
    session: Session, target: Path, *, shadows: bool = False, progress: Progress | None = None
) -> tuple[float, float]:
    """Write the clip without its subject; gives the share of the holes that other frames filled, mean and least.

    ``shadows``: without the subject's own shadow too.
    """
    known, _ = solved_background(session, shadows=shadows)
    from app.actions.compositing import in_order

    count, report = len(known.pictures), progress or silent
    shares: list[float] = []

    def pictures() -> Iterator[Picture]:
        for made in in_order(known.plate, range(count), lambda: report(len(shares) / count)):
            hole = int(made.filled.sum() + made.invented.sum())
            shares.append(float(made.filled.sum()) / hole if hole else 1.0)
            yield made.picture
            report(len(shares) / count)

    write_video(target, pictures(), rate(session), count=count)
    return float(np.mean(shares)), min(shares)


def summary(maps: list[DepthMap]) -> dict[str, Any]:
    """Figures of solved depth for people and machines."""
    z = np.concatenate([each.depth[np.isfinite(each.depth)][::37] for each in maps])
    return {
        "key_frames": [each.frame for each in maps],
        "nearest": float(np.percentile(z, 1)),
        "median": float(np.median(z)),
        "farthest": float(np.percentile(z, 99)),
        "confirmed": float(np.mean([each.sure().sum() / max(1, np.isfinite(each.depth).sum()) for each in maps])),
    }
