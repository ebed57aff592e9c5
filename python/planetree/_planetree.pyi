"""Extension module. The package planetree documents its interface."""

from typing import Any, Dict, List, Tuple

import numpy as np

version: str
no_triangle: int
enum_values: Dict[str, Dict[str, int]]

class Error(RuntimeError):
    code: int
    page: "int | None"
    offset: "int | None"

class QueryOptions:
    def __init__(
        self,
        parts: int,
        wait: int,
        side_rule: int,
        normal_rule: int,
        max_error: float,
        max_distance: float,
        max_work: int,
    ) -> None: ...

class ClosestPoint:
    distance: float
    signed_distance: float
    lower: float
    upper: float
    side: int
    point: np.ndarray
    normal: np.ndarray
    triangle: int
    barycentric: np.ndarray
    feature: int
    status: int

class RayHit:
    t: float
    t_lower: float
    t_upper: float
    point: np.ndarray
    normal: np.ndarray
    triangle: int
    barycentric: np.ndarray
    entering: bool
    status: int

class FirstContact:
    t: float
    t_lower: float
    t_upper: float
    at: ClosestPoint
    free: bool
    status: int

class BuildReport:
    triangles: int
    input_triangles: int
    skipped: int
    first_skipped: int
    first_skipped_text: str
    notes: List[str]
    vertices: int
    strays: int
    unbalanced_edges: int
    watertight: bool
    side_rule: int
    openness: float
    levels: int
    layers: int
    attributes: int
    pages: int
    file_bytes: int
    temporary_bytes: int
    peak_resident_bytes: int

class Probe:
    def __init__(self, model: "Model") -> None: ...
    def closest_point(self, point: Any, options: QueryOptions) -> ClosestPoint: ...
    def contains(self, point: Any, options: QueryOptions) -> Tuple[int, int]: ...
    def first_hit(
        self, origin: Any, direction: Any, t_min: float, t_max: float, options: QueryOptions
    ) -> RayHit: ...
    def first_contact(
        self, start: Any, end: Any, radius: float, options: QueryOptions
    ) -> FirstContact: ...
    def contacts(
        self, point: Any, radius: float, limit: int, options: QueryOptions
    ) -> Tuple[List[ClosestPoint], bool]: ...
    def motion(self, position: Any, velocity: Any) -> None: ...
    def work_spent(self) -> int: ...

class Model:
    is_closed: bool
    def __init__(self, path: str, options: Dict[str, Any]) -> None: ...
    def close(self) -> None: ...
    def info(self) -> Dict[str, Any]: ...
    def metadata(self) -> Dict[str, str]: ...
    def stats(self) -> Dict[str, int]: ...
    def closest_points(self, *arguments: Any) -> None: ...
    def contains(self, *arguments: Any) -> None: ...
    def first_hits(self, *arguments: Any) -> None: ...
    def all_hits(self, *arguments: Any) -> None: ...
    def first_contacts(self, *arguments: Any) -> None: ...
    def contacts(self, *arguments: Any) -> None: ...
    def nearest_triangles(self, *arguments: Any) -> None: ...
    def triangles_within(self, *arguments: Any) -> None: ...
    def triangles(
        self, indices: np.ndarray, outputs: Dict[str, np.ndarray], progress: Any
    ) -> None: ...

def build_files(
    meshes: List[str], output: str, options: Dict[str, Any], progress: Any
) -> BuildReport: ...
def build_arrays(
    vertices: np.ndarray,
    faces: np.ndarray,
    attributes: Dict[str, Any],
    output: str,
    options: Dict[str, Any],
    progress: Any,
) -> BuildReport: ...
