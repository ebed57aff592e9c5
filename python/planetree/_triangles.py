"""Triangles of a mesh by their indices, and what files keep of them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Dict, Optional

import numpy as np

from ._arrays import Columns, numbers
from ._enums import Attributes, ValueKind

if TYPE_CHECKING:
    from ._model import Model

_VALUE_TYPES = {
    ValueKind.UNSIGNED: np.uint64,
    ValueKind.SIGNED: np.int64,
    ValueKind.REAL: np.float64,
}


class Triangles(Columns):
    """Triangles of a mesh, as arrays of the leading shape of the indices.

    An array exists only if the file keeps it.
    """

    corners: np.ndarray  #: (..., 3, 3): positions of the three corners, in model units
    colors: np.ndarray  #: (..., 3, 4) uint8: red, green, blue and alpha of the corners
    uvs: np.ndarray  #: (..., 3, 2) float32: texture coordinates of the corners
    values: np.ndarray  #: (...) uint64, int64 or float64: a number a triangle

    def _mean(self, name: str, barycentric: Any) -> np.ndarray:
        weights = numbers("barycentric", barycentric)
        shape = self.corners.shape[:-2] + (3,)
        if weights.shape != shape:
            raise ValueError(f"'barycentric' has the shape {weights.shape}; it needs {shape}")
        return np.einsum("...k,...kc->...c", weights, getattr(self, name).astype(np.float64))

    def colors_at(self, barycentric: Any) -> np.ndarray:
        """Returns the colours (..., 4) uint8 at points that are given by their barycentric
        coordinates (..., 3), such as those of nearest points."""
        return np.clip(np.floor(self._mean("colors", barycentric) + 0.5), 0, 255).astype(np.uint8)

    def uvs_at(self, barycentric: Any) -> np.ndarray:
        """Returns the texture coordinates (..., 2) float32 at points, in the same way."""
        return self._mean("uvs", barycentric).astype(np.float32)


def triangles(model: "Model", indices: Any, progress: Optional[Any] = None) -> Triangles:
    """Returns triangles of the mesh by their indices, such as those of answers.

    model     a file that was built with keep=...
    indices   (...) of integers
    progress  called as progress(done, count) now and then

    Raises Error if an index has no triangle in the file, or if the file keeps no triangles.
    """
    info = model.info
    kept = info["attributes"]
    given = np.asarray(indices)
    if given.size > 0 and given.dtype.kind not in "iu":
        raise TypeError(f"'indices' has values of the type {given.dtype}; it needs integers")
    chosen = np.require(given, np.uint64, ("C", "A"))
    shape = given.shape
    arrays: Dict[str, np.ndarray] = {"corners": np.empty(shape + (3, 3))}
    if kept & Attributes.COLOR:
        arrays["colors"] = np.empty(shape + (3, 4), np.uint8)
    if kept & Attributes.UV:
        arrays["uvs"] = np.empty(shape + (3, 2), np.float32)
    if kept & Attributes.VALUE:
        arrays["values"] = np.empty(shape, _VALUE_TYPES[info["value_kind"]])
    model._handle.triangles(chosen, arrays, progress)
    return Triangles(arrays)
