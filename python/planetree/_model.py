"""Open files."""

from __future__ import annotations

import os
from typing import Any, Dict, Optional, Tuple

import numpy as np

from . import _planetree
from ._arrays import bytes_of
from ._deviation import Deviation, deviation
from ._enums import Attributes, EvictionPolicy, Layers, Locking, SideRule, ValueKind
from ._grid import Grid, Slice, grid, slice_of
from ._probe import Probe
from ._queries import Queries
from ._raycasting import RaycastingScene
from ._triangles import Triangles, triangles


class Model(Queries):
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
        told["attributes"] = Attributes(told["attributes"])
        told["value_kind"] = ValueKind(told["value_kind"])
        return told

    @property
    def metadata(self) -> Dict[str, str]:
        """What the file says of the model: its unit, coordinate reference system, and so on."""
        return self._handle.metadata()

    @property
    def stats(self) -> Dict[str, int]:
        """State and counters: pages read, evicted, in memory, and so on."""
        return self._handle.stats()

    def probe(self) -> Probe:
        """Returns a probe, which answers one query at a time, such as at the rate of a haptic device.

        It belongs to one thread. A model has max_probes of them, and calls use some meanwhile.
        """
        return Probe(_planetree.Probe(self._handle))

    def triangles(self, indices: Any, progress: Optional[Any] = None) -> Triangles:
        """Returns triangles of the mesh by their indices, with what the file keeps of them.

        indices   (...) of integers, such as `triangles` of answers
        progress  called as progress(done, count) now and then

        The file must have been built with keep=...
        """
        return triangles(self, indices, progress)

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
    http_cache: "str | os.PathLike[str] | None" = None,
    http_cache_size: "int | str" = "1G",
    allow_missing_members: bool = False,
) -> Model:
    """Opens a .ptree file, a set of files (.ptreeset), or a URL of either.

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
    http_cache     directory that keeps what is read of a URL, for later processes; None: nowhere
    http_cache_size        maximum size of the file there
    allow_missing_members  whether members of a set may be missing; answers that need one are degraded

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
            "http_cache": "" if http_cache is None else os.fspath(http_cache),
            "http_cache_bytes": bytes_of(http_cache_size),
            "allow_missing_members": bool(allow_missing_members),
        },
    )
