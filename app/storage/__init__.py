"""The project folder: open, save, autosave, recover, migrate."""
