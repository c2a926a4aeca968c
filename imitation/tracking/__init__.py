"""Interactive point tracking (paper A, appendix) and subject masks."""
