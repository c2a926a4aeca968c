"""Why a sequence is cut where it is: pictures of the distance curve (Fig. 4) and the self-similarity; and how right."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.actions.session import Session
from app.formats import Picture, write_image
from app.formats.images import read_bytes
from app.stages.performance.results import Distances
from imitation.errors import InputError

PAPER, INK, LINE, MARK = (250, 250, 248), (40, 44, 52), (38, 110, 190), (214, 84, 40)
LARGEST = 1200
"""Pixels of the picture of a matrix."""


def write_report(session: Session, sequence_id: str, folder: Path) -> list[Path]:
    """Write the curve and the matrix of a sequence as PNG, and its structure as JSON; gives the files."""
    sequence = session.document.sequence(sequence_id)
    structure: Any = session.result(session.stages.structure(sequence_id))
    found = session.result(session.stages.distances(sequence_id))
    assert isinstance(found, Distances)
    stem = sequence.name.replace("/", "-")
    starts = [cluster.first for cluster in structure.clusters[1:]]
    textons = [first for cluster in structure.clusters for first, _ in cluster.textons]
    curve, matrix = folder / f"{stem}-curve.png", folder / f"{stem}-matrix.png"
    write_image(curve, curve_picture(structure.curve, structure.novelty, structure.threshold, starts, textons))
    write_image(matrix, matrix_picture(found.atoms, starts))
    table = folder / f"{stem}-structure.json"
    table.write_text(json.dumps(structure_values(structure), indent=1) + "\n")
    return [curve, matrix, table]


def structure_values(structure: Any) -> dict[str, Any]:
    """Give a structure as plain values."""
    return {
        "method": structure.method,
        "threshold": float(structure.threshold),
        "reason": structure.reason,
        "boundaries": [cluster.first for cluster in structure.clusters[1:]],
        "clusters": [
            {
                "first": cluster.first,
                "last": cluster.last,
                "cyclic": cluster.cyclic,
                "period": float(cluster.period),
                "kind": cluster.kind,
                "textons": [list(texton) for texton in cluster.textons],
                "reason": cluster.reason,
            }
            for cluster in structure.clusters
        ],
    }


def curve_picture(
    curve: NDArray[np.floating],
    novelty: NDArray[np.floating],
    threshold: float,
    boundaries: list[int],
    textons: list[int],
) -> Picture:
    """Distance to the first atom of each frame's texton (Fig. 4), what speaks for a new cluster, and the threshold."""
    import cv2

    count = len(curve)
    width, height, margin = min(1800, max(640, 2 * count + 120)), 420, 50
    picture = np.full((height, width, 3), PAPER, np.uint8)
    known = novelty[np.isfinite(novelty)]
    top = 1.1 * max(float(curve.max(initial=0.0)), float(known.max(initial=0.0)), threshold, 1e-9)

    def x(frame: float) -> int:
        return int(margin + (width - 2 * margin) * frame / max(count - 1, 1))

    def y(value: float) -> int:
        return int(height - margin - (height - 2 * margin) * value / top)

    for frame in textons:
        cv2.line(picture, (x(frame), margin), (x(frame), height - margin), (226, 226, 222), 1)
    for frame in boundaries:
        cv2.line(picture, (x(frame), margin - 8), (x(frame), height - margin + 6), MARK, 2)
        cv2.putText(picture, str(frame), (x(frame) - 10, margin - 14), cv2.FONT_HERSHEY_SIMPLEX, 0.42, MARK, 1, 16)
    cv2.line(picture, (margin, y(threshold)), (width - margin, y(threshold)), (170, 170, 170), 1)
    for values, colour in ((novelty, (150, 190, 150)), (curve, LINE)):
        for run in _runs(np.isfinite(values)):
            places = np.array([[x(k), y(float(values[k]))] for k in run], np.int32)
            cv2.polylines(picture, [places], False, colour, 2 if colour == LINE else 1, 16)
    cv2.rectangle(picture, (margin, margin), (width - margin, height - margin), INK, 1)
    step = _nice(count / 8)
    for frame in range(0, count, step):
        place = (x(frame) - 8, height - margin + 20)
        cv2.putText(picture, str(frame), place, cv2.FONT_HERSHEY_SIMPLEX, 0.42, INK, 1, 16)
    for share in (0.0, 0.5, 1.0):
        value = top * share / 1.1
        cv2.putText(picture, f"{value:.2f}", (6, y(value) + 4), cv2.FONT_HERSHEY_SIMPLEX, 0.4, INK, 1, 16)
    words = "atom distance to the texton's first atom (blue), novelty (green), threshold (grey), boundaries (red)"
    cv2.putText(picture, words, (margin, height - 8), cv2.FONT_HERSHEY_SIMPLEX, 0.42, INK, 1, 16)
    return picture


def matrix_picture(atoms: NDArray[np.floating], boundaries: list[int]) -> Picture:
    """Self-similarity: dark where two moments look alike; boundaries in red."""
    import cv2

    count = len(atoms)
    share = np.asarray(atoms, np.float32) / max(float(np.max(atoms)), 1e-9)
    size = int(np.clip(count, 480, LARGEST))
    method = cv2.INTER_AREA if count > size else cv2.INTER_NEAREST
    scaled = np.clip(np.asarray(cv2.resize(share, (size, size), interpolation=method)), 0, 1)[..., None]
    # From dark blue over teal to paper, evenly lighter.
    stops = np.array([[20, 24, 60], [38, 110, 150], [150, 200, 170], [250, 248, 235]], np.float32)
    place = scaled * (len(stops) - 1)
    low = np.minimum(place.astype(int), len(stops) - 2)
    colour = stops[low[..., 0]] * (1 - (place - low)) + stops[low[..., 0] + 1] * (place - low)
    picture = np.ascontiguousarray(np.rint(colour).astype(np.uint8))
    for frame in boundaries:
        at = int(frame * size / count)
        cv2.line(picture, (at, 0), (at, size), MARK, 1)
        cv2.line(picture, (0, at), (size, at), MARK, 1)
    return picture


def read_labels(source: Path) -> dict[str, list[int]]:
    """Read boundaries labelled by hand: JSON, a list of first frames, or one for each sequence by name.

    Raises ``InputError`` when it is something else.
    """
    try:
        values = json.loads(read_bytes(source).tobytes())
        if isinstance(values, dict) and "boundaries" in values:
            values = values["boundaries"]
        lists = {"": values} if isinstance(values, list) else dict(values)
        return {str(name): [_frame(frame) for frame in frames] for name, frames in lists.items()}
    except (ValueError, TypeError, AttributeError) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(
            f"{source.name} holds no labels: write a JSON list of first frames, or one for each sequence by name."
        ) from error


def evaluate(session: Session, sequence_id: str, labels: list[int], *, tolerance: float = 5) -> dict[str, Any]:
    """Compare boundaries with labels: precision, recall and F (Fig. 5), beside the printed method on its features.

    Boundaries set by hand are compared as they are. The baseline is measured in the same call.
    """
    from tvmedit import Agreement, compare_boundaries

    def values(found: list[int]) -> dict[str, Any]:
        agreement: Agreement = compare_boundaries(found, labels, tolerance=tolerance)
        return {
            "boundaries": found,
            "precision": agreement.precision,
            "recall": agreement.recall,
            "f_score": agreement.f_score,
        }

    structure: Any = session.result(session.stages.structure(sequence_id))
    result = values([cluster.first for cluster in structure.clusters[1:]])
    return {
        "labels": sorted(labels),
        "tolerance": tolerance,
        **result,
        "printed": values(_printed(session, sequence_id)),
    }


def _printed(session: Session, sequence_id: str) -> list[int]:
    """Boundaries of the paper's procedure on its own features, beta derived."""
    import attrs

    from app.model.performance import StructureChoice
    from app.stages.project import Stages

    document = session.document
    sequence = attrs.evolve(document.sequence(sequence_id), structure=StructureChoice(method="paper"))
    alone = attrs.evolve(
        document, sequences=(sequence,), performance=attrs.evolve(document.performance, features="paper")
    )
    structure: Any = session.result(Stages(alone).structure(sequence_id))
    return [cluster.first for cluster in structure.clusters[1:]]


def _frame(value: Any) -> int:
    if isinstance(value, bool) or not isinstance(value, int) or value < 0:
        raise InputError(f"A label must be a frame number of 0 or more, not {value!r}.")
    return value


def _runs(known: NDArray[np.bool_]) -> list[range]:
    edges = np.flatnonzero(np.diff(np.r_[False, known, False].astype(int)))
    return [range(int(a), int(b)) for a, b in zip(edges[::2], edges[1::2], strict=True)]


def _nice(step: float) -> int:
    power = 10 ** int(np.floor(np.log10(max(step, 1))))
    return int(next(power * factor for factor in (1, 2, 5, 10) if power * factor >= step))
