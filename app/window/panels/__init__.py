"""Panels at the right edge that can be opened beside any workspace: what was done, and what was said."""

from app.window.panels.side import SidePanel

__all__ = ["SidePanel"]
