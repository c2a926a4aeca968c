"""What is in a project and how far it is: for people, and as plain values."""

from __future__ import annotations

from typing import Any

from app.actions.limbs import ambiguous_limbs, limb_lines
from app.actions.lost_media import missing_media
from app.actions.session import Session
from app.stages.results import World
from app.stages.stage import Stage


def overview(session: Session) -> tuple[dict[str, Any], list[str]]:
    """Give the values, and the lines that say the same."""
    document = session.document
    clip = document.clip
    steps = {stage.name: _state(session, stage) for stage in session.stages.all()}
    values: dict[str, Any] = {
        "project": str(session.folder.path),
        "name": document.name,
        "clip": None
        if clip is None
        else {"file": clip.media.path, "frames": clip.frame_count, "size": [clip.width, clip.height], "fps": clip.fps},
        "world": _world(session),
        "masks": list(document.masks),
        "tracks": {
            track.name: {
                "clicks": len(track.clicks),
                "contacts": [[contact.span.first, contact.span.last] for contact in track.contacts],
            }
            for track in document.tracks
        },
        "characters": {
            character.name: {
                "mesh": character.mesh.path,
                "pairs": len(character.pairs),
                "edited_frames": list(character.edits),
                "ambiguous": ambiguous_limbs(session, character.id),
            }
            for character in document.characters
        },
        "missing": {each.owner: each.media.path for each in missing_media(document, session.folder)},
        "steps": steps,
    }
    return values, _lines(values, session)


def _world(session: Session) -> dict[str, Any]:
    """What is known of the world and what is assumed; None where it has not been found yet."""
    choice, found = session.document.world, session.ready(session.stages.world)
    values: dict[str, Any] = {"ground": choice.ground, "pitch": choice.pitch, "roll": choice.roll}
    values |= {"camera_height": choice.height, "note": None, "metric": None}
    if isinstance(found, World):
        values |= {"note": found.note, "metric": found.metric}
    return values


def _world_lines(world: dict[str, Any]) -> list[str]:
    if world["note"] is None:
        return []
    lines = [f"world       {world['note']}"]
    if "level camera" in world["note"]:
        lines.append(
            "            the camera is taken as level: set --pitch DEGREES says how far it looks down in frame 0"
        )
    if not world["metric"]:
        lines.append(
            "            no length is known: set --length NAME NAME FRAME METRES, --length-pixels or --camera-height"
        )
    return lines


def _state(session: Session, stage: Stage) -> dict[str, str]:
    state = session.runner.state(stage)
    why = stage.why_blocked() if state == "blocked" else session.runner.why_failed(stage)
    return {"state": state, "why": why} if why else {"state": state}


def _lines(values: dict[str, Any], session: Session) -> list[str]:
    clip = values["clip"]
    lines = [f"{values['name']}  ({values['project']})"]
    if clip is None:
        lines.append("clip        none yet: set --clip FILE")
    else:
        width, height = clip["size"]
        lines.append(
            f"clip        {clip['file']}: {clip['frames']} frames of {width} x {height} at {clip['fps']:g} fps"
        )
    lines += _world_lines(values["world"])
    clicks = sum(track["clicks"] for track in values["tracks"].values())
    contacts = sum(len(track["contacts"]) for track in values["tracks"].values())
    lines.append(f"masks       {len(values['masks'])} drawn")
    lines.append(f"tracks      {len(values['tracks'])} with {clicks} clicks, {contacts} contacts")
    for name, character in values["characters"].items():
        edited = len(character["edited_frames"])
        lines.append(f"character   {name}: {character['pairs']} pairs, {edited} edited frames ({character['mesh']})")
        lines += limb_lines(character["ambiguous"] or [])
    for owner, place in values["missing"].items():
        lines.append(f"missing     {owner}, expected at {place}: put it back, or set --find FOLDER")
    labels = {stage.name: stage.label for stage in session.stages.all()}
    for name, step in values["steps"].items():
        why = f": {step['why']}" if "why" in step else ""
        lines.append(f"  {step['state']:8} {labels[name]}{why}")
    return lines
