"""Tell the user's desktop about the program: an entry in its menu, an icon, and what a project file is."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from importlib.resources import files
from pathlib import Path

from app.formats.atomic import explained, replacing
from imitation.errors import InputError

MIME = "application/x-motionwright"
ENTRY = """[Desktop Entry]
Type=Application
Version=1.5
Name=Motionwright
GenericName=Animation from filmed motion
Comment=Take motion from where it was filmed or captured and make new animation of it
Exec={command} %f
TryExec={program}
Icon=motionwright
Terminal=false
StartupNotify=true
StartupWMClass=motionwright
Categories=Graphics;3DGraphics;AudioVideo;Video;
Keywords=animation;motion;tracking;mesh;volumetric;video;
MimeType={mime};
"""
# A project is a folder; the file inside is what a file manager can open, told from other JSON by its first line.
PACKAGE = """<?xml version="1.0" encoding="UTF-8"?>
<mime-info xmlns="http://www.freedesktop.org/standards/shared-mime-info">
  <mime-type type="{mime}">
    <comment>Motionwright project</comment>
    <sub-class-of type="application/json"/>
    <icon name="application-x-motionwright"/>
    <glob pattern="*.motionwright"/>
    <magic priority="60">
      <match type="string" offset="0:16" value="&quot;format&quot;: &quot;motionwright&quot;"/>
    </magic>
  </mime-type>
</mime-info>
"""


def install_desktop() -> list[Path]:
    """Write menu entry, icon and file type into the user's data folder; gives the files written.

    Raises ``InputError`` on systems that keep such things elsewhere, or where the folder cannot be written.
    """
    _linux_only()
    program = _program()
    icon = (files("resources") / "icons" / "motionwright.svg").read_bytes()
    entry = ENTRY.format(command=_quoted(program), program=program, mime=MIME).encode()
    contents = dict(zip(_targets(), (entry, PACKAGE.format(mime=MIME).encode(), icon, icon), strict=True))
    for path, content in contents.items():
        with replacing(path) as beside:
            beside.write_bytes(content)
    _refresh()
    return list(contents)


def remove_desktop() -> list[Path]:
    """Take back what ``install_desktop`` wrote; gives the files that were there."""
    _linux_only()
    there = [path for path in _targets() if path.exists()]
    for path in there:
        with explained(path):
            path.unlink()
    _refresh()
    return there


def _linux_only() -> None:
    if sys.platform in ("win32", "darwin"):
        raise InputError(
            "Menu entries are written on Linux only: on Windows make a shortcut to motionwright-gui.exe, "
            "on macOS start motionwright-gui from a terminal (docs/install.md)."
        )


def _data() -> Path:
    stated = os.environ.get("XDG_DATA_HOME", "")
    return Path(stated) if stated.startswith("/") else Path.home() / ".local" / "share"


def _targets() -> tuple[Path, Path, Path, Path]:
    data = _data()
    icons = data / "icons" / "hicolor" / "scalable"
    return (
        data / "applications" / "motionwright.desktop",
        data / "mime" / "packages" / "motionwright.xml",
        icons / "apps" / "motionwright.svg",
        icons / "mimetypes" / "application-x-motionwright.svg",
    )


def _program() -> Path:
    """The windowed program: the one on the path where it is ours, else the one beside this Python."""
    beside = Path(sys.executable).parent / "motionwright-gui"
    found = shutil.which("motionwright-gui")
    if found is not None and (not beside.exists() or Path(found).resolve() == beside.resolve()):
        return Path(found).absolute()
    if beside.exists():
        return beside.absolute()
    raise InputError("The program motionwright-gui is not installed: install Motionwright with pipx or pip first.")


def _quoted(program: Path) -> str:
    """A path as the Exec line of a menu entry wants it."""
    text = str(program).replace("%", "%%")
    for character in '\\"`$':
        text = text.replace(character, "\\" + character)
    return f'"{text}"'.replace("\\", "\\\\")


def _refresh() -> None:
    """Let the desktop read again what it keeps a list of; a desktop without these programs reads the files."""
    data = _data()
    for program, folder in (
        ("update-mime-database", data / "mime"),
        ("update-desktop-database", data / "applications"),
    ):
        found = shutil.which(program)
        if found is not None and folder.is_dir():
            subprocess.run([found, str(folder)], check=False, capture_output=True)
