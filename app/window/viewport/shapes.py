"""Arrays as what VTK draws: triangles, lines and points whose arrays stay ours and are changed in place."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper


class Shape:
    """One shape: ``points`` (n, 3) float32 and ``colours`` (n, 3 or 4) uint8 are shared with what draws it.

    Cells are of one kind: triangles (m, 3), lines (m, k) of k points each, or a dot for every point where neither is
    given.
    """

    def __init__(
        self,
        points: ArrayLike,
        *,
        triangles: ArrayLike | None = None,
        lines: ArrayLike | None = None,
        colours: ArrayLike | None = None,
    ) -> None:
        self.points = np.array(points, np.float32).reshape(-1, 3)
        self.colours: NDArray[np.uint8] | None = None
        self.data = vtkPolyData()
        places = vtkPoints()
        places.SetData(numpy_to_vtk(self.points))
        self.data.SetPoints(places)
        if triangles is not None:
            self.data.SetPolys(_cells(triangles))
        elif lines is not None:
            self.data.SetLines(_cells(lines))
        else:
            self.data.SetVerts(_cells(np.arange(len(self.points))[:, None]))
        if colours is not None:
            self.colours = np.array(colours, np.uint8, order="C")
            self.data.GetPointData().SetScalars(numpy_to_vtk(self.colours))

    def moved(self) -> None:
        """Say that the points are elsewhere now."""
        self.data.GetPoints().GetData().Modified()
        self.data.GetPoints().Modified()
        self.data.Modified()

    def painted(self) -> None:
        """Say that the colours are others now."""
        self.data.GetPointData().GetScalars().Modified()
        self.data.Modified()


def actor_of(source: Any, *, colour: tuple[float, float, float] | None = None) -> vtkActor:
    """What draws a shape, or the output of a filter; in one colour where one is given, else in its own.

    It is drawn without light until told otherwise.
    """
    mapper = vtkPolyDataMapper()
    if isinstance(source, Shape):
        mapper.SetInputData(source.data)
    else:
        mapper.SetInputConnection(source.GetOutputPort())
    actor = vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().LightingOff()
    if colour is None:
        mapper.SetColorModeToDirectScalars()
    else:
        mapper.ScalarVisibilityOff()
        actor.GetProperty().SetColor(*colour)
    return actor


def _cells(rows: ArrayLike) -> vtkCellArray:
    """Cells of as many points each, (m, k) indices."""
    indices = np.array(rows, np.int32, order="C")
    made = vtkCellArray()
    made.SetData(indices.shape[1], numpy_to_vtk(indices.reshape(-1)))
    return made
