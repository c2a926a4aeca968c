"""Dense background depth: not here yet; contacts take their place from a local ground fit until it is."""
