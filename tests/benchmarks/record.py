"""Figures of ``make bench``: each is written beside its baseline of the same run and what was asked."""

from __future__ import annotations

import json
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, Literal

Better = Literal["lower", "higher"]


class Recorder:
    """Collects figures in one JSON file; a figure of the same name replaces the older one."""

    def __init__(self, path: Path, source: str) -> None:
        self.path, self.source = path, source

    def record(
        self,
        name: str,
        value: float,
        *,
        asked: float | None = None,
        better: Better = "lower",
        unit: str = "",
        baseline: float | None = None,
        baseline_name: str = "",
        note: str = "",
    ) -> bool:
        """Write one figure and say whether it is as good as asked (True where nothing was asked)."""
        met = asked is None or (value <= asked if better == "lower" else value >= asked)
        figures: dict[str, Any] = json.loads(self.path.read_text()) if self.path.is_file() else {}
        figures[name] = {
            "value": float(value),
            "asked": asked,
            "better": better,
            "unit": unit,
            "met": bool(met),
            "baseline": baseline,
            "baseline_name": baseline_name,
            "note": note,
            "source": self.source,
        }
        self.path.parent.mkdir(parents=True, exist_ok=True)
        self.path.write_text(json.dumps(figures, indent=1, sort_keys=True) + "\n")
        print(f"{'met ' if met else 'MISS'} {name}: {value:.4g} {unit} (asked {asked}, {baseline_name} {baseline})")
        return met


def cpu_seconds(call: Callable[[], Any], rounds: int = 5) -> float:
    """Median CPU seconds of a call in this process."""
    spent = []
    for _ in range(rounds):
        start = time.process_time()
        call()
        spent.append(time.process_time() - start)
    return sorted(spent)[len(spent) // 2]
