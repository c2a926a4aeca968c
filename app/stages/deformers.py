"""Deformers of rest meshes: making one costs a factorisation, so the last few are kept and shared."""

from __future__ import annotations

import hashlib
import threading
from collections import OrderedDict
from typing import Any

import numpy as np

KEPT = 3


class Deformers:
    """Makes each deformer once, whoever asks first; several threads may use the same one."""

    def __init__(self) -> None:
        self._kept: OrderedDict[bytes, _Place] = OrderedDict()
        self._lock = threading.Lock()

    def get(self, vertices: Any, faces: Any, keep_volume: bool) -> Any:
        """Give the deformer of a rest mesh: vertices (v, 3), faces (m, 3)."""
        from imitation.deformation import Deformer

        digest = hashlib.blake2b(bytes([keep_volume]))
        for array in (vertices, faces):
            digest.update(np.ascontiguousarray(array).tobytes())
        key = digest.digest()
        with self._lock:
            place = self._kept.setdefault(key, _Place())
            self._kept.move_to_end(key)
            while len(self._kept) > KEPT:
                self._kept.popitem(last=False)
        with place.lock:
            if place.deformer is None:
                place.deformer = Deformer(vertices, faces, keep_volume=keep_volume)
            return place.deformer

    def clear(self) -> None:
        """Forget all."""
        with self._lock:
            self._kept.clear()


class _Place:
    """Where a deformer is or will be; whoever needs it meanwhile waits and does not make another."""

    def __init__(self) -> None:
        self.lock = threading.Lock()
        self.deformer: Any = None
