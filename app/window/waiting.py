"""Waiting for something that has to be done before the window can go on, with a bar and a way out."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

from PySide6.QtCore import QEventLoop, QObject, Qt, Signal
from PySide6.QtWidgets import QProgressDialog, QWidget

from imitation.errors import Cancelled
from imitation.progress import Progress

PATIENCE = 400
"""Milliseconds before the bar is shown."""


class _Ears(QObject):
    told = Signal(float)
    ended = Signal()


def wait_for(parent: QWidget, text: str, work: Callable[[Progress], Any]) -> Any:
    """Do ``work`` in a thread of its own while the window lives on behind a bar; gives what it gave.

    Raises what it raised, ``Cancelled`` where the person did not want to wait.
    """
    ears, loop, answer, gone = _Ears(), QEventLoop(), [], threading.Event()
    bar = QProgressDialog(text, "Cancel", 0, 1000, parent)
    bar.setWindowTitle(text)
    bar.setWindowModality(Qt.WindowModality.WindowModal)
    bar.setMinimumDuration(PATIENCE)
    bar.setAutoClose(False)
    bar.setAutoReset(False)
    bar.setMinimumWidth(360)
    bar.canceled.connect(gone.set)
    ears.told.connect(lambda fraction: bar.setValue(round(1000 * fraction)))
    ears.ended.connect(loop.quit)

    def tell(fraction: float) -> None:
        if gone.is_set():
            raise Cancelled
        ears.told.emit(fraction)

    def carry() -> None:
        try:
            answer.append((work(tell), None))
        except Exception as error:  # noqa: BLE001 - handed to whoever waits
            answer.append((None, error))
        ears.ended.emit()

    thread = threading.Thread(target=carry, name="waited for", daemon=True)
    thread.start()
    loop.exec()
    thread.join()
    bar.hide()
    bar.deleteLater()
    value, error = answer[0]
    if error is not None:
        raise error
    return value
