"""Opening, saving, bringing in and exporting, as a person asks for it: dialogs, drops, and their errors."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from PySide6.QtWidgets import QFileDialog, QMessageBox, QWidget

from app.storage.folder import SUFFIX
from app.window.project import Project

VIDEOS = {".mp4", ".mov", ".avi", ".mkv", ".webm", ".m4v"}
MESHES = {".ply", ".obj", ".off", ".stl"}
VIDEO_FILTER = f"Videos ({' '.join('*' + suffix for suffix in sorted(VIDEOS))});;All files (*)"
MESH_FILTER = f"Meshes ({' '.join('*' + suffix for suffix in sorted(MESHES))});;All files (*)"
EXPORT_FILTER = "Animated GLB (*.glb);;Universal Scene Description (*.usd);;NumPy (*.npz)"


def ask_project(parent: QWidget) -> Path | None:
    """Ask for a project folder."""
    chosen = QFileDialog.getExistingDirectory(parent, "Open a project", str(Path.home()))
    return Path(chosen) if chosen else None


def ask_place(parent: QWidget, project: Project) -> Path | None:
    """Ask where to save."""
    start = Path.home() / f"{project.document.name}{SUFFIX}"
    chosen, _ = QFileDialog.getSaveFileName(parent, "Save the project", str(start), f"Motionwright (*{SUFFIX})")
    return Path(chosen) if chosen else None


def ask_clip(parent: QWidget) -> Path | None:
    """Ask for a video."""
    chosen, _ = QFileDialog.getOpenFileName(parent, "Add a video", str(Path.home()), VIDEO_FILTER)
    return Path(chosen) if chosen else None


def ask_mesh(parent: QWidget) -> Path | None:
    """Ask for a mesh."""
    chosen, _ = QFileDialog.getOpenFileName(parent, "Add a character", str(Path.home()), MESH_FILTER)
    return Path(chosen) if chosen else None


def ask_export(parent: QWidget, name: str) -> Path | None:
    """Ask where to export a character's motion."""
    start = str(Path.home() / f"{name}.glb")
    chosen, _ = QFileDialog.getSaveFileName(parent, "Export the motion", start, EXPORT_FILTER)
    return Path(chosen) if chosen else None


def ask_unsaved(parent: QWidget, name: str) -> str:
    """Ask what becomes of unsaved changes: save, discard or stay."""
    box = QMessageBox(parent)
    box.setIcon(QMessageBox.Icon.NoIcon)
    box.setWindowTitle("Unsaved changes")
    box.setText(f"Save the changes of {name}?")
    save = box.addButton("Save", QMessageBox.ButtonRole.AcceptRole)
    discard = box.addButton("Do not save", QMessageBox.ButtonRole.DestructiveRole)
    box.addButton("Stay", QMessageBox.ButtonRole.RejectRole)
    box.setDefaultButton(save)
    box.exec()
    return {save: "save", discard: "discard"}.get(box.clickedButton(), "stay")


def kind_of(path: Path) -> str:
    """What a dropped file is: project, clip, mesh, or nothing that is known."""
    if path.suffix == SUFFIX or path.name == "project.json":
        return "project"
    if path.suffix.lower() in MESHES:
        return "mesh"
    if path.suffix.lower() in VIDEOS or path.is_dir():
        return "clip"
    return ""


Ask = Callable[..., Path | None]
