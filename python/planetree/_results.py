"""What queries return: arrays by field."""

from __future__ import annotations

import numpy as np

from ._arrays import Columns


class Result(Columns):
    """Closest points. Arrays have the leading shape of the query points, here (...).

    distance         float64 (...)     distance to the nearest surface point found
    signed_distance  float64 (...)     the same, negative inside
    lower, upper     float64 (...)     certified: the true distance is between them
    side             uint8 (...)       a Side
    points           float64 (..., 3)  nearest surface point
    normals          float64 (..., 3)  contact normal of length 1, out of the solid
    triangles        uint64 (...)      index of the triangle, or NO_TRIANGLE
    barycentric      float64 (..., 3)  weights of the triangle's corners
    feature          uint8 (...)       a Feature
    status           uint8 (...)       a Status
    """

    distance: np.ndarray
    signed_distance: np.ndarray
    lower: np.ndarray
    upper: np.ndarray
    side: np.ndarray
    points: np.ndarray
    normals: np.ndarray
    triangles: np.ndarray
    barycentric: np.ndarray
    feature: np.ndarray
    status: np.ndarray


class SetResult(Result):
    """Several closest points for each query point. Arrays have a further axis, of `limit` rows.

    counts    uint64 (...)  how many were found; the rows behind them have no triangle and an
                            infinite distance
    complete  bool (...)    whether these are all
    """

    counts: np.ndarray
    complete: np.ndarray


class Hits(Columns):
    """Hits of rays. Arrays have the leading shape of the rays, here (...).

    t                 float64 (...)     position: the point is origin + t * direction; inf: no hit
    t_lower, t_upper  float64 (...)     certified: nothing is hit before t_lower
    points            float64 (..., 3)  the point
    normals           float64 (..., 3)  normal of the triangle, as the mesh is oriented
    triangles         uint64 (...)      index of the triangle, or NO_TRIANGLE
    barycentric       float64 (..., 3)  weights of the triangle's corners
    entering          uint8 (...)       1: the ray goes against the normal
    status            uint8 (...)       a Status
    """

    t: np.ndarray
    t_lower: np.ndarray
    t_upper: np.ndarray
    points: np.ndarray
    normals: np.ndarray
    triangles: np.ndarray
    barycentric: np.ndarray
    entering: np.ndarray
    status: np.ndarray


class SetHits(Hits):
    """All hits of each ray, in their order. Arrays have a further axis, of `limit` rows.

    counts    uint64 (...)  how many were found; the rows behind them have t = inf
    complete  bool (...)    whether these are all
    """

    counts: np.ndarray
    complete: np.ndarray


class FirstContacts(Columns):
    """First contacts of moving balls. Arrays have the leading shape of the motions, here (...).

    t                 float64 (...)     least t in [0, 1] at which the ball touches; inf: none
    t_lower, t_upper  float64 (...)     certified: before t_lower the ball is free, by t_upper it
                                        has touched
    free              uint8 (...)       1: certainly no contact in all of the motion
    points            float64 (..., 3)  surface point of the contact
    normals           float64 (..., 3)  from that point to the ball's centre, length 1
    triangles         uint64 (...)      index of the triangle, or NO_TRIANGLE
    barycentric       float64 (..., 3)  weights of the triangle's corners
    feature           uint8 (...)       a Feature
    status            uint8 (...)       a Status
    """

    t: np.ndarray
    t_lower: np.ndarray
    t_upper: np.ndarray
    free: np.ndarray
    points: np.ndarray
    normals: np.ndarray
    triangles: np.ndarray
    barycentric: np.ndarray
    feature: np.ndarray
    status: np.ndarray
