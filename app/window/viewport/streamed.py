"""A mesh that is another one in every frame, as captures are: arrays are handed over, nothing is computed from them."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkImageData, vtkPolyData
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper, vtkTexture

from app.window.viewport.scene import CLAY, Scene

SHADE = (0.055, 0.065, 0.08)


class Shown(Protocol):
    """Vertices and normals (v, 3) float32, faces (m, 3) int32, colours (v, 3) uint8 or None; places (v, 2) float32 in a
    picture (h, w, 3) uint8, rows from the top, or None for both. closed : whether its inside is never seen.
    """

    vertices: NDArray[np.float32]
    normals: NDArray[np.float32]
    faces: NDArray[np.int32]
    colours: NDArray[np.uint8] | None
    coordinates: NDArray[np.float32] | None
    picture: NDArray[np.uint8] | None
    closed: bool


class StreamedMesh:
    """One such mesh in a scene, by name; see-through where ``opacity`` is less than 1.

    The arrays are shared with the renderer, so they must not be changed afterwards.
    """

    def __init__(self, scene: Scene, name: str, *, opacity: float = 1.0) -> None:
        self._scene, self._name = scene, name
        self._data, self._mapper = vtkPolyData(), vtkPolyDataMapper()
        self._mapper.SetInputData(self._data)
        self._mapper.SetColorModeToDirectScalars()
        self._actor = vtkActor()
        self._actor.SetMapper(self._mapper)
        look = self._actor.GetProperty()
        self._picture: NDArray[np.uint8] | None = None
        look.SetInterpolationToPhong()
        look.SetAmbient(0.20)
        look.SetDiffuse(0.85)
        look.SetSpecular(0.10)
        look.SetSpecularPower(18.0)
        look.SetOpacity(opacity)
        self._there = False

    def show(self, frame: Shown, *, quick: bool = False) -> None:
        """Show another frame; a quick one leaves out what faces away where that is never seen: cheaper, the same."""
        data = self._data
        self._actor.GetProperty().SetBackfaceCulling(quick and frame.closed)
        _fill(data, frame.vertices, frame.faces)
        data.GetPointData().SetNormals(numpy_to_vtk(frame.normals))
        data.GetPointData().SetScalars(None if frame.colours is None else numpy_to_vtk(frame.colours))
        self._mapper.SetScalarVisibility(frame.colours is not None)
        self._wear(frame.coordinates, frame.picture)
        data.Modified()
        if not self._there:
            self._there = True
            self._scene.put(self._name, self._actor)

    def _wear(self, coordinates: NDArray[np.float32] | None, picture: NDArray[np.uint8] | None) -> None:
        self._data.GetPointData().SetTCoords(None if coordinates is None else numpy_to_vtk(coordinates))
        if picture is not self._picture:
            self._picture = picture
            self._actor.SetTexture(None if picture is None else _texture(picture))
        paint = CLAY if picture is None else (255, 255, 255)
        self._actor.GetProperty().SetColor(*(value / 255 for value in paint))

    def hide(self) -> None:
        """Take it out of the scene."""
        if self._there:
            self._there = False
            self._scene.take_out(self._name)
            self._data.Initialize()
            self._wear(None, None)


class StreamedShadow:
    """The shadow of such a mesh, flat on the ground."""

    def __init__(self, scene: Scene, name: str) -> None:
        self._scene, self._name = scene, name
        self._data, mapper = vtkPolyData(), vtkPolyDataMapper()
        mapper.SetInputData(self._data)
        mapper.ScalarVisibilityOff()
        self._actor = vtkActor()
        self._actor.SetMapper(mapper)
        self._actor.GetProperty().LightingOff()
        self._actor.GetProperty().SetColor(*SHADE)
        self._there = False

    def show(self, frame: Shown, ground: float) -> None:
        """Show the shadow on a height."""
        flat = frame.vertices.copy()
        flat[:, 2] = ground
        _fill(self._data, flat, frame.faces)
        self._data.Modified()
        if not self._there:
            self._there = True
            self._scene.put(self._name, self._actor)

    def hide(self) -> None:
        """Take it out of the scene."""
        if self._there:
            self._there = False
            self._scene.take_out(self._name)
            self._data.Initialize()


def _texture(picture: NDArray[np.uint8]) -> vtkTexture:
    """A texture of a picture whose rows come from the top."""
    height, width = picture.shape[:2]
    image = vtkImageData()
    image.SetDimensions(width, height, 1)
    image.GetPointData().SetScalars(numpy_to_vtk(np.ascontiguousarray(picture[::-1]).reshape(-1, 3)))
    texture = vtkTexture()
    texture.SetInputData(image)
    texture.InterpolateOn()
    texture.RepeatOn()
    return texture


def _fill(data: vtkPolyData, vertices: NDArray[np.float32], faces: NDArray[np.int32]) -> None:
    points, cells = vtkPoints(), vtkCellArray()
    points.SetData(numpy_to_vtk(vertices))
    cells.SetData(3, numpy_to_vtk(faces.reshape(-1)))
    data.SetPoints(points)
    data.SetPolys(cells)
