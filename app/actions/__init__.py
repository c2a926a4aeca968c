"""What a person can do in one step: the same verbs serve window, command line and scripts."""
