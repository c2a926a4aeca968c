"""Shapes and cameras for the tests of rendering, and VTK as a second opinion."""

from __future__ import annotations

import numpy as np

from imitation.geometry.projection import Camera
from imitation.rendering import look_at

SIZE = (320, 240)


def off_centre_camera(seed: int = 0, size: tuple[int, int] = SIZE) -> Camera:
    """A camera with fx != fy and its principal point far from the middle, looking at the origin."""
    rng = np.random.default_rng(seed)
    K = np.array([[350.0, 0, size[0] * 0.57], [0, 390.0, size[1] * 0.38], [0, 0, 1]])
    place = np.array([np.cos(seed), np.sin(seed), 0.45]) * 5 + rng.normal(0, 0.2, 3)
    return look_at(place, np.zeros(3), np.array([0.1, 0.05, 1.0]), K)


def ball(centre: np.ndarray, radius: float = 0.1, rings: int = 14) -> tuple[np.ndarray, np.ndarray]:
    """A ball as triangles."""
    up = np.linspace(0, np.pi, rings + 1)
    round_ = np.linspace(0, 2 * np.pi, 2 * rings, endpoint=False)
    places = [(np.sin(a) * np.cos(b), np.sin(a) * np.sin(b), np.cos(a)) for a in up for b in round_]
    faces = []
    for i in range(rings):
        for j in range(2 * rings):
            a, b = 2 * rings * i + j, 2 * rings * i + (j + 1) % (2 * rings)
            faces += [(a, a + 2 * rings, b), (b, a + 2 * rings, b + 2 * rings)]
    return centre + radius * np.array(places), np.array(faces, np.int32)


def bumpy(seed: int = 3) -> tuple[np.ndarray, np.ndarray]:
    """A ball with bumps, not convex."""
    vertices, faces = ball(np.zeros(3), 1.0, 20)
    waves = np.random.default_rng(seed).normal(0, 2.5, (3, 3))
    return vertices * (1 + 0.25 * np.sin(vertices @ waves).mean(axis=1, keepdims=True)), faces


class VtkRenderer:
    """The same cameras by VTK off-screen (EGL): an explicit projection matrix, a pose, supersampling."""

    def __init__(self, vertices: np.ndarray, faces: np.ndarray, size: tuple[int, int], samples: int = 1) -> None:
        from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
        from vtkmodules.vtkCommonCore import vtkPoints
        from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
        from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper, vtkRenderer
        from vtkmodules.vtkRenderingOpenGL2 import vtkEGLRenderWindow

        self.size, self.samples = size, samples
        self.points = np.ascontiguousarray(vertices, np.float64).copy()
        self._array = numpy_to_vtk(self.points, deep=False)
        self._vtk_points = vtkPoints()
        self._vtk_points.SetData(self._array)
        cells = vtkCellArray()
        table = np.concatenate([np.full((len(faces), 1), 3), faces], axis=1).astype(np.int64).reshape(-1)
        cells.ImportLegacyFormat(numpy_to_vtkIdTypeArray(table, deep=True))
        self._data = vtkPolyData()
        self._data.SetPoints(self._vtk_points)
        self._data.SetPolys(cells)
        mapper, actor = vtkPolyDataMapper(), vtkActor()
        mapper.SetInputData(self._data)
        actor.SetMapper(mapper)
        self.renderer = vtkRenderer()
        self.renderer.AddActor(actor)
        self.window = vtkEGLRenderWindow()
        self.window.SetOffScreenRendering(True)
        self.window.SetMultiSamples(0)
        self.window.SetAlphaBitPlanes(1)
        self.window.SetSize(size[0] * samples, size[1] * samples)
        self.renderer.SetBackground(0, 0, 0)
        self.renderer.SetBackgroundAlpha(0.0)
        self.window.AddRenderer(self.renderer)

    def draw(self, vertices: np.ndarray, camera: Camera, near: float = 0.1, far: float = 100.0) -> np.ndarray:
        """RGBA (h, w, 4), averaged over the samples."""
        s = self.samples
        image = self.read(vertices, camera, near, far).reshape(self.size[1], s, self.size[0], s, 4)
        return image[::-1, ::-1].mean(axis=(1, 3))

    def read(self, vertices: np.ndarray, camera: Camera, near: float = 0.1, far: float = 100.0) -> np.ndarray:
        """RGBA of every sample, from the bottom row up, as VTK reads it back."""
        from vtkmodules.util.numpy_support import vtk_to_numpy
        from vtkmodules.vtkCommonCore import vtkUnsignedCharArray
        from vtkmodules.vtkCommonMath import vtkMatrix4x4

        self.points[:] = vertices
        self._array.Modified()
        self._vtk_points.Modified()
        self._data.Modified()
        (width, height), K = self.size, camera.K
        view = self.renderer.GetActiveCamera()
        view.SetPosition(*camera.centre)
        view.SetFocalPoint(*(camera.centre + camera.R[2]))
        view.SetViewUp(*-camera.R[1])
        matrix = vtkMatrix4x4()
        matrix.Zero()
        matrix.SetElement(0, 0, 2 * K[0, 0] / width)
        matrix.SetElement(0, 2, 1 - 2 * (K[0, 2] + 0.5) / width)
        matrix.SetElement(1, 1, 2 * K[1, 1] / height)
        matrix.SetElement(1, 2, 2 * (K[1, 2] + 0.5) / height - 1)
        matrix.SetElement(2, 2, -(far + near) / (far - near))
        matrix.SetElement(2, 3, -2 * far * near / (far - near))
        matrix.SetElement(3, 2, -1)
        view.SetUseExplicitProjectionTransformMatrix(True)
        view.SetExplicitProjectionTransformMatrix(matrix)
        self.window.Render()
        buffer = vtkUnsignedCharArray()
        s = self.samples
        self.window.GetRGBACharPixelData(0, 0, width * s - 1, height * s - 1, 0, buffer)
        return vtk_to_numpy(buffer)

    def close(self) -> None:
        """Free the window."""
        self.window.Finalize()
