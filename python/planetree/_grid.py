"""Samples of a model on grids and planes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Iterable, Optional, Sequence, Tuple, Union

import numpy as np

from ._arrays import chosen_fields, make_columns
from ._results import Result

if TYPE_CHECKING:
    from ._model import Model

_CHUNK_POINTS = 1 << 18  # points that are made at once: 6 MiB
_AXES = {"x": 0, "y": 1, "z": 2}


class Grid(Result):
    """Closest points at the points of a grid. Arrays have the shape of the grid.

    axes  three arrays: the coordinates of the points along each axis, model units
    """

    axes: Tuple[np.ndarray, np.ndarray, np.ndarray]


class Slice(Result):
    """Closest points at the points of a plane. Arrays have a row for each of axes[1].

    axes    coordinates along the columns and along the rows, model units
    extent  (left, right, bottom, top), as matplotlib's imshow() takes it with origin="lower"
    """

    axes: Tuple[np.ndarray, np.ndarray]
    extent: Tuple[float, float, float, float]


def _box(model: "Model", lower: Any, upper: Any) -> Tuple[np.ndarray, np.ndarray]:
    """Returns the corners of the box to sample: by default the core and a twentieth around it."""
    core = model.info["core"]
    margin = 0.05 * (core[1] - core[0])
    low = core[0] - margin if lower is None else np.asarray(lower, np.float64)
    high = core[1] + margin if upper is None else np.asarray(upper, np.float64)
    if low.shape != (3,) or high.shape != (3,):
        raise ValueError("'lower' and 'upper' are points of three numbers")
    return low, high


def _sample(
    model: "Model",
    axes: Sequence[np.ndarray],
    fields: Union[str, Iterable[str], None],
    options: Any,
    progress: Any,
) -> dict:
    """Returns columns of the shape of a grid. Points are made in chunks along the first axes."""
    names = chosen_fields(fields, None, Result.all_fields())
    shape = tuple(len(axis) for axis in axes)
    count = int(np.prod(shape))
    arrays = make_columns(names, None, shape)
    flat = {name: array.reshape(count, *array.shape[3:]) for name, array in arrays.items()}
    points = np.empty((min(count, _CHUNK_POINTS), 3))
    for first in range(0, count, _CHUNK_POINTS):
        end = min(first + _CHUNK_POINTS, count)
        some = points[: end - first]
        places = np.unravel_index(np.arange(first, end), shape)
        for axis in range(3):
            some[:, axis] = axes[axis][places[axis]]
        out = {name: array[first:end] for name, array in flat.items()}
        model.closest_points(some, out=out, **options)
        if progress is not None:
            progress(end, count)
    return arrays


def grid(
    model: "Model",
    shape: Tuple[int, int, int],
    *,
    lower: Optional[Sequence[float]] = None,
    upper: Optional[Sequence[float]] = None,
    fields: Union[str, Iterable[str], None] = "signed_distance",
    progress: Any = None,
    **options: Any,
) -> Grid:
    """Samples a model at the points of a grid.

    shape         numbers of points along x, y and z; each 1 or more
    lower, upper  first and last point; None: the model's core and a twentieth around it
    fields        names of the arrays to make, as in Result
    """
    if len(shape) != 3 or min(shape) < 1:
        raise ValueError(f"{shape} is no shape of a grid; give three numbers of points")
    low, high = _box(model, lower, upper)
    axes = tuple(np.linspace(low[i], high[i], int(shape[i])) for i in range(3))
    result = Grid(_sample(model, axes, fields, options, progress))
    result.axes = axes  # type: ignore[assignment]
    return result


def slice_of(
    model: "Model",
    axis: "int | str",
    at: float,
    *,
    resolution: int = 512,
    lower: Optional[Sequence[float]] = None,
    upper: Optional[Sequence[float]] = None,
    fields: Union[str, Iterable[str], None] = "signed_distance",
    progress: Any = None,
    **options: Any,
) -> Slice:
    """Samples a model at the points of a plane across an axis.

    axis          "x", "y", "z" or 0, 1, 2
    at            coordinate of the plane on that axis, model units
    resolution    number of points along the longer side; the other side has points as far apart
    lower, upper  corners of a box around the points; None: the core and a twentieth around it
    """
    across = _AXES.get(axis, axis) if isinstance(axis, str) else int(axis)
    if across not in (0, 1, 2):
        raise ValueError(f"{axis!r} is no axis; give 'x', 'y', 'z' or 0, 1, 2")
    if resolution < 2:
        raise ValueError(f"a resolution of {resolution} is too low; give 2 or more")
    low, high = _box(model, lower, upper)
    along = [i for i in range(3) if i != across]
    sides = [high[i] - low[i] for i in along]
    step = max(sides) / (resolution - 1)
    counts = [max(2, int(round(side / step)) + 1) if step > 0 else 2 for side in sides]
    lines = [np.linspace(low[i], high[i], counts[n]) for n, i in enumerate(along)]
    axes = [lines[0], lines[1]]
    axes.insert(across, np.array([float(at)]))
    arrays = _sample(model, axes, fields, options, progress)
    # From (column, row) to (row, column).
    result = Slice(
        {name: np.moveaxis(array.squeeze(across), 0, 1) for name, array in arrays.items()}
    )
    result.axes = (lines[0], lines[1])
    result.extent = (lines[0][0], lines[0][-1], lines[1][0], lines[1][-1])
    return result
