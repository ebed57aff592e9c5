"""Open3D's RaycastingScene, answered from a file."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Dict

import numpy as np

from ._arrays import numbers

if TYPE_CHECKING:
    from ._model import Model

_INVALID = 0xFFFFFFFF


class RaycastingScene:
    """The methods of open3d.t.geometry.RaycastingScene for one model.

    Arrays are of NumPy; tensors of Open3D are taken too. As in Open3D, answers are float32 and
    uint32, and rays are (..., 6). Model has the same queries in float64, with certified intervals.
    """

    #: Id of no geometry, and of no triangle.
    INVALID_ID = _INVALID

    def __init__(self, model: "Model") -> None:
        self._model = model

    def compute_closest_points(self, query_points: Any, nthreads: int = 0) -> Dict[str, np.ndarray]:
        """Returns points, geometry_ids, primitive_ids, primitive_uvs and primitive_normals.

        The normals are the contact normals: out of the solid.
        """
        fields = ("points", "normals", "triangles", "barycentric")
        found = self._model.closest_points(_numbers(query_points), fields=fields)
        return {
            "points": found.points.astype(np.float32),
            "geometry_ids": np.zeros(found.triangles.shape, np.uint32),
            "primitive_ids": _ids(found.triangles),
            "primitive_uvs": found.barycentric[..., 1:].astype(np.float32),
            "primitive_normals": found.normals.astype(np.float32),
        }

    def compute_distance(self, query_points: Any, nthreads: int = 0) -> np.ndarray:
        """Returns the distance of each point from the surface."""
        return self._model.distance(_numbers(query_points)).astype(np.float32)

    def compute_signed_distance(
        self, query_points: Any, nthreads: int = 0, nsamples: int = 1
    ) -> np.ndarray:
        """Returns the distance of each point from the surface, negative inside."""
        return self._model.signed_distance(_numbers(query_points)).astype(np.float32)

    def compute_occupancy(
        self, query_points: Any, nthreads: int = 0, nsamples: int = 1
    ) -> np.ndarray:
        """Returns 1 for each point inside or on the surface, else 0."""
        return (self._model.contains(_numbers(query_points)) == 1).astype(np.float32)

    def cast_rays(self, rays: Any, nthreads: int = 0) -> Dict[str, np.ndarray]:
        """Returns t_hit, geometry_ids, primitive_ids, primitive_uvs and primitive_normals."""
        fields = ("t", "normals", "triangles", "barycentric")
        found = self._model.first_hits(_numbers(rays), fields=fields)
        missed = np.isinf(found.t)
        normals = found.normals.astype(np.float32)
        normals[missed] = 0
        return {
            "t_hit": found.t.astype(np.float32),
            "geometry_ids": np.where(missed, _INVALID, 0).astype(np.uint32),
            "primitive_ids": _ids(found.triangles),
            "primitive_uvs": found.barycentric[..., 1:].astype(np.float32),
            "primitive_normals": normals,
        }

    def test_occlusions(
        self, rays: Any, tnear: float = 0.0, tfar: float = math.inf, nthreads: int = 0
    ) -> np.ndarray:
        """Returns whether each ray hits something between tnear and tfar."""
        found = self._model.first_hits(_numbers(rays), t_min=tnear, t_max=tfar, fields="t")
        return np.isfinite(found.t)

    def count_intersections(self, rays: Any, nthreads: int = 0) -> np.ndarray:
        """Returns how many triangles each ray passes through, int32."""
        return self._all_hits(rays, ("t",)).counts.astype(np.int32)

    def list_intersections(self, rays: Any, nthreads: int = 0) -> Dict[str, np.ndarray]:
        """Returns all intersections, ray by ray.

        ray_splits  int64 (rays + 1): those of ray i are from ray_splits[i] to ray_splits[i + 1]
        ray_ids, t_hit, geometry_ids, primitive_ids, primitive_uvs  one row for each intersection
        """
        found = self._all_hits(rays, ("t", "triangles", "barycentric"))
        counts = found.counts.reshape(-1).astype(np.int64)
        used = np.arange(found.t.shape[-1]) < counts[:, None]
        limit = found.t.shape[-1]
        triangles = found.triangles.reshape(-1, limit)[used]
        return {
            "ray_splits": np.concatenate(([0], np.cumsum(counts))),
            "ray_ids": np.repeat(np.arange(len(counts)), counts),
            "t_hit": found.t.reshape(-1, limit)[used].astype(np.float32),
            "geometry_ids": np.zeros(triangles.shape, np.uint32),
            "primitive_ids": _ids(triangles),
            "primitive_uvs": found.barycentric.reshape(-1, limit, 3)[used][:, 1:].astype(np.float32),
        }

    def _all_hits(self, rays: Any, fields: Any) -> Any:
        """Finds all hits, with as much room as the ray with most hits needs."""
        rays, limit = _numbers(rays), 16
        while True:
            found = self._model.all_hits(rays, limit=limit, fields=fields)
            if found.complete.all() or not (found.counts == limit).any():
                return found
            limit *= 4


def _numbers(given: Any) -> np.ndarray:
    """Returns an array of NumPy, from a tensor of Open3D too."""
    return numbers("query", given.cpu().numpy() if hasattr(given, "cpu") else given)


def _ids(triangles: np.ndarray) -> np.ndarray:
    """Returns indices as uint32. Those that it does not hold, and none, become INVALID_ID."""
    return np.minimum(triangles, _INVALID).astype(np.uint32)
