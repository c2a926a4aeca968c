"""What can be shown or hidden round the mesh: one set for looking about in space, one for looking over the film."""

from __future__ import annotations

from dataclasses import dataclass, field

LAYERS = (
    ("film", "Film"),
    ("tracks", "Tracks"),
    ("points", "3D points"),
    ("path", "Camera path"),
    ("background", "Background mesh"),
    ("shadow", "Shadow"),
    ("ground", "Ground grid"),
)
IN_SCENE = ("points", "path", "background", "shadow", "ground")
SPACE_ONLY = ("path",)
"""Of no use where one looks through that very camera."""
FILM_ONLY = ("film",)


@dataclass
class Layers:
    """Which layers are on; the choice over the film is another one than that in space."""

    space: set[str] = field(default_factory=lambda: {"tracks", "points", "path", "shadow", "ground"})
    film: set[str] = field(default_factory=lambda: {"film"})

    def on(self, name: str, *, over_film: bool) -> bool:
        """Whether a layer is shown."""
        return name in (self.film if over_film else self.space)

    def switch(self, name: str, on: bool, *, over_film: bool) -> None:
        """Show or hide a layer."""
        chosen = self.film if over_film else self.space
        (chosen.add if on else chosen.discard)(name)
