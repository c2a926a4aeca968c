"""Base controls of the window."""

from app.window.controls.buttons import button, icon_button, renew_tooltips, set_tooltip, toggle, tool
from app.window.controls.chooser import Chooser
from app.window.controls.error_bar import ErrorBar
from app.window.controls.figure import Figure
from app.window.controls.fold import Fold
from app.window.controls.invitation import Invitation
from app.window.controls.labels import Chip, Elided, Header, Pictogram, Row, label, separator
from app.window.controls.number import NumberField, NumberRange
from app.window.controls.panel import Panel, ScrollColumn
from app.window.controls.swatches import Meter, Swatches

__all__ = [
    "Chip",
    "Chooser",
    "Elided",
    "ErrorBar",
    "Figure",
    "Fold",
    "Header",
    "Invitation",
    "Meter",
    "NumberField",
    "NumberRange",
    "Panel",
    "Pictogram",
    "Row",
    "ScrollColumn",
    "Swatches",
    "button",
    "icon_button",
    "label",
    "renew_tooltips",
    "separator",
    "set_tooltip",
    "toggle",
    "tool",
]
