"""Icons are letters of a font that comes with a package whose own module is not loaded."""

from __future__ import annotations

import subprocess
import sys

from PySide6.QtCore import QSize
from PySide6.QtGui import QColor, QIcon, QImage
from PySide6.QtWidgets import QApplication

from app.window import icons
from app.window.drawings import Drawing


def inked(picture: QImage) -> set[str]:
    """Colours of all fully drawn pixels."""
    places = [(x, y) for x in range(picture.width()) for y in range(picture.height())]
    return {picture.pixelColor(*place).name() for place in places if picture.pixelColor(*place).alpha() == 255}


def test_every_icon_is_drawn_in_its_colours(qapp: QApplication) -> None:
    """Each meaning has a drawing of its own, in the colour of its state."""
    size, seen = QSize(24, 24), set()
    for name in sorted(set(icons.NAMES.values())):
        icon = QIcon(Drawing(name, "#aabbcc", "#112233", "#445566"))
        for mode, state, colour in (
            (QIcon.Mode.Normal, QIcon.State.Off, "#aabbcc"),
            (QIcon.Mode.Normal, QIcon.State.On, "#112233"),
            (QIcon.Mode.Disabled, QIcon.State.Off, "#445566"),
        ):
            picture = icon.pixmap(size, mode, state).toImage()
            assert inked(picture) == {QColor(colour).name()}, f"{name} is not drawn in {colour}"
        seen.add(bytes(picture.convertToFormat(QImage.Format.Format_ARGB32).constBits()))
    assert len(seen) == len(set(icons.NAMES.values()))


def test_the_window_needs_no_slow_library_to_appear() -> None:
    """What takes long to load is loaded behind the first picture of the window."""
    code = (
        "import sys, app.commands.gui, app.window.application, app.window.shell\n"
        "slow = ['qtawesome', 'qtpy', 'scipy', 'numba', 'cv2', 'vtkmodules', 'pyvista', 'trimesh', 'pyvistaqt']\n"
        "print(*[name for name in slow if name in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=60)
    assert done.stdout.strip() == ""
