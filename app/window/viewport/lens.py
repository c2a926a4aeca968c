"""What the 3D view looks through: any camera, brought to the widget's own pixels.

Orbiting, looking from the side and looking through a solved camera are all one ``Camera``, so projecting, picking and
dragging are written once. Widget places are continuous: (0, 0) is the top-left corner, not a pixel's centre.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from app.window.canvas.view import View
from imitation.geometry import Camera

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Lens:
    """A camera in widget pixels, the widget's size (w, h), and the distances (near, far) that are drawn."""

    camera: Camera
    size: tuple[int, int]
    near: float = 0.01
    far: float = 1000.0

    def to_widget(self, points: ArrayLike) -> Array:
        """Widget places (..., 2) of world points (..., 3); NaN behind the camera."""
        return self.camera.project(points)

    def projection(self) -> Array:
        """The matrix (4, 4) that takes OpenGL eye coordinates to clip coordinates."""
        width, height = self.size
        K, near, far = self.camera.K, self.near, self.far
        matrix = np.zeros((4, 4))
        matrix[0, 0], matrix[0, 1], matrix[0, 2] = 2 * K[0, 0] / width, -2 * K[0, 1] / width, 1 - 2 * K[0, 2] / width
        matrix[1, 1], matrix[1, 2] = 2 * K[1, 1] / height, 2 * K[1, 2] / height - 1
        matrix[2, 2], matrix[2, 3] = -(far + near) / (far - near), -2 * far * near / (far - near)
        matrix[3, 2] = -1.0
        return matrix

    def pose(self) -> tuple[Array, Array, Array]:
        """Position, focal point and up of the camera, world."""
        centre = self.camera.centre
        return centre, centre + self.camera.R[2], -self.camera.R[1]


def framed(camera: Camera, view: View) -> Camera:
    """A picture's camera (pixel centres at integers) in the pixels of the widget that shows it by a view."""
    placed = np.array(
        [[view.scale, 0, 0.5 * view.scale + view.x], [0, view.scale, 0.5 * view.scale + view.y], [0, 0, 1]]
    )
    return Camera(placed @ camera.K, camera.R, camera.T)


def clipped(camera: Camera, size: tuple[int, int], points: ArrayLike) -> Lens:
    """A lens whose near and far distances enclose the points (n, 3) with room to spare."""
    depths = camera.depth(np.asarray(points, np.float64).reshape(-1, 3))
    far = float(np.max(depths, initial=1.0)) * 4.0
    near = max(float(np.min(depths, initial=far)) * 0.2, far * 2e-4)
    return Lens(camera, size, near, max(far, near * 10))
