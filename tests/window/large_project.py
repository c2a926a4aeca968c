"""A long project as after a day's work: 240 frames of 540p, a walking body of any size, its motion solved.

The pictures carry their own number in stripes; the tracks are the true ones with a third of a pixel of noise, put
where the tracker's results would lie, so that the rest is solved as for a user.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from app.actions import bringing
from app.actions.session import Session
from app.formats import write_mesh, write_video
from app.formats.cameras import write_cameras
from app.model.edits import characters, contacts, tracks
from imitation.tracking import Track

FRAMES, SIZE = 240, (960, 540)
BITS = 9
Picture = NDArray[np.uint8]


def striped(count: int, seed: int = 0) -> Iterator[Picture]:
    """Pictures (540, 960, 3) of a drifting texture; the top rows say their number in black and white blocks."""
    random = np.random.default_rng(seed)
    small = random.uniform(60, 200, (40, 120, 3))
    wide = np.kron(small, np.ones((18, 18, 1)))
    for number in range(count):
        x, y = 2 * number % 900, number % 150
        picture = wide[y : y + SIZE[1], x : x + SIZE[0]].astype(np.uint8)
        for bit in range(BITS):
            picture[:32, 32 * bit : 32 * bit + 32] = 235 if number >> bit & 1 else 20
        yield picture


def number_in(picture: NDArray[np.uint8]) -> int:
    """The number that a picture (h, w, 3) carries."""
    return sum(1 << bit for bit in range(BITS) if picture[16, 32 * bit + 16].mean() > 128)


def build_large_project(folder: Path, vertices: int) -> Path:
    """Make the project and solve it; gives its folder."""
    from resources.world.body import make_body
    from resources.world.camera import make_camera
    from resources.world.gait import walk

    body = make_body("quadruped", vertices=vertices)
    made = walk(body, FRAMES, "flat", seed=5)
    cameras = make_camera(made.centre, body.diagonal, azimuth=60.0, seed=5, size=SIZE)
    write_video(folder / "walk.mp4", striped(FRAMES), 25, count=FRAMES, gop=12)
    write_cameras(folder / "transforms.json", cameras, SIZE)
    write_mesh(folder / "hound.ply", body.vertices, body.faces, exact=True)
    session = Session.new(folder / f"large {vertices}")
    bringing.add_clip(session, folder / "walk.mp4", copy=True)
    bringing.use_camera_file(session, folder / "transforms.json", copy=True)
    hound = bringing.add_character(session, folder / "hound.ply", up="z", copy=True)
    random, marks = np.random.default_rng(5), {}
    for name, points in made.key_points.items():
        pixels = np.stack([cameras[frame].project(points[frame]) for frame in range(FRAMES)])
        pixels[1:] += 0.33 * random.normal(size=(FRAMES - 1, 2))
        session.apply(tracks.add_track(session.document, 0, pixels[0], name=name))
        track = session.document.tracks[-1].id
        for begin, end, place in made.contacts.get(name, []):
            session.apply(contacts.add_contact(session.document, track, begin, end, place=place))
        session.apply(characters.set_pair(session.document, hound, track, body.key_vertices[name]))
        marks[track] = pixels
    for track, pixels in marks.items():
        seen = Track(pixels, np.ones(FRAMES), np.full(FRAMES, "visible", "<U8"), np.zeros(FRAMES), (0,))
        session.cache.put(session.stages.track(track), seen)
    session.result(session.stages.animation(hound))
    session.save()
    path = session.folder.path
    session.close()
    return path
