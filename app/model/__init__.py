"""The document: what the user made, as immutable typed values; edits; history. No Qt, no files."""
