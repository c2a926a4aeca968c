"""Compiled inner loops of the deformation: the local step, the global step, Anderson's mixing.

Shapes: m welded vertices in elimination order, e directed edges (compressed rows), k handles, r constraint rows.
All lengths are in diagonals of the rest mesh.
"""

# mypy: disable-error-code="no-untyped-def"
from __future__ import annotations

import numpy as np
from numba import njit

from imitation.deformation.factor import solve_three

OPTIONS = {"cache": True, "nogil": True, "boundscheck": False, "error_model": "numpy"}
WINDOW = 5
"""Anderson's mixing looks back this many steps."""
FARTHEST = 0.02
"""No vertex goes farther than this along the slow directions in one step: beyond, they bend."""
WHOLE = 0.3
"""With the slow directions' rest added the step has to be this much shorter still: what is left there does not fade."""
SLOW_FROM = 3
"""The first step along the slow directions: before, the rotations do not yet follow the handles."""
RESTART = 4.0
"""It forgets them when the squared step exceeds the smallest so far by this factor."""


@njit(fastmath={"contract"}, **OPTIONS)
def local_step(pose, turn, start, other, edge, detail, spread, turned):
    """One Newton step on every vertex's rotation, then the right-hand sides with the new rotations.

    Rotation i is the polar factor of ``S_i = sum_j w_ij (u_i - u_j) (v_i - v_j)'``; with ``B = R' S`` the step is
    ``omega = (tr(B) I - sym(B))^-1 axial(B)``, applied as a Cayley transform.

    Parameters
    ----------
    pose : (m, 3). turn : (m, 4) unit quaternions, updated. start, other : compressed rows of the neighbours.
    edge : (e, 3) ``w_ij (v_i - v_j)``. detail : (m, 3) ``delta``.
    spread : (m, 3) out, ``sum_j w_ij (R_i + R_j) / 2 (v_i - v_j)``. turned : (m, 3) out, ``R_i delta_i``.
    """
    size = len(pose)
    for i in range(size):
        spread[i, 0] = 0.0
        spread[i, 1] = 0.0
        spread[i, 2] = 0.0
    for i in range(size):
        x, y, z = pose[i, 0], pose[i, 1], pose[i, 2]
        s00 = s01 = s02 = s10 = s11 = s12 = s20 = s21 = s22 = 0.0
        for p in range(start[i], start[i + 1]):
            j = other[p]
            a, b, c = x - pose[j, 0], y - pose[j, 1], z - pose[j, 2]
            d, e, f = edge[p, 0], edge[p, 1], edge[p, 2]
            s00 += a * d
            s01 += a * e
            s02 += a * f
            s10 += b * d
            s11 += b * e
            s12 += b * f
            s20 += c * d
            s21 += c * e
            s22 += c * f
        qw, qx, qy, qz = turn[i, 0], turn[i, 1], turn[i, 2], turn[i, 3]
        r00, r01, r02 = 1 - 2 * (qy * qy + qz * qz), 2 * (qx * qy - qw * qz), 2 * (qx * qz + qw * qy)
        r10, r11, r12 = 2 * (qx * qy + qw * qz), 1 - 2 * (qx * qx + qz * qz), 2 * (qy * qz - qw * qx)
        r20, r21, r22 = 2 * (qx * qz - qw * qy), 2 * (qy * qz + qw * qx), 1 - 2 * (qx * qx + qy * qy)
        b00 = r00 * s00 + r10 * s10 + r20 * s20
        b11 = r01 * s01 + r11 * s11 + r21 * s21
        b22 = r02 * s02 + r12 * s12 + r22 * s22
        b01 = r00 * s01 + r10 * s11 + r20 * s21
        b10 = r01 * s00 + r11 * s10 + r21 * s20
        b02 = r00 * s02 + r10 * s12 + r20 * s22
        b20 = r02 * s00 + r12 * s10 + r22 * s20
        b12 = r01 * s02 + r11 * s12 + r21 * s22
        b21 = r02 * s01 + r12 * s11 + r22 * s21
        g0, g1, g2 = b21 - b12, b02 - b20, b10 - b01
        trace = b00 + b11 + b22
        h00, h11, h22 = b11 + b22, b00 + b22, b00 + b11
        h01, h02, h12 = -0.5 * (b01 + b10), -0.5 * (b02 + b20), -0.5 * (b12 + b21)
        c00, c01, c02 = h11 * h22 - h12 * h12, h02 * h12 - h01 * h22, h01 * h12 - h02 * h11
        c11, c12, c22 = h00 * h22 - h02 * h02, h01 * h02 - h00 * h12, h00 * h11 - h01 * h01
        det = h00 * c00 + h01 * c01 + h02 * c02
        if h00 > 0.0 and c22 > 0.0 and det > 1e-9 * trace * trace * trace:
            inverse = 1.0 / det
            o0 = (c00 * g0 + c01 * g1 + c02 * g2) * inverse
            o1 = (c01 * g0 + c11 * g1 + c12 * g2) * inverse
            o2 = (c02 * g0 + c12 * g1 + c22 * g2) * inverse
        else:
            extent = np.sqrt(
                s00 * s00
                + s01 * s01
                + s02 * s02
                + s10 * s10
                + s11 * s11
                + s12 * s12
                + s20 * s20
                + s21 * s21
                + s22 * s22
            )
            inverse = 2.0 / (abs(trace) + 0.3 * extent + 1e-300)
            o0, o1, o2 = g0 * inverse, g1 * inverse, g2 * inverse
        length = o0 * o0 + o1 * o1 + o2 * o2
        if length > 4.0:
            shrink = 2.0 / np.sqrt(length)
            o0, o1, o2 = o0 * shrink, o1 * shrink, o2 * shrink
        # cayley(omega) is the quaternion (1, omega / 2) made unit
        o0, o1, o2 = 0.5 * o0, 0.5 * o1, 0.5 * o2
        nw = qw - qx * o0 - qy * o1 - qz * o2
        nx = qx + qw * o0 + qy * o2 - qz * o1
        ny = qy + qw * o1 + qz * o0 - qx * o2
        nz = qz + qw * o2 + qx * o1 - qy * o0
        unit = 1.0 / np.sqrt(nw * nw + nx * nx + ny * ny + nz * nz)
        qw, qx, qy, qz = nw * unit, nx * unit, ny * unit, nz * unit
        turn[i, 0], turn[i, 1], turn[i, 2], turn[i, 3] = qw, qx, qy, qz
        r00, r01, r02 = 1 - 2 * (qy * qy + qz * qz), 2 * (qx * qy - qw * qz), 2 * (qx * qz + qw * qy)
        r10, r11, r12 = 2 * (qx * qy + qw * qz), 1 - 2 * (qx * qx + qz * qz), 2 * (qy * qz - qw * qx)
        r20, r21, r22 = 2 * (qx * qz - qw * qy), 2 * (qy * qz + qw * qx), 1 - 2 * (qx * qx + qy * qy)
        d, e, f = detail[i, 0], detail[i, 1], detail[i, 2]
        a, b, c = r00 * d + r01 * e + r02 * f, r10 * d + r11 * e + r12 * f, r20 * d + r21 * e + r22 * f
        turned[i, 0], turned[i, 1], turned[i, 2] = a, b, c
        # sum_j w_ij R_i (v_i - v_j) is R_i delta_i again: its half stays here, edge by edge the other half goes over
        spread[i, 0] += 0.5 * a
        spread[i, 1] += 0.5 * b
        spread[i, 2] += 0.5 * c
        for p in range(start[i], start[i + 1]):
            j = other[p]
            d, e, f = 0.5 * edge[p, 0], 0.5 * edge[p, 1], 0.5 * edge[p, 2]
            spread[j, 0] -= r00 * d + r01 * e + r02 * f
            spread[j, 1] -= r10 * d + r11 * e + r12 * f
            spread[j, 2] -= r20 * d + r21 * e + r22 * f


@njit(**OPTIONS)
def apply_inverse(ground, shifted, area, total, coupling, spread, turned):
    """Turn the two right-hand sides into ``G b``, in place in ``turned``; b = L M^-1 turned + coupling * spread.

    ``Q^-1 = (L + c M)^-1 M L^-1``, where L is held at its last vertex (b has no constant part, so nothing is lost) and
    the free constant is taken out by making the intermediate result M-orthogonal to constants.
    """
    size = len(area)
    solve_three(ground[0], ground[1], ground[2], ground[3], spread)
    for axis in range(3):
        mean = 0.0
        for i in range(size):
            mean += area[i] * spread[i, axis]
        mean /= total
        for i in range(size):
            turned[i, axis] += coupling * area[i] * (spread[i, axis] - mean)
        if coupling == 0.0:
            # L alone can only make what sums to zero
            mean = 0.0
            for i in range(size):
                mean += turned[i, axis]
            mean /= total
            for i in range(size):
                turned[i, axis] -= area[i] * mean
    solve_three(shifted[0], shifted[1], shifted[2], shifted[3], turned)


@njit(fastmath={"contract"}, **OPTIONS)
def constrain(free, response, handle, owner, row, target, matrix, inverse):
    """Add what the constraints do, in place: ``U = G b - G C' mu + t``.

    Parameters
    ----------
    free : (m, 3) ``G b``. response : (m, k) columns of G. handle : (k,) vertices. owner : (r,) handle of each row.
    row : (r, 3) directions. target : (r,). matrix, inverse : (r + 3, r + 3) of the small system.
    """
    rows, handles = len(owner), len(handle)
    given = np.zeros(rows + 3)
    for s in range(rows):
        v = handle[owner[s]]
        given[s] = row[s, 0] * free[v, 0] + row[s, 1] * free[v, 1] + row[s, 2] * free[v, 2] - target[s]
    answer = inverse @ given
    answer += inverse @ (given - matrix @ answer)
    force = np.zeros((handles, 3))
    for s in range(rows):
        for axis in range(3):
            force[owner[s], axis] += answer[s] * row[s, axis]
    for i in range(len(free)):
        a, b, c = answer[rows], answer[rows + 1], answer[rows + 2]
        for h in range(handles):
            g = response[i, h]
            a -= g * force[h, 0]
            b -= g * force[h, 1]
            c -= g * force[h, 2]
        free[i, 0] += a
        free[i, 1] += b
        free[i, 2] += c


@njit(**OPTIONS)
def mixing(gram, side, count):
    """Weights of Anderson's mixing by elimination of the small normal equations; dependent columns get none."""
    a = gram[:count, :count].copy()
    b = side[:count].copy()
    used = np.ones(count, np.bool_)
    for j in range(count):
        if not a[j, j] > 1e-12 * gram[j, j]:
            used[j] = False
            continue
        for i in range(j + 1, count):
            factor = a[i, j] / a[j, j]
            for q in range(j, count):
                a[i, q] -= factor * a[j, q]
            b[i] -= factor * b[j]
    for j in range(count - 1, -1, -1):
        if not used[j]:
            b[j] = 0.0
            continue
        for q in range(j + 1, count):
            b[j] -= a[j, q] * b[q]
        b[j] /= a[j, j]
    return b


@njit(fastmath={"reassoc", "contract"}, **OPTIONS)
def correct_slow(pose, new, turn, modes):
    """Add to the step what is still to come along the slow directions, in place in ``new`` (see ``modes``)."""
    dual, moved, inverse, reach = modes
    size, count = len(pose), len(inverse)
    share = np.zeros(count, np.float32)
    for i in range(size):
        a, b, c = np.float32(new[i, 0] - pose[i, 0]), np.float32(new[i, 1] - pose[i, 1]), np.float32(0)
        c = np.float32(new[i, 2] - pose[i, 2])
        w, x, y, z = (
            np.float32(turn[i, 0]),
            np.float32(-turn[i, 1]),
            np.float32(-turn[i, 2]),
            np.float32(-turn[i, 3]),
        )
        s, t, u = y * c - z * b + w * a, z * a - x * c + w * b, x * b - y * a + w * c
        a, b, c = a + 2 * (y * u - z * t), b + 2 * (z * s - x * u), c + 2 * (x * t - y * s)
        for k in range(count):
            share[k] += a * dual[i, 0, k] + b * dual[i, 1, k] + c * dual[i, 2, k]
    wide = inverse @ share.astype(np.float64)
    far = 0.0
    for k in range(count):
        far += abs(wide[k]) * reach[k]
    share = (wide * min(1.0, FARTHEST / (far + 1e-300))).astype(np.float32)
    for i in range(size):
        a, b, c = np.float32(0), np.float32(0), np.float32(0)
        for k in range(count):
            a += moved[i, 0, k] * share[k]
            b += moved[i, 1, k] * share[k]
            c += moved[i, 2, k] * share[k]
        w, x, y, z = turn[i, 0], turn[i, 1], turn[i, 2], turn[i, 3]
        s, t, u = y * c - z * b + w * a, z * a - x * c + w * b, x * b - y * a + w * c
        new[i, 0] += a + 2 * (y * u - z * t)
        new[i, 1] += b + 2 * (z * s - x * u)
        new[i, 2] += c + 2 * (x * t - y * s)


@njit(**OPTIONS)
def one_step(pose, turn, mesh, constraints):
    """One local and one global step; the new pose (m, 3)."""
    start, other, edge, detail, area, total, coupling, ground, shifted = mesh
    response, handle, owner, row, target, matrix, inverse = constraints
    spread, new = np.empty_like(pose), np.empty_like(pose)
    local_step(pose, turn, start, other, edge, detail, spread, new)
    apply_inverse(ground, shifted, area, total, coupling, spread, new)
    constrain(new, response, handle, owner, row, target, matrix, inverse)
    return new


@njit(fastmath={"reassoc", "contract"}, **OPTIONS)
def dot(a, b):
    """Scalar product of two vectors."""
    total = 0.0
    for i in range(len(a)):
        total += a[i] * b[i]
    return total


@njit(fastmath={"reassoc", "contract"}, **OPTIONS)
def distance(a, b):
    """Squared distance of two poses (m, 3)."""
    total = 0.0
    a, b = a.ravel(), b.ravel()
    for i in range(len(a)):
        total += (a[i] - b[i]) ** 2
    return total


@njit(**OPTIONS)
def mix(pose, new, history, gram, side, weight, state):
    """Anderson's mixing (type II) of the last steps, in place in ``pose``; state as in ``relax``."""
    last_new, step, new_change, step_change = history
    values, place, before = new.ravel(), pose.ravel(), last_new.ravel()
    size = len(place)
    count, slot = int(state[0]), int(state[1])
    mine, change = step_change[slot], new_change[slot]
    for i in range(size):
        now = values[i] - place[i]
        mine[i] = now - step[i]
        change[i] = values[i] - before[i]
        step[i] = now
        before[i] = values[i]
    squared = dot(step, step)
    if squared > RESTART * state[2]:
        count, slot = 0, 0
        state[2] = squared
        state[4] += 1
    else:
        state[2] = min(state[2], squared)
        if state[3] > 0:
            count = min(count + 1, WINDOW)
            for h in range(count):
                gram[slot, h] = dot(mine, step_change[h])
                gram[h, slot] = gram[slot, h]
            slot = (slot + 1) % WINDOW
    for h in range(count):
        side[h] = dot(step_change[h], step)
    weight[:] = 0.0
    weight[:count] = mixing(gram, side, count)
    if count == WINDOW:
        a, b, c, d, e = weight[0], weight[1], weight[2], weight[3], weight[4]
        v, w, x, y, z = new_change[0], new_change[1], new_change[2], new_change[3], new_change[4]
        for i in range(size):
            place[i] = values[i] - a * v[i] - b * w[i] - c * x[i] - d * y[i] - e * z[i]
    else:
        for i in range(size):
            place[i] = values[i]
        for h in range(count):
            share, change = weight[h], new_change[h]
            for i in range(size):
                place[i] -= share * change[i]
    state[0], state[1], state[3] = count, slot, state[3] + 1


@njit(**OPTIONS)
def relax(pose, turn, mesh, constraints, modes, iterations, tolerance, least):
    """Local and global steps until the root mean square step is at most the tolerance; pose and turn are updated.

    Returns the number of steps made and the last root mean square step. Where the slow directions do not help (the
    mixing had to start again three times) they are left out for the rest.
    """
    start, other, edge, detail, area, total, coupling, ground, shifted = mesh
    response, handle, owner, row, target, matrix, inverse = constraints
    size = len(pose)
    spread, new = np.empty((size, 3)), np.empty((size, 3))
    history = (
        np.zeros((size, 3)),
        np.zeros(size * 3),
        np.empty((WINDOW, size * 3)),
        np.empty((WINDOW, size * 3)),
    )
    gram, side, weight = np.zeros((WINDOW, WINDOW)), np.zeros(WINDOW), np.zeros(WINDOW)
    # columns kept, next to be replaced, smallest squared step, mixings done, times started again
    state = np.array([0.0, 0.0, np.inf, 0.0, 0.0])
    slow = len(modes[2]) > 0
    step, made = 0.0, 0
    for made in range(1, iterations + 1):
        local_step(pose, turn, start, other, edge, detail, spread, new)
        apply_inverse(ground, shifted, area, total, coupling, spread, new)
        constrain(new, response, handle, owner, row, target, matrix, inverse)
        step = np.sqrt(distance(new, pose) / size)
        whole = 0.0
        if slow and made >= SLOW_FROM and state[4] < 3:
            correct_slow(pose, new, turn, modes)
            whole = np.sqrt(distance(new, pose) / size)
        if made == iterations or (made >= least and step <= tolerance and whole <= WHOLE * tolerance):
            break
        mix(pose, new, history, gram, side, weight, state)
    for i in range(size):
        for axis in range(3):
            pose[i, axis] = new[i, axis]
    return made, step


@njit(**OPTIONS)
def fit_turns(pose, turn, start, other, edge, detail, sweeps):
    """Bring the rotations to the pose without moving it."""
    spread, turned = np.empty_like(pose), np.empty_like(pose)
    for _ in range(sweeps):
        local_step(pose, turn, start, other, edge, detail, spread, turned)
