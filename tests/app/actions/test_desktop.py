"""The desktop learns of the program: files in the user's data folder, and nothing left when taken back."""

from __future__ import annotations

import configparser
import os
import re
import shutil
import stat
import subprocess
import sys
import tomllib
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest

from app.actions import desktop
from app.commands.main import BAD_INPUT, DONE, run
from app.model.document import Document
from app.storage.schema import document_to_json

ROOT = Path(__file__).resolve().parents[3]


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A home folder of the test's own, and the windowed program in a place with a difficult name."""
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.delenv("XDG_DATA_HOME", raising=False)
    program = tmp_path / "my $tools" / "bin" / "motionwright-gui"
    program.parent.mkdir(parents=True)
    program.write_text("#!/bin/sh\n")
    program.chmod(program.stat().st_mode | stat.S_IXUSR)
    monkeypatch.setattr(sys, "executable", str(program.parent / "python"))
    monkeypatch.setenv("PATH", f"{program.parent}{os.pathsep}{os.environ['PATH']}")
    monkeypatch.setattr(sys, "platform", "linux")
    return tmp_path


def test_the_menu_entry_starts_the_window(home: Path) -> None:
    """It names the program, quoted as the desktop unquotes it, its icon and its file type."""
    assert run(["--quiet", "install-desktop"]) == DONE
    share = home / ".local" / "share"
    parser = configparser.ConfigParser(interpolation=None)
    parser.optionxform = str  # type: ignore[assignment,method-assign]
    parser.read(share / "applications" / "motionwright.desktop")
    entry = parser["Desktop Entry"]
    quoted, field = re.fullmatch(r'"(.*)" (%\w)', entry["Exec"].replace("\\\\", "\\")).groups()  # type: ignore[union-attr]
    assert re.sub(r"\\(.)", r"\1", quoted) == str(home / "my $tools" / "bin" / "motionwright-gui")
    assert field == "%f"
    assert entry["MimeType"] == "application/x-motionwright;"
    assert (share / "icons" / "hicolor" / "scalable" / "apps" / f"{entry['Icon']}.svg").stat().st_size > 100
    if shutil.which("desktop-file-validate"):
        subprocess.run(["desktop-file-validate", share / "applications" / "motionwright.desktop"], check=True)


def test_the_file_type_is_told_by_the_first_line(home: Path) -> None:
    """The words looked for stand where they are looked for in every project file."""
    desktop.install_desktop()
    tree = ET.parse(home / ".local" / "share" / "mime" / "packages" / "motionwright.xml")
    space = {"m": "http://www.freedesktop.org/standards/shared-mime-info"}
    match = tree.find(".//m:match", space)
    assert match is not None
    first, last = map(int, match.attrib["offset"].split(":"))
    place = document_to_json(Document()).find(match.attrib["value"].encode())
    assert first <= place <= last


def test_all_is_taken_back(home: Path) -> None:
    """Removing leaves none of the files; a second time there is nothing to remove."""
    written = desktop.install_desktop()
    assert all(path.is_file() and path.is_relative_to(home) for path in written)
    assert desktop.remove_desktop() == written
    assert not any(path.exists() for path in written)
    assert desktop.remove_desktop() == []


def test_other_systems_are_told_what_to_do(home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """One sentence, exit code of bad input, nothing written."""
    monkeypatch.setattr(sys, "platform", "darwin")
    assert run(["install-desktop"]) == BAD_INPUT
    assert not (home / ".local").exists()


def test_the_wheel_takes_what_the_program_needs_and_no_more() -> None:
    """Every file of resources that is no Python is matched by the package's list; compiled kernels are not."""
    stated = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["setuptools"]["package-data"]["resources"]
    folder = ROOT / "resources"
    listed = subprocess.run(["git", "ls-files", "resources"], cwd=ROOT, capture_output=True, text=True, check=False)
    tracked = {ROOT / name for name in listed.stdout.split("\n") if name and not name.endswith(".py")}
    matched = {path for pattern in stated for path in folder.glob(pattern) if path.is_file()}
    assert {path for path in matched if path.suffix in (".nbi", ".nbc", ".pyc")} == set()
    assert not tracked - matched
    for needed in ("fonts/Inter-Regular.otf", "icons/motionwright.svg", "sample/clip.mp4", "theme/window.qss"):
        assert folder / needed in matched
