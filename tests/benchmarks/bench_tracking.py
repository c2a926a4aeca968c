"""Figures of tracking: speed, hand labels of real clips beside LK and DIS chains, synthetic motion, carried masks."""

from __future__ import annotations

import functools
import json
import time
from collections.abc import Callable, Mapping, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from imitation.tracking import (
    FlowField,
    Outline,
    PaperOptions,
    PreparedClip,
    RobustOptions,
    carry_masks,
    compute_flow,
    prepare_clip,
    track_point,
)
from imitation.tracking.kernels import HALF_TO_FLOAT, flow_at
from imitation.tracking.masks import blend_masks
from tests.imitation.tracking.worlds import moving

pytestmark = [pytest.mark.bench, pytest.mark.timeout(1200)]
Clicks = Mapping[int, tuple[float, float]]
Tracker = Callable[[Clicks], np.ndarray]
CLIPS = {"dog": "davis_dog", "camel": "davis_camel", "horsejump": "davis_horsejump-high"}
ASKED = {
    ("mid", False): (30, 67, 58),
    ("mid", True): (33, 70, 62),
    ("second", False): (46, 92, 71),
    ("second", True): (None, None, None),
}


def track_bgr(frames: Sequence[np.ndarray], clicks: dict[int, tuple[float, float]]) -> np.ndarray:
    """The tracker for the stand-alone scorer, which hands over BGR pictures, always the same list for one clip."""
    return track_point(_turned(frames), clicks).positions


_LAST: list[Any] = [None, None]


def _turned(frames: Sequence[np.ndarray]) -> PreparedClip:
    if _LAST[0] is not frames:
        rgb = [np.ascontiguousarray(frame[:, :, ::-1]) for frame in frames]
        _LAST[:] = [frames, prepare_clip(rgb, flow=compute_flow(rgb))]
    return _LAST[1]


def read_clip(folder: Path, count: int | None = None) -> list[np.ndarray]:
    """RGB frames of a clip, the first ``count`` of them."""
    import cv2

    capture, frames = cv2.VideoCapture(str(folder / "clip.mp4")), []
    while count is None or len(frames) < count:
        ok, frame = capture.read()
        if not ok:
            break
        frames.append(np.ascontiguousarray(frame[:, :, ::-1]))
    return frames


def read_masks(folder: Path, count: int) -> list[np.ndarray]:
    """Masks of the subject, bool (h, w)."""
    import cv2

    return [cv2.imread(str(folder / "masks" / f"{t:05d}.png"), cv2.IMREAD_GRAYSCALE) > 0 for t in range(count)]


@functools.cache
def ready_clip(folder: Path) -> tuple[list[np.ndarray], FlowField, float]:
    """Frames, flow, and the flow's CPU seconds a frame."""
    frames = read_clip(folder)
    start = time.process_time()
    field = compute_flow(frames)
    return frames, field, (time.process_time() - start) / len(frames)


def two_sided(count: int, clicks: Clicks, walk: Callable[[int, int, int], dict[int, np.ndarray]]) -> np.ndarray:
    """Paths from both clicks of each span, blended by the distance in time."""
    out, keys = np.full((count, 2), np.nan), sorted(clicks)
    for left, right in pairwise(keys):
        forward, backward = walk(left, right, 1), walk(right, left, -1)
        for t in range(left, right + 1):
            w = (right - t) / (right - left)
            out[t] = w * forward[t] + (1 - w) * backward[t]
    return out


def lk_blend(greys: Sequence[np.ndarray], clicks: Clicks) -> np.ndarray:
    """Baseline: pyramidal Lucas-Kanade, 21 x 21, four levels."""
    import cv2

    def walk(start: int, stop: int, step: int) -> dict[int, np.ndarray]:
        point = np.array([[clicks[start]]], np.float32)
        path = {start: point[0, 0].astype(float)}
        for t in range(start, stop, step):
            point, _, _ = cv2.calcOpticalFlowPyrLK(greys[t], greys[t + step], point, None, winSize=(21, 21), maxLevel=3)
            path[t + step] = point[0, 0].astype(float)
        return path

    return two_sided(len(greys), clicks, walk)


def dis_blend(clip: PreparedClip, clicks: Clicks) -> np.ndarray:
    """Baseline: chained dense flow."""

    def walk(start: int, stop: int, step: int) -> dict[int, np.ndarray]:
        path = {start: np.array(clicks[start], float)}
        for t in range(start, stop, step):
            x, y = path[t]
            path[t + step] = path[t] + flow_at(clip.flow(t, t + step), HALF_TO_FLOAT, clip.scale, x, y, clip.mask(t))
        return path

    return two_sided(len(clip), clicks, walk)


def share_within(folder: Path, protocol: str, tracker: Tracker) -> float:
    """Per cent of held-out labels within 8 px, by the rules of the stand-alone scorer."""
    errors: list[float] = []
    for track in json.loads((folder / "joints.json").read_text())["tracks"].values():
        labels = {int(t): tuple(place) for t, place in track.items()}
        keys = sorted(labels)
        if len(keys) < 4:
            continue
        given = keys[::2] if protocol == "second" else [keys[0], keys[len(keys) // 2], keys[-1]]
        path = tracker({t: labels[t] for t in given})
        held = [t for t in keys if t not in given and given[0] < t < given[-1]]
        errors += [float(np.hypot(*(path[t] - np.array(labels[t])))) for t in held]
    return 100 * float(np.mean(np.array(errors) <= 8))


def test_speed(bench, shared_data):
    """Frames a second of one point, 50 frames, everything prepared; and what the flow costs once."""
    frames, field, seconds = ready_clip(shared_data / "davis_camel")
    part = FlowField(field.forward[:49], field.backward[:49], field.ready[:49], field.scale)
    clip = prepare_clip(frames[:50], flow=part)
    tracks = json.loads((shared_data / "davis_camel" / "joints.json").read_text())["tracks"].values()
    ends = []
    for track in tracks:
        inside = sorted(int(t) for t in track if int(t) < 50)
        if len(inside) > 1:
            ends.append({t: tuple(track[str(t)]) for t in (inside[0], inside[-1])})
    settings = {
        "paper": {"mode": "paper", "options": PaperOptions(window=11)},
        "robust": {},
        "robust without search": {"options": RobustOptions(look_alikes=0)},
    }
    for name, asked, baseline in (("paper", 2500, 1800), ("robust", 500, 250), ("robust without search", None, 600)):
        for clicks in ends:
            track_point(clip, clicks, **settings[name])
        spent = []
        for clicks in ends * 3:
            start = time.process_time()
            track_point(clip, clicks, **settings[name])
            spent.append(time.process_time() - start)
        bench.record(
            f"tracking speed, {name}", 50 / float(np.median(spent)), asked=asked, better="higher", unit="frames/s",
            baseline=baseline, baseline_name="prototype, another run", note="one point, 50 frames of 854 x 480",
        )  # fmt: skip
    bench.record("dense flow, both ways", seconds, unit="CPU s a frame", baseline=0.1, baseline_name="prototype")


def test_hand_labels(bench, shared_data):
    """Share of hand labels within 8 px on three clips, two protocols, with and without masks, beside LK and DIS."""
    import cv2

    shares: dict[str, list[float]] = {"ours": [], "masks": [], "lk": [], "dis": []}
    for k, (name, folder_name) in enumerate(CLIPS.items()):
        folder = shared_data / folder_name
        frames, field, _ = ready_clip(folder)
        plain = prepare_clip(frames, flow=field)
        masked = prepare_clip(frames, flow=field, masks=read_masks(folder, len(frames)))
        greys = [cv2.cvtColor(frame, cv2.COLOR_RGB2GRAY) for frame in frames]
        trackers: dict[str, Tracker] = {
            "ours": lambda clicks, clip=plain: track_point(clip, clicks).positions,
            "masks": lambda clicks, clip=masked: track_point(clip, clicks).positions,
            "lk": lambda clicks, greys=greys: lk_blend(greys, clicks),
            "dis": lambda clicks, clip=plain: dis_blend(clip, clicks),
        }
        for protocol in ("mid", "second"):
            got = {kind: share_within(folder, protocol, tracker) for kind, tracker in trackers.items()}
            for kind, value in got.items():
                shares[kind].append(value)
            for kind, with_masks in (("ours", False), ("masks", True)):
                bench.record(
                    f"hand labels within 8 px, {name}, {protocol}{', with masks' if with_masks else ''}", got[kind],
                    asked=ASKED[protocol, with_masks][k], better="higher", unit="%", baseline=got["lk"],
                    baseline_name="LK blend", note=f"DIS chain {got['dis']:.1f}",
                )  # fmt: skip
    lk, dis = float(np.mean(shares["lk"])), float(np.mean(shares["dis"]))
    bench.record(
        "hand labels, mean over clips and protocols, over LK", float(np.mean(shares["ours"])) / lk, asked=1.5,
        better="higher", unit="x", baseline=dis / lk, baseline_name="DIS chain",
        note=", ".join(f"{kind} {np.mean(values):.1f} %" for kind, values in shares.items()),
    )  # fmt: skip


def test_synthetic(bench):
    """Worst error on moving texture, under falling light, and under and beside a bar of four frames."""
    worst: dict[str, list[float]] = {}
    for seed in range(31, 37):
        cases = {
            "texture": {},
            "light": {"dimming": 0.4},
            "bar": {"bar": (8, 11)},
            "wide bar": {"bar": (8, 11), "bar_width": 120},
        }
        for case, arguments in cases.items():
            frames, path = moving(seed=seed, **arguments)
            clip, clicks = prepare_clip(frames, flow=compute_flow(frames)), {t: tuple(path[t]) for t in (0, 20)}
            for mode in ("robust", "paper"):
                error = np.hypot(*(track_point(clip, clicks, mode=mode).positions - path).T)
                under = error[8:12].max()
                worst.setdefault(f"{case} {mode}", []).append(float(under if "bar" in case else error.max()))
                if case == "bar":
                    worst.setdefault(f"beside {mode}", []).append(float(np.delete(error, range(8, 12)).max()))
    for case, name, asked in (
        ("texture", "moving texture", 0.2),
        ("light", "light falls by 40 %", 0.2),
        ("bar", "under a bar of 4 frames", 4.0),
        ("beside", "beside the bar", None),
        ("wide bar", "under a bar of 120 px", 4.0),
    ):
        bench.record(
            f"synthetic, {name}: worst error of six seeds", max(worst[f"{case} robust"]), asked=asked, unit="px",
            baseline=max(worst[f"{case} paper"]), baseline_name="printed method",
            note=f"medians {np.median(worst[f'{case} robust']):.3f}, {np.median(worst[f'{case} paper']):.3f}",
        )  # fmt: skip


def outlines_of(mask: np.ndarray) -> list[Outline]:
    """Simplified outlines (2 px) of a mask, as a person would draw them."""
    import cv2

    contours, _ = cv2.findContours(mask.astype(np.uint8), cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
    lines = [cv2.approxPolyDP(c, 2.0, True)[:, 0] for c in contours if cv2.contourArea(c) >= 30]
    return [Outline(line.astype(float)) for line in lines if len(line) >= 3]


@pytest.mark.parametrize("name", ["dog", "camel", "horsejump-high", "libby", "parkour"])
def test_carried_masks(bench, shared_data, name):
    """Overlap with the true masks of outlines drawn in every 15th frame, beside plain shape interpolation."""
    folder = shared_data / f"davis_{name}"
    frames, field, _ = ready_clip(folder)
    masks = read_masks(folder, len(frames))
    keys = sorted({*range(0, len(frames), 15), len(frames) - 1})
    start = time.process_time()
    carried = carry_masks(frames, {t: outlines_of(masks[t]) for t in keys}, flow=field)
    seconds = (time.process_time() - start) / len(frames)
    ours, plain = [], []
    for left, right in pairwise(keys):
        for t in range(left + 1, right):
            shape = blend_masks(carried[left], carried[right], (right - t) / (right - left))
            for found, scores in ((carried[t], ours), (shape, plain)):
                union = np.count_nonzero(found | masks[t])
                scores.append(np.count_nonzero(found & masks[t]) / union if union else 1.0)
    bench.record(
        f"carried masks, {name}: mean overlap (IoU)", float(np.mean(ours)), better="higher",
        baseline=float(np.mean(plain)), baseline_name="plain shape interpolation",
        note=f"worst {min(ours):.2f}, {seconds:.3f} CPU s a frame",
    )  # fmt: skip
