"""A folder of meshes, one file a frame, in the natural order of their names."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

from app.formats.images import natural_key
from app.formats.meshes import read_mesh
from app.formats.meshfile import check_mesh, mesh_bytes
from app.formats.obj import read_obj
from app.formats.ply import read_ply
from app.formats.tvm.dress import obj_dress
from app.formats.tvm.frames import FrameMesh, MeshFrames
from app.formats.tvm.glb_dress import read_dressed_glb
from app.formats.tvm.pictures import PictureRoom
from app.formats.tvm.ply_dress import ply_texture
from imitation.errors import InputError

SUFFIXES = (".ply", ".obj", ".off", ".stl", ".glb")


class FolderFrames(MeshFrames):
    """Files of one format; colours and, for PLY, OBJ and GLB, textures come along, for OBJ materials too."""

    def __init__(self, folder: Path) -> None:
        self.paths = frame_files(folder)
        self.folder, self.name = folder, folder.name
        self._room = PictureRoom()
        suffix = self.paths[0].suffix.lower()
        self.form = f"{suffix[1:].upper()} folder"
        if suffix == ".glb":
            # glTF says Y up and metres; its reader turns it to Z up.
            self.up, self.unit = "z", 1.0

    def __len__(self) -> int:
        return len(self.paths)

    def _frame(self, frame: int) -> FrameMesh:
        path = self.paths[frame]
        kind = path.suffix.lower()
        if kind not in (".obj", ".ply", ".glb"):
            mesh = read_mesh(path)
            return FrameMesh(mesh.vertices, mesh.faces, mesh.colors)
        data = mesh_bytes(path)
        if kind == ".glb":
            return read_dressed_glb(path, data, self._room)
        if kind == ".ply":
            mesh = check_mesh(read_ply(data, path.name))
            return FrameMesh(mesh.vertices, mesh.faces, mesh.colors, ply_texture(data, path, mesh))
        mesh = check_mesh(read_obj(data, path.name))
        colours, texture = obj_dress(data, path, mesh)
        return FrameMesh(mesh.vertices, mesh.faces, mesh.colors if mesh.colors is not None else colours, texture)


def frame_files(folder: Path) -> list[Path]:
    """Give the meshes of a folder in natural order (2 before 10).

    Raises ``InputError`` when there are none, only one, or several formats.
    """
    try:
        entries = sorted(folder.iterdir())
    except OSError as error:
        raise InputError(f"The folder {folder} cannot be read: {error.strerror or error}.") from error
    paths = [each for each in entries if each.suffix.lower() in SUFFIXES and not each.name.startswith(".")]
    if not paths:
        raise InputError(f"The folder {folder} holds no PLY, OBJ, OFF, STL or GLB files: choose another one.")
    kinds = Counter(each.suffix.lower()[1:].upper() for each in paths)
    if len(kinds) > 1:
        counted = ", ".join(f"{count} {kind}" for kind, count in sorted(kinds.items()))
        raise InputError(f"The folder {folder.name} mixes formats ({counted}): leave one of them in it.")
    if len(paths) < 2:
        raise InputError(f"The folder {folder.name} holds one mesh only: a sequence needs at least two frames.")
    return sorted(paths, key=lambda each: natural_key(each.name))
