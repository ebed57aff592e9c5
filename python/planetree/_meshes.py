"""Meshes of other libraries as arrays."""

from __future__ import annotations

from typing import Any, Tuple

import numpy as np


def mesh_arrays(mesh: Any) -> Tuple[np.ndarray, np.ndarray]:
    """Returns the vertices (n, 3) and the triangles (m, 3) of a mesh.

    mesh  a pair (vertices, faces), or a mesh of trimesh, Open3D (legacy or tensor), meshio or
          PyVista. Quadrilaterals are split into two triangles.
    """
    if isinstance(mesh, (tuple, list)) and len(mesh) == 2:
        return _checked(np.asarray(mesh[0]), np.asarray(mesh[1]))
    for adapt in (_of_tensors, _of_meshio, _of_pyvista, _of_trimesh, _of_open3d):
        found = adapt(mesh)
        if found is not None:
            return _checked(*found)
    raise TypeError(
        f"{type(mesh).__name__} is no mesh that is known; give (vertices, faces), a path, or a mesh "
        "of trimesh, Open3D, meshio or PyVista"
    )


def is_mesh(some: Any) -> bool:
    """Whether mesh_arrays() takes a value, other than an array of points."""
    if isinstance(some, np.ndarray):
        return False
    if isinstance(some, (tuple, list)):
        return len(some) == 2 and np.ndim(some[0]) == 2 and np.ndim(some[1]) == 2
    return any(hasattr(some, name) for name in ("faces", "triangles", "cells", "triangle"))


def _of_tensors(mesh: Any) -> Any:
    """A TriangleMesh of open3d.t.geometry."""
    vertex, triangle = getattr(mesh, "vertex", None), getattr(mesh, "triangle", None)
    if vertex is None or triangle is None or not hasattr(vertex, "positions"):
        return None
    return vertex.positions.cpu().numpy(), triangle.indices.cpu().numpy()


def _of_open3d(mesh: Any) -> Any:
    """A TriangleMesh of open3d.geometry."""
    if not hasattr(mesh, "vertices") or not hasattr(mesh, "triangles"):
        return None
    return np.asarray(mesh.vertices), np.asarray(mesh.triangles)


def _of_meshio(mesh: Any) -> Any:
    """A Mesh of meshio."""
    if not hasattr(mesh, "cells_dict") or not hasattr(mesh, "points"):
        return None
    cells = mesh.cells_dict
    parts = [np.asarray(cells[kind]) for kind in ("triangle",) if kind in cells]
    if "quad" in cells:
        quads = np.asarray(cells["quad"])
        parts += [quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]]
    if not parts:
        raise ValueError("the mesh has no triangles and no quadrilaterals")
    return np.asarray(mesh.points)[:, :3], np.concatenate(parts)


def _of_pyvista(mesh: Any) -> Any:
    """A PolyData of PyVista."""
    if not hasattr(mesh, "regular_faces"):
        return None
    return np.asarray(mesh.points), np.asarray(mesh.triangulate().regular_faces)


def _of_trimesh(mesh: Any) -> Any:
    """A Trimesh of trimesh, or what has the same attributes."""
    if not hasattr(mesh, "vertices") or not hasattr(mesh, "faces"):
        return None
    return np.asarray(mesh.vertices), np.asarray(mesh.faces)


def _checked(vertices: np.ndarray, faces: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
    """Returns the arrays as a build takes them, without a copy if they are so already."""
    if vertices.ndim != 2 or vertices.shape[1] != 3 or vertices.dtype.kind not in "fiu":
        raise ValueError(f"vertices have the shape {vertices.shape}; they need (count, 3)")
    if faces.ndim != 2 or faces.shape[1] != 3 or faces.dtype.kind not in "iu":
        raise ValueError(
            f"faces have the shape {faces.shape} and the type {faces.dtype}; they need (count, 3) "
            "and integers"
        )
    if vertices.dtype != np.float32:
        vertices = np.require(vertices, np.float64)
    return np.require(vertices, None, ("C", "A")), _indices(faces)


def _indices(faces: np.ndarray) -> np.ndarray:
    """Returns indices as uint32. Those that it does not hold become the greatest, which is skipped."""
    if faces.dtype == np.int32:
        faces = faces.view(np.uint32)  # negative ones are beyond all vertices
    elif faces.dtype != np.uint32:
        bad = (faces < 0) | (faces > 0xFFFFFFFF)
        narrow = faces.astype(np.uint32)
        if bad.any():
            narrow[bad] = 0xFFFFFFFF
        faces = narrow
    return np.require(faces, np.uint32, ("C", "A"))
