"""Anchors (3.2), track transfer (3.3), lifting and depth smoothing (3.5)."""
