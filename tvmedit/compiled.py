"""The one way this engine compiles an inner loop: cached on disk, free of the interpreter's lock."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar, cast

from numba import njit

Function = TypeVar("Function", bound=Callable[..., object])


def compiled(function: Function) -> Function:
    """Compile; same input, same bits."""
    return cast("Function", njit(cache=True, nogil=True)(function))


def compiled_sums(function: Function) -> Function:
    """Compile a loop of sums whose terms may be taken several at a time: same bits on one machine."""
    return cast("Function", njit(cache=True, nogil=True, fastmath={"reassoc", "contract", "nsz"})(function))


def compiled_lanes(function: Function) -> Function:
    """Compile a loop whose rounds are independent, several at a time; a division by zero gives inf, not an error."""
    return cast("Function", njit(cache=True, nogil=True, error_model="numpy")(function))
