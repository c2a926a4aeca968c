"""Time-varying meshes as one USD stage: points, faces and colours are time samples of one mesh."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.formats.gltf import to_linear, to_srgb
from app.formats.meshfile import MeshFile, check_mesh, fan, to_int32, y_up_to_z_up
from app.formats.tvm.frames import FrameMesh, MeshFrames
from app.formats.usd import begin_stage, export_stage, usd_library
from imitation.errors import InputError
from imitation.progress import Progress, silent


def write_usd_frames(
    path: Path,
    frames: Iterable[FrameMesh],
    *,
    fps: Fraction | float,
    count: int,
    name: str = "performance",
    progress: Progress | None = None,
) -> None:
    """Write frames as a USD stage: Z up, metres, one time code a frame from 0, fps time codes a second.

    Faces are samples only where they change, so that a mesh that keeps them has them once. The stage is kept in memory
    until it is written.

    Raises
    ------
    InputError
        usd-core is missing.
    """
    pxr = usd_library()
    report = progress or silent
    stage, mesh = begin_stage(path.name, name, fps, count)
    points, extent = mesh.CreatePointsAttr(), mesh.CreateExtentAttr()
    counts, corners = mesh.CreateFaceVertexCountsAttr(), mesh.CreateFaceVertexIndicesAttr()
    colours: Any = None
    last: NDArray[np.int32] | None = None
    for frame, each in enumerate(frames):
        places = np.ascontiguousarray(each.vertices, np.float32)
        points.Set(pxr.Vt.Vec3fArray.FromNumpy(places), frame)
        extent.Set(pxr.Vt.Vec3fArray.FromNumpy(np.stack([places.min(axis=0), places.max(axis=0)])), frame)
        if last is None or not np.array_equal(each.faces, last):
            counts.Set(pxr.Vt.IntArray.FromNumpy(np.full(len(each.faces), 3, np.int32)), frame)
            corners.Set(pxr.Vt.IntArray.FromNumpy(np.ascontiguousarray(each.faces, np.int32).reshape(-1)), frame)
            last = each.faces
        if each.colours is not None or colours is not None:
            if colours is None:
                colours = mesh.CreateDisplayColorPrimvar(pxr.UsdGeom.Tokens.vertex)
            painted = each.colours if each.colours is not None else np.full(places.shape, 255, np.uint8)
            linear = np.ascontiguousarray(to_linear(painted) / np.float32(65535), np.float32)
            colours.Set(pxr.Vt.Vec3fArray.FromNumpy(linear), frame)
        report((frame + 1) / (count + 1))
    export_stage(stage, path)
    report(1.0)


class UsdFrames(MeshFrames):
    """The first mesh of a stage at each time sample of its points, whether its faces change or not."""

    form = "USD"
    up = "z"

    def __init__(self, path: Path) -> None:
        self._pxr = usd_library()
        self.name = path.name
        try:
            self._open(str(path))
        except self._pxr.Tf.ErrorException as error:
            raise InputError(f"The file {path.name} is not a USD stage that can be read.") from error

    def _open(self, path: str) -> None:
        self._stage = self._pxr.Usd.Stage.Open(path)
        prims = [prim for prim in self._stage.Traverse() if prim.IsA(self._pxr.UsdGeom.Mesh)]
        if not prims:
            raise InputError(f"The USD stage {self.name} holds no mesh.")
        if len(prims) > 1:
            self.remark = f"{self.name} holds {len(prims)} meshes: {prims[0].GetName()} is taken."
        self._prim, self._mesh = prims[0], self._pxr.UsdGeom.Mesh(prims[0])
        self._samples = self._mesh.GetPointsAttr().GetTimeSamples()
        if len(self._samples) < 2:
            raise InputError(f"The file {self.name} holds one frame only: a sequence needs at least two.")
        # Where faces are no time samples, or one only, all frames share them.
        self.moving = len(self._mesh.GetFaceVertexIndicesAttr().GetTimeSamples()) < 2
        rate = self._stage.GetTimeCodesPerSecond()
        step = float(np.median(np.diff(self._samples)))
        if not 0 < rate / step <= 1000:
            raise InputError(f"The USD stage {self.name} has no frame rate that can be: export it again.")
        self.fps = Fraction(rate / step).limit_denominator(1001)
        stated = self._pxr.UsdGeom.StageHasAuthoredMetersPerUnit(self._stage)
        unit = float(self._pxr.UsdGeom.GetStageMetersPerUnit(self._stage)) if stated else 0.0
        self.unit = unit if 0.0 < unit < np.inf else None
        self._turned = self._pxr.UsdGeom.GetStageUpAxis(self._stage) == self._pxr.UsdGeom.Tokens.y

    def __len__(self) -> int:
        return len(self._samples)

    def _frame(self, frame: int) -> FrameMesh:
        at = self._samples[frame]
        try:
            local = np.asarray(self._mesh.GetPointsAttr().Get(at), np.float64).reshape(-1, 3)
            matrix = np.array(self._pxr.UsdGeom.XformCache(at).GetLocalToWorldTransform(self._prim))
            vertices = local @ matrix[:3, :3] + matrix[3, :3]
            counts = np.asarray(self._mesh.GetFaceVertexCountsAttr().Get(at), np.int64)
            corners = np.asarray(self._mesh.GetFaceVertexIndicesAttr().Get(at), np.int64)
            if (counts < 0).any() or counts.sum() != len(corners):
                raise ValueError("faces")
            if (counts == 3).all():
                faces = corners.reshape(-1, 3)
            else:
                faces = fan([part.tolist() for part in np.split(corners, np.cumsum(counts)[:-1])])
        except (ValueError, TypeError, IndexError, self._pxr.Tf.ErrorException) as error:
            raise InputError(f"Frame {frame} of {self.name} is no whole mesh: export it again.") from error
        vertices = y_up_to_z_up(vertices) if self._turned else vertices
        colours = self._colours(at, len(vertices))
        mesh = check_mesh(MeshFile(vertices, to_int32(faces, self.name), colours, "z", self.name))
        return FrameMesh(mesh.vertices, mesh.faces, mesh.colors)

    def _colours(self, at: float, count: int) -> NDArray[np.uint8] | None:
        # Colours that cannot be read are no reason to refuse the surface.
        try:
            return self._painted(at, count)
        except (self._pxr.Tf.ErrorException, ValueError, TypeError):
            return None

    def _painted(self, at: float, count: int) -> NDArray[np.uint8] | None:
        painted = self._mesh.GetDisplayColorPrimvar()
        if not painted or painted.GetInterpolation() != self._pxr.UsdGeom.Tokens.vertex:
            return None
        values = painted.Get(at)
        colours = None if values is None else np.asarray(values, np.float64).reshape(-1, 3)
        return None if colours is None or len(colours) != count else to_srgb(np.clip(colours, 0.0, 1.0))
