"""Open files and their queries."""

from __future__ import annotations

import math
import os
from typing import Any, Callable, Dict, Iterable, Mapping, Optional, Tuple, Union

import numpy as np

from . import _planetree
from ._arrays import Columns, bytes_of, chosen_fields, make_columns, spread, vectors
from ._deviation import Deviation, deviation
from ._enums import EvictionPolicy, Layers, Locking, NormalRule, Side, SideRule
from ._grid import Grid, Slice, grid, slice_of
from ._probe import Probe, query_options
from ._raycasting import RaycastingScene
from ._results import (
    CLOSEST_POINT_FIELDS,
    CONTACT_FIELDS,
    HIT_FIELDS,
    FirstContacts,
    Hits,
    Result,
    SetHits,
    SetResult,
)

Progress = Callable[[int, int], Any]
Fields = Union[str, Iterable[str], None]
Out = Optional[Mapping[str, np.ndarray]]

_SIDE_FIELDS = frozenset({"side", "signed_distance"})
_DISTANCE, _SIDE, _NORMAL = 1, 2, 4


def _parts_of(names: Iterable[str]) -> int:
    """Returns the parts of a query that its fields need."""
    parts = 0
    for name in names:
        if name in _SIDE_FIELDS:
            parts |= _SIDE
        if name == "normals":
            parts |= _NORMAL
        if name not in ("side", "normals"):
            parts |= _DISTANCE
    return parts or _DISTANCE


def _rays(origins: Any, directions: Any, t_min: Any, t_max: Any) -> Tuple[tuple, Tuple[int, ...]]:
    """Returns the columns of rays, and their leading shape."""
    if directions is None:
        rays = np.asarray(origins)
        if rays.ndim == 0 or rays.shape[-1] != 6:
            raise ValueError(f"'rays' has the shape {rays.shape}; it needs (..., 6)")
        if rays.dtype.kind not in "fiu":
            raise TypeError(f"'rays' has values of the type {rays.dtype}; it needs real numbers")
        rows = np.require(rays, np.float64, ("C", "A")).reshape(-1, 6)
        starts, ways, shape = rows[:, :3], rows[:, 3:], rays.shape[:-1]
    else:
        starts, shape = vectors("origins", origins)
        ways, shape_of_ways = vectors("directions", directions)
        if shape_of_ways != shape:
            raise ValueError(f"'directions' has the leading shape {shape_of_ways}; it needs {shape}")
    return (starts, ways, spread("t_min", t_min, shape), spread("t_max", t_max, shape)), shape


class Model:
    """An open .ptree file. open() makes it. Any number of threads may use one model.

    Use it as a context manager, or call close(). A model cannot be used in a process made by
    fork(): use the start method 'spawn' of multiprocessing, or open it there.

    Every query of many points takes arrays of any leading shape, (..., 3). C-contiguous arrays of
    float64 are not copied. A query runs without Python's global lock, takes at most 64 MB besides
    the memory of the model and the arrays, and can be interrupted by Ctrl-C. Options of all of
    them:

    max_error     allowed error of the distance, in model units; 0: exact
    max_distance  distance to search within, in model units
    max_work      limit of the work of one point, in units; None: none
    side_rule     how sides are decided
    normal_rule   which way normals point
    wait          False: never wait for the disk; answers are then DEGRADED where pages are missing
    progress      called as progress(done, count) now and then
    """

    def __init__(self, path: "str | os.PathLike[str]", options: Dict[str, Any]) -> None:
        self._path = os.fspath(path)
        self._handle = _planetree.Model(self._path, options)

    def __enter__(self) -> "Model":
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()

    def close(self) -> None:
        """Closes the file as soon as no call uses it, and releases its memory."""
        self._handle.close()

    def __repr__(self) -> str:
        if self._handle.is_closed:
            return f"<planetree.Model {self._path!r}, closed>"
        info = self.info
        kind = "watertight" if info["watertight"] else f"{info['unbalanced_edges']:,} open edges"
        return f"<planetree.Model {self._path!r}, {info['triangles']:,} triangles, {kind}>"

    @property
    def info(self) -> Dict[str, Any]:
        """Contents of the file: counts, box, whether it is watertight, and so on."""
        told = self._handle.info()
        for name in ("box", "core", "region"):
            told[name] = told[name] and np.array(told[name])
        told["side_rule"] = SideRule(told["side_rule"])
        told["layers"] = Layers(told["layers"])
        return told

    @property
    def stats(self) -> Dict[str, int]:
        """State and counters: pages read, evicted, in memory, and so on."""
        return self._handle.stats()

    def probe(self) -> Probe:
        """Returns a probe, which answers one query at a time, such as at the rate of a haptic device.

        It belongs to one thread. A model has max_probes of them, and calls use some meanwhile.
        """
        return Probe(_planetree.Probe(self._handle))

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
        return Result(self._closest_points(points, fields, out, progress, options))

    def _closest_points(
        self, points: Any, fields: Fields, out: Out, progress: Any, options: Dict[str, Any]
    ) -> Dict[str, np.ndarray]:
        queries, shape = vectors("points", points)
        names = chosen_fields(fields, out, CLOSEST_POINT_FIELDS)
        arrays = make_columns(names, out, shape)
        self._handle.closest_points(
            queries, arrays, query_options(_parts_of(names), **options), progress
        )
        return arrays

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
        self._handle.contains(queries, {"side": sides}, query_options(_SIDE, **options), progress)
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
        names = chosen_fields(fields, out, HIT_FIELDS)
        arrays = make_columns(names, out, shape)
        self._handle.first_hits(*rays, arrays, query_options(_DISTANCE, **options), progress)
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
        return SetHits(
            self._set(self._handle.all_hits, rays, shape, limit, HIT_FIELDS, fields, progress, options)
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
        ends, shape_of_ends = vectors("end", end)
        if shape_of_ends != shape:
            raise ValueError(f"'end' has the leading shape {shape_of_ends}; it needs {shape}")
        names = chosen_fields(fields, out, CONTACT_FIELDS)
        arrays = make_columns(names, out, shape)
        self._handle.first_contacts(
            starts,
            ends,
            spread("radius", radius, shape),
            arrays,
            query_options(_DISTANCE, **options),
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
        ask: Any,
        points: Any,
        radius: float,
        limit: int,
        fields: Fields,
        progress: Any,
        options: Dict[str, Any],
    ) -> SetResult:
        queries, shape = vectors("points", points)
        arguments = (queries, float(radius))
        return SetResult(
            self._set(ask, arguments, shape, limit, CLOSEST_POINT_FIELDS, fields, progress, options)
        )

    @staticmethod
    def _set(
        ask: Any,
        arguments: tuple,
        shape: Tuple[int, ...],
        limit: int,
        known: Tuple[str, ...],
        fields: Fields,
        progress: Any,
        options: Dict[str, Any],
    ) -> Dict[str, np.ndarray]:
        if limit < 1:
            raise ValueError(f"at most {limit} answers make no sense; give 1 or more")
        names = chosen_fields(fields, None, known)
        arrays = make_columns(names, None, shape + (limit,))
        counts = np.empty(shape, np.uint64)
        complete = np.empty(shape, np.bool_)
        parts = _parts_of(names) if known is CLOSEST_POINT_FIELDS else _DISTANCE
        ask(
            *arguments,
            limit,
            arrays,
            counts,
            complete.view(np.uint8),
            query_options(parts, **options),
            progress,
        )
        return {**arrays, "counts": counts, "complete": complete}

    def grid(self, shape: Tuple[int, int, int], **arguments: Any) -> Grid:
        """Samples the model at the points of a grid. See planetree.grid."""
        return grid(self, shape, **arguments)

    def slice(self, axis: "int | str", at: float, **arguments: Any) -> Slice:
        """Samples the model at the points of a plane across an axis. See planetree.slice_of."""
        return slice_of(self, axis, at, **arguments)

    def deviation(self, points_or_mesh: Any, **arguments: Any) -> Deviation:
        """Measures how far points, or the vertices of a mesh, deviate. See planetree.deviation."""
        return deviation(self, points_or_mesh, **arguments)

    def as_raycasting_scene(self) -> RaycastingScene:
        """Returns an object with the methods of Open3D's RaycastingScene that answers from the file."""
        return RaycastingScene(self)


_IS_INSIDE = np.full(256, 255, np.uint8)
_IS_INSIDE[[Side.INSIDE, Side.OUTSIDE, Side.ON_SURFACE]] = 1, 0, 1


def open(  # noqa: A001 - the interface of the package
    path: "str | os.PathLike[str]",
    memory: "int | str" = "256M",
    threads: int = 1,
    *,
    layers: int = Layers.ALL,
    fetch_threads: int = 1,
    max_probes: int = 16,
    locking: Locking = Locking.TRY,
    policy: EvictionPolicy = EvictionPolicy.CLOCK,
    read_ahead: bool = False,
    wait_limit: float = 10.0,
    use_io_uring: bool = True,
) -> Model:
    """Opens a .ptree file.

    memory         maximum memory of the model: bytes, or text such as "256M"
    threads        number of threads that answer one call of many points
    layers         layers to open; others take no memory
    fetch_threads  number of threads that read pages for probes that do not wait
    max_probes     maximum number of probes, and of calls at one time
    locking        whether the memory is locked, so that the system does not swap it out
    policy         how the page to evict is chosen; answers do not depend on it
    read_ahead     whether all pages are read ahead, if memory holds them
    wait_limit     seconds that a query waits for one page at most
    use_io_uring   whether queries may wait for the disk by io_uring

    Raises Error if the file cannot be read or is not one, or if `memory` is too small.
    """
    return Model(
        path,
        {
            "memory_budget_bytes": bytes_of(memory),
            "batch_threads": int(threads),
            "layers": int(layers) | Layers.DISTANCE,
            "fetch_threads": int(fetch_threads),
            "max_probes": int(max_probes),
            "locking": int(Locking(locking)),
            "policy": int(EvictionPolicy(policy)),
            "read_ahead": bool(read_ahead),
            "wait_limit_ms": int(wait_limit * 1000),
            "use_io_uring": bool(use_io_uring),
        },
    )


__all__ = ["Columns", "Model", "open"]
