"""Exact distances to triangle meshes larger than memory.

    import numpy as np
    import planetree

    planetree.build("scan.ply", "scan.ptree")
    with planetree.open("scan.ptree", memory="256M") as model:
        found = model.closest_points(np.random.rand(1000, 3))
        print(found.signed_distance, found.points)
"""

from ._planetree import BuildReport, ClosestPoint, Error, FirstContact, RayHit
from ._planetree import version as __version__

from ._build import build
from ._deviation import Deviation, deviation
from ._enums import (
    NO_TRIANGLE,
    Attributes,
    ErrorCode,
    EvictionPolicy,
    Feature,
    Layers,
    Locking,
    NormalRule,
    Parts,
    Side,
    SideRule,
    Status,
    ValueKind,
)
from ._grid import Grid, Slice, grid, slice_of
from ._meshes import mesh_arrays
from ._model import Model, open
from ._probe import Contacts, Probe
from ._raycasting import RaycastingScene
from ._results import FirstContacts, Hits, Result, SetHits, SetResult
from ._triangles import Triangles

__all__ = [
    "NO_TRIANGLE",
    "Attributes",
    "BuildReport",
    "ClosestPoint",
    "Contacts",
    "Deviation",
    "Error",
    "ErrorCode",
    "EvictionPolicy",
    "Feature",
    "FirstContact",
    "FirstContacts",
    "Grid",
    "Hits",
    "Layers",
    "Locking",
    "Model",
    "NormalRule",
    "Parts",
    "Probe",
    "RayHit",
    "RaycastingScene",
    "Result",
    "SetHits",
    "SetResult",
    "Side",
    "SideRule",
    "Slice",
    "Status",
    "Triangles",
    "ValueKind",
    "build",
    "deviation",
    "grid",
    "mesh_arrays",
    "open",
    "slice_of",
]
