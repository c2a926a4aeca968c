"""User control, two passes (paper A, 3.6), and the comparisons of the paper."""
