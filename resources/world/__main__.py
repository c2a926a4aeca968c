"""Make the files of the built-in sample again: ``python -m resources.world [folder]``."""

from __future__ import annotations

import sys
from pathlib import Path

from resources.world.make import make_sample
from resources.world.sample import FOLDER


def main() -> None:
    """Write the sample into the folder given, or where the program finds it."""
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else FOLDER

    def report(fraction: float) -> None:
        sys.stderr.write(f"\r{100 * fraction:5.1f} %")
        sys.stderr.flush()

    make_sample(folder, report)
    sys.stderr.write(f"\nThe sample is in {folder}.\n")


if __name__ == "__main__":
    main()
