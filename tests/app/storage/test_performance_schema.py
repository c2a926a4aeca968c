"""Sequences and performances in project.json."""

from __future__ import annotations

import json

from app.model.document import Document
from app.model.edits import performance, sequences
from app.model.performance import Motion
from app.model.values import MediaRef
from app.storage.schema import document_from_json, document_to_json


def full() -> Document:
    """A document with all that a performance can hold."""
    made = sequences.add_sequence(
        Document(), name="run", frame_count=50, fps=25.0, media=MediaRef("run", "f"), guessed=("up",)
    ).document
    made = sequences.set_boundaries(made, "s1", (10, 20)).document
    made = sequences.set_representative(made, "s1", 12).document
    made = sequences.set_front(made, "s1", 90.0).document
    made = performance.add_key(made, Motion("s1", 3), repeats=3).document
    made = performance.set_forbidden(made, Motion("s1", 30), True).document
    return performance.set_hard_cut(made, Motion("s1", 3), Motion("s1", 30), True).document


def test_all_of_it_reads_back() -> None:
    """Nothing is lost on the way through JSON."""
    assert document_from_json(document_to_json(full()), "project.json") == full()


def test_a_project_without_performances_opens() -> None:
    """A file written before there were sequences reads as one that has none."""
    body = json.loads(document_to_json(Document()))
    del body["document"]["sequences"], body["document"]["performance"]
    assert document_from_json(json.dumps(body).encode(), "project.json") == Document()


def test_fields_of_a_newer_program_are_kept_within() -> None:
    """Unknown fields of a sequence, its structure and the performance survive load and save."""
    body = json.loads(document_to_json(full()))
    sequence, choice = body["document"]["sequences"][0], body["document"]["performance"]
    sequence["scanner"], sequence["structure"]["seed"], choice["music"] = {"bits": 12}, 7, ["a", None]
    again = json.loads(document_to_json(document_from_json(json.dumps(body).encode(), "project.json")))["document"]
    assert again["sequences"][0]["scanner"] == {"bits": 12}
    assert again["sequences"][0]["structure"]["seed"] == 7
    assert again["performance"]["music"] == ["a", None]
