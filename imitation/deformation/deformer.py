"""Detail-preserving deformation of one mesh by points and rays (paper A, 3.4)."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Literal

import attrs
import numpy as np
from numpy.typing import ArrayLike, NDArray

from imitation.deformation.constraints import FrameConstraints, Rows, build_rows
from imitation.deformation.pose import Pose
from imitation.deformation.start import FAR, behind, complete, first_motion, rigid_fit, warp
from imitation.errors import InputError
from imitation.geometry import Camera, kabsch, prepare_mesh, quaternion_of, quaternion_product
from imitation.geometry.projection import Array
from imitation.progress import Progress, silent

if TYPE_CHECKING:
    from imitation.deformation.modes import Modes
    from imitation.deformation.session import DragSession

KEPT = 8
"""Sets of handles whose slow directions are kept."""
MOST = 60
ASTRAY = 1e-4
"""A last step longer than this, in diagonals, means that the slow directions led nowhere."""
HARD = 1.0
PRINTED = 0.999
"""Softness of points: the printed form has no hard ones, this is its weight lambda (eq. 10)."""
Method = Literal["detail", "paper"]


class Deformer:
    """Deforms one mesh, keeping its details; everything that depends on the mesh alone is computed once.

    Several threads may use one: what is kept for later does not change a result.

    The energy is the paper's G (eq. 10) with the differential coordinates turned by the rotation of each one-ring's
    edges, plus a membrane that keeps limbs from inflating:
    ``sum |(LU)_i - R_i delta_i|^2 / m_i + a / 2S sum w_ij |u_i - u_j - R_i (v_i - v_j)|^2 + |CU - p|^2 / eps``.

    Parameters
    ----------
    vertices : (n, 3), faces : (f, 3); any triangle mesh, see ``prepare_mesh``.
    method : "detail" as above, or "paper" for the printed form ([26] of the paper).
    stretch_weight : a, resistance to stretching.
    stiffness : (n,) positive, 1 = normal; parts that should bend less get more.
    keep_volume : keep the volume of the rest pose (closed meshes only).
    """

    def __init__(
        self,
        vertices: ArrayLike,
        faces: ArrayLike,
        *,
        method: Method = "detail",
        stretch_weight: float = 300.0,
        stiffness: ArrayLike | None = None,
        keep_volume: bool = False,
    ) -> None:
        from imitation.deformation.paper import PaperIteration
        from imitation.deformation.system import System
        from imitation.deformation.volume import VolumeKeeper

        if not (np.isfinite(stretch_weight) and stretch_weight >= 0):
            raise InputError(f"The stretch weight must be zero or more, but is {stretch_weight}.")
        self.mesh = prepare_mesh(vertices, faces)
        if method not in ("detail", "paper"):
            raise InputError(f"The method of a deformation is 'detail' or 'paper', not '{method}'.")
        printed = method == "paper"
        self.system = System(self.mesh, 0.0 if printed else float(stretch_weight), stiffness, printed)
        self.method = method
        self._paper = PaperIteration(self.system) if printed else None
        self._volume = VolumeKeeper(self.system) if keep_volume else None
        self._modes: dict[tuple[bytes, ...], Modes] = {}
        self._lock = threading.Lock()

    def solve(
        self,
        points: Mapping[int, ArrayLike],
        rays: Mapping[int, ArrayLike] | None = None,
        camera: Camera | None = None,
        *,
        start: ArrayLike | Pose | None = None,
        depths: Mapping[int, float] | None = None,
        softness: Mapping[int, float] | None = None,
        iterations: int | None = None,
        tolerance: float = 1e-6,
    ) -> Array:
        """Deform the mesh so that vertices lie at points and on rays.

        Parameters
        ----------
        points, rays, camera, depths, softness : see ``FrameConstraints``.
        start : an earlier pose, (n, 3) or a ``Pose``; by default chosen from the constraints.
        iterations : number of steps; by default until the root mean square step is at most ``tolerance`` times the
            diagonal of the rest mesh, 60 at most.

        Returns
        -------
        (n, 3) vertices in the caller's order, world.

        Raises
        ------
        InputError
            See ``build_rows``.
        """
        asked = FrameConstraints(points, rays, camera, depths, softness)
        return self.solve_pose(asked, start=start, iterations=iterations, tolerance=tolerance).vertices

    def solve_pose(
        self,
        asked: FrameConstraints,
        *,
        start: ArrayLike | Pose | None = None,
        iterations: int | None = None,
        tolerance: float = 1e-6,
        most: int = MOST,
        modes: Modes | None = None,
    ) -> Pose:
        """As ``solve``, with the rotations for a warm start, the number of steps and warnings."""
        rows = build_rows(self.mesh, asked, HARD if self._paper is None else PRINTED)
        if not len(rows.handles):
            return self._as_pose(start)
        return self.solve_rows(rows, self.begin(rows, start), iterations, tolerance, most, modes)

    def solve_rows(
        self,
        rows: Rows,
        first: tuple[Array, Array],
        iterations: int | None = None,
        tolerance: float = 1e-6,
        most: int = MOST,
        modes: Modes | None = None,
    ) -> Pose:
        """The inner form of ``solve_pose``: rows instead of constraints, pose and rotations to begin with."""
        from imitation.deformation.kernels import relax
        from imitation.deformation.modes import no_modes

        rows, notes = complete(rows, first[0][self.system.place[rows.handles]])
        given = self.system.arrays, self.system.small(rows).arrays(rows.target)
        limit, within = (most, tolerance) if iterations is None else (max(1, int(iterations)), 0.0)
        inner, turns = first[0].copy(), first[1].copy()
        if self._paper is not None:
            inner, made, step = self._paper.relax(inner, turns, given[1], limit, within)
            turns = self._turns(inner, None)
        else:
            if modes is None and iterations is None:
                modes = self.slow_modes(rows, inner)
            plain = no_modes(len(inner))
            made, step = relax(inner, turns, *given, (modes or plain).arrays(), limit, within, 2)
            if modes is not None and not step <= ASTRAY:
                # Far from anything linear the slow directions can mislead: once more without them.
                other, bent = first[0].copy(), first[1].copy()
                again, last = relax(other, bent, *given, plain.arrays(), limit, within, 2)
                if not step <= last:
                    inner, turns, made, step = other, bent, again, last
        if self._volume is not None:
            inner = self._volume(inner, given[1])
        hidden = behind(rows, inner[self.system.place[rows.handles]])
        if hidden.any():
            notes = (*notes, f"Vertex {rows.vertex[hidden][0]} came to lie behind the camera; start from another pose.")
        reached = iterations is not None or bool(step <= within)
        return Pose(self.outward(inner), inner, turns, int(made), float(step), reached, notes)

    def modes_of(self, asked: FrameConstraints, heard: Callable[[], object] | None = None) -> Modes | None:
        """Slow directions of what a frame asks for; frames with the same handles may share them (``solve_pose``).

        They cost as much as some frames, and only the speed depends on them: where handles change their softness
        from frame to frame, one frame's serve all. ``heard`` is called now and then and may raise to stop.
        """
        rows = build_rows(self.mesh, asked, HARD if self._paper is None else PRINTED)
        if self._paper is not None or not len(rows.handles):
            return None
        rows, _ = complete(rows, self.system.rest[self.system.place[rows.handles]])
        return self.slow_modes(rows, self.system.rest, many=True, heard=heard)

    def slow_modes(
        self, rows: Rows, inner: Array, *, many: bool = False, heard: Callable[[], object] | None = None
    ) -> Modes:
        """Slow directions for a set of handles, more of them where ``many`` frames share them.

        Those of points alone do not depend on the frame and are kept.
        """
        from imitation.deformation.modes import COUNT, COUNT_OF_MANY, KRYLOV, KRYLOV_OF_MANY, slow_modes

        wanted = (COUNT_OF_MANY, KRYLOV_OF_MANY) if many else (COUNT, KRYLOV)
        if not rows.pinned.all():
            return slow_modes(self.system, rows, kabsch(self.system.rest, inner, self.system.area)[0], *wanted, heard)
        key = (*rows.signature, bytes(many))
        with self._lock:
            if key not in self._modes:
                if len(self._modes) >= KEPT:
                    self._modes.pop(next(iter(self._modes)))
                self._modes[key] = slow_modes(self.system, rows, np.eye(3), *wanted, heard)
            return self._modes[key]

    def solve_sequence(
        self,
        frames: Sequence[FrameConstraints],
        *,
        start: ArrayLike | Pose | None = None,
        tolerance: float = 1e-6,
        max_iterations: int = MOST,
        iterations: int | None = None,
        progress: Progress | None = None,
        on_frame: Callable[[int, Array], None] | None = None,
    ) -> Array:
        """Deform the mesh in every frame, each started from the one before.

        Parameters
        ----------
        frames : what each frame asks for. start : pose before the first frame, as in ``solve``.
        on_frame : called with the frame's position and its vertices (n, 3) as soon as they are solved.

        Returns
        -------
        (frames, n, 3) vertices.
        """
        result = np.empty((len(frames), len(self.mesh.vertices), 3))
        report = progress or silent
        report(0.0)
        poses = self.solve_poses(frames, start=start, tolerance=tolerance, most=max_iterations, iterations=iterations)
        for position, pose in enumerate(poses):
            result[position] = pose.vertices
            if on_frame is not None:
                on_frame(position, result[position])
            report((position + 1) / len(frames))
        return result

    def solve_poses(
        self,
        frames: Sequence[FrameConstraints],
        *,
        start: ArrayLike | Pose | None = None,
        tolerance: float = 1e-6,
        most: int = MOST,
        iterations: int | None = None,
    ) -> Iterator[Pose]:
        """The frames of ``solve_sequence`` one after the other, with their reports."""
        from imitation.deformation.sequence import run

        return run(self, frames, start, tolerance, most, iterations)

    def session(self, asked: FrameConstraints | None = None, start: ArrayLike | Pose | None = None) -> DragSession:
        """An interactive drag that begins at a pose."""
        from imitation.deformation.session import DragSession

        return DragSession(self, asked, start)

    def pose_of(self, vertices: ArrayLike) -> Pose:
        """Rotations found for a pose (n, 3) made elsewhere."""
        inner = self.inward(vertices)
        return Pose(np.array(vertices, np.float64), inner, self._turns(inner, None))

    # ---- poses in the solver's order and units

    def inward(self, vertices: ArrayLike) -> Array:
        """The caller's vertices (n, 3) as welded vertices (m, 3) in the solver's order and units."""
        given = np.asarray(vertices, np.float64)
        if given.shape != self.mesh.vertices.shape or not np.isfinite(given).all():
            raise InputError(
                f"The start pose must be {self.mesh.vertices.shape} finite numbers, but has shape {given.shape}."
            )
        welded = np.empty((len(self.mesh.positions), 3))
        welded[self.mesh.index[::-1]] = given[::-1]
        return np.ascontiguousarray(((welded - self.mesh.centre) / self.mesh.diagonal)[self.system.order])

    def outward(self, inner: Array) -> Array:
        """Welded vertices (m, 3) in the solver's order and units as the caller's vertices (n, 3)."""
        mesh = self.mesh
        world: Array = inner[self.system.place[mesh.index]] * mesh.diagonal + mesh.centre
        return world

    def _as_pose(self, start: ArrayLike | Pose | None) -> Pose:
        if isinstance(start, Pose):
            return start
        pose = self.pose_of(self.mesh.vertices if start is None else start)
        return attrs.evolve(pose, warnings=("Nothing holds the mesh in this frame; it keeps the pose it had before.",))

    def _turns(self, inner: Array, turn: Array | None) -> Array:
        """Rotations (m, 4) that fit a pose, starting from one turn for all."""
        from imitation.deformation.kernels import fit_turns

        if turn is None:
            turn = quaternion_of(kabsch(self.system.rest, inner, self.system.area)[0])
        turns = np.tile(turn, (len(inner), 1))
        start, other, edge, detail = self.system.arrays[:4]
        fit_turns(inner, turns, start, other, edge, detail, 12)
        return turns

    def begin(self, rows: Rows, start: ArrayLike | Pose | None) -> tuple[Array, Array]:
        """Pose (m, 3) and rotations (m, 4) to begin with."""
        place = self.system.place[rows.handles]
        if start is None:
            return self._cold(rows, place)
        if isinstance(start, Pose):
            inner, turns = start.inner.copy(), start.turns.copy()
        else:
            inner = self.inward(start)
            turns = self._turns(inner, None)
        handles = inner[place]
        gap = np.einsum("ri,ri->r", rows.direction, handles[rows.owner]) - rows.target
        if np.abs(gap).max() > FAR:
            rotation, translation, _ = rigid_fit(rows, handles, np.eye(3), np.zeros(3))
            inner = inner @ rotation.T + translation
            turns = np.ascontiguousarray(quaternion_product(quaternion_of(rotation), turns))
        return np.ascontiguousarray(inner), turns

    def _cold(self, rows: Rows, place: NDArray[np.int64]) -> tuple[Array, Array]:
        rest = self.system.rest
        handles = rest[place]
        rotation, translation = first_motion(rows, handles)
        turn = quaternion_of(rotation)
        moved = np.ascontiguousarray(rest @ rotation.T + translation)
        if rows.pinned.all() and np.abs(moved[place] - rows.place).max() > FAR:
            warped = warp(rest, handles, rows.place)
            if warped is not None:
                return np.ascontiguousarray(warped), self._turns(warped, turn)
        return moved, np.tile(turn, (len(rest), 1))
