"""Building .ptree files."""

from __future__ import annotations

import os
from typing import Any, Callable, List, Mapping, Optional, Sequence

from . import _planetree
from ._arrays import bytes_of
from ._attributes import Keep, array_attributes, attributes_of
from ._enums import Attributes, Layers, SideRule
from ._meshes import mesh_arrays

_OF_ARRAYS = {"colors": Attributes.COLOR, "uvs": Attributes.UV, "values": Attributes.VALUE}


def paths_of(mesh: Any) -> List[str]:
    """The paths of a mesh of files; empty if it is none."""
    if isinstance(mesh, (str, os.PathLike)):
        return [os.fspath(mesh)]
    if isinstance(mesh, (list, tuple)) and all(isinstance(at, (str, os.PathLike)) for at in mesh):
        return [os.fspath(path) for path in mesh]
    return []


def build(
    mesh: Any,
    out: "str | os.PathLike[str]",
    *,
    memory: "int | str | None" = None,
    threads: int = 0,
    temp_dir: "str | os.PathLike[str] | None" = None,
    page_size: "int | str" = 65536,
    member_size: "int | str" = 0,
    box: Optional[Sequence[Sequence[float]]] = None,
    side: SideRule = SideRule.OF_FILE,
    layers: int = Layers.ALL,
    keep: Keep = 0,
    value: str = "value",
    colors: Any = None,
    uvs: Any = None,
    values: Any = None,
    resume: bool = False,
    float64: bool = False,
    metadata: Optional[Mapping[str, str]] = None,
    strict: bool = False,
    replace: bool = False,
    progress: Optional[Callable[[str, int, int], Any]] = None,
) -> _planetree.BuildReport:
    """Builds the .ptree file of a mesh, which may be larger than memory.

    mesh       path of a mesh file, a list of paths of files that follow each other, a pair
               (vertices (n, 3), faces (m, 3)) of arrays, or a mesh of trimesh, Open3D, meshio or
               PyVista. C-contiguous vertices of float32 or float64 and faces of int32 or uint32 are
               not copied. Files are those that `planetree build` reads
    out        the file to write
    memory     maximum memory of the build: bytes, or text such as "1G"; None: a quarter of the
               machine's. It spills what does not fit to temporary files in `temp_dir`
    threads    maximum number of threads; 0: one for each processor
    page_size  bytes of a decoded page, a power of two
    member_size  0: one file; else `out` is a set, OUT.ptreeset, with members of up to so many bytes
    box        two corners: build only the triangles that touch this box
    side       SideRule.SOLID or SURFACE; OF_FILE: as the mesh suggests
    layers     layers of the file
    keep       attributes of triangles that the file keeps: Attributes, or names such as "color,uv"
    value      the property of a PLY's faces that keep="value" reads
    colors     (n, 3) or (n, 4): colours of the vertices of arrays, integers from 0 to 255 or floats
               from 0 to 1. They are kept; so are the next two
    uvs        (n, 2) or (m, 3, 2): texture coordinates of vertices, or of the corners of faces
    values     (m,): a number for each face
    resume     keep completed work, and resume that of an earlier build
    float64    read floats of ascii PLY files as doubles
    metadata   texts that the file says of the model, such as {"unit": "mm", "crs": "EPSG:25832"}
    strict     a bad record is an error; otherwise it is skipped and counted
    replace    whether an existing file may be replaced
    progress   called as progress(phase, done, total) about 20 times a second

    Returns a report: triangles, skipped, watertight, side_rule, file_bytes and so on. Raises Error
    if the mesh is malformed, memory or space lacks, or the file exists.
    """
    options = {
        "threads": int(threads),
        "page_bytes": bytes_of(page_size),
        "member_bytes": bytes_of(member_size),
        "layers": int(layers) | Layers.DISTANCE,
        "side": int(SideRule(side)),
        "keep": int(attributes_of(keep)),
        "value_property": str(value),
        "resume": bool(resume),
        "float64": bool(float64),
        "metadata": {str(key): str(text) for key, text in (metadata or {}).items()},
        "strict": bool(strict),
        "replace": bool(replace),
    }
    if memory is not None:
        options["memory_bytes"] = bytes_of(memory)
    if temp_dir is not None:
        options["temp_directory"] = os.fspath(temp_dir)
    if box is not None:
        options["box"] = [[float(at) for at in corner] for corner in box]
    attributes = array_attributes(colors, uvs, values)
    paths = paths_of(mesh)
    if paths:
        if attributes:
            raise ValueError("colors=, uvs= and values= belong to arrays; a file has its own: keep=")
        return _planetree.build_files(paths, os.fspath(out), options, progress)
    vertices, faces = mesh_arrays(mesh)
    for name, flag in _OF_ARRAYS.items():
        if name in attributes:
            options["keep"] |= int(flag)
    return _planetree.build_arrays(vertices, faces, attributes, os.fspath(out), options, progress)
