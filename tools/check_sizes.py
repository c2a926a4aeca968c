"""Check what no linter knows: a module above 400 lines is two modules."""

from __future__ import annotations

import sys
from pathlib import Path

LIMIT = 400
PACKAGES = ("app", "imitation", "tvmedit", "resources", "tests", "tools")


def main() -> None:
    """Name the modules that are too long."""
    long = [
        (path, count)
        for package in PACKAGES
        for path in sorted(Path(package).rglob("*.py"))
        if (count := len(path.read_text().splitlines())) > LIMIT
    ]
    for path, count in long:
        print(f"{path} has {count} lines, more than {LIMIT}: it is two modules.", file=sys.stderr)
    raise SystemExit(1 if long else 0)


if __name__ == "__main__":
    main()
