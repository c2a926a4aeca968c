"""Print build/bench.json as a table: what was measured beside what was asked."""

from __future__ import annotations

import json
from pathlib import Path


def main() -> None:
    """Print one line a figure, misses first."""
    figures = json.loads(Path("build/bench.json").read_text())
    for name, figure in sorted(figures.items(), key=lambda item: (item[1]["met"], item[0])):
        mark = "met " if figure["met"] else "MISS"
        asked = "" if figure["asked"] is None else f" asked {figure['asked']:g}"
        baseline = "" if figure["baseline"] is None else f", {figure['baseline_name']} {figure['baseline']:.4g}"
        print(f"{mark} {name}: {figure['value']:.4g} {figure['unit']}{asked}{baseline}")
    missed = sum(not figure["met"] for figure in figures.values())
    print(f"{len(figures)} figures, {missed} missed")


if __name__ == "__main__":
    main()
