"""A small project that is solved in seconds: a short clip of the sample world with its true cameras."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

from app.actions import bringing
from app.actions.session import Session
from app.formats import write_mesh, write_video
from app.formats.cameras import write_cameras
from app.model.edits import characters, contacts, tracks

FRAMES, SIZE, EVERY = 24, (320, 180), 8


@cache
def small_clip() -> Any:
    """The clip with all that is true of it; its arrays are not to be written to."""
    from resources.world.clip import make_clip
    from resources.world.render import Look

    return make_clip(frames=FRAMES, stairs=False, look=Look(size=SIZE, samples=1, sky=6), vertices=1200, seed=3)


def build_small_project(folder: Path) -> Path:
    """Make the project and solve it; gives its folder."""
    clip = small_clip()
    assert clip.walk is not None
    write_video(folder / "walk.mp4", clip.frames, 25)
    write_cameras(folder / "transforms.json", clip.cameras, SIZE)
    body = clip.walk.body
    write_mesh(folder / "hound.ply", body.vertices, body.faces, exact=True)
    session = Session.new(folder / "small")
    bringing.add_clip(session, folder / "walk.mp4", copy=True)
    bringing.use_camera_file(session, folder / "transforms.json", copy=True)
    hound = bringing.add_character(session, folder / "hound.ply", up="z", copy=True)
    seen = clip.visibility()
    for name, positions in clip.tracks().items():
        if seen[name].mean() < 0.8 or not seen[name][0]:
            continue
        first, *others = [frame for frame in range(0, FRAMES, EVERY) if seen[name][frame]]
        session.apply(tracks.add_track(session.document, first, positions[first], name=name))
        track = session.document.tracks[-1].id
        for frame in others:
            session.apply(tracks.set_click(session.document, track, frame, positions[frame]))
        for begin, end, place in clip.walk.contacts.get(name, []):
            session.apply(contacts.add_contact(session.document, track, begin, end, place=place))
        session.apply(characters.set_pair(session.document, hound, track, body.key_vertices[name]))
    session.result(session.stages.animation(hound))
    session.save()
    path = session.folder.path
    session.close()
    return path
