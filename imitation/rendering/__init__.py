"""Composites: character, shadow, occlusion, plate."""
