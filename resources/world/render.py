"""Pictures of a walk in a scene, as a phone would record them, and the depth and masks that are true of them."""

from __future__ import annotations

import attrs
import numpy as np
from numpy.typing import NDArray

from imitation.cameras.path import CameraPath
from imitation.errors import InputError
from imitation.geometry.projection import Camera
from imitation.progress import Progress, steps
from resources.world.gait import Walk
from resources.world.light import light_maps, sky_directions
from resources.world.materials import Material
from resources.world.raster import rasterise
from resources.world.scene import Scene
from resources.world.shading import SUN, Lights, film
from resources.world.shapes import Geometry, union, vertex_normals
from resources.world.skeleton import Array

Picture = NDArray[np.uint8]


@attrs.frozen
class Look:
    """How a clip is recorded.

    Attributes
    ----------
    size : (width, height) pixels. samples : samples a pixel along one side.
    sky : directions of sky light. grain : sigma of the sensor's noise, levels.
    light_change : share by which the light goes up and down over the clip (clouds, automatic exposure).
    gain_drift : sigma of a slow random walk of the gain. blur : share of the frame time that the shutter is open.
    seed : of the noise.
    """

    size: tuple[int, int] = (960, 540)
    samples: int = 2
    sky: int = 24
    grain: float = 1.2
    light_change: float = 0.0
    gain_drift: float = 0.0
    blur: float = 0.0
    seed: int = 0


class Stage:
    """A scene and who walks in it, ready to be drawn."""

    def __init__(self, scene: Scene, walk: Walk | None, look: Look, extra: Geometry | None = None) -> None:
        self.scene, self.walk, self.look = scene, walk, look
        self.still = union([scene.geometry, extra]) if extra is not None else scene.geometry
        self._directions = sky_directions(look.sky)
        fine = 2048 if look.size[0] > 500 else 1024
        coarse = 448 if look.size[0] > 500 else 256
        g = self.still
        self._sun = light_maps(g.vertices, g.faces, SUN[None], scene.middle, scene.width, fine)
        self._sky = light_maps(g.vertices, g.faces, self._directions, scene.middle, scene.width, coarse)

    def subject(self, time: float) -> Geometry | None:
        """The subject at a time in frames; between frames its vertices move in straight lines."""
        if self.walk is None:
            return None
        body = self.walk.body
        first = int(np.clip(np.floor(time), 0, len(self.walk.vertices) - 1))
        second = min(first + 1, len(self.walk.vertices) - 1)
        share = time - first
        vertices = (1 - share) * self.walk.vertices[first] + share * self.walk.vertices[second]
        coat = Material.HOUND if body.skeleton.kind == "quadruped" else Material.CLOTH
        return Geometry(
            vertices,
            body.faces,
            vertex_normals(vertices, body.faces),
            body.vertices,
            np.zeros_like(vertices),
            np.full(len(body.faces), coat, np.int32),
        )

    def _lights(self, subject: Geometry | None) -> Lights:
        fine = self.look.size[0] > 500
        if subject is None:
            points, faces, middle, width = np.zeros((3, 3)), np.zeros((0, 3), np.int32), self.scene.middle, 1.0
        else:
            points, faces = subject.vertices, subject.faces
            middle = (points.min(axis=0) + points.max(axis=0)) / 2
            width = 1.1 * float(np.linalg.norm(np.ptp(points, axis=0)))
        sun = light_maps(points, faces, SUN[None], middle, width, 512 if fine else 256)
        sky = light_maps(points, faces, self._directions, middle, width, 128 if fine else 64)
        return Lights(self._sun, sun, self._sky, sky)

    def expose(self, time: float, camera: Camera, sun_power: float = 1.0) -> Array:
        """Linear RGB (h, w, 3) at one instant."""
        subject = self.subject(time)
        everything = self.still if subject is None else union([self.still, subject])
        seen = rasterise(everything.vertices, everything.faces, camera, self.look.size, self.look.samples)
        lights = self._lights(subject)
        return film(
            seen, everything, len(self.still.faces), camera, self.look.size, self.look.samples, lights, sun_power
        )

    def frame(self, time: int, cameras: CameraPath) -> Picture:
        """The recorded frame (h, w, 3) uint8 RGB."""
        look = self.look
        power = 1 - 0.5 * abs(look.light_change) * (1 - np.cos(2 * np.pi * time / 37.0))
        if look.blur <= 0:
            light = self.expose(time, cameras[time], power)
        else:
            shutter = look.blur * (np.arange(5) / 4 - 0.5)
            times = np.clip(time + shutter, 0, len(cameras) - 1)
            light = np.mean([self.expose(float(t), between(cameras, float(t)), power) for t in times], axis=0)
        gain = 1 + 0.25 * look.light_change * np.sin(2 * np.pi * time / 53.0)
        if look.gain_drift:
            walk = np.random.default_rng([look.seed, 77]).standard_normal(len(cameras)).cumsum()
            gain *= 1 + look.gain_drift * walk[time]
        picture = 255 * develop(light * gain)
        noise = np.random.default_rng([look.seed, time, 99]).standard_normal(picture.shape, dtype=np.float32)
        recorded: Picture = np.clip(np.rint(picture + look.grain * noise), 0, 255).astype(np.uint8)
        return recorded

    def clip(self, cameras: CameraPath, progress: Progress | None = None) -> Picture:
        """All frames (n, h, w, 3) uint8 RGB."""
        if self.walk is not None and len(cameras) > len(self.walk.vertices):
            raise InputError(f"There are {len(cameras)} cameras, but the walk has {len(self.walk.vertices)} frames.")
        return np.stack([self.frame(t, cameras) for t in steps(range(len(cameras)), progress)])

    def depth(self, time: int, camera: Camera, *, subject: bool = False) -> Array:
        """Exact camera z (h, w) at pixel centres, NaN in the open sky: of what stands still, or with the subject."""
        geometry = self.subject(time) if subject else None
        everything = self.still if geometry is None else union([self.still, geometry])
        closeness, _, _ = rasterise(everything.vertices, everything.faces, camera, self.look.size)
        with np.errstate(divide="ignore"):
            depth: Array = np.where(closeness > 0, 1 / closeness, np.nan)
        return depth

    def mask(self, time: int, camera: Camera) -> NDArray[np.bool_]:
        """Which pixels (h, w) show the subject."""
        geometry = self.subject(time)
        if geometry is None:
            return np.zeros((self.look.size[1], self.look.size[0]), bool)
        everything = union([self.still, geometry])
        _, ids, _ = rasterise(everything.vertices, everything.faces, camera, self.look.size)
        shown: NDArray[np.bool_] = ids >= len(self.still.faces)
        return shown

    def visible(self, time: int, camera: Camera, points: Array, tolerance: float | Array = 0.02) -> NDArray[np.bool_]:
        """Which points (n, 3) on surfaces are in the picture with nothing in front by more than a tolerance."""
        depth = np.nan_to_num(self.depth(time, camera, subject=True), nan=np.inf)
        pixels, z = camera.project(points), camera.depth(points)
        width, height = self.look.size
        with np.errstate(invalid="ignore"):
            inside = (z > 0) & (pixels >= 0).all(axis=1) & (pixels[:, 0] <= width - 1) & (pixels[:, 1] <= height - 1)
        corner = np.floor(np.nan_to_num(pixels)).astype(int)
        x0, y0 = np.clip(corner[:, 0], 0, width - 1), np.clip(corner[:, 1], 0, height - 1)
        x1, y1 = np.minimum(x0 + 1, width - 1), np.minimum(y0 + 1, height - 1)
        behind = np.max([depth[y0, x0], depth[y0, x1], depth[y1, x0], depth[y1, x1]], axis=0)
        seen: NDArray[np.bool_] = inside & (z <= behind + tolerance)
        return seen


def between(cameras: CameraPath, time: float) -> Camera:
    """The camera at a time between frames: the rotation turned on evenly, the centre moved in a straight line."""
    from scipy.spatial.transform import Rotation, Slerp

    first = int(np.clip(np.floor(time), 0, len(cameras) - 1))
    second = min(first + 1, len(cameras) - 1)
    share = time - first
    if first == second or share == 0:
        return cameras[first]
    R = Slerp([0, 1], Rotation.from_matrix(cameras.R[[first, second]]))(share).as_matrix()
    centre = (1 - share) * cameras[first].centre + share * cameras[second].centre
    return Camera(cameras.K[first], R, -R @ centre)


def develop(light: Array) -> Array:
    """From linear light to sRGB in [0, 1] with a film's soft shoulder."""
    x = np.maximum(light, 0) * 0.5
    mapped = np.clip(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0, 1)
    encoded: Array = np.where(mapped <= 0.0031308, 12.92 * mapped, 1.055 * mapped ** (1 / 2.4) - 0.055)
    return encoded
