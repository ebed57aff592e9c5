"""Queries of many points, rays and moving balls."""

from __future__ import annotations

import math
from typing import Any, Callable, Dict, Iterable, Mapping, Optional, Tuple, Union

import numpy as np

from . import _planetree
from ._arrays import chosen_fields, make_columns, rows, spread, vectors, vectors_beside
from ._enums import Parts, Side
from ._probe import query_options
from ._results import FirstContacts, Hits, Result, SetHits, SetResult

Progress = Callable[[int, int], Any]
Fields = Union[str, Iterable[str], None]
Out = Optional[Mapping[str, np.ndarray]]


def _parts_of(names: Iterable[str]) -> int:
    """Returns the parts of a query that its fields need."""
    parts = Parts(0)
    for name in names:
        if name in ("side", "signed_distance"):
            parts |= Parts.SIDE
        if name == "normals":
            parts |= Parts.NORMAL
        if name not in ("side", "normals"):
            parts |= Parts.DISTANCE
    return parts or Parts.DISTANCE


def _rays(origins: Any, directions: Any, t_min: Any, t_max: Any) -> Tuple[tuple, Tuple[int, ...]]:
    """Returns the columns of rays, and their leading shape."""
    if directions is None:
        both, shape = rows("rays", origins, 6)
        starts, ways = both[:, :3], both[:, 3:]
    else:
        starts, shape = vectors("origins", origins)
        ways = vectors_beside("directions", directions, shape)
    return (starts, ways, spread("t_min", t_min, shape), spread("t_max", t_max, shape)), shape


class Queries:
    """The queries of many points, rays and moving balls that a Model answers; see there."""

    _handle: _planetree.Model

    def closest_points(
        self,
        points: Any,
        *,
        fields: Fields = None,
        out: Out = None,
        progress: Optional[Progress] = None,
        **options: Any,
    ) -> Result:
        """Finds the nearest surface point, its normal and the side of each point.

        points    (..., 3), model units
        fields    names of the arrays to make, as in Result; None: those of `out`, or all. What is
                  not asked for is not computed
        out       arrays to write to, by field; others are made
        progress  and further options: see Model
        """
        queries, shape = vectors("points", points)
        names = chosen_fields(fields, out, Result.all_fields())
        arrays = make_columns(names, out, shape)
        self._handle.closest_points(
            queries, arrays, query_options(_parts_of(names), **options), progress
        )
        return Result(arrays)

    def distance(self, points: Any, **options: Any) -> np.ndarray:
        """Returns the distance of each point from the surface, float64 (...)."""
        return self.closest_points(points, fields="distance", **options).distance

    def signed_distance(self, points: Any, **options: Any) -> np.ndarray:
        """Returns the distance of each point from the surface, negative inside, float64 (...).

        The sign is that of Open3D. That of trimesh is opposite: there it is positive inside. Where
        the side is unknown, the distance is positive.
        """
        return self.closest_points(points, fields="signed_distance", **options).signed_distance

    def contains(
        self,
        points: Any,
        *,
        out: Optional[np.ndarray] = None,
        progress: Optional[Progress] = None,
        **options: Any,
    ) -> np.ndarray:
        """Returns whether each point is inside, uint8 (...).

        1: inside or on the surface. 0: outside. 255: unknown, as where the file has no side layer.
        """
        queries, shape = vectors("points", points)
        sides = make_columns(("side",), None if out is None else {"side": out}, shape)["side"]
        self._handle.contains(queries, {"side": sides}, query_options(Parts.SIDE, **options), progress)
        for first in range(0, sides.size, 1 << 20):  # in place, in little memory
            some = sides.reshape(-1)[first : first + (1 << 20)]
            some[:] = _IS_INSIDE[some]
        return sides

    def first_hits(
        self,
        origins: Any,
        directions: Any = None,
        *,
        t_min: Any = 0.0,
        t_max: Any = math.inf,
        fields: Fields = None,
        out: Out = None,
        progress: Optional[Progress] = None,
        **options: Any,
    ) -> Hits:
        """Finds the first triangle that each ray passes through.

        origins     (..., 3), model units; or rays (..., 6), each an origin and a direction
        directions  (..., 3), of any length but 0
        t_min       hits before origin + t_min * direction do not count; one for all rays or (...)
        t_max       nor do hits behind origin + t_max * direction
        fields      names of the arrays to make, as in Hits; None: all
        """
        rays, shape = _rays(origins, directions, t_min, t_max)
        names = chosen_fields(fields, out, Hits.all_fields())
        arrays = make_columns(names, out, shape)
        self._handle.first_hits(*rays, arrays, query_options(Parts.DISTANCE, **options), progress)
        return Hits(arrays)

    def all_hits(
        self,
        origins: Any,
        directions: Any = None,
        *,
        limit: int = 16,
        t_min: Any = 0.0,
        t_max: Any = math.inf,
        fields: Fields = None,
        progress: Optional[Progress] = None,
        **options: Any,
    ) -> SetHits:
        """Finds the triangles that each ray passes through, in their order; at most `limit` a ray.

        Arguments are those of first_hits(). Arrays have a further axis, of `limit` rows.
        """
        rays, shape = _rays(origins, directions, t_min, t_max)
        names = chosen_fields(fields, None, Hits.all_fields())
        settings = query_options(Parts.DISTANCE, **options)
        return SetHits(
            _find_sets(self._handle.all_hits, rays, shape, limit, names, settings, progress)
        )

    def first_contacts(
        self,
        start: Any,
        end: Any,
        radius: Any = 0.0,
        *,
        fields: Fields = None,
        out: Out = None,
        progress: Optional[Progress] = None,
        **options: Any,
    ) -> FirstContacts:
        """Finds when each moving ball first touches the surface.

        start, end  (..., 3), the centre before and after a straight motion, model units
        radius      one for all balls or (...), model units; 0: a point
        fields      names of the arrays to make, as in FirstContacts; None: all
        """
        starts, shape = vectors("start", start)
        ends = vectors_beside("end", end, shape)
        names = chosen_fields(fields, out, FirstContacts.all_fields())
        arrays = make_columns(names, out, shape)
        self._handle.first_contacts(
            starts,
            ends,
            spread("radius", radius, shape),
            arrays,
            query_options(Parts.DISTANCE, **options),
            progress,
        )
        return FirstContacts(arrays)

    def contacts(
        self,
        points: Any,
        radius: float,
        *,
        limit: int = 16,
        fields: Fields = None,
        progress: Optional[Progress] = None,
        **options: Any,
    ) -> SetResult:
        """Finds the contacts of a ball at each point: the local minima of the distance within it.

        points  (..., 3), model units
        radius  of the balls, model units
        limit   maximum number of contacts of one ball, the nearest first
        """
        return self._point_set(
            self._handle.contacts, points, radius, limit, fields, progress, options
        )

    def nearest_triangles(
        self,
        points: Any,
        k: int,
        *,
        fields: Fields = None,
        progress: Optional[Progress] = None,
        **options: Any,
    ) -> SetResult:
        """Finds the `k` triangles nearest to each point, the nearest first."""
        return self._point_set(
            self._handle.nearest_triangles, points, 0.0, k, fields, progress, options
        )

    def triangles_within(
        self,
        points: Any,
        radius: float,
        *,
        limit: int = 16,
        fields: Fields = None,
        progress: Optional[Progress] = None,
        **options: Any,
    ) -> SetResult:
        """Finds the triangles within a radius of each point, the nearest first, at most `limit`."""
        return self._point_set(
            self._handle.triangles_within, points, radius, limit, fields, progress, options
        )

    def _point_set(
        self,
        find: Any,
        points: Any,
        radius: float,
        limit: int,
        fields: Fields,
        progress: Any,
        options: Dict[str, Any],
    ) -> SetResult:
        """Makes a query that finds up to `limit` closest points for each point."""
        queries, shape = vectors("points", points)
        names = chosen_fields(fields, None, Result.all_fields())
        settings = query_options(_parts_of(names), **options)
        return SetResult(
            _find_sets(find, (queries, float(radius)), shape, limit, names, settings, progress)
        )


def _find_sets(
    find: Any,
    queries: tuple,
    shape: Tuple[int, ...],
    limit: int,
    names: Tuple[str, ...],
    settings: Any,
    progress: Any,
) -> Dict[str, np.ndarray]:
    """Makes a query that finds up to `limit` answers for each row. Returns its columns."""
    if limit < 1:
        raise ValueError(f"at most {limit} answers make no sense; give 1 or more")
    arrays = make_columns(names, None, shape + (limit,))
    counts = np.empty(shape, np.uint64)
    complete = np.empty(shape, np.bool_)
    find(*queries, limit, arrays, counts, complete.view(np.uint8), settings, progress)
    return {**arrays, "counts": counts, "complete": complete}


_IS_INSIDE = np.full(256, 255, np.uint8)
_IS_INSIDE[[Side.INSIDE, Side.OUTSIDE, Side.ON_SURFACE]] = 1, 0, 1
