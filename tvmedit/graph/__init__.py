"""Motion graph."""
