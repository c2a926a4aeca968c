"""User control and two-pass propagation (paper A, 3.6), and the comparisons of the paper."""

from imitation.motion.ambiguity import AmbiguousSpan
from imitation.propagation.ambiguity import ambiguous_spans
from imitation.propagation.base import Base, solve_base
from imitation.propagation.compare import compare
from imitation.propagation.edits import commit_edit, edit_constraints, edited_pose, typical_modes
from imitation.propagation.imitate import imitate
from imitation.propagation.propagate import Imitation, propagate
from imitation.propagation.report import Report
from imitation.propagation.start import placed_frame, start_pose

__all__ = [
    "AmbiguousSpan",
    "Base",
    "Imitation",
    "Report",
    "ambiguous_spans",
    "commit_edit",
    "compare",
    "edit_constraints",
    "edited_pose",
    "imitate",
    "placed_frame",
    "propagate",
    "solve_base",
    "start_pose",
    "typical_modes",
]
