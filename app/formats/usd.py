"""USD: one mesh whose points are time samples; needs the optional package usd-core."""

from __future__ import annotations

import errno
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np

from app.formats.gltf import to_linear, to_srgb
from app.formats.meshfile import to_int32, y_up_to_z_up
from app.formats.sequence import MeshSequence, mesh_sequence
from imitation.errors import InputError
from imitation.progress import Progress, silent

USD_SUFFIXES = (".usd", ".usda", ".usdc")


def write_usd(path: Path, sequence: MeshSequence, progress: Progress | None = None) -> None:
    """Write a sequence as a USD stage: Z up, metres, one time code a frame from 0, fps time codes a second."""
    pxr = usd_library()
    report = progress or silent
    stage, mesh = begin_stage(path.name, sequence.name, sequence.fps, len(sequence))
    mesh.CreateFaceVertexCountsAttr(pxr.Vt.IntArray.FromNumpy(np.full(len(sequence.faces), 3, np.int32)))
    mesh.CreateFaceVertexIndicesAttr(pxr.Vt.IntArray.FromNumpy(sequence.faces.reshape(-1)))
    points, extent = mesh.CreatePointsAttr(), mesh.CreateExtentAttr()
    for frame, vertices in enumerate(sequence.vertices):
        single = np.ascontiguousarray(vertices, np.float32)
        points.Set(pxr.Vt.Vec3fArray.FromNumpy(single), frame)
        extent.Set(pxr.Vt.Vec3fArray.FromNumpy(np.stack([single.min(axis=0), single.max(axis=0)])), frame)
        report((frame + 1) / (len(sequence) + 1))
    if sequence.colors is not None:
        colors = mesh.CreateDisplayColorPrimvar(pxr.UsdGeom.Tokens.vertex)
        linear = np.ascontiguousarray(to_linear(sequence.colors) / np.float32(65535), np.float32)
        colors.Set(pxr.Vt.Vec3fArray.FromNumpy(linear))
    export_stage(stage, path)
    report(1.0)


def read_usd(path: Path) -> MeshSequence:
    """Read the first mesh of a stage at each of its time samples, turned to Z up where the stage is Y up."""
    pxr = usd_library()
    try:
        stage = pxr.Usd.Stage.Open(str(path))
    except pxr.Tf.ErrorException as error:
        raise InputError(f"The file {path.name} is not a USD stage that can be read.") from error
    prims = [prim for prim in stage.Traverse() if prim.IsA(pxr.UsdGeom.Mesh)]
    if not prims:
        raise InputError(f"The USD stage {path.name} holds no mesh.")
    mesh = pxr.UsdGeom.Mesh(prims[0])
    points = mesh.GetPointsAttr()
    samples = points.GetTimeSamples() or [pxr.Usd.TimeCode.Default()]
    place = pxr.UsdGeom.XformCache()
    frames = []
    for sample in samples:
        place.SetTime(sample)
        matrix = np.array(place.GetLocalToWorldTransform(prims[0]))
        local = np.asarray(points.Get(sample), np.float64).reshape(-1, 3)
        frames.append(local @ matrix[:3, :3] + matrix[3, :3])
    if len({len(frame) for frame in frames}) != 1:
        raise InputError(f"The mesh of {path.name} changes its number of vertices: a sequence of one is needed.")
    counts = np.asarray(mesh.GetFaceVertexCountsAttr().Get())
    corners = np.asarray(mesh.GetFaceVertexIndicesAttr().Get(), np.int64)
    if (counts != 3).any():
        raise InputError(f"The mesh of {path.name} has polygons: triangulate it first.")
    vertices = np.stack(frames)
    if pxr.UsdGeom.GetStageUpAxis(stage) == pxr.UsdGeom.Tokens.y:
        vertices = y_up_to_z_up(vertices)
    painted = mesh.GetDisplayColorPrimvar()
    colors = None
    if painted and painted.GetInterpolation() == pxr.UsdGeom.Tokens.vertex and painted.Get() is not None:
        colors = to_srgb(np.asarray(painted.Get()))
    fps = Fraction(stage.GetTimeCodesPerSecond()).limit_denominator(1001)
    return mesh_sequence(vertices, to_int32(corners.reshape(-1, 3), path.name), fps, colors, prims[0].GetName())


def begin_stage(title: str, name: str, fps: Fraction | float, count: int) -> tuple[Any, Any]:
    """Make a stage in memory and its one mesh: Z up, metres, one time code a frame from 0, fps time codes a second."""
    pxr = usd_library()
    stage = pxr.Usd.Stage.CreateInMemory(title)
    pxr.UsdGeom.SetStageUpAxis(stage, pxr.UsdGeom.Tokens.z)
    pxr.UsdGeom.SetStageMetersPerUnit(stage, 1.0)
    stage.SetTimeCodesPerSecond(float(fps))
    stage.SetFramesPerSecond(float(fps))
    stage.SetStartTimeCode(0)
    stage.SetEndTimeCode(count - 1)
    root = pxr.UsdGeom.Xform.Define(stage, "/World")
    stage.SetDefaultPrim(root.GetPrim())
    mesh = pxr.UsdGeom.Mesh.Define(stage, "/World/" + pxr.Tf.MakeValidIdentifier(name))
    mesh.CreateSubdivisionSchemeAttr(pxr.UsdGeom.Tokens.none)
    return stage, mesh


def export_stage(stage: Any, path: Path) -> None:
    """Write a stage; raises ``OSError`` where the place does not take it."""
    pxr = usd_library()
    try:
        exported = stage.GetRootLayer().Export(str(path))
    except pxr.Tf.ErrorException as error:
        full = "No space left" in str(error) or "File too large" in str(error)
        raise OSError(errno.ENOSPC if full else errno.EIO, "the USD library failed") from error
    if not exported:
        raise OSError(errno.EIO, "the USD library failed")


def usd_library() -> Any:
    """Give the parts of usd-core that are used; it is an optional extra."""
    try:
        from pxr import Tf, Usd, UsdGeom, Vt
    except ImportError as error:
        raise InputError('USD needs the package usd-core: pip install "motionwright[usd]", or write GLB.') from error
    import types

    return types.SimpleNamespace(Tf=Tf, Usd=Usd, UsdGeom=UsdGeom, Vt=Vt)
