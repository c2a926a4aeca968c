"""Set up the checkout: a virtual environment with everything in it, and the system libraries that a window needs.

Runs on the system's Python with nothing installed. As root on Debian and Ubuntu, missing system packages are
installed; otherwise one sentence names them.
"""

from __future__ import annotations

import ctypes
import os
import shutil
import subprocess
import sys
from pathlib import Path

LIBRARIES = {
    "libEGL.so.1": "libegl1",
    "libGL.so.1": "libgl1",
    "libglib-2.0.so.0": "libglib2.0-0",
    "libfontconfig.so.1": "libfontconfig1",
    "libxkbcommon.so.0": "libxkbcommon0",
    "libdbus-1.so.3": "libdbus-1-3",
}
DESKTOP = {
    "libxcb-cursor.so.0": "libxcb-cursor0",
    "libxcb-icccm.so.4": "libxcb-icccm4",
    "libxcb-keysyms.so.1": "libxcb-keysyms1",
    "libxcb-image.so.0": "libxcb-image0",
    "libxcb-randr.so.0": "libxcb-randr0",
    "libxcb-render-util.so.0": "libxcb-render-util0",
    "libxcb-shape.so.0": "libxcb-shape0",
    "libxcb-xkb.so.1": "libxcb-xkb1",
    "libxcb-sync.so.1": "libxcb-sync1",
    "libxcb-xfixes.so.0": "libxcb-xfixes0",
    "libxkbcommon-x11.so.0": "libxkbcommon-x11-0",
    "libX11-xcb.so.1": "libx11-xcb1",
}


def main() -> None:
    """Do what is still to be done; fast when nothing is."""
    venv = Path(sys.argv[1] if len(sys.argv) > 1 else ".venv")
    if not (3, 11) <= sys.version_info[:2] <= (3, 13):
        found = ".".join(map(str, sys.version_info[:2]))
        stop(f"Motionwright needs Python 3.11 to 3.13, but python3 is {found}: run make PYTHON=python3.11.")
    python = venv / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
    if not works(python):
        make_venv(venv)
    # First what takes a second: who has to ask for system packages should not learn it after the downloads.
    if sys.platform == "linux":
        system_libraries()
    print("Installing what the project needs into", venv, "(some minutes, 2 GB)", flush=True)
    command = [str(python), "-m", "pip", "install", "--quiet", "-c", "constraints.txt", "-e", ".[dev]"]
    if subprocess.run(command, check=False).returncode:
        stop("The packages could not be installed: check the network, then run the same command again.")
    compile_sources(python)


def compile_sources(python: Path) -> None:
    """Write the byte code that pip writes for what it copies: the window starts from it in two thirds of the time."""
    command = [str(python), "-m", "compileall", "-q", "app", "imitation", "tvmedit", "resources"]
    subprocess.run(command, check=False, stdout=subprocess.DEVNULL)


def works(python: Path) -> bool:
    """Whether the environment is there with a pip in it."""
    if not python.exists():
        return False
    return subprocess.run([str(python), "-m", "pip", "--version"], check=False, capture_output=True).returncode == 0


def make_venv(venv: Path) -> None:
    """Make the environment; Debian keeps what this needs in a package of its own."""
    shutil.rmtree(venv, ignore_errors=True)
    command = [sys.executable, "-m", "venv", str(venv)]
    if subprocess.run(command, check=False, capture_output=True).returncode == 0:
        return
    package = f"python{sys.version_info[0]}.{sys.version_info[1]}-venv"
    if not install_packages([package]):
        stop(
            f"Python's venv module is incomplete: install it with 'apt-get install {package}' as root, then try again."
        )
    shutil.rmtree(venv, ignore_errors=True)
    subprocess.run(command, check=True)


def system_libraries() -> None:
    """See to the libraries that Qt and VTK load from the system."""
    needed = missing(LIBRARIES)
    wanted = missing(DESKTOP) if os.environ.get("DISPLAY") else []
    if not needed and not wanted:
        return
    if install_packages(needed + wanted):
        return
    if needed:
        packages = " ".join(needed + wanted)
        stop(
            "The program needs system libraries: install them as root with "
            f"'apt-get install {packages}', then run the same command again."
        )
    print(f"On this desktop the window also needs 'apt-get install {' '.join(wanted)}'.")


def missing(libraries: dict[str, str]) -> list[str]:
    """Give the packages of the libraries that do not load."""
    packages = []
    for library, package in libraries.items():
        try:
            ctypes.CDLL(library)
        except OSError:
            packages.append(package)
    return packages


def install_packages(packages: list[str]) -> bool:
    """Install Debian packages when root; False when that is not possible."""
    if not shutil.which("apt-get") or not hasattr(os, "geteuid") or os.geteuid() != 0:
        return False
    print("Installing system packages:", *packages, flush=True)
    environment = {**os.environ, "DEBIAN_FRONTEND": "noninteractive"}
    for command in (
        ["apt-get", "update", "-qq"],
        ["apt-get", "install", "-y", "-qq", "--no-install-recommends", *packages],
    ):
        done = subprocess.run(command, check=False, env=environment, stdout=subprocess.DEVNULL)
        if done.returncode and command[1] == "install":
            return False
    return True


def stop(sentence: str) -> None:
    """Say what is missing and end."""
    print(sentence, file=sys.stderr)
    raise SystemExit(2)


if __name__ == "__main__":
    main()
