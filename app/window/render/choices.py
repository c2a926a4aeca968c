"""What was chosen in the dialog, as plain values that are remembered between runs."""

from __future__ import annotations

import json
from typing import Any

import attrs

from app.actions.compositing import SHUTTER, SheetForm, Standing
from app.actions.films import View
from app.actions.rendering import FilmOrder
from app.window import settings

KEY = "render/film"


@attrs.frozen
class FilmChoices:
    """The state of the controls; shares are in per cent, angles in degrees, as they are shown.

    Attributes
    ----------
    form : film, or png or exr for pictures with alpha.
    ranged : whether only the frames first to last are filmed. blurred : whether the shutter is open at all.
    """

    form: str = "film"
    view: View = "video"
    occlusion: bool = True
    shadow: bool = True
    plate: bool = True
    remove_shadow: bool = False
    match_light: bool = True
    light_turn: float = 0.0
    light_lift: float = 0.0
    brightness: float = 100.0
    warmth: float = 0.0
    shadow_strength: float = 100.0
    blurred: bool = True
    shutter: float = 100.0 * SHUTTER
    grain: bool = True
    dim: float = 0.0
    points: bool = False
    ranged: bool = False

    @property
    def alpha(self) -> bool:
        """Whether pictures with alpha are written."""
        return self.form != "film"

    def order(self, characters: tuple[str, ...], frames: tuple[int, int]) -> FilmOrder:
        """The film that is meant, of these characters; ``frames`` count where a range is chosen."""
        standing = Standing(
            occlusion=self.occlusion,
            shadow=self.shadow,
            plate=self.plate and not self.alpha,
            remove_shadow=self.remove_shadow and self.plate and not self.alpha,
            match_light=self.match_light,
            shutter=self.shutter / 100 if self.blurred else 0.0,
            grain=None if self.grain else 0.0,
            light_turn=self.light_turn,
            light_lift=self.light_lift,
            brightness=self.brightness / 100,
            warmth=self.warmth / 100,
            shadow_strength=self.shadow_strength / 100,
        )
        view: View = "video" if self.alpha else self.view
        shown = frames if self.ranged else None
        if self.alpha:
            form: SheetForm = "exr" if self.form == "exr" else "png"
            return FilmOrder(characters, standing=standing, frames=shown, alpha=True, form=form)
        return FilmOrder(characters, view, standing, self.dim / 100, self.points, shown)


def remembered() -> FilmChoices:
    """What was chosen last; the usual where nothing was, or what is stored cannot be read."""
    try:
        stored: Any = json.loads(str(settings.settings().value(KEY, "{}")))
    except ValueError:
        return FilmChoices()
    known = attrs.fields_dict(FilmChoices)
    usual = FilmChoices()
    kept = {
        name: value
        for name, value in (stored.items() if isinstance(stored, dict) else ())
        if name in known and isinstance(value, type(getattr(usual, name)))
    }
    return attrs.evolve(usual, **kept)


def remember(choices: FilmChoices) -> None:
    """Keep what was chosen for the next time."""
    settings.settings().setValue(KEY, json.dumps(attrs.asdict(choices)))


def remembered_text(name: str, usual: str = "") -> str:
    """A text that was chosen last, such as a folder."""
    return str(settings.settings().value(f"render/{name}", usual) or usual)


def remember_text(name: str, text: str) -> None:
    """Keep a text for the next time."""
    settings.settings().setValue(f"render/{name}", text)
