"""The one 3D scene: a mesh that is updated in place, the ground, points, the camera's path. Knows no widget.

It needs a renderer and its window only, so it stands in a picture and in an interactor alike. VTK is used as it is:
pyvista's plotter brings a second's worth of libraries for charts, and the first 3D picture would wait for them.
"""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401 - what windows and renderers are made of
from numpy.typing import ArrayLike, NDArray
from vtkmodules.vtkCommonMath import vtkMatrix4x4
from vtkmodules.vtkFiltersCore import vtkPolyDataNormals
from vtkmodules.vtkRenderingCore import vtkLight, vtkRenderer, vtkRenderWindow

from app.window.viewport.closed import is_closed
from app.window.viewport.grid import ground_grid
from app.window.viewport.lens import Lens
from app.window.viewport.shapes import Shape, actor_of

Array = NDArray[np.float64]
CLAY = (214, 202, 186)
SHADE = (0.055, 0.065, 0.08)
POINTS, PATH = (0x8C / 255, 0x96 / 255, 0xA2 / 255), (0xC3 / 255, 0x9B / 255, 1.0)
LIGHTS = (
    ((-0.9, 1.3, 1.4), 0.78, (1.0, 0xF4 / 255, 0xE4 / 255)),
    ((1.4, 0.4, 0.9), 0.34, (0xDC / 255, 0xE8 / 255, 1.0)),
    ((0.2, 0.9, -1.6), 0.40, (1.0, 1.0, 1.0)),
)
"""Place beside the camera, strength and colour."""


class Stage(Protocol):
    """Where a scene stands."""

    renderer: vtkRenderer
    render_window: vtkRenderWindow


class Scene:
    """What is seen in 3D. Every change marks the scene; drawing is the host's business."""

    def __init__(self, stage: Stage) -> None:
        self.renderer = stage.renderer
        self._mesh: Shape | None = None
        self._shadow: Shape | None = None
        self._far: Array | None = None
        self._own: NDArray[np.uint8] = np.zeros((0, 3), np.uint8)
        self._ground_height = 0.0
        self._closed = False
        self._actors: dict[str, Any] = {}
        self._shown: dict[str, bool] = {}
        self.extent = np.array([[-1.0, -1.0, 0.0], [1.0, 1.0, 1.0]])
        stage.render_window.SetMultiSamples(0)
        self.renderer.SetUseDepthPeeling(False)
        self._blend()
        self.renderer.SetBackgroundAlpha(0.0)
        self.renderer.SetBackground(0.0, 0.0, 0.0)
        self._light()

    def _light(self) -> None:
        self.renderer.RemoveAllLights()
        for place, strength, colour in LIGHTS:
            light = vtkLight()
            light.SetLightTypeToCameraLight()
            light.SetPosition(*place)
            light.SetFocalPoint(0.0, 0.0, 0.0)
            light.SetIntensity(strength)
            light.SetColor(*colour)
            light.PositionalOff()
            self.renderer.AddLight(light)

    def set_mesh(self, vertices: ArrayLike, faces: ArrayLike, colours: NDArray[np.uint8] | None = None) -> None:
        """Show a mesh: vertices (v, 3), triangles (m, 3), colours (v, 3) where it has them."""
        self.clear_mesh()
        corners = np.asarray(faces, np.int64).reshape(-1, 3)
        paint = np.tile(np.array(CLAY, np.uint8), (len(vertices), 1)) if colours is None else colours[:, :3]  # type: ignore[arg-type]
        mesh = Shape(vertices, triangles=corners, colours=paint)
        self._own = np.array(mesh.colours)
        normals = vtkPolyDataNormals()
        normals.SetInputData(mesh.data)
        for switch in (normals.SplittingOff, normals.ConsistencyOff, normals.AutoOrientNormalsOff):
            switch()
        actor = actor_of(normals)
        look = actor.GetProperty()
        look.LightingOn()
        look.SetInterpolationToPhong()
        look.SetAmbient(0.20)
        look.SetDiffuse(0.85)
        look.SetSpecular(0.10)
        look.SetSpecularPower(18.0)
        self._mesh, self._closed = mesh, is_closed(mesh.points, corners)
        self._put("mesh", actor)
        self._make_shadow(mesh, corners)
        self.extent = np.array([mesh.points.min(0), mesh.points.max(0)], np.float64)

    def clear_mesh(self) -> None:
        """Take the mesh away."""
        self._remove("mesh")
        self._remove("shadow")
        self._mesh = self._shadow = None

    def move_mesh(self, vertices: ArrayLike) -> None:
        """Bring the mesh to other places (v, 3); nothing is made anew."""
        if self._mesh is None:
            return
        places = np.asarray(vertices)
        self._mesh.points[:] = places
        self._mesh.moved()
        self.extent = np.array([places.min(0), places.max(0)], np.float64)
        self._move_shadow()

    def leave_out_hidden(self, wanted: bool) -> None:
        """Draw only what faces the camera, where the mesh is closed: the picture is the same at half the cost.

        A deformation may turn a part inside out, so a view at rest is drawn whole.
        """
        for name in ("mesh", "shadow"):
            if name in self._actors:
                self._actors[name].GetProperty().SetBackfaceCulling(wanted and self._closed)

    def paint_mesh(self, colours: NDArray[np.uint8] | None) -> None:
        """Give the vertices other colours (v, 3), or their own again."""
        if self._mesh is None or self._mesh.colours is None:
            return
        self._mesh.colours[:] = self._own if colours is None else colours
        self._mesh.painted()

    def _make_shadow(self, mesh: Shape, corners: NDArray[np.int64]) -> None:
        self._shadow = Shape(mesh.points, triangles=corners)
        self._put("shadow", actor_of(self._shadow, colour=SHADE))
        self._move_shadow()

    def _move_shadow(self) -> None:
        if self._shadow is None or self._mesh is None or not self._shown.get("shadow", True):
            return
        height = float(np.ptp(self._mesh.points[:, 2])) or 1.0
        self._shadow.points[:] = self._mesh.points
        self._shadow.points[:, 2] = self._ground_height + 0.001 * height
        self._shadow.moved()

    def set_ground(self, centre: ArrayLike, radius: float, height: float = 0.0) -> None:
        """Draw a grid on the ground round a place (2,), with the height of the ground."""
        self._ground_height = height
        points, lines, rgba = ground_grid(np.asarray(centre, np.float64)[:2], radius, height)
        self._put("ground", actor_of(Shape(points, lines=lines, colours=rgba)))

    def set_points(self, points: ArrayLike) -> None:
        """Show background points (p, 3)."""
        places = np.asarray(points, np.float32).reshape(-1, 3)
        self._remove("points")
        if len(places):
            actor = actor_of(Shape(places), colour=POINTS)
            actor.GetProperty().SetPointSize(3.0)
            self._put("points", actor)

    def set_camera_path(self, centres: ArrayLike) -> None:
        """Show the way of the camera (n, 3)."""
        places = np.asarray(centres, np.float64).reshape(-1, 3)
        self._remove("path")
        if len(places) > 1:
            following = np.arange(len(places) - 1)
            actor = actor_of(Shape(places, lines=np.stack([following, following + 1], axis=1)), colour=PATH)
            actor.GetProperty().SetLineWidth(2.0)
            self._put("path", actor)

    def set_background(self, vertices: ArrayLike, faces: ArrayLike, colours: NDArray[np.uint8]) -> None:
        """Show the measured background: a mesh (n, 3), (m, 3) with colours (n, 3)."""
        places = np.asarray(vertices, np.float32).reshape(-1, 3)
        self._remove("background")
        self._far = None
        if len(places):
            shape = Shape(places, triangles=np.asarray(faces, np.int64).reshape(-1, 3), colours=colours[:, :3])
            self._put("background", actor_of(shape))
            self._far = np.array([places.min(0), places.max(0)], np.float64)

    @property
    def seen_extent(self) -> Array:
        """Least and largest corner (2, 3) of the mesh and of what is shown of its background."""
        if self._far is None or not self._shown.get("background", True):
            return self.extent
        return np.array([np.minimum(self.extent[0], self._far[0]), np.maximum(self.extent[1], self._far[1])])

    def show(self, name: str, shown: bool) -> None:
        """Show or hide mesh, shadow, ground, points or path; holds for what comes later under that name too."""
        self._shown[name] = shown
        if name in self._actors:
            self._actors[name].SetVisibility(shown)
        if name == "shadow" and shown:
            self._move_shadow()

    def look_through(self, lens: Lens) -> None:
        """Draw by a lens from now on."""
        camera = self.renderer.GetActiveCamera()
        position, focus, up = lens.pose()
        camera.SetPosition(*position)
        camera.SetFocalPoint(*focus)
        camera.SetViewUp(*up)
        camera.SetClippingRange(lens.near, lens.far)
        matrix = vtkMatrix4x4()
        matrix.DeepCopy(lens.projection().ravel())
        camera.SetExplicitProjectionTransformMatrix(matrix)
        camera.SetUseExplicitProjectionTransformMatrix(True)

    def _put(self, name: str, actor: Any) -> None:
        self._remove(name)
        self.renderer.AddActor(actor)
        self._actors[name] = actor
        self._blend()
        actor.SetVisibility(self._shown.get(name, True))

    def _blend(self) -> None:
        """Blend in the order of drawing, which is right for the ground's thin lines, and which costs far less than to
        blend in any order; a see-through mesh, whose triangles come as they come, needs the latter.
        """
        see_through = any(each.GetProperty().GetOpacity() < 1.0 for each in self._actors.values())
        self.renderer.SetUseOIT(see_through)

    def put(self, name: str, actor: Any) -> None:
        """Add an actor made elsewhere under a name; one of that name is taken out."""
        self._put(name, actor)

    def take_out(self, name: str) -> None:
        """Take an actor out by its name."""
        self._remove(name)

    def _remove(self, name: str) -> None:
        actor = self._actors.pop(name, None)
        if actor is not None:
            self.renderer.RemoveActor(actor)
            self._blend()

    def clear(self) -> None:
        """Take everything away, so that nothing outlives its render window."""
        for name in list(self._actors):
            self._remove(name)
        self._mesh = self._shadow = None
