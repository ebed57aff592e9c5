"""Enumerations. Their values are those of the columns of answers."""

from enum import IntEnum, IntFlag


class Side(IntEnum):
    """Side of a query point."""

    INSIDE = 0
    OUTSIDE = 1
    ON_SURFACE = 2
    UNKNOWN = 3


class Feature(IntEnum):
    """Where a nearest point lies on its triangle."""

    FACE = 0
    EDGE = 1
    VERTEX = 2


class Status(IntEnum):
    """What is proven of an answer."""

    EXACT = 0
    WITHIN_ERROR = 1
    DEGRADED = 2
    BEYOND_MAX_DISTANCE = 3
    BAD_QUERY = 4


class SideRule(IntEnum):
    """How sides are decided."""

    OF_FILE = 0  #: as the file says
    SOLID = 1  #: by the winding number
    SURFACE = 2  #: in front of or behind the nearest feature


class NormalRule(IntEnum):
    """Which way normals point."""

    OUTWARD = 0  #: out of the solid, or as the mesh is oriented
    TOWARD_QUERY = 1  #: to the query point's side of the surface


class Layers(IntFlag):
    """Layers of a file."""

    DISTANCE = 1
    SIDE = 2
    FIELD = 4
    ATTRIBUTES = 8
    ALL = 15


class Attributes(IntFlag):
    """What a file keeps of each triangle beside its shape."""

    TRIANGLES = 1  #: where it is, so that its corners are found by its index
    COLOR = 2  #: colours of its corners
    UV = 4  #: texture coordinates of its corners
    VALUE = 8  #: a number of 8 bytes


class ValueKind(IntEnum):
    """Type of the numbers of Attributes.VALUE."""

    UNSIGNED = 0
    SIGNED = 1
    REAL = 2


class Parts(IntFlag):
    """Parts of an answer."""

    DISTANCE = 1
    SIDE = 2
    NORMAL = 4
    ALL = 7


class Locking(IntEnum):
    """Whether the memory of a model is locked, so that the system does not swap it out."""

    TRY = 0
    REQUIRE = 1
    NEVER = 2


class EvictionPolicy(IntEnum):
    """How the page to evict is chosen. Answers do not depend on it."""

    CLOCK = 0
    LRU = 1
    SIEVE = 2
    S3_FIFO = 3
    TWO_Q = 4


class ErrorCode(IntEnum):
    """Kind of a failure, as in Error.code."""

    BAD_ARGUMENT = 1
    NOT_FOUND = 2
    ALREADY_EXISTS = 3
    PERMISSION = 4
    NO_SPACE = 5
    NO_MEMORY = 6
    READ_FAILED = 7
    WRITE_FAILED = 8
    BAD_INPUT = 9
    NOT_PLANETREE = 10
    UNSUPPORTED = 11
    TRUNCATED = 12
    DAMAGED = 13
    CANCELLED = 14


#: Index of answers without a triangle.
NO_TRIANGLE = 2**64 - 1
