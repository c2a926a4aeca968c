"""The window: shell, theme, canvas, viewport, timeline and the workspaces."""
