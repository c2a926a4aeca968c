"""From what each sample sees to the light that reaches the film, compiled."""

from __future__ import annotations

import attrs
import numpy as np
from numba import njit

from imitation.geometry.projection import Camera
from resources.world.light import LightMaps, lit
from resources.world.materials import albedo, relief
from resources.world.noise import layers
from resources.world.raster import Ids
from resources.world.shapes import Geometry
from resources.world.skeleton import Array

SUN = np.array([-0.42, -0.62, 0.66])
SUN = SUN / np.linalg.norm(SUN)


@attrs.frozen(eq=False)
class Lights:
    """Shadow maps of what stands and of what moves, for the sun and for the sky."""

    sun_still: LightMaps
    sun_moving: LightMaps
    sky_still: LightMaps
    sky_moving: LightMaps


@njit(cache=True, nogil=True)
def sky_colour(dx, dy, dz):  # type: ignore[no-untyped-def]
    """Linear RGB of the open sky in a direction."""
    up = max(dz, 0.0)
    k = (1 - up) ** 3
    r, g, b = 0.2 + 0.62 * k, 0.4 + 0.48 * k, 0.86 + 0.1 * k
    s = 1 / (up + 0.18)
    cloud = layers(dx * s, dy * s, 0.0, 0.9, 6, 0.004 * s) + 0.12
    cover = min(1.0, max(0.0, cloud * 2.2)) * min(1.0, max(0.0, up * 9))
    shade = 1.05 - 0.25 * min(1.0, max(0.0, cloud * 2 - 0.3))
    return r + (shade - r) * cover, g + (shade * 0.99 - g) * cover, b + (shade * 0.98 - b) * cover


@njit(cache=True, nogil=True)
def _sky_light(x, y, z, nx, ny, nz, axes, a_mid, a_texel, a_maps, b_mid, b_texel, b_maps):  # type: ignore[no-untyped-def]
    """Light of the sky on a place, and how open the place is."""
    total, open_ = 0.0, 0.0
    count = len(axes)
    off_a, off_b = (1.2 * a_texel, 1.6 * b_texel)
    ax, ay, az = x + nx * off_a - a_mid[0], y + ny * off_a - a_mid[1], z + nz * off_a - a_mid[2]
    bx, by, bz = x + nx * off_b - b_mid[0], y + ny * off_b - b_mid[1], z + nz * off_b - b_mid[2]
    for k in range(count):
        d = axes[k, 2]
        facing = nx * d[0] + ny * d[1] + nz * d[2]
        if facing <= 0.02:
            continue
        seen = lit(axes[k], a_texel, a_maps[k], ax, ay, az, 0.012)
        if seen > 0:
            seen *= lit(axes[k], b_texel, b_maps[k], bx, by, bz, 0.006)
        total += facing
        open_ += facing * seen
    scale = 2.0 / count
    return open_ * scale, open_ / total if total > 0 else 0.0


@njit(cache=True, nogil=True)
def _film(  # type: ignore[no-untyped-def]
    picture, ids, closeness, inverse, faces, normals, coords, shades, materials, first_moving,
    K_inverse, R, centre, focal, ss, sun_dir, sun_power,
    axes, a_mid, a_texel, a_maps, b_mid, b_texel, b_maps,
    sun_axis, c_mid, c_texel, c_map, d_mid, d_texel, d_map,
):  # fmt: skip
    height, width = picture.shape[0], picture.shape[1]
    for row in range(height):
        for column in range(width):
            have, hx, hy, hz, hnx, hny, hnz = False, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
            sky, open_ = 0.0, 1.0
            for sample in range(ss * ss):
                j, i = row * ss + sample // ss, column * ss + sample % ss
                u, v = (i + 0.5) / ss - 0.5, (j + 0.5) / ss - 0.5
                cx = K_inverse[0, 0] * u + K_inverse[0, 2]
                cy = K_inverse[1, 1] * v + K_inverse[1, 2]
                dx = R[0, 0] * cx + R[1, 0] * cy + R[2, 0]
                dy = R[0, 1] * cx + R[1, 1] * cy + R[2, 1]
                dz = R[0, 2] * cx + R[1, 2] * cy + R[2, 2]
                length = np.sqrt(dx * dx + dy * dy + dz * dz)
                t = ids[j, i]
                if t < 0:
                    r, g, b = sky_colour(dx / length, dy / length, dz / length)
                    picture[row, column, 0] += r
                    picture[row, column, 1] += g
                    picture[row, column, 2] += b
                    continue
                m = inverse[t]
                depth = 1 / closeness[j, i]
                w0 = (m[0, 0] * u + m[0, 1] * v + m[0, 2]) * depth
                w1 = (m[1, 0] * u + m[1, 1] * v + m[1, 2]) * depth
                w2 = 1 - w0 - w1
                f0, f1, f2 = faces[t, 0], faces[t, 1], faces[t, 2]
                x, y, z = centre[0] + depth * dx, centre[1] + depth * dy, centre[2] + depth * dz
                nx = w0 * normals[f0, 0] + w1 * normals[f1, 0] + w2 * normals[f2, 0]
                ny = w0 * normals[f0, 1] + w1 * normals[f1, 1] + w2 * normals[f2, 1]
                nz = w0 * normals[f0, 2] + w1 * normals[f1, 2] + w2 * normals[f2, 2]
                kind = materials[t]
                if kind == 6 or kind == 18:
                    face_camera = 1.0
                else:
                    face_camera = -1.0 if nx * dx + ny * dy + nz * dz > 0 and t < first_moving else 1.0
                n = face_camera / np.sqrt(nx * nx + ny * ny + nz * nz + 1e-18)
                nx, ny, nz = nx * n, ny * n, nz * n
                px = w0 * coords[f0, 0] + w1 * coords[f1, 0] + w2 * coords[f2, 0]
                py = w0 * coords[f0, 1] + w1 * coords[f1, 1] + w2 * coords[f2, 1]
                pz = w0 * coords[f0, 2] + w1 * coords[f1, 2] + w2 * coords[f2, 2]
                s0 = w0 * shades[f0, 0] + w1 * shades[f1, 0] + w2 * shades[f2, 0]
                s1 = w0 * shades[f0, 1] + w1 * shades[f1, 1] + w2 * shades[f2, 1]
                s2 = w0 * shades[f0, 2] + w1 * shades[f1, 2] + w2 * shades[f2, 2]
                slant = max(0.15, abs(nx * dx + ny * dy + nz * dz) / length)
                fp = depth / focal / np.sqrt(slant)
                r, g, b, gloss = albedo(kind, px, py, pz, nx, ny, nz, s0, s1, s2, fp)
                same = have and (x - hx) ** 2 + (y - hy) ** 2 + (z - hz) ** 2 < 1e-3 + (2 * fp) ** 2
                if not same or nx * hnx + ny * hny + nz * hnz < 0.97:
                    sky, open_ = _sky_light(x, y, z, nx, ny, nz, axes, a_mid, a_texel, a_maps, b_mid, b_texel, b_maps)
                    have, hx, hy, hz, hnx, hny, hnz = True, x, y, z, nx, ny, nz
                ox, oy, oz = nx, ny, nz
                if fp < 0.03:
                    e = max(0.004, 0.7 * fp)
                    h0 = relief(kind, px, py, pz, nx, nz, fp)
                    if h0 != 0:
                        gx = (relief(kind, px + e, py, pz, nx, nz, fp) - h0) / e
                        gy = (relief(kind, px, py + e, pz, nx, nz, fp) - h0) / e
                        gz = (relief(kind, px, py, pz + e, nx, nz, fp) - h0) / e
                        along = gx * ox + gy * oy + gz * oz
                        ox, oy, oz = ox - gx + along * ox, oy - gy + along * oy, oz - gz + along * oz
                        n = 1 / np.sqrt(ox * ox + oy * oy + oz * oz)
                        ox, oy, oz = ox * n, oy * n, oz * n
                facing = ox * sun_dir[0] + oy * sun_dir[1] + oz * sun_dir[2]
                flat = nx * sun_dir[0] + ny * sun_dir[1] + nz * sun_dir[2]
                if kind == 6 or kind == 18 or kind == 8:
                    facing = 0.55 * abs(facing) + 0.3
                    flat = 1.0
                elif t >= first_moving:
                    facing = max(0.0, (facing + 0.12) / 1.12)
                direct = 0.0
                if facing > 0 and flat > -0.1:
                    off = 1.5 * c_texel
                    direct = lit(
                        sun_axis, c_texel, c_map,
                        x + nx * off - c_mid[0], y + ny * off - c_mid[1], z + nz * off - c_mid[2], 0.01,
                    )  # fmt: skip
                    if direct > 0:
                        off = (3.0 if t >= first_moving else 1.0) * d_texel
                        direct *= lit(
                            sun_axis, d_texel, d_map,
                            x + nx * off - d_mid[0], y + ny * off - d_mid[1], z + nz * off - d_mid[2],
                            0.02 if t >= first_moving else 0.004,
                        )  # fmt: skip
                    direct *= facing * sun_power
                shine = 0.0
                if gloss > 0:
                    hx_, hy_, hz_ = sun_dir[0] - dx / length, sun_dir[1] - dy / length, sun_dir[2] - dz / length
                    hn = 1 / np.sqrt(hx_ * hx_ + hy_ * hy_ + hz_ * hz_)
                    mirror = max(0.0, (ox * hx_ + oy * hy_ + oz * hz_) * hn)
                    shine = gloss * direct * mirror**24 * 0.6 + 0.05 * gloss * sky
                bounce = (0.2 - 0.12 * nz) * open_
                red = direct * 3.2 + 0.5 * sky + 0.1 * bounce * 4.2
                green = direct * 2.78 + 0.63 * sky + 0.08 * bounce * 4.2
                blue = direct * 2.2 + 0.88 * sky + 0.055 * bounce * 4.2
                haze = 1 - np.exp(-depth * length / 420.0)
                picture[row, column, 0] += (r * red + shine * 2.6) * (1 - haze) + 0.74 * haze
                picture[row, column, 1] += (g * green + shine * 2.4) * (1 - haze) + 0.8 * haze
                picture[row, column, 2] += (b * blue + shine * 2.1) * (1 - haze) + 0.9 * haze


def film(
    seen: tuple[Array, Ids, Array],
    geometry: Geometry,
    first_moving: int,
    camera: Camera,
    size: tuple[int, int],
    ss: int,
    lights: Lights,
    sun_power: float,
) -> Array:
    """Linear RGB (h, w, 3) of what ``rasterise`` saw; faces from ``first_moving`` on belong to what moves."""
    closeness, ids, inverse = seen
    picture = np.zeros((size[1], size[0], 3))
    sky, moving = lights.sky_still, lights.sky_moving
    sun, sun_moving = lights.sun_still, lights.sun_moving
    _film(
        picture, ids, closeness, inverse, geometry.faces, geometry.normals, geometry.coords, geometry.shades,
        geometry.materials, first_moving, np.linalg.inv(camera.K), camera.R, camera.centre, camera.K[0, 0], ss,
        SUN, sun_power, sky.axes, sky.middle, sky.texel, sky.maps, moving.middle, moving.texel, moving.maps,
        sun.axes[0], sun.middle, sun.texel, sun.maps[0], sun_moving.middle, sun_moving.texel, sun_moving.maps[0],
    )  # fmt: skip
    return picture / ss**2
