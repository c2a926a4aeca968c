"""Derived results: one graph of stages; cache, staleness, jobs."""
