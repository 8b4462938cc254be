"""Checks of arguments: each gives the value as a number of Python, or raises InputError with the name of the argument."""
from __future__ import annotations

import math
import operator
from typing import Any, Iterable, Optional

import numpy as np

from . import _core


def mistake(key: str, text: str) -> _core.InputError:
    error = _core.InputError(f"{key}: {text}")
    error.key = key
    return error


def whole(key: str, value: Any, least: int, most: Optional[int] = None) -> int:
    """A whole number, also one of numpy."""
    try:
        found = None if isinstance(value, (bool, np.bool_)) else operator.index(value)
    except TypeError:
        found = None
    if found is None or found < least or (most is not None and found > most):
        upto = "" if most is None else f", at most {most}"
        raise mistake(key, f"expected a whole number of at least {least}{upto}: found {value!r}")
    return found


def checked_seed(seed: Any) -> Optional[int]:
    return None if seed is None else whole("seed", seed, 0)


def checked_seeds(key: str, seeds: Iterable[Any]) -> list[int]:
    """At least one."""
    found = [whole(key, seed, 0) for seed in seeds] if hasattr(seeds, "__iter__") else []
    if not found:
        raise mistake(key, f"expected a list of whole numbers, not empty: found {seeds!r}")
    return found


def real(key: str, value: Any, zero: bool = False, most: float = math.inf) -> float:
    """A finite number above 0 and at most `most`. zero: or 0."""
    fine = isinstance(value, (int, float, np.integer, np.floating)) and not isinstance(value, bool) and math.isfinite(value)
    if not fine or not (0 <= value if zero else 0 < value) or not value <= most:
        upto = "" if most == math.inf else f", at most {most:g}"
        raise mistake(key, f"expected a number {'of at least' if zero else 'above'} 0{upto}: found {value!r}")
    return float(value)
