"""Deformers are made once and shared."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from app.stages.deformers import KEPT, Deformers
from tests.imitation.deformation.shapes import ball


def test_each_is_made_once_whoever_asks(monkeypatch: pytest.MonkeyPatch) -> None:
    """Equal meshes in different arrays share one; another pose, other faces or kept volume has its own."""
    import imitation.deformation as engine

    made: list[object] = []

    class Counted(engine.Deformer):
        def __init__(self, *given: object, **options: object) -> None:
            made.append(self)
            super().__init__(*given, **options)  # type: ignore[arg-type]

    monkeypatch.setattr(engine, "Deformer", Counted)
    vertices, faces = ball(2)
    deformers = Deformers()
    with ThreadPoolExecutor(4) as pool:
        found = list(pool.map(lambda _: deformers.get(np.array(vertices), np.array(faces), False), range(8)))
    assert len(set(map(id, found))) == len(made) == 1
    assert deformers.get(vertices * 2, faces, False) is not found[0]
    assert deformers.get(vertices, faces, True) is not found[0]
    assert deformers.get(vertices, faces, False) is found[0]
    for size in range(KEPT):
        deformers.get(vertices * (3 + size), faces, False)
    assert deformers.get(vertices, faces, False) is not found[0], "only the last few are kept"
