"""Motion database, motion graph and composition (paper B, sections 5 to 7)."""

from tvmedit.graph.alternatives import best_paths
from tvmedit.graph.compose import compose
from tvmedit.graph.database import Node
from tvmedit.graph.motion_graph import MotionGraph, motion_graph
from tvmedit.graph.performance import Cut, Performance
from tvmedit.graph.search import best_path
from tvmedit.graph.unreachable import Unreachable

__all__ = [
    "Cut",
    "MotionGraph",
    "Node",
    "Performance",
    "Unreachable",
    "best_path",
    "best_paths",
    "compose",
    "motion_graph",
]
