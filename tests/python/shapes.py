"""Meshes and true distances for tests, without planetree."""

import math
import os
import subprocess
import sys

import numpy as np


def sphere(rings=20):
    """Vertices and triangles of a closed polyhedron with corners on the unit sphere."""
    around = 2 * rings
    corners = [(0.0, 0.0, 1.0)]
    for ring in range(1, rings):
        polar = math.pi * ring / rings
        for step in range(around):
            angle = math.tau * step / around
            corners.append(
                (math.sin(polar) * math.cos(angle), math.sin(polar) * math.sin(angle), math.cos(polar))
            )
    corners.append((0.0, 0.0, -1.0))
    last = len(corners) - 1

    def at(ring, step):
        return 1 + (ring - 1) * around + step % around

    faces = [(0, at(1, step), at(1, step + 1)) for step in range(around)]
    for ring in range(1, rings - 1):
        for step in range(around):
            a, b = at(ring, step), at(ring, step + 1)
            c, d = at(ring + 1, step), at(ring + 1, step + 1)
            faces += [(a, c, d), (a, d, b)]
    faces += [(last, at(rings - 1, step + 1), at(rings - 1, step)) for step in range(around)]
    return np.array(corners), np.array(faces)


def cube():
    """Vertices and triangles of the unit cube, outward."""
    vertices = np.array([[i & 1, i >> 1 & 1, i >> 2] for i in range(8)], np.float64)
    faces = [(0, 2, 3), (0, 3, 1), (4, 5, 7), (4, 7, 6), (0, 1, 5), (0, 5, 4)]
    faces += [(2, 6, 7), (2, 7, 3), (0, 4, 6), (0, 6, 2), (1, 3, 7), (1, 7, 5)]
    return vertices, np.array(faces)


def distance_to_triangles(point, vertices, faces):
    """Distance of a point from each triangle, by projection onto the plane and the edges."""
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    normal = np.cross(b - a, c - a)
    height = np.einsum("ij,ij->i", normal, point - a) / np.einsum("ij,ij->i", normal, normal)
    foot = point - height[:, None] * normal
    inside = np.ones(len(faces), bool)
    best = np.full(len(faces), np.inf)
    for start, end in ((a, b), (b, c), (c, a)):
        way = end - start
        inside &= np.einsum("ij,ij->i", np.cross(way, foot - start), normal) >= 0
        share = np.einsum("ij,ij->i", point - start, way) / np.einsum("ij,ij->i", way, way)
        nearest = start + np.clip(share, 0, 1)[:, None] * way
        best = np.minimum(best, np.linalg.norm(point - nearest, axis=1))
    return np.where(inside, np.linalg.norm(point - foot, axis=1), best)


def distances(points, vertices, faces):
    """Distance of each point from a mesh, by brute force."""
    return np.array([distance_to_triangles(p, vertices, faces).min() for p in points])


def run_command(*arguments):
    """Runs the planetree command of the build."""
    subprocess.run([os.environ["PLANETREE_COMMAND"], *map(str, arguments)], check=True,
                   stdout=subprocess.DEVNULL, stderr=sys.stderr)
