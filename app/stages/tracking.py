"""Stages of the clip and its tracks: flow, masks, spans between clicks, tracks."""

from __future__ import annotations

from typing import Any

import attrs

from app.model.document import Document
from app.model.tracks import Track
from app.model.values import Clip, KeyMask
from app.stages.context import Context
from app.stages.once import once
from app.stages.results import Masks
from app.stages.stage import Stage

NO_CLIP = "Add a video first."
FLOW_SECONDS = 0.15
CLICK = tuple[int, float, float]


@once
def flow(document: Document) -> Stage:
    """Dense optical flow between neighbouring frames, both ways."""
    clip = document.clip
    if clip is None:
        return Stage("flow", "Following the picture", _flow, blocked=NO_CLIP)
    return Stage("flow", "Following the picture", _flow, (clip,), weight=FLOW_SECONDS * clip.frame_count)


@once
def masks(document: Document) -> Stage:
    """The subject's mask in every frame; None where no mask was drawn."""
    clip = document.clip
    keys = tuple((frame, key.lassos) for frame, key in document.masks.items() if key.lassos)
    if clip is None:
        return Stage("masks", "Carrying the masks", _masks, blocked=NO_CLIP)
    needs = (flow(document),) if keys else ()
    return Stage("masks", "Carrying the masks", _masks, (clip, keys), needs, weight=0.05 * clip.frame_count)


@once
def spans(document: Document, track: Track) -> tuple[Stage, ...]:
    """The spans of a track, each between two clicks or from one to an open end."""
    from imitation.tracking import plan_spans

    clip = document.clip
    if clip is None:
        return (Stage(f"span/{track.id}", f"Tracking {track.name}", _span, blocked=NO_CLIP),)
    clicks: list[CLICK] = [(frame, *place) for frame, place in track.clicks.items()]
    plans = plan_spans(clicks, clip.frame_count, [(gap.first, gap.last) for gap in track.absent], _guesses(track))
    needs = (flow(document), masks(document)) if track.masked else (flow(document),)
    return tuple(
        Stage(
            f"span/{track.id}/{plan.first}-{plan.last}",
            f"Tracking {track.name}, frames {plan.first}-{plan.last}",
            _span,
            (clip, track.mode, plan),
            needs,
            version=4,
            weight=0.004 * (plan.last - plan.first),
        )
        for plan in plans
    )


@once
def track(document: Document, track: Track) -> Stage:
    """A track: its spans put together, with what the user said of hidden frames."""
    if document.clip is None:
        return Stage(f"track/{track.id}", f"Tracking {track.name}", _track, blocked=NO_CLIP)
    clicks = tuple((frame, *place) for frame, place in track.clicks.items())
    inputs = (document.clip.frame_count, clicks, track.absent, track.occluded)
    return Stage(
        f"track/{track.id}", f"Tracking {track.name}", _track, inputs, spans(document, track), version=2, weight=0.01
    )


def _guesses(track: Track) -> tuple[int, ...]:
    """Clicks in frames where the user says that the point is hidden: only they change what is followed."""
    return tuple(frame for frame in track.clicks if any(frame in gap for gap in track.occluded))


def _flow(context: Context, inputs: tuple[Clip]) -> Any:
    from imitation.tracking import compute_flow

    (clip,) = inputs
    # A cancelled flow goes on where it stopped: the field with its finished pairs is kept with the media.
    field = compute_flow(context.media.frames(clip), context.progress, out=context.media.flow_room(clip))
    context.media.leave_flow_room()
    return field


def _masks(context: Context, inputs: tuple[Clip, tuple[tuple[int, tuple[Any, ...]], ...]], *needs: Any) -> Masks | None:
    from imitation.tracking import carry_masks

    clip, keys = inputs
    if not keys:
        return None
    drawn = {frame: _outlines(KeyMask(lassos)) for frame, lassos in keys}
    carried = carry_masks(context.media.frames(clip), drawn, flow=needs[0], progress=context.progress)
    return Masks.pack(carried)


def _outlines(key: KeyMask) -> list[Any]:
    from imitation.tracking import Outline

    return [Outline(lasso.points, subtract=lasso.subtract) for lasso in key.lassos]


def _span(context: Context, inputs: tuple[Clip, str, Any], field: Any, subject: Masks | None = None) -> Any:
    from imitation.tracking import track_span

    clip, mode, plan = inputs
    prepared = context.media.prepared(clip, field, subject)
    until = None
    if plan.left is None:
        until = plan.first
    elif plan.right is None:
        until = plan.last
    return track_span(
        prepared,
        plan.left,
        plan.right,
        until=until,
        mode=mode,  # type: ignore[arg-type]
        hidden=plan.guessed,
        progress=context.progress,
    )


def _track(context: Context, inputs: tuple[int, tuple[CLICK, ...], Any, Any], *solved: Any) -> Any:
    from imitation.tracking import assemble_track

    count, clicks, absent, occluded = inputs
    guesses = [frame for frame, _, _ in clicks if any(frame in gap for gap in occluded)]
    found = assemble_track(count, clicks, solved, [(gap.first, gap.last) for gap in absent], guesses)
    if not occluded:
        return found
    state = found.state.copy()
    for interval in occluded:
        here = state[interval.first : interval.last + 1]
        here[here == "visible"] = "occluded"
    state.setflags(write=False)
    return attrs.evolve(found, state=state)
