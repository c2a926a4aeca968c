"""The document as JSON: readable, versioned, unknown fields kept (docs/formats.md)."""

from __future__ import annotations

import json
from collections.abc import Callable
from functools import cache
from typing import Any, get_args, get_origin

import attrs
import cattrs
from cattrs.gen import make_dict_structure_fn, make_dict_unstructure_fn, override

from app.model.document import Document
from app.model.frozen import FrozenMap
from app.model.values import ModelError
from app.storage.migrations import VERSION, migrate
from imitation.errors import InputError

FORMAT = "motionwright"


def document_to_json(document: Document) -> bytes:
    """Give the bytes of project.json; equal documents give equal bytes."""
    body = {"format": FORMAT, "version": VERSION, "document": _converter().unstructure(document)}
    return (json.dumps(body, indent=1, ensure_ascii=False, allow_nan=False) + "\n").encode()


def document_from_json(data: bytes, where: str) -> Document:
    """Read project.json of this or an older version.

    Raises ``InputError`` for damaged files and for files of a newer program.
    """
    try:
        body = json.loads(data)
    except (UnicodeDecodeError, json.JSONDecodeError) as error:
        raise InputError(f"{where} is not readable ({error}): open the autosave or an older copy.") from error
    if not isinstance(body, dict) or body.get("format") != FORMAT or not isinstance(body.get("version"), int):
        raise InputError(f"{where} is not a Motionwright project.")
    if body["version"] > VERSION:
        raise InputError(
            f"{where} was saved by a newer Motionwright (format {body['version']}, this one reads up to {VERSION}): "
            "update the program to open it."
        )
    try:
        document: Document = _converter().structure(migrate(body)["document"], Document)
    except (
        cattrs.BaseValidationError,
        cattrs.StructureHandlerNotFoundError,
        ModelError,
        LookupError,
        TypeError,
    ) as error:
        raise InputError(f"{where} is damaged ({_first_reason(error)}): open the autosave or an older copy.") from error
    return document


@cache
def _converter() -> cattrs.Converter:
    converter = cattrs.Converter(unstruct_collection_overrides={tuple: list})

    def is_map(kind: Any) -> bool:
        return get_origin(kind) is FrozenMap or kind is FrozenMap

    def structure_map(value: Any, kind: Any) -> FrozenMap[Any, Any]:
        key_type, value_type = get_args(kind) or (str, Any)
        if value_type is Any:
            return FrozenMap({key: _freeze(item) for key, item in value.items()})
        return FrozenMap({key_type(key): converter.structure(item, value_type) for key, item in value.items()})

    def unstructure_map(value: FrozenMap[Any, Any]) -> dict[str, Any]:
        return {str(key): converter.unstructure(item) for key, item in value.items()}

    def structure_factory(kind: Any) -> Callable[[Any, Any], Any]:
        plain = make_dict_structure_fn(kind, converter, unknown=override(omit=True))
        if "unknown" not in attrs.fields_dict(kind):
            return plain
        known = set(attrs.fields_dict(kind)) - {"unknown"}

        def structure(value: Any, kind_: Any) -> Any:
            made = plain(value, kind_)
            extra = {key: _freeze(item) for key, item in value.items() if key not in known}
            return attrs.evolve(made, unknown=FrozenMap(extra)) if extra else made

        return structure

    def unstructure_factory(kind: Any) -> Callable[[Any], Any]:
        plain = make_dict_unstructure_fn(kind, converter, unknown=override(omit=True))
        if "unknown" not in attrs.fields_dict(kind):
            return plain
        return lambda value: {**plain(value), **{key: _thaw(item) for key, item in value.unknown.items()}}

    def number(value: Any, _: Any) -> float:
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise TypeError(f"a number was expected, not {value!r}")
        return float(value)

    def whole(value: Any, _: Any) -> int:
        if isinstance(value, bool) or not isinstance(value, int):
            raise TypeError(f"a whole number was expected, not {value!r}")
        return value

    def truth(value: Any, _: Any) -> bool:
        if not isinstance(value, bool):
            raise TypeError(f"true or false was expected, not {value!r}")
        return value

    def text(value: Any, _: Any) -> str:
        if not isinstance(value, str):
            raise TypeError(f"text was expected, not {value!r}")
        return value

    converter.register_structure_hook(float, number)
    converter.register_structure_hook(int, whole)
    converter.register_structure_hook(str, text)
    converter.register_structure_hook(bool, truth)
    converter.register_structure_hook_factory(attrs.has, structure_factory)
    converter.register_unstructure_hook_factory(attrs.has, unstructure_factory)
    converter.register_structure_hook_func(is_map, structure_map)
    converter.register_unstructure_hook_func(is_map, unstructure_map)
    return converter


def _freeze(value: Any) -> Any:
    # Unknown fields live in a hashable document, so lists and dicts become tuples and maps.
    if isinstance(value, dict):
        return FrozenMap({str(key): _freeze(item) for key, item in value.items()})
    if isinstance(value, list):
        return tuple(_freeze(item) for item in value)
    return value


def _thaw(value: Any) -> Any:
    if isinstance(value, FrozenMap):
        return {key: _thaw(item) for key, item in value.items()}
    if isinstance(value, tuple):
        return [_thaw(item) for item in value]
    return value


def _first_reason(error: BaseException) -> str:
    while isinstance(error, BaseExceptionGroup) and error.exceptions:
        error = error.exceptions[0]
    return f"missing field {error}" if isinstance(error, KeyError) else str(error).rstrip(".")
