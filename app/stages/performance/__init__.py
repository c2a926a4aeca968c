"""Stages of performances: sequences measured and cut into motions, the motion graph, the composed performance."""

from app.stages.performance.composing import assembled, blended, paths
from app.stages.performance.database import database, graph
from app.stages.performance.sequences import analysis, distances, features, structure

__all__ = [
    "analysis",
    "assembled",
    "blended",
    "database",
    "distances",
    "features",
    "graph",
    "paths",
    "structure",
]
