"""No path: which key motion cannot be reached, and what would reach it."""

from __future__ import annotations

from imitation.errors import NoSolution


class Unreachable(NoSolution):
    """A key motion cannot be reached from the one before.

    Attributes
    ----------
    start, goal : int
        The two key motions.
    mu : float or None
        The smallest mu that connects them; None where it is not known or none does.
    edges : tuple of (int, int)
        The pruned edges that this mu brings back on the path.
    """

    def __init__(self, start: int, goal: int, mu: float | None = None, edges: tuple[tuple[int, int], ...] = ()) -> None:
        self.start, self.goal, self.mu, self.edges = start, goal, mu, edges
        if mu is None:
            remedy = "choose another key motion, or allow what is forbidden."
        else:
            named = ", ".join(f"{a} to {b}" for a, b in edges)
            remedy = f"a mu above {mu:.4g} brings back {named}."
        super().__init__(f"Motion {goal} cannot be reached from motion {start}: {remedy}")

    def __reduce__(self) -> tuple[type[Unreachable], tuple[int, int, float | None, tuple[tuple[int, int], ...]]]:
        """Pickle by the arguments, so that it crosses processes."""
        return type(self), (self.start, self.goal, self.mu, self.edges)
