"""How far points deviate from a model."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Dict, Tuple

import numpy as np

from ._meshes import is_mesh, mesh_arrays

if TYPE_CHECKING:
    from ._model import Model


class Deviation:
    """Deviations of points from a model.

    distances     float64 (...)  signed distance of each point, negative inside
    lower, upper  float64 (...)  certified: the true distance, without its sign, is between them
    exact         bool (...)     whether a distance is exact and its side known
    """

    def __init__(self, arrays: Dict[str, np.ndarray]) -> None:
        self.distances = arrays["signed_distance"]
        self.lower = arrays["lower"]
        self.upper = arrays["upper"]
        self.exact = arrays["status"] == 0

    @property
    def mean(self) -> float:
        """Mean of the signed distances of exact points."""
        return float(self._exact().mean())

    @property
    def rms(self) -> float:
        """Root of the mean square distance of exact points."""
        return float(np.sqrt(np.mean(self._exact() ** 2)))

    @property
    def greatest(self) -> Tuple[float, float]:
        """Certified interval of the greatest distance of all points from the surface."""
        return float(self.lower.max()), float(self.upper.max())

    def percentiles(self, of: Any = (5, 25, 50, 75, 95)) -> np.ndarray:
        """Returns percentiles of the signed distances of exact points."""
        return np.percentile(self._exact(), of)

    def within(self, tolerance: float) -> float:
        """Returns the share of points that are certainly no farther than a tolerance."""
        return float(np.mean(self.upper <= tolerance))

    def histogram(self, bins: Any = 50) -> Tuple[np.ndarray, np.ndarray]:
        """Returns counts and edges of a histogram of the signed distances of exact points."""
        return np.histogram(self._exact(), bins)

    def _exact(self) -> np.ndarray:
        exact = self.distances[self.exact]
        if exact.size == 0:
            raise ValueError("no distance is exact, so there are no statistics")
        return exact

    def __repr__(self) -> str:
        low, high = self.greatest
        return f"<planetree.Deviation of {self.distances.size:,} points, greatest {low:g} to {high:g}>"


def deviation(model: "Model", points_or_mesh: Any, **options: Any) -> Deviation:
    """Measures how far points, or the vertices of a mesh, deviate from a model.

    points_or_mesh  points (..., 3), or a mesh as build() takes it, of which the vertices count.
                    `planetree compare` measures whole triangles, and files of any size
    """
    points = mesh_arrays(points_or_mesh)[0] if is_mesh(points_or_mesh) else points_or_mesh
    fields = ("signed_distance", "lower", "upper", "status")
    return Deviation(model.closest_points(points, fields=fields, **options).as_dict())
