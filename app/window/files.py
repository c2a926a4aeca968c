"""Opening, saving, bringing in and exporting, as a person asks for it: dialogs, drops, and their errors."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtWidgets import QFileDialog, QMessageBox, QWidget

from app.actions.kinds import GLTF, MESHES, VIDEOS
from app.actions.lost_media import LostMedium
from app.storage.folder import SUFFIX
from app.window import settings
from app.window.project import Project

VIDEO_FILTER = f"Videos ({' '.join('*' + suffix for suffix in sorted(VIDEOS))});;All files (*)"
MESH_FILTER = f"Meshes ({' '.join('*' + suffix for suffix in sorted(MESHES | GLTF))});;All files (*)"
EXPORT_FILTER = "Animated GLB (*.glb);;Universal Scene Description (*.usd);;NumPy (*.npz)"


def ask_project(parent: QWidget) -> Path | None:
    """Ask for a project folder."""
    recent = settings.recent_projects()
    start = recent[0].parent if recent else Path.home()
    chosen = QFileDialog.getExistingDirectory(parent, "Open a project", str(start))
    return Path(chosen) if chosen else None


def ask_place(parent: QWidget, project: Project) -> Path | None:
    """Ask where to save."""
    folder = project.session.folder.path.parent if project.session.titled else Path.home()
    start = folder / f"{project.document.name}{SUFFIX}"
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


def ask_medium(parent: QWidget, lost: LostMedium) -> Path | None:
    """Ask where a medium lies now; a folder of pictures or meshes is asked for as a folder."""
    title, start = f"Where is {lost.name}?", str(_nearest(Path(lost.media.path).parent))
    if not Path(lost.name).suffix:
        chosen = QFileDialog.getExistingDirectory(parent, title, start)
    else:
        same = f"{lost.name} ({lost.name});;All files (*)"
        chosen, _ = QFileDialog.getOpenFileName(parent, title, start, same)
    return Path(chosen) if chosen else None


def _nearest(folder: Path) -> Path:
    """The folder, or what is left of the way to it."""
    while not folder.is_dir() and folder != folder.parent:
        folder = folder.parent
    return folder if folder.is_absolute() else Path.home()
