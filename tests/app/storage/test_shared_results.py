"""Results of one project taken by a copy of it."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from app.storage.results import ResultStore


def test_shared_results_outlive_either_store(tmp_path: Path) -> None:
    """They are read in the copy, nothing is copied, and what either throws away the other still has."""
    first, second = ResultStore(tmp_path / "first"), ResultStore(tmp_path / "second")
    values = {f"{number:02x}key": np.arange(5.0) + number for number in range(4)}
    for key, value in values.items():
        first.save(key, value, name="track/nose")
    second.save("00key", np.zeros(2))
    second.share(first)
    assert np.array_equal(second.load("00key"), np.zeros(2)), "its own stay"
    assert second.knows("track/nose")
    assert np.array_equal(second.load("03key"), values["03key"])
    twin = next((tmp_path / "second").rglob("03key/0.npy"))
    assert twin.stat().st_nlink == 2
    first.clear()
    assert np.array_equal(second.load("03key"), values["03key"])
    second.share(first)
    second.clear()


def test_where_files_have_one_name_only_results_are_left_out(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """They are computed again then; nothing half taken is left."""

    def refuse(*_: Any, **__: Any) -> None:
        raise OSError("no second name")

    first, second = ResultStore(tmp_path / "first"), ResultStore(tmp_path / "second")
    first.save("0akey", np.arange(3.0))
    monkeypatch.setattr(os, "link", refuse)
    second.share(first)
    assert "0akey" not in second
    assert not list((tmp_path / "second").rglob("*.part"))
