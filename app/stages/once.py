"""Stages of one version of a document are made once, however many others stand on them."""

from __future__ import annotations

import functools
import threading
from collections import OrderedDict
from collections.abc import Callable
from typing import Any, Concatenate, ParamSpec, TypeVar

from app.model.document import Document

VERSIONS = 3
Parts = ParamSpec("Parts")
Made = TypeVar("Made")
_kept: OrderedDict[int, tuple[Document, dict[Any, Any]]] = OrderedDict()
_last: tuple[Document | None, dict[Any, Any]] = (None, {})
"""The version asked for last: nearly always the one that is asked for next, thousands of times after an edit."""
_lock = threading.Lock()


def once(make: Callable[Concatenate[Document, Parts], Made]) -> Callable[Concatenate[Document, Parts], Made]:
    """Keep what a function makes of a document and parts of it; for the last few versions, told by identity.

    Every contact stands on the world, the world on the cameras, these on the masks: without this, the stages of a
    project would be made anew as often as there are ways through it.
    """

    @functools.wraps(make)
    def kept(document: Document, /, *parts: Parts.args, **named: Parts.kwargs) -> Made:
        room = _room(document)
        # Parts live as long as their document does, so their identity is theirs alone; names are compared as such.
        key = (make, *(part if isinstance(part, str) else id(part) for part in (*parts, *named.values())))
        if key not in room:
            room[key] = make(document, *parts, **named)
        found: Made = room[key]
        return found

    return kept


def _room(document: Document) -> dict[Any, Any]:
    global _last
    last, room = _last
    if last is document:
        return room
    with _lock:
        found = _kept.get(id(document))
        if found is None or found[0] is not document:
            found = _kept[id(document)] = document, {}
        _kept.move_to_end(id(document))
        while len(_kept) > VERSIONS:
            _kept.popitem(last=False)
        _last = found
        return found[1]
