"""Engine of time-varying mesh editing: nothing of it is here yet; it comes with the motion graph."""
