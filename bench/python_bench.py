#!/usr/bin/env python3
"""Distances of many points from Python: planetree beside Open3D's RaycastingScene, in turn.

Prints the processor time of a point in nanoseconds, for each round, and the ratio of the medians.
Pin it to one processor (taskset -c 0): Open3D uses all it finds.
"""

import argparse
import statistics
import time

import numpy as np
import open3d
import planetree

ROUNDS = 3


def points_of(kind, vertices, count):
    """float64 points of shape (count, 3): in the box of the mesh, or around its vertices."""
    random = np.random.default_rng(5)
    lower, upper = vertices.min(0), vertices.max(0)
    if kind == "uniform":
        return lower + (upper - lower) * random.random((count, 3))
    spread = np.linalg.norm(upper - lower) / 1500
    return vertices[random.integers(0, len(vertices), count)] + random.normal(0, spread, (count, 3))


def seconds_of(call):
    """Processor time of a call, and what it returns."""
    begin = time.process_time()
    value = call()
    return time.process_time() - begin, value


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("mesh", help="a PLY that Open3D reads")
    parser.add_argument("model", help="the .ptree file of it")
    parser.add_argument("--kind", choices=["near", "uniform"], default="near")
    parser.add_argument("--points", type=int, default=10_000_000, help="for planetree")
    parser.add_argument("--few", type=int, default=100_000, help="of these, for Open3D")
    options = parser.parse_args()

    mesh = open3d.t.geometry.TriangleMesh.from_legacy(open3d.io.read_triangle_mesh(options.mesh))
    vertices = mesh.vertex["positions"].numpy().astype(np.float64)
    points = points_of(options.kind, vertices, options.points)
    few = open3d.core.Tensor(points[: options.few].astype(np.float32))
    scene = open3d.t.geometry.RaycastingScene()
    scene.add_triangles(mesh)
    scene.compute_distance(few)

    ours, theirs = [], []
    with planetree.open(options.model, memory="4G") as model:
        model.closest_points(points, fields=("distance",))
        for _ in range(ROUNDS):
            seconds, found = seconds_of(lambda: model.closest_points(points, fields=("distance",)))
            ours.append(seconds / len(points))
            seconds, other = seconds_of(lambda: scene.compute_distance(few).numpy())
            theirs.append(seconds / len(other))
    print("planetree:", *(f"{value * 1e9:.0f}" for value in ours))
    print("Open3D:", *(f"{value * 1e9:.0f}" for value in theirs))
    print(f"ratio: {statistics.median(theirs) / statistics.median(ours):.1f}")
    print(f"greatest difference: {np.abs(found.distance[: options.few] - other).max():.2g}")


if __name__ == "__main__":
    main()
