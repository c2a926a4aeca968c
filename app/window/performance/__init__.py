"""The Motion graph workspace: sequences, their motion graph, and the performance composed of it."""
