"""Detail-preserving deformation (paper A, 3.4)."""
