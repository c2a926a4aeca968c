"""Edits: pure functions from a document to the next one, each with the label a person would use."""

from app.model.edits.edit import Edit

__all__ = ["Edit"]
