"""Make the built-in sample: render, mark as a user would, write the truth and the characters."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from imitation.cameras.path import CameraPath
from imitation.progress import Progress, part, silent
from resources.world import ply, truth
from resources.world.body import Body
from resources.world.camera import make_camera
from resources.world.characters import characters, vertex_colours
from resources.world.clip import tolerances
from resources.world.gait import Walk, walk
from resources.world.render import Look, Stage
from resources.world.rotation import about
from resources.world.scene import garden
from resources.world.skeleton import Array
from resources.world.terrain import STAIRS
from resources.world.user import clicks, lasso, marked

FRAMES, FPS, SIZE = 81, 25, (960, 540)
POINTS = 16  # as many as the paper's user tracks


def sample_camera(walked: Walk, size: tuple[int, int] = SIZE) -> CameraPath:
    """The sample's handheld camera."""
    return make_camera(
        walked.centre, walked.body.diagonal, azimuth=92, distance=2.25, height=0.6, travel=0.6, seed=3, size=size
    )


def encode(path: Path, frames: list[NDArray[np.uint8]], fps: int, quality: int = 21) -> None:
    """Write frames (h, w, 3) as H.264 that every player opens."""
    import av

    with av.open(str(path), "w", options={"movflags": "+faststart"}) as container:
        stream = container.add_stream("libx264", rate=fps)
        stream.width, stream.height, stream.pix_fmt = frames[0].shape[1], frames[0].shape[0], "yuv420p"
        stream.options = {"crf": str(quality), "preset": "veryslow", "x264-params": "threads=1:colormatrix=bt709"}
        for picture in frames:
            container.mux(stream.encode(av.VideoFrame.from_ndarray(picture, format="rgb24")))
        container.mux(stream.encode())


def make_sample(folder: Path, progress: Progress | None = None) -> None:
    """Write clip.mp4, truth.npz, sample.json and the characters into a folder."""
    folder.mkdir(parents=True, exist_ok=True)
    walked = walk(characters()["hound"][0], FRAMES, STAIRS)
    cameras = sample_camera(walked)
    stage = Stage(garden(STAIRS), walked, Look(size=SIZE))
    encode(folder / "clip.mp4", list(stage.clip(cameras, part(progress, 0.0, 0.85))), FPS)
    make_truth(folder, stage, walked, cameras)
    (progress or silent)(1.0)


def make_truth(folder: Path, stage: Stage, walked: Walk, cameras: CameraPath) -> None:
    """Write all but the pictures: truth.npz, sample.json and the characters."""
    bodies = characters()
    movers = {"subject": walked}
    for name, (body, _) in bodies.items():
        movers[name] = walked if body is walked.body else walk(body, FRAMES, STAIRS, steps=walked.footfalls)
    visible = _visible(stage, walked, cameras)
    made = truth.Truth(cameras, {name: truth.moving(of) for name, of in movers.items()}, visible)
    truth.save(folder / "truth.npz", made)
    marks = user_marks(stage, walked, cameras, visible)
    clicked = marks["clicks"]
    marks["characters"] = {name: _character(folder, name, *bodies[name], movers[name], clicked) for name in bodies}
    text = json.dumps(marks, indent=None, separators=(",", ":"))
    (folder / "sample.json").write_text(text.replace('},"', '},\n"').replace('],"', '],\n"') + "\n")


def _visible(stage: Stage, walked: Walk, cameras: CameraPath) -> dict[str, NDArray[np.bool_]]:
    names = walked.body.key_vertices | truth.extra_vertices(walked.body)
    chosen = list(names.values())
    slack = tolerances(walked, list(names))
    seen = np.stack([stage.visible(t, cameras[t], walked.vertices[t, chosen], slack) for t in range(len(cameras))])
    return {name: seen[:, i] for i, name in enumerate(names)}


def user_marks(
    stage: Stage, walked: Walk, cameras: CameraPath, visible: dict[str, NDArray[np.bool_]]
) -> dict[str, dict]:  # type: ignore[type-arg]
    """Lassos about every 15 frames, clicks about every 20 on the points best seen, contacts, a known length."""
    rng = np.random.default_rng(2011)
    names = walked.body.key_vertices | truth.extra_vertices(walked.body)
    frames = len(cameras)
    lassos = {}
    for t in sorted({*range(0, frames - 7, 15), frames - 1}):
        lassos[t] = lasso(stage.mask(t, cameras[t]), rng)
    keys = set(walked.body.key_vertices)
    # Soles first (their contacts carry the motion), then what is seen longest.
    worth = {n: visible[n].mean() + 2.0 * (n in walked.contacts) + 0.25 * (n in keys) for n in names}
    chosen = sorted(names, key=lambda n: -worth[n])[:POINTS]
    found = {}
    for name in sorted(chosen, key=list(names).index):
        track = np.stack([cameras[t].project(walked.vertices[t, names[name]]) for t in range(frames)])
        found[name] = clicks(track, visible[name], rng)
    contacts = marked({n: spans for n, spans in walked.contacts.items() if n in found}, rng)
    post = np.array([[0.62, -0.72, 0.0], [0.62, -0.72, 0.78]]) * [STAIRS.tread, 1, 1] + [STAIRS.start, 0, STAIRS.rise]
    ends = cameras[0].project(post).round(1).tolist()
    return {
        "clip": "clip.mp4",  # type: ignore[dict-item]
        "fps": FPS,  # type: ignore[dict-item]
        "size": list(SIZE),  # type: ignore[dict-item]
        "length": [*ends, 0.78],  # type: ignore[dict-item]
        "lassos": lassos,
        "clicks": found,
        "contacts": contacts,
    }


def _character(folder: Path, name: str, body: Body, coat: str, walked: Walk, tracks: dict) -> dict:  # type: ignore[type-arg]
    """Write a character's file as another program would have left it: own origin, unit and heading."""
    scale, turn = (1.0, 0.0) if name == "hound" else (0.01, -90.0)
    rotation = about("z", np.radians(-turn))
    start = walked.vertices[0]
    translation = np.array([start[:, 0].mean(), start[:, 1].mean(), start[:, 2].min()])
    local: Array = (start - translation) @ rotation / scale
    ply.write(folder / f"{name}.ply", local, body.faces, vertex_colours(body, coat))
    names = body.key_vertices | truth.extra_vertices(body)
    return {
        "file": f"{name}.ply",
        "scale": scale,
        "rotation": rotation.tolist(),
        "translation": translation.tolist(),
        "pairs": {track: names[track] for track in tracks},
    }
