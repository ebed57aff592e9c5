"""Building .ptree files."""

from __future__ import annotations

import os
from typing import Any, Callable, Optional, Sequence

from . import _planetree
from ._arrays import bytes_of
from ._enums import Layers, SideRule
from ._meshes import mesh_arrays


def build(
    mesh: Any,
    out: "str | os.PathLike[str]",
    *,
    memory: "int | str | None" = None,
    threads: int = 0,
    temp_dir: "str | os.PathLike[str] | None" = None,
    page_size: "int | str" = 65536,
    box: Optional[Sequence[Sequence[float]]] = None,
    side: SideRule = SideRule.OF_FILE,
    layers: int = Layers.ALL,
    resume: bool = False,
    float64: bool = False,
    strict: bool = False,
    replace: bool = False,
    progress: Optional[Callable[[str, int, int], Any]] = None,
) -> _planetree.BuildReport:
    """Builds the .ptree file of a mesh, which may be larger than memory.

    mesh       path of a mesh file, a pair (vertices (n, 3), faces (m, 3)) of arrays, or a mesh of
               trimesh, Open3D, meshio or PyVista. C-contiguous vertices of float32 or float64 and
               faces of int32 or uint32 are not copied. Files are those that `planetree build` reads
    out        the file to write
    memory     maximum memory of the build: bytes, or text such as "1G"; None: a quarter of the
               machine's. It spills what does not fit to temporary files in `temp_dir`
    threads    maximum number of threads; 0: one for each processor
    page_size  bytes of a decoded page, a power of two
    box        two corners: build only the triangles that touch this box
    side       SideRule.SOLID or SURFACE; OF_FILE: as the mesh suggests
    layers     layers of the file
    resume     keep completed work, and resume that of an earlier build
    float64    read floats of ascii PLY files as doubles
    strict     a bad record is an error; otherwise it is skipped and counted
    replace    whether an existing file may be replaced
    progress   called as progress(phase, done, total) about 20 times a second

    Returns a report: triangles, skipped, watertight, side_rule, file_bytes and so on. Raises Error
    if the mesh is malformed, memory or space lacks, or the file exists.
    """
    options = {
        "threads": int(threads),
        "page_bytes": bytes_of(page_size),
        "layers": int(layers) | Layers.DISTANCE,
        "side": int(SideRule(side)),
        "resume": bool(resume),
        "float64": bool(float64),
        "strict": bool(strict),
        "replace": bool(replace),
    }
    if memory is not None:
        options["memory_bytes"] = bytes_of(memory)
    if temp_dir is not None:
        options["temp_directory"] = os.fspath(temp_dir)
    if box is not None:
        options["box"] = [[float(at) for at in corner] for corner in box]
    if isinstance(mesh, (str, os.PathLike)):
        return _planetree.build_file(os.fspath(mesh), os.fspath(out), options, progress)
    vertices, faces = mesh_arrays(mesh)
    return _planetree.build_arrays(vertices, faces, os.fspath(out), options, progress)
