"""User control and two-pass propagation (paper A, 3.6), and the comparisons of the paper."""

from imitation.propagation.base import Base, solve_base
from imitation.propagation.edits import commit_edit, edit_constraints, edited_pose
from imitation.propagation.imitate import imitate
from imitation.propagation.propagate import Imitation, propagate
from imitation.propagation.report import Report

__all__ = [
    "Base",
    "Imitation",
    "Report",
    "commit_edit",
    "edit_constraints",
    "edited_pose",
    "imitate",
    "propagate",
    "solve_base",
]
