"""Probes, which answer one query at a time."""

from __future__ import annotations

import math
from typing import Any, List, NamedTuple, Optional, Sequence, Tuple

from . import _planetree
from ._enums import NormalRule, Parts, Side, SideRule, Status

_NO_LIMIT = 2**32 - 1


def query_options(
    parts: int = Parts.ALL,
    *,
    max_error: float = 0.0,
    max_distance: float = math.inf,
    max_work: Optional[int] = None,
    side_rule: SideRule = SideRule.OF_FILE,
    normal_rule: NormalRule = NormalRule.OUTWARD,
    wait: bool = True,
) -> _planetree.QueryOptions:
    """Returns the options of a query; see Model."""
    if not 0 <= max_error < math.inf:
        raise ValueError(f"max_error is {max_error}; give a length of 0 or more")
    if not max_distance >= 0:
        raise ValueError(f"max_distance is {max_distance}; give a length of 0 or more")
    if max_work is not None and not 0 < max_work < _NO_LIMIT:
        raise ValueError(f"max_work is {max_work}; give 1 or more, or None")
    return _planetree.QueryOptions(
        int(parts),
        0 if wait else 1,
        int(SideRule(side_rule)),
        int(NormalRule(normal_rule)),
        float(max_error),
        float(max_distance),
        _NO_LIMIT if max_work is None else int(max_work),
    )


class Contacts(NamedTuple):
    """Contacts of a ball, the nearest first."""

    found: List[Any]
    complete: bool  #: whether these are all


class Probe:
    """Answers one query at a time, for loops such as that of a haptic device. For one thread.

    Points are sequences of three numbers, in model units. Options are those of Model, given once
    to options() and then by `options=`. With wait=False a query never waits for the disk. It takes
    microseconds, and keeps Python's global lock.
    """

    def __init__(self, probe: _planetree.Probe) -> None:
        self._probe = probe
        self._default = query_options()

    @staticmethod
    def options(parts: int = Parts.ALL, **options: Any) -> _planetree.QueryOptions:
        """Returns options for the methods below. `parts` is a sum of Parts."""
        return query_options(parts, **options)

    def closest_point(
        self, point: Sequence[float], options: Optional[_planetree.QueryOptions] = None
    ) -> _planetree.ClosestPoint:
        """Finds the nearest surface point, its normal and the side.

        Returns an object with distance, signed_distance, lower, upper, side, point, normal,
        triangle, barycentric, feature and status, as the rows of Result.
        """
        return self._probe.closest_point(point, options or self._default)

    def contains(
        self, point: Sequence[float], options: Optional[_planetree.QueryOptions] = None
    ) -> Tuple[Side, Status]:
        """Returns the side of a point, and what is proven of it."""
        side, status = self._probe.contains(point, options or self._default)
        return Side(side), Status(status)

    def first_hit(
        self,
        origin: Sequence[float],
        direction: Sequence[float],
        t_min: float = 0.0,
        t_max: float = math.inf,
        options: Optional[_planetree.QueryOptions] = None,
    ) -> _planetree.RayHit:
        """Finds the first triangle that a ray passes through; the result is as a row of Hits."""
        return self._probe.first_hit(origin, direction, t_min, t_max, options or self._default)

    def first_contact(
        self,
        start: Sequence[float],
        end: Sequence[float],
        radius: float = 0.0,
        options: Optional[_planetree.QueryOptions] = None,
    ) -> _planetree.FirstContact:
        """Finds when a moving ball first touches the surface.

        Returns an object with t, t_lower, t_upper, free, status, and the contact `at`.
        """
        return self._probe.first_contact(start, end, radius, options or self._default)

    def contacts(
        self,
        point: Sequence[float],
        radius: float,
        limit: int = 16,
        options: Optional[_planetree.QueryOptions] = None,
    ) -> Contacts:
        """Finds the contacts of a ball, at most `limit`, the nearest first."""
        return Contacts(*self._probe.contacts(point, radius, limit, options or self._default))

    def motion(self, position: Sequence[float], velocity: Sequence[float]) -> None:
        """Tells where the tip goes, in model units and model units a second.

        Pages ahead of it are then read in the background.
        """
        self._probe.motion(position, velocity)

    @property
    def work_spent(self) -> int:
        """Units of work that the queries of this probe took so far."""
        return self._probe.work_spent()
