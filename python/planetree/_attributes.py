"""Attributes of a mesh in memory, as builds take them."""

from __future__ import annotations

from typing import Any, Dict, Iterable, Union

import numpy as np

from ._enums import Attributes, ValueKind

#: What build() takes as `keep`.
Keep = Union[int, str, Iterable[str]]


def attributes_of(keep: Keep) -> Attributes:
    """Returns flags: those given, or those that names stand for, as "color" or ["color", "uv"]."""
    if isinstance(keep, int):
        return Attributes(keep)
    names = keep.split(",") if isinstance(keep, str) else keep
    found = Attributes(0)
    for name in names:
        try:
            found |= Attributes[name.strip().upper()]
        except KeyError:
            known = ", ".join(each.name.lower() for each in Attributes)
            raise ValueError(f"there is no attribute {name!r}; choose from {known}") from None
    return found


def _colors(colors: Any) -> np.ndarray:
    array = np.asarray(colors)
    if array.ndim != 2 or array.shape[1] not in (3, 4):
        raise ValueError(f"'colors' has the shape {array.shape}; it needs (n, 3) or (n, 4)")
    if array.dtype.kind == "f":
        array = np.floor(np.clip(array, 0, 1) * 255 + 0.5)
    if array.dtype != np.uint8:
        if array.size > 0 and (array.min() < 0 or array.max() > 255):
            raise ValueError("'colors' has integers that are not from 0 to 255")
        array = array.astype(np.uint8)
    if array.shape[1] == 3:
        array = np.concatenate([array, np.full((len(array), 1), 255, np.uint8)], axis=1)
    return np.require(array, np.uint8, ("C", "A"))


def _uvs(uvs: Any) -> np.ndarray:
    array = np.require(np.asarray(uvs), np.float32, ("C", "A"))
    if array.ndim < 2 or array.shape[-1] != 2 or (array.ndim == 3 and array.shape[1] != 3):
        raise ValueError(f"'uvs' has the shape {array.shape}; it needs (n, 2) or (m, 3, 2)")
    return array.reshape(-1, 2)


def array_attributes(colors: Any, uvs: Any, values: Any) -> Dict[str, Any]:
    """Returns arrays for the extension module: colours of vertices, texture coordinates of vertices
    or corners, and a value for each triangle."""
    arrays: Dict[str, Any] = {}
    if colors is not None:
        arrays["colors"] = _colors(colors)
    if uvs is not None:
        arrays["uvs"] = _uvs(uvs)
    if values is not None:
        array = np.asarray(values)
        if array.ndim != 1 or array.dtype.kind not in "iuf":
            raise ValueError(f"'values' has the shape {array.shape}; it needs (m,) numbers")
        kind = {"u": ValueKind.UNSIGNED, "i": ValueKind.SIGNED, "f": ValueKind.REAL}
        wide = {"u": np.uint64, "i": np.int64, "f": np.float64}[array.dtype.kind]
        arrays["values"] = np.require(array, wide, ("C", "A")).view(np.uint64)
        arrays["value_kind"] = int(kind[array.dtype.kind])
    return arrays
