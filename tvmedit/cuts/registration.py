"""Registering one mesh onto another of different connectivity by embedded deformation, and the shapes in between."""

from __future__ import annotations

import attrs
import numpy as np
from numpy.typing import NDArray

from tvmedit.cuts.assembly import deform, normal_equations, turn_normals
from tvmedit.cuts.interpolation import partly
from tvmedit.cuts.landmarks import Counterparts, counterparts, end_places
from tvmedit.cuts.nodes import DeformationGraph
from tvmedit.cuts.rotations import rotation_matrices
from tvmedit.cuts.surface import Mesh, Surface, evenly, mesh_volume

Array = NDArray[np.float64]
Faces = NDArray[np.int32]
Pairs = tuple[Array, NDArray[np.int64], Array, Array, Array, Array]
"""Points, what they follow, gaps to their partners, the partners' normals, trust."""
SPACING = 0.1015
"""Distance of nodes on a person, metres."""
PERSON = 1.75
SKIN = 2.2
"""Height in metres, and surface in square metres of a body that is large for it: what lies low is not small."""
SAMPLES = 1000
JUDGED = 4000
"""So many vertices at most tell how near a fit has come: the last hundredth of them is many enough."""
POINT_SHARE = 0.25
FACING = 0.3
"""Cosine of the angle between the normals of two partners: about 72 degrees."""
TIGHT, WIDE = (0.4, 0.05), (0.3, 0.15)
"""Distance gates on a person, first and last, metres; the wide one where the tight one loses a limb."""
SURE_EDGES = 1.25
"""A registration by the tight gate is sure if 99 % of the target lies no further from it than so many edge lengths."""
ASTRAY_EDGES = 5.0
"""One that is not sure is refused if the way back leads 1 % of the body further astray than so many edge lengths."""
TWISTED_EDGES = 8.0
"""The same for one that began with the limbs: what moved as far as an arm that is raised turns about itself besides."""
MET = 0.12
"""Metres on a person: so near to their places in the target, the ends of limbs have arrived."""
SLID = 0.35
"""Metres on a person: half of the body further away is another place, not another pose."""
FEWEST_BACK = 14
GUIDED = (10.0, 10.0, 6.0, 3.0, 2.0, 1.0, 0.5, 0.5)
"""Stiffness of the steps towards known places, before closest points are looked for."""
PULL, PULLED = 0.3, 0.7
"""How much they weigh beside closest points at first, and the share of the steps after which they count no longer."""
REFUSED_EDGES = 2.0
"""A registration is refused if 1 % of the target lies further from it than so many mean edge lengths."""
VOLUMES = (0.93, 1.05)


@attrs.frozen(eq=False)
class Registration:
    """A deformation of one mesh that brings it onto another.

    Attributes
    ----------
    vertices : (v, 3) float64
        The mesh as it was.
    faces : (m, 3) int32
    graph : DeformationGraph
    rotations, moves : (k, 3, 3), (k, 3)
        Of each node.
    residual : float
        99 % quantile of the distance from the target's vertices to the deformed mesh, in the meshes' unit.
    volume : float
        Volume half-way over the mean volume of both ends.
    reason : str
        Why it must not be used; empty where it may.
    """

    vertices: Array
    faces: Faces
    graph: DeformationGraph
    rotations: Array
    moves: Array
    residual: float = float("nan")
    volume: float = float("nan")
    reason: str = ""

    def between(self, share: float) -> Array:
        """Vertices (v, 3) of the shape in between: 0 the mesh as it was, 1 on the target.

        Its lowest part is as high as the share says between both ends, so that who stands on the ground stays on it.
        """
        if share == 1.0:
            return self._deformed(self.rotations, self.moves)
        shape = self._deformed(*partly(self.graph, self.rotations, self.moves, share))
        ends = _lowest(self.vertices), _lowest(self._deformed(self.rotations, self.moves))
        shape[:, 2] += (1.0 - share) * ends[0] + share * ends[1] - _lowest(shape)
        return shape

    def _deformed(self, rotations: Array, moves: Array) -> Array:
        graph = self.graph
        return deform(self.vertices, graph.places, graph.bound, graph.weights, rotations, moves)


def _lowest(vertices: Array) -> float:
    """Mean height of the lowest hundredth of the vertices."""
    count = max(1, len(vertices) // 100)
    return float(np.partition(vertices[:, 2], count - 1)[:count].mean())


def register(
    source: Mesh,
    target: Mesh,
    *,
    height: float,
    edge: float,
    iterations: int = 30,
    start: Registration | None = None,
) -> Registration:
    """Deform the source onto the target.

    Gauss-Newton on one rigid motion a node: closest points both ways whose normals agree, along the normal and to a
    quarter as points; far pairs are gated and weigh little; neighbouring nodes agree, at first strongly.

    Parameters
    ----------
    source, target : Surface, or (vertices, faces)
        Already aligned, z up; what is found out about a Surface is kept for the next registration.
    height : float
        Body height in the meshes' unit.
    edge : float
        Mean edge length, for the verdict.
    iterations : int
    start : Registration, optional
        Of a neighbouring frame: its nodes' motions are the first guess, and the schedule begins where it ends.

    Returns
    -------
    Registration
        With its verdict; never raises for a bad fit.
    """
    source, target = Surface.of(source), Surface.of(target)
    metre = body_scale(source.vertices, source.faces, height)
    found = _judged(_fitted(source, target, metre, iterations, start, TIGHT), target, edge)
    if not found.reason and found.residual <= SURE_EDGES * edge:
        return found
    by_limbs = _found_by_limbs(source, target, metre, iterations, edge)
    if by_limbs is not None:
        return by_limbs
    # Limbs far on their way: a wider gate catches them, but now and then the wrong one. Then the way back differs.
    wide = found
    if found.reason:
        wide = _judged(_fitted(source, target, metre, iterations, start, WIDE), target, edge)
        if wide.reason:
            return found
    back = _judged(_fitted(target, source, metre, max(iterations, FEWEST_BACK), None, WIDE), source, edge)
    if back.reason or _astray(wide, back) > ASTRAY_EDGES * edge:
        reason = "part of the body has another counterpart there than back"
        return found if found.reason else attrs.evolve(found, reason=reason)
    return wide


def _found_by_limbs(
    source: Surface, target: Surface, metre: float, iterations: int, edge: float
) -> Registration | None:
    """Registration that begins where the limbs are by their distances along the surface, if it leads there and back."""
    there = counterparts(source, target)
    if there is None:
        return None
    found = _judged(_fitted(source, target, metre, iterations, None, TIGHT, there), target, edge)
    if found.reason or np.median(np.linalg.norm(found.between(1.0) - found.vertices, axis=1)) > SLID * metre:
        return None
    back = counterparts(target, source)
    if back is None:
        return None
    returned = _judged(_fitted(target, source, metre, iterations, None, TIGHT, back), source, edge)
    if returned.reason:
        # The way back may be barred: a hand that lies on a hip is one with it. Then the limbs themselves must say.
        vertices, places = there
        apart = float(np.quantile(np.linalg.norm(found.between(1.0)[vertices] - places, axis=1), 0.95))
        if apart > TWISTED_EDGES * edge and _ends_met(found, source, target, metre):
            return found
    else:
        apart = _astray(found, returned)
    return found if apart <= TWISTED_EDGES * edge else None


def _ends_met(found: Registration, source: Surface, target: Surface, metre: float) -> bool:
    """Whether the ends of all limbs that are told lie on their own: along bent limbs places are told less exactly."""
    ends = end_places(source, target)
    if ends is None:
        return False
    vertices, places = ends
    return bool((np.linalg.norm(found.between(1.0)[vertices] - places, axis=1) <= MET * metre).all())


def _fitted(
    source: Surface,
    target: Surface,
    metre: float,
    iterations: int,
    start: Registration | None,
    gates: tuple[float, float],
    known: Counterparts | None = None,
) -> Registration:
    graph = source.nodes(SPACING * metre)
    rotations, moves = _first_guess(graph, start)
    fit = _Fit(source, target, graph, metre)
    if known is not None:
        for stiffness in GUIDED:
            rotations, moves = fit.towards(rotations, moves, known, stiffness)
    for number, (stiffness, gate) in enumerate(
        _schedule(iterations, gates, warm=start is not None or known is not None)
    ):
        pull = PULL * max(0.0, 1.0 - number / (PULLED * iterations)) if known is not None else 0.0
        rotations, moves = fit.step(rotations, moves, stiffness, gate * metre, known if pull > 0.0 else None, pull)
    return Registration(source.vertices, source.faces, graph, rotations, moves)


def _astray(there: Registration, back: Registration) -> float:
    """How far 1 % of a mesh's vertices end from where they began, there and back by the nearest vertices."""
    from scipy.spatial import cKDTree

    some = evenly(len(there.vertices), JUDGED)
    partner = cKDTree(back.vertices).query(there.between(1.0)[some])[1]
    apart = np.linalg.norm(back.between(1.0)[partner] - there.vertices[some], axis=1)
    return float(np.quantile(apart, 0.99))


def body_scale(vertices: Array, faces: Faces, height: float) -> float:
    """What a metre of a person is on this body: by its height, or by its surface where it lies long and low."""
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    area = 0.5 * float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum())
    return max(height / PERSON, float(np.sqrt(area / SKIN)))


def _schedule(iterations: int, gates: tuple[float, float], *, warm: bool) -> list[tuple[float, float]]:
    """Stiffness 3 to 0.2 and distance gate from first to last, geometrically; a warm start begins half of the way."""
    first = 0.5 if warm else 0.0
    shares = np.linspace(first, 1.0, iterations)
    return [(3.0 * (0.2 / 3.0) ** s, gates[0] * (gates[1] / gates[0]) ** s) for s in shares.tolist()]


def _first_guess(graph: DeformationGraph, start: Registration | None) -> tuple[Array, Array]:
    count = len(graph.places)
    if start is None:
        return np.tile(np.eye(3), (count, 1, 1)), np.zeros((count, 3))
    from scipy.spatial import cKDTree

    nearest = cKDTree(start.graph.places).query(graph.places)[1]
    rotations = start.rotations[nearest]
    arm = graph.places - start.graph.places[nearest]
    carried = np.einsum("nij,nj->ni", rotations, arm) + start.graph.places[nearest] + start.moves[nearest]
    return rotations.copy(), carried - graph.places


class _Fit:
    """Samples of both meshes and the steps between them."""

    def __init__(self, source: Surface, target: Surface, graph: DeformationGraph, metre: float) -> None:
        self.graph, self.metre, self.vertices = graph, metre, source.vertices
        pick = evenly(len(source.vertices), SAMPLES)
        self.points, self.normals = source.vertices[pick], source.normals[pick]
        self.bound, self.weights = graph.bound[pick], graph.weights[pick]
        pick = evenly(len(target.vertices), SAMPLES)
        self.goals, self.goal_normals = target.vertices[pick], target.normals[pick]
        self.target, self.target_normals = target.vertices, target.normals
        self.tree = target.tree

    def step(
        self,
        rotations: Array,
        moves: Array,
        stiffness: float,
        gate: float,
        known: Counterparts | None = None,
        pull: float = 0.0,
    ) -> tuple[Array, Array]:
        """Take one Gauss-Newton step by closest points, and towards known places with a share of a pair's weight."""
        from scipy.spatial import cKDTree

        graph = self.graph
        now = deform(self.points, graph.places, self.bound, self.weights, rotations, moves)
        facing = turn_normals(self.normals, self.bound, self.weights, rotations)
        # Beyond the gate nothing counts: what is found there, if anything, has no weight.
        far, partner = self.tree.query(now, distance_upper_bound=gate)
        partner = np.minimum(partner, len(self.target) - 1)
        there = _trust(np.asarray(far), facing, self.target_normals[partner], gate)
        far, mine = cKDTree(now, compact_nodes=False, balanced_tree=False).query(self.goals, distance_upper_bound=gate)
        mine = np.minimum(mine, len(now) - 1)
        back = _trust(np.asarray(far), facing[mine], self.goal_normals, gate)
        pairs = [
            (self.points, self.bound, self.weights, now - self.target[partner], self.target_normals[partner], there),
            (self.points[mine], self.bound[mine], self.weights[mine], now[mine] - self.goals, self.goal_normals, back),
        ]
        if known is not None:
            pairs.append(self._pulled(rotations, moves, known, pull))
        return self._solved(rotations, moves, pairs, stiffness)

    def towards(self, rotations: Array, moves: Array, known: Counterparts, stiffness: float) -> tuple[Array, Array]:
        """Take one Gauss-Newton step towards known places alone."""
        return self._solved(rotations, moves, [self._pulled(rotations, moves, known, 1.0)], stiffness)

    def _pulled(self, rotations: Array, moves: Array, known: Counterparts, pull: float) -> Pairs:
        vertices, places = known
        points, bound, weights = self.vertices[vertices], self.graph.bound[vertices], self.graph.weights[vertices]
        now = deform(points, self.graph.places, bound, weights, rotations, moves)
        # Without a normal only the share of the whole gap is left of a pair's weight.
        return points, bound, weights, now - places, np.zeros_like(points), np.full(len(points), pull / POINT_SHARE)

    def _solved(self, rotations: Array, moves: Array, pairs: list[Pairs], stiffness: float) -> tuple[Array, Array]:
        from scipy.linalg import solveh_banded

        graph = self.graph
        points, bound, weights, gaps, normals, trust = (np.concatenate(column) for column in zip(*pairs, strict=True))
        matrix, right = normal_equations(
            points, bound, weights, gaps, normals, trust, graph.places, rotations, moves, graph.edges,
            stiffness, POINT_SHARE, graph.bandwidth,
        )  # fmt: skip
        size = len(right)
        # A node far from all pairs keeps its motion; the term is far below any pair's.
        matrix[0] += np.tile([1e-4 * self.metre**2] * 3 + [1e-2] * 3, size // 6)
        change = solveh_banded(matrix, right, lower=True, overwrite_ab=True, check_finite=False).reshape(-1, 6)
        turned = rotation_matrices(change[:, :3]) @ rotations
        return turned, moves + change[:, 3:]


def _trust(far: Array, facing: Array, other: Array, gate: float) -> Array:
    """Cauchy-like weights of pairs within the gate whose normals agree."""
    agree = (facing * other).sum(axis=1) > FACING
    return np.where(agree & (far < gate), 1.0 / (1.0 + (np.minimum(far, gate) / gate) ** 2), 0.0)


def _judged(found: Registration, target: Surface, edge: float) -> Registration:
    """Refuse what would break the body: part of the target has no partner, or the half-way shape swells or thins."""
    from scipy.spatial import cKDTree

    reached = found.between(1.0)
    far = cKDTree(reached).query(target.vertices[evenly(len(target.vertices), JUDGED)])[0]
    residual = float(np.quantile(far, 0.99))
    ends = 0.5 * (mesh_volume(found.vertices, found.faces) + target.volume)
    volume = mesh_volume(found.between(0.5), found.faces) / ends if ends > 0 else float("nan")
    reason = ""
    if not residual <= REFUSED_EDGES * edge:
        edges = residual / max(edge, 1e-12)
        reason = f"part of the body has no counterpart: 1 % of it is more than {edges:.1f} triangle edges away"
    elif not VOLUMES[0] <= volume <= VOLUMES[1]:
        reason = f"the shape half-way would have {volume:.2f} of the body's volume"
    return attrs.evolve(found, residual=residual, volume=volume, reason=reason)
