"""The Character workspace."""

from app.window.character.workspace import CharacterWorkspace

__all__ = ["CharacterWorkspace"]
