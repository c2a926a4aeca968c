"""Write the versions installed here, which the tests passed with, to constraints.txt."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

HEADER = "# Versions that the tests pass with; written by make lock.\n"
OURS = ("motionwright", "pip", "setuptools", "wheel")


def main() -> None:
    """Ask pip what is installed and leave out ourselves and pip's own."""
    listed = subprocess.run(
        [sys.executable, "-m", "pip", "list", "--format=freeze"], check=True, capture_output=True, text=True
    ).stdout
    lines = [line for line in listed.splitlines() if line.split("==")[0].lower() not in OURS]
    Path("constraints.txt").write_text(HEADER + "\n".join(sorted(lines, key=str.lower)) + "\n")


if __name__ == "__main__":
    main()
