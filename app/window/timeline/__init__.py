"""The timeline that all workspaces share."""

from app.window.timeline.drags import LaneEdit
from app.window.timeline.lanes import Bar, Curve, Diamond, Lane, Row, TimelineHit
from app.window.timeline.transport import Transport
from app.window.timeline.widget import LaneView

__all__ = ["Bar", "Curve", "Diamond", "Lane", "LaneEdit", "LaneView", "Row", "TimelineHit", "Transport"]
