# mypy: disable-error-code="untyped-decorator"
"""Compiled loops of the bundle adjustment: linearise, eliminate the points, factorise, step back."""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit

FAST = {"reassoc", "contract"}  # the same order on every run; lets the dot products use the vector units


@njit(cache=True, nogil=True)
def residuals(
    R: Any, T: Any, f: float, cx: float, cy: float, X: Any, camera: Any, point: Any, uv: Any, out: Any
) -> None:
    """Reprojection errors (m, 2), pixels; a point behind its camera gets a large one."""
    for m in range(len(camera)):
        c, p = camera[m], point[m]
        x = R[c, 0, 0] * X[p, 0] + R[c, 0, 1] * X[p, 1] + R[c, 0, 2] * X[p, 2] + T[c, 0]
        y = R[c, 1, 0] * X[p, 0] + R[c, 1, 1] * X[p, 1] + R[c, 1, 2] * X[p, 2] + T[c, 1]
        z = R[c, 2, 0] * X[p, 0] + R[c, 2, 1] * X[p, 1] + R[c, 2, 2] * X[p, 2] + T[c, 2]
        if z > 1e-9:
            out[m, 0] = f * x / z + cx - uv[m, 0]
            out[m, 1] = f * y / z + cy - uv[m, 1]
        else:
            out[m, 0] = 1e6
            out[m, 1] = 1e6


@njit(cache=True, nogil=True)
def linearise(
    R: Any,
    T: Any,
    f: float,
    cx: float,
    cy: float,
    X: Any,
    camera: Any,
    point: Any,
    uv: Any,
    weight: Any,
    s2: float,
    turn_only: bool,
    U: Any,
    uf: Any,
    bc: Any,
    V: Any,
    bp: Any,
    W: Any,
    Wf: Any,
) -> tuple[float, float, float]:
    """Blocks of the normal equations under a Cauchy loss of scale sqrt(s2); cost, focal diagonal and gradient."""
    U[:] = 0.0
    uf[:] = 0.0
    bc[:] = 0.0
    V[:] = 0.0
    bp[:] = 0.0
    Wf[:] = 0.0
    cost, ff, bf = 0.0, 0.0, 0.0
    J = np.zeros((2, 6))
    P = np.zeros((2, 3))
    L = np.zeros((2, 3))
    F = np.zeros(2)
    e = np.zeros(2)
    for m in range(len(camera)):
        c, p = camera[m], point[m]
        a = R[c, 0, 0] * X[p, 0] + R[c, 0, 1] * X[p, 1] + R[c, 0, 2] * X[p, 2]
        b = R[c, 1, 0] * X[p, 0] + R[c, 1, 1] * X[p, 1] + R[c, 1, 2] * X[p, 2]
        d = R[c, 2, 0] * X[p, 0] + R[c, 2, 1] * X[p, 1] + R[c, 2, 2] * X[p, 2]
        x, y, z = a + T[c, 0], b + T[c, 1], d + T[c, 2]
        W[m] = 0.0
        if z <= 1e-9:
            cost += weight[m] * s2 * np.log(1.0 + 1e12 / s2)
            continue
        F[0], F[1] = x / z, y / z
        e[0], e[1] = f * F[0] + cx - uv[m, 0], f * F[1] + cy - uv[m, 1]
        square = e[0] * e[0] + e[1] * e[1]
        cost += weight[m] * s2 * np.log(1.0 + square / s2)
        w = weight[m] / (1.0 + square / s2)
        L[0, 0], L[0, 1], L[0, 2] = f / z, 0.0, -f * x / (z * z)
        L[1, 0], L[1, 1], L[1, 2] = 0.0, f / z, -f * y / (z * z)
        for i in range(2):
            # d(camera point)/d(small rotation on the left) = -[R X]_x
            J[i, 0] = -L[i, 1] * d + L[i, 2] * b
            J[i, 1] = L[i, 0] * d - L[i, 2] * a
            J[i, 2] = -L[i, 0] * b + L[i, 1] * a
            for k in range(3):
                J[i, 3 + k] = 0.0 if turn_only else L[i, k]
                P[i, k] = L[i, 0] * R[c, 0, k] + L[i, 1] * R[c, 1, k] + L[i, 2] * R[c, 2, k]
        for i in range(2):
            ff += w * F[i] * F[i]
            bf += w * F[i] * e[i]
            for k in range(6):
                bc[c, k] += w * J[i, k] * e[i]
                uf[c, k] += w * J[i, k] * F[i]
                for n in range(6):
                    U[c, k, n] += w * J[i, k] * J[i, n]
                for n in range(3):
                    W[m, k, n] += w * J[i, k] * P[i, n]
            for k in range(3):
                bp[p, k] += w * P[i, k] * e[i]
                Wf[p, k] += w * P[i, k] * F[i]
                for n in range(3):
                    V[p, k, n] += w * P[i, k] * P[i, n]
    return cost, ff, bf


@njit(cache=True, nogil=True)
def _inverse3(A: Any, out: Any) -> None:
    c00 = A[1, 1] * A[2, 2] - A[1, 2] * A[2, 1]
    c01 = A[1, 2] * A[2, 0] - A[1, 0] * A[2, 2]
    c02 = A[1, 0] * A[2, 1] - A[1, 1] * A[2, 0]
    s = 1.0 / (A[0, 0] * c00 + A[0, 1] * c01 + A[0, 2] * c02)
    out[0, 0], out[0, 1], out[0, 2] = c00 * s, c01 * s, c02 * s
    out[1, 0] = out[0, 1]
    out[1, 1] = (A[0, 0] * A[2, 2] - A[0, 2] * A[2, 0]) * s
    out[1, 2] = (A[0, 2] * A[1, 0] - A[0, 0] * A[1, 2]) * s
    out[2, 0] = out[0, 2]
    out[2, 1] = out[1, 2]
    out[2, 2] = (A[0, 0] * A[1, 1] - A[0, 1] * A[1, 0]) * s


@njit(cache=True, nogil=True, fastmath=FAST)
def reduce_points(
    camera: Any,
    start: Any,
    damping: float,
    free_focal: bool,
    U: Any,
    uf: Any,
    ff: float,
    bc: Any,
    bf: float,
    V: Any,
    bp: Any,
    W: Any,
    Wf: Any,
    inverse: Any,
    S: Any,
    right: Any,
) -> None:
    """Schur complement of the points: S (6n + 1)^2 (lower triangle) and its right side; the focal comes last."""
    count = len(U)
    last = 6 * count
    S[:] = 0.0
    for c in range(count):
        for k in range(6):
            for n in range(6):
                S[6 * c + k, 6 * c + n] = U[c, k, n]
            S[6 * c + k, 6 * c + k] += damping * U[c, k, k] + 1e-12
            right[6 * c + k] = -bc[c, k]
            S[last, 6 * c + k] = uf[c, k] if free_focal else 0.0
            if U[c, k, k] == 0.0:
                S[6 * c + k, 6 * c + k] = 1.0
    S[last, last] = ff * (1.0 + damping) if free_focal else 1.0
    right[last] = -bf if free_focal else 0.0
    A = np.zeros((3, 3))
    Y = np.zeros((6, 3))
    for p in range(len(V)):
        if start[p + 1] == start[p]:
            inverse[p] = 0.0
            continue
        for k in range(3):
            for n in range(3):
                A[k, n] = V[p, k, n]
            A[k, k] += damping * V[p, k, k] + 1e-12
        _inverse3(A, inverse[p])
        I = inverse[p]
        if free_focal:
            for n in range(3):
                g = Wf[p, 0] * I[0, n] + Wf[p, 1] * I[1, n] + Wf[p, 2] * I[2, n]
                S[last, last] -= g * Wf[p, n]
                right[last] += g * bp[p, n]
        for m in range(start[p], start[p + 1]):
            c = camera[m]
            for k in range(6):
                for n in range(3):
                    Y[k, n] = W[m, k, 0] * I[0, n] + W[m, k, 1] * I[1, n] + W[m, k, 2] * I[2, n]
                right[6 * c + k] += Y[k, 0] * bp[p, 0] + Y[k, 1] * bp[p, 1] + Y[k, 2] * bp[p, 2]
                if free_focal:
                    S[last, 6 * c + k] -= Y[k, 0] * Wf[p, 0] + Y[k, 1] * Wf[p, 1] + Y[k, 2] * Wf[p, 2]
            for o in range(start[p], m + 1):  # sorted by camera: only the lower triangle is touched
                q = camera[o]
                for k in range(6):
                    for n in range(6):
                        S[6 * c + k, 6 * q + n] -= Y[k, 0] * W[o, n, 0] + Y[k, 1] * W[o, n, 1] + Y[k, 2] * W[o, n, 2]


@njit(cache=True, nogil=True, fastmath=FAST)
def solve_lower(S: Any, right: Any) -> bool:
    """Cholesky of the lower triangle in place, rows from their first non-zero on, and the solution in ``right``."""
    size = len(S)
    first = np.zeros(size, np.int64)
    for i in range(size):
        j = 0
        while j < i and S[i, j] == 0.0:
            j += 1
        first[i] = j
        for j in range(first[i], i + 1):
            total = S[i, j]
            low = max(first[i], first[j])
            part = 0.0
            for k in range(low, j):
                part += S[i, k] * S[j, k]
            total -= part
            if i == j:
                if not total > 0.0:
                    return False
                S[i, i] = np.sqrt(total)
            else:
                S[i, j] = total / S[j, j]
        part = 0.0
        for k in range(first[i], i):
            part += S[i, k] * right[k]
        right[i] = (right[i] - part) / S[i, i]
    for i in range(size - 1, -1, -1):
        right[i] /= S[i, i]
        for k in range(first[i], i):
            right[k] -= S[i, k] * right[i]
    return True


@njit(cache=True, nogil=True)
def step_points(camera: Any, start: Any, bp: Any, W: Any, Wf: Any, inverse: Any, step: Any, out: Any) -> None:
    """Steps of the points (p, 3) from those of the cameras and the focal length."""
    last = len(step) - 1
    g = np.zeros(3)
    for p in range(len(bp)):
        for k in range(3):
            g[k] = -bp[p, k] - Wf[p, k] * step[last]
        for m in range(start[p], start[p + 1]):
            c = camera[m]
            for n in range(6):
                for k in range(3):
                    g[k] -= W[m, n, k] * step[6 * c + n]
        for k in range(3):
            out[p, k] = inverse[p, k, 0] * g[0] + inverse[p, k, 1] * g[1] + inverse[p, k, 2] * g[2]
