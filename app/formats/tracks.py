"""Tracks from and to JSON and CSV: where followed points are in each frame."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Mapping, Sequence
from fractions import Fraction
from pathlib import Path
from typing import Any

import attrs
import numpy as np
from numpy.typing import ArrayLike, NDArray

from app.formats.atomic import replacing
from app.formats.images import read_bytes
from imitation.errors import InputError

STATES = ("visible", "occluded", "outside")
_COLUMNS = ("track", "frame", "x", "y", "confidence", "state")


def _positions(value: ArrayLike) -> NDArray[np.float64]:
    array = np.array(value, np.float64)
    if array.ndim != 2 or array.shape[1] != 2 or np.isinf(array).any():
        raise InputError(f"A track needs positions (n, 2), NaN where it is absent, but got {array.shape}.")
    # A point is there or not: half a position is none.
    array[np.isnan(array).any(axis=1)] = np.nan
    array.setflags(write=False)
    return array


@attrs.frozen(eq=False)
class TrackFile:
    """One track as a file holds it.

    Attributes
    ----------
    positions : (n, 2) pixels (x, y), pixel centres at integers; NaN where absent.
    confidence : (n,) 0 to 1, or None.
    state : n words of "visible", "occluded", "outside", or None.
    """

    positions: NDArray[np.float64] = attrs.field(converter=_positions)
    confidence: NDArray[np.float64] | None = None
    state: tuple[str, ...] | None = None


def write_tracks(
    path: str | Path,
    tracks: Mapping[str, TrackFile] | Mapping[str, NDArray[np.float64]],
    *,
    size: tuple[int, int] | None = None,
    fps: Fraction | None = None,
) -> None:
    """Write tracks as JSON or CSV, as the suffix says; whole or not at all. Numbers keep all their digits.

    Parameters
    ----------
    tracks : name to track, or to positions (n, 2).
    size, fps : of the clip, kept in JSON.
    """
    path = Path(path)
    every = {name: each if isinstance(each, TrackFile) else TrackFile(each) for name, each in tracks.items()}
    if len({len(track.positions) for track in every.values()}) > 1:
        raise InputError("The tracks have different numbers of frames: give every track one position a frame.")
    if path.suffix.lower() == ".json":
        text = _to_json(every, size, fps)
    elif path.suffix.lower() == ".csv":
        text = _to_csv(every)
    else:
        raise InputError(f"Tracks cannot be written as {path.name}: use .json or .csv.")
    with replacing(path) as temporary:
        temporary.write_text(text, encoding="utf-8", newline="")


def read_tracks(path: str | Path, frames: int | None = None) -> dict[str, TrackFile]:
    """Read tracks from JSON or CSV.

    Parameters
    ----------
    frames : how many frames the clip has; a track for more is an error. A CSV that leaves out frames needs it.

    Raises
    ------
    InputError
        Not such a file, frames outside the clip, numbers that are none.
    """
    path = Path(path)
    try:
        text = read_bytes(path).tobytes().decode("utf-8-sig")
        if path.suffix.lower() == ".csv":
            tracks = _from_csv(text, frames)
        elif path.suffix.lower() == ".json":
            tracks = _from_json(json.loads(text))
        else:
            raise InputError(f"The file {path.name} holds no tracks that can be read: give .json or .csv.")
    except InputError:
        raise
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError, csv.Error) as error:
        raise InputError(f"The file {path.name} holds no tracks in the form of docs/formats.md: {error}.") from error
    for name, track in tracks.items():
        if frames is not None and len(track.positions) != frames:
            raise InputError(f"The track {name} has {len(track.positions)} frames, but the clip has {frames}.")
    return tracks


def _to_json(tracks: Mapping[str, TrackFile], size: tuple[int, int] | None, fps: Fraction | None) -> str:
    listed: list[dict[str, Any]] = []
    for name, track in tracks.items():
        entry: dict[str, Any] = {"name": name, "positions": _listed(track.positions)}
        if track.confidence is not None:
            entry["confidence"] = [None if np.isnan(each) else float(each) for each in track.confidence]
        if track.state is not None:
            entry["state"] = list(track.state)
        listed.append(entry)
    whole: dict[str, Any] = {"format": "motionwright tracks", "version": 1, "tracks": listed}
    if size is not None:
        whole["size"] = list(size)
    if fps is not None:
        whole["fps"] = str(fps)
    return json.dumps(whole, ensure_ascii=False, separators=(",", ":")) + "\n"


def _listed(positions: NDArray[np.float64]) -> list[list[float] | None]:
    return [None if np.isnan(place[0]) else [float(place[0]), float(place[1])] for place in positions]


def _from_json(whole: Any) -> dict[str, TrackFile]:
    if int(whole["version"]) > 1:
        raise InputError("The tracks were written by a newer version of this program: update it.")
    tracks: dict[str, TrackFile] = {}
    for entry in whole["tracks"]:
        places = [[np.nan, np.nan] if place is None else place for place in entry["positions"]]
        positions = np.array(places, np.float64).reshape(-1, 2) if places else np.zeros((0, 2))
        if len(positions) != len(places):
            raise ValueError("positions must be pairs")
        trust = entry.get("confidence")
        sure = None if trust is None else np.array([np.nan if each is None else each for each in trust], np.float64)
        tracks[_new(str(entry["name"]), tracks)] = _made(positions, sure, entry.get("state"))
    return tracks


def _made(
    positions: NDArray[np.float64], confidence: NDArray[np.float64] | None, state: Sequence[str] | None
) -> TrackFile:
    if confidence is not None and len(confidence) != len(positions):
        raise ValueError("confidence must have one number a frame")
    if state is not None and (len(state) != len(positions) or any(each not in STATES for each in state)):
        raise ValueError(f"state must be one of {', '.join(STATES)} a frame")
    return TrackFile(positions, confidence, None if state is None else tuple(state))


def _to_csv(tracks: Mapping[str, TrackFile]) -> str:
    memory = io.StringIO()
    writer = csv.writer(memory, lineterminator="\r\n")
    writer.writerow(_COLUMNS)
    for name, track in tracks.items():
        for frame, (x, y) in enumerate(track.positions.tolist()):
            trust = "" if track.confidence is None else _number(float(track.confidence[frame]))
            state = "" if track.state is None else track.state[frame]
            writer.writerow((name, frame, _number(x), _number(y), trust, state))
    return memory.getvalue()


def _number(value: float) -> str:
    return "" if np.isnan(value) else repr(value)


def _from_csv(text: str, frames: int | None) -> dict[str, TrackFile]:
    reader = csv.DictReader(io.StringIO(text, newline=""))
    if not reader.fieldnames or not set(_COLUMNS[:4]) <= set(reader.fieldnames):
        raise ValueError(f"the first line must be {','.join(_COLUMNS)}")
    rows: dict[str, dict[int, dict[str, Any]]] = {}
    for row in reader:
        frame = int(row["frame"])
        if frame < 0 or frame >= (frames if frames is not None else 10_000_000):
            raise InputError(f"The track {row['track']} has a position in frame {frame}, which the clip does not have.")
        rows.setdefault(row["track"], {})[frame] = row
    longest = frames or 1 + max((max(each) for each in rows.values()), default=-1)
    return {name: _track(each, longest) for name, each in rows.items()}


def _track(rows: Mapping[int, Mapping[str, Any]], frames: int) -> TrackFile:
    def column(name: str) -> NDArray[np.float64]:
        values = np.full(frames, np.nan)
        for frame, row in rows.items():
            values[frame] = float(row.get(name) or "nan")
        return values

    def filled(name: str) -> bool:
        return any(bool(row.get(name)) for row in rows.values())

    confidence = column("confidence") if filled("confidence") else None
    state = [str(rows.get(frame, {}).get("state") or "outside") for frame in range(frames)] if filled("state") else None
    return _made(np.stack([column("x"), column("y")], axis=1), confidence, state)


def _new(name: str, known: Mapping[str, Any]) -> str:
    if name in known:
        raise ValueError(f"two tracks are called {name!r}")
    return name
