"""Which stages of a performance are wanted now; the keeper starts those that are missing."""

from __future__ import annotations

from app.stages.stage import Stage
from app.window.project import SEARCHING, Project

FINDING, PLACING, BLENDING = "Finding motions", "Placing the clips", "Blending the cuts"
LEADING = ("graph", "paths", "performance", "animation")
Wanted = tuple[str, str, list[Stage]]


def leads_on(stage: Stage) -> bool:
    """Whether something else can begin once this stage is there."""
    return stage.name.split("/")[0] in LEADING


def wanted(project: Project, *, all_: bool) -> list[Wanted]:
    """Give kind of work, label and stages: those that wait for an earlier one come without stages.

    A sequence that is a character's motion waits for that motion, unless ``all_`` is asked for: solving it may take
    long, and the user decides when.
    """
    stages, document = project.session.stages, project.document
    sequences = document.sequences
    characters = {each.character for each in sequences if each.character is not None}
    waiting = not all_ and any(project.state(stages.animation(each)) != "fresh" for each in characters)
    finding = [] if waiting or not sequences else [*(stages.structure(each.id) for each in sequences), stages.graph]
    ready = bool(sequences) and project.state(stages.graph) == "fresh"
    composing = ready and bool(document.performance.keys)
    found = composing and project.state(stages.paths) == "fresh"
    placed = found and project.state(stages.performance) == "fresh"
    return [
        ("sequences", FINDING, finding),
        ("paths", SEARCHING, [stages.paths] if composing else []),
        ("performance", PLACING, [stages.performance] if found else []),
        ("blends", BLENDING, [stages.blends] if placed else []),
    ]
