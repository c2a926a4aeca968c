"""Icons are letters of a font that comes with a package whose own module is not loaded."""

from __future__ import annotations

import builtins
import subprocess
import sys

import pytest
from PySide6.QtCore import QSize
from PySide6.QtGui import QColor, QIcon, QImage
from PySide6.QtWidgets import QApplication

from app.window import icons
from app.window.drawings import Drawing
from app.window.plain_imports import use_plain_imports


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
        "slow += ['app.window.character', 'app.window.performance', 'imitation.tracking']\n"
        "print(*[name for name in slow if name in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=60)
    assert done.stdout.strip() == ""


def test_a_picture_in_3d_needs_no_library_of_charts() -> None:
    """The host that draws in memory stands on VTK alone: what else pyvista brings takes longer than the window."""
    code = (
        "import sys, app.window.viewport.scene, app.window.viewport.raster_host\n"
        "slow = ['pyvista', 'matplotlib', 'PIL', 'scipy', 'pyvistaqt']\n"
        "print(*[name for name in slow if name in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=60)
    assert done.stdout.strip() == ""


def test_no_source_is_read_after_an_import(monkeypatch: pytest.MonkeyPatch) -> None:
    """What PySide does after every import is taken away, and importing still works."""
    seen = sys.modules["shibokensupport.feature"].pyside_feature_dict
    monkeypatch.setattr(builtins, "__import__", builtins.__import__)
    use_plain_imports()
    for name in ("sched", "this_is_no_module"):
        monkeypatch.delitem(sys.modules, name, raising=False)
        seen.pop(name, None)
    import sched

    assert sched.scheduler
    assert "sched" not in seen
    with pytest.raises(ModuleNotFoundError):
        import this_is_no_module  # noqa: F401
