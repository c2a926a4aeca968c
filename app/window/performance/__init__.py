"""The Motion graph workspace: sequences, their motion graph, and the performance composed of it."""

from app.window.performance.workspace import PerformanceWorkspace

__all__ = ["PerformanceWorkspace"]
