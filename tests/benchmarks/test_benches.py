"""The figures themselves take long, and are not part of every run: what they stand on is."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]


def test_every_bench_has_what_it_asks_for() -> None:
    """Benches import fixtures of other folders by name: one that asks for another, not imported, cannot begin."""
    options = ["-m", "bench", "-o", "python_files=bench_*.py", "-p", "no:xdist", "-p", "no:cacheprovider"]
    asked = [sys.executable, "-m", "pytest", *options, "--setup-plan", "-q", "tests/benchmarks"]
    done = subprocess.run(asked, cwd=ROOT, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stdout[-3000:]
    assert "test_update" in done.stdout
