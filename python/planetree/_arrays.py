"""Arrays that queries take and return."""

from __future__ import annotations

import re
from typing import Any, Dict, Iterable, Mapping, Optional, Sequence, Tuple

import numpy as np

#: Names of columns with three numbers a row.
_TRIPLES = frozenset({"points", "normals", "barycentric"})
_TYPES = {
    "triangles": np.dtype(np.uint64),
    "side": np.dtype(np.uint8),
    "feature": np.dtype(np.uint8),
    "status": np.dtype(np.uint8),
    "entering": np.dtype(np.uint8),
    "free": np.dtype(np.uint8),
}


def bytes_of(size: "int | str") -> int:
    """Returns a size in bytes: a number, or text such as "256M". K, M, G and T are powers of 1024."""
    if isinstance(size, str):
        match = re.fullmatch(r"\s*(\d+(?:\.\d+)?)\s*([KMGT]?)(?:i?B)?\s*", size, re.IGNORECASE)
        if not match:
            raise ValueError(f"{size!r} is no size; write a number and K, M, G or T, such as '256M'")
        return int(float(match[1]) * 1024 ** " KMGT".index(match[2].upper() or " "))
    if isinstance(size, bool) or int(size) != size or size < 0:
        raise ValueError(f"{size!r} is no size; give a number of bytes, or text such as '256M'")
    return int(size)


def _real(name: str, values: Any) -> np.ndarray:
    """Returns an array of real numbers, as they are given."""
    array = np.asarray(values)
    if array.dtype.kind not in "fiu":
        raise TypeError(f"{name!r} has values of the type {array.dtype}; it needs real numbers")
    return array


def numbers(name: str, values: Any) -> np.ndarray:
    """Returns an array of float64. C-contiguous arrays of float64 are returned as they are."""
    return np.require(_real(name, values), np.float64, ("C", "A"))


def rows(name: str, values: Any, width: int) -> Tuple[np.ndarray, Tuple[int, ...]]:
    """Returns an array of shape (count, width) and the leading shape of one of shape (..., width)."""
    array = numbers(name, values)
    if array.ndim == 0 or array.shape[-1] != width:
        raise ValueError(f"{name!r} has the shape {array.shape}; it needs (..., {width})")
    return array.reshape(-1, width), array.shape[:-1]


def vectors(name: str, values: Any) -> Tuple[np.ndarray, Tuple[int, ...]]:
    """Returns points or directions as rows()."""
    return rows(name, values, 3)


def vectors_beside(name: str, values: Any, shape: Tuple[int, ...]) -> np.ndarray:
    """Returns rows of an array that must have a leading shape."""
    found, leading = vectors(name, values)
    if leading != shape:
        raise ValueError(f"{name!r} has the leading shape {leading}; it needs {shape}")
    return found


def spread(name: str, values: Any, shape: Tuple[int, ...]) -> np.ndarray:
    """Returns numbers, one for each row, from one for all or from an array of a shape."""
    array = np.require(_real(name, values), np.float64, ("A",))
    count = int(np.prod(shape))
    if array.ndim == 0:
        return np.broadcast_to(array, (count,))
    try:
        return np.broadcast_to(array, shape).reshape(count)
    except ValueError:
        raise ValueError(f"{name!r} has the shape {array.shape}; it needs {shape}") from None


class Columns:
    """Arrays by field. A field that was not asked for does not exist.

    The fields of a class are those that it and its bases annotate, in their order.
    """

    _all = ()  # type: Tuple[str, ...]

    def __init_subclass__(cls) -> None:
        cls._all = tuple(dict.fromkeys((*cls._all, *getattr(cls, "__annotations__", {}))))

    @classmethod
    def all_fields(cls) -> Tuple[str, ...]:
        """Names of all arrays that there may be."""
        return cls._all

    def __init__(self, arrays: Mapping[str, np.ndarray]) -> None:
        self._arrays = dict(arrays)

    def __getattr__(self, name: str) -> np.ndarray:
        arrays = self.__dict__.get("_arrays", {})
        if name in arrays:
            return arrays[name]
        if name in self._all:
            raise AttributeError(f"{name!r} was not asked for; name it in fields=")
        raise AttributeError(f"{type(self).__name__} has no {name!r}; it has {', '.join(arrays)}")

    @property
    def fields(self) -> Tuple[str, ...]:
        """Names of the arrays."""
        return tuple(self._arrays)

    def as_dict(self) -> Dict[str, np.ndarray]:
        """Returns the arrays by name. They are not copied."""
        return dict(self._arrays)

    def __dir__(self) -> Iterable[str]:
        return sorted({*super().__dir__(), *self._arrays})

    def __repr__(self) -> str:
        shapes = ", ".join(f"{name}{list(array.shape)}" for name, array in self._arrays.items())
        return f"{type(self).__name__}({shapes})"


def chosen_fields(
    fields: Optional[Iterable[str]], out: Optional[Mapping[str, Any]], known: Sequence[str]
) -> Tuple[str, ...]:
    """Returns the names of the fields to make: those asked for, of `out`, or all."""
    if fields is None:
        return tuple(out) if out is not None else tuple(known)
    names = (fields,) if isinstance(fields, str) else tuple(fields)
    for name in names:
        if name not in known:
            raise ValueError(f"there is no field {name!r}; choose from {', '.join(known)}")
    return names


def make_columns(
    names: Iterable[str], out: Optional[Mapping[str, Any]], shape: Tuple[int, ...]
) -> Dict[str, np.ndarray]:
    """Returns an array for each field: that of `out`, or a new one of a leading shape."""
    arrays: Dict[str, np.ndarray] = {}
    for name in names:
        wanted = shape + ((3,) if name in _TRIPLES else ())
        if out is not None and name in out:
            given = out[name]
            if not isinstance(given, np.ndarray) or given.shape != wanted:
                got = getattr(given, "shape", type(given).__name__)
                raise ValueError(f"out[{name!r}] has the shape {got}; it needs {wanted}")
            arrays[name] = given
        else:
            arrays[name] = np.empty(wanted, _TYPES.get(name, np.float64))
    return arrays
