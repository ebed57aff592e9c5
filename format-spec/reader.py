#!/usr/bin/env python3
"""A reader of .ptree files and sets, version 1.0, written from v1/spec.md and set-v1/spec.md.

    reader.py FILE                       what the file holds
    reader.py FILE --answers POINTS      nearest triangles, sides, and triangles by index

All output is JSON. POINTS is a JSON file with some of these keys, in the input's coordinates:

    {"nearest": [[x, y, z], ...], "side": [[x, y, z], ...], "triangles": [index, ...]}

It is the specification as a program: plain and slow. Distances and signs are found with whole
numbers, so nothing is rounded before it is compared. What a reader may ignore for an answer (1.3)
it ignores: the mask, moments and the field.

It checks what it reads, as far as an answer depends on it. checker.py checks a whole file.

Exit status: 0 done, 1 the file is at fault, 2 the command line is. Needs numpy, xxhash and lz4.
"""

from __future__ import annotations

import argparse
import heapq
import itertools
import json
import math
import os
import re
import struct
import sys
from collections import defaultdict, namedtuple
from fractions import Fraction
from functools import cached_property
from typing import Any, Iterable

import lz4.block
import numpy as np
from xxhash import xxh3_64_intdigest, xxh3_128_intdigest

# --- Notation (1.4) -------------------------------------------------------------------------------
Vec = tuple[float, float, float]        # or of whole numbers, or of fractions
Link = tuple[int, int, int]             # NODE or BLOCK, page number, number of the record there
NODE, BLOCK, OTHER_PAGE = range(3)
AXES = (0, 1, 2)


class Issue(Exception):
    """What is wrong with a file: one of the codes of ISSUES.md."""

    def __init__(self, code: str, message: str, page: int | None = None):
        super().__init__(f"{code}: {message}")
        self.code, self.message, self.page = code, message, page


def require(condition: Any, message: str, code: str = "PAGE_STRUCTURE") -> None:
    if not condition:
        raise Issue(code, message)


class Record:
    """Fields by name. `fields` has names and formats of the module `struct`, in their order."""

    def __init__(self, fields: str, data: bytes, at: int = 0):
        words = fields.split()
        require(at + struct.calcsize("<" + "".join(words[1::2])) <= len(data), "the head is cut")
        for name, form in zip(words[::2], words[1::2]):
            values = struct.unpack_from("<" + form, data, at)
            setattr(self, name, values if len(values) > 1 else values[0])
            at += struct.calcsize("<" + form)


def sub(a: Vec, b: Vec) -> Vec:
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def dot(a: Vec, b: Vec) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Vec, b: Vec) -> Vec:
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def normal_of(a: Vec, b: Vec, c: Vec) -> Vec:
    return cross(sub(b, a), sub(c, a))


def whole(*points: Vec) -> tuple[int, list[Vec]]:
    """Points times a common denominator, as whole numbers: exact arithmetic."""
    ratios = [[x.as_integer_ratio() for x in p] for p in points]
    scale = math.lcm(*(r[1] for p in ratios for r in p))
    return scale, [tuple(n * (scale // d) for n, d in p) for p in ratios]


def sign(*values: float) -> int:
    """The first sign that is not 0."""
    return next((1 if v > 0 else -1 for v in values if v != 0), 0)


def scaled(p: Iterable[float], exponent: int) -> Vec:
    """1.7: the conversion to the model frame, and back with the negative exponent."""
    return tuple(np.ldexp(p, exponent).tolist())


# --- Header (2.2, 2.4, 2.5) -----------------------------------------------------------------------
MAGIC, HEADER_BYTES = b"\x89PTREE\r\n", 1024
HEADER = """
magic 8s  version H  header_bytes H  page_bytes I  incompatible_features Q  compatible_features Q
file_bytes Q  content_id 16s  extensions_hash Q  stored_bytes 5Q  page_count I  extension_count I
max_raw_bytes I  max_stored_bytes I  triangle_count Q  skipped_count Q  first_skipped Q
vertex_count Q  node_count Q  block_count Q  box_lower 3d  box_upper 3d  centre 3d  sample 3d
sample_triangle Q  scale_exponent i  vertex_kind B  triangle_id_bytes B  height B
model_reserved 9s  unbalanced_edge_count Q  unbalanced_edge 192s  mask_cell_count Q
mask_page_count I  mask_levels B  mask_reserved 3s  input_triangles Q  region_lower 3d
region_upper 3d  region_winding q  core_lower 3d  core_upper 3d  stray_count Q  stray_edge d
cap_count Q  cap_node_count Q  cap_block_count Q  cap_area d  cap_page_count I  cap_height B
cap_reserved 11s  openness d  side_rule B  side_is_chosen B  without_sides B  side_reserved 5s
field_lower 3d  field_step d  field_quantum d  field_size 3I  field_page_count I
attribute_page_count I  attributes B  value_kind B  attribute_reserved 2s  reserved 256s
header_hash Q"""
EDGE = "start 3d  end 3d  triangle Q  along I  against I"


class Header(Record):
    def __init__(self, data: bytes):
        super().__init__(HEADER, data)
        self.is_whole = self.magic == MAGIC and xxh3_64_intdigest(data[:1016]) == self.header_hash
        self.usable = self.input_triangles or self.triangle_count                   # 1.6
        self.indices = self.usable + self.skipped_count
        self.edges = [Record(EDGE, self.unbalanced_edge, 64 * i)
                      for i in range(min(3, self.unbalanced_edge_count))]
        layers = (self.mask_page_count, self.attribute_page_count, self.field_page_count,
                  self.cap_page_count)
        ends = itertools.accumulate(layers, int.__sub__, initial=self.page_count)
        self.layers = [0, *reversed(list(ends))]                    # 2.1: 0, c, e, a, d and n
        each = sum(size for i, size in enumerate((4, 12, 24, 8)) if self.attributes >> i & 1)
        self.attributes_per_page = (self.page_bytes - 64) // each if each else 0    # 12.1


def out_of_range(h: Header) -> list[str]:
    """The fields that are not in their valid ranges."""
    region, walls = h.input_triangles > 0, (h.region_lower, h.region_upper)
    caps, mask, field = h.cap_count > 0, h.mask_page_count > 0, h.field_page_count > 0
    vectors = h.box_lower, h.box_upper, h.centre, h.sample, h.core_lower, h.core_upper, *walls
    box = scaled(h.box_lower + h.box_upper, h.scale_exponent)
    core = scaled(h.core_lower + h.core_upper, h.scale_exponent)
    points, per_page = math.prod(h.field_size), h.attributes_per_page
    edge = 2 * max(y / 2 - x / 2 for x, y in zip(h.core_lower, h.core_upper))
    a, b = min(h.input_triangles, 2**62), min(h.cap_count, 2**62)

    def is_zero(*values: float) -> bool:
        return not any(struct.pack(f"<{len(values)}d", *values))                    # 2.4: no -0

    def ascend(*corners: Vec) -> bool:
        return all(x[i] <= y[i] for x, y in itertools.pairwise(corners) for i in AXES)

    rules = {
        "header_bytes or page_bytes": h.header_bytes == HEADER_BYTES
        and h.page_bytes in (2**i for i in range(12, 19)),
        "page_count or extension_count": h.layers[1] >= 1 and h.extension_count <= 64,
        "max_raw_bytes or max_stored_bytes": 1 <= h.max_stored_bytes <= h.max_raw_bytes <= 2**20,
        "a coordinate": all(map(math.isfinite, sum(vectors, h.field_lower))),
        "triangle_count or block_count": h.triangle_count >= 1 and h.block_count >= 1,
        "sample_triangle or first_skipped": h.sample_triangle < h.indices < 2**64
        and (h.first_skipped < h.indices if h.skipped_count else h.first_skipped == 2**64 - 1),
        "node_count": (h.node_count == 0) == (h.triangle_count <= 16),
        "box": ascend(h.box_lower, h.box_upper) and all(abs(x) <= 2.0**112 for x in box),
        "scale_exponent": -1200 <= h.scale_exponent <= 1200 and (
            not edge >= 2.0**-1000 or 1 <= np.ldexp(edge, h.scale_exponent) < 2),       # 1.7
        "vertex_kind or triangle_id_bytes": h.vertex_kind <= 1 and h.triangle_id_bytes in (4, 8),
        "height or mask_levels": h.height <= 96 and h.mask_levels <= (19 if mask else 0),
        "mask_cell_count": (h.mask_cell_count > 0) == mask,
        "unbalanced_edge": not any(h.unbalanced_edge[64 * len(h.edges):]) and all(
            e.along != e.against and e.triangle < h.indices
            and all(map(math.isfinite, e.start + e.end)) for e in h.edges),
        "input_triangles": not region or h.input_triangles >= h.triangle_count,
        "region": (ascend(h.region_lower, h.region_upper) and ascend(h.region_lower, h.box_upper)
                   and ascend(h.box_lower, h.region_upper) if region else is_zero(*sum(walls, ()))),
        "region_winding": abs(h.region_winding) <= (
            a // 2 + b // 2 + 1 if region and not h.without_sides else 0),
        "core": (ascend(h.box_lower, h.core_lower, h.core_upper, h.box_upper) and all(
            abs(x) < 2.0**55 for x in core) and (h.stray_count > 0 or (
                h.box_lower, h.box_upper) == (h.core_lower, h.core_upper))),
        "stray_count": h.stray_count == 0 or h.stray_count < h.usable,
        "stray_edge": 0 <= h.stray_edge <= 2.0**60 and (h.stray_count or is_zero(h.stray_edge)),
        "cap_count": caps == (h.unbalanced_edge_count > 0 and not h.without_sides)
        and (h.triangle_id_bytes == 8 or h.cap_count <= 2**32),
        "cap_node_count, cap_block_count or cap_page_count": caps == (h.cap_block_count > 0)
        and caps == (h.cap_page_count > 0) and (h.cap_node_count == 0) == (h.cap_count <= 16),
        "cap_area or cap_height": 0 <= h.cap_area <= 2.0**1000 and (caps or is_zero(h.cap_area))
        and h.cap_height <= (96 if caps else 0),
        "openness": 0 <= h.openness <= 1,
        "side_rule": h.side_rule <= 1 and h.side_is_chosen <= 1 and (
            h.side_rule == 0 or h.side_is_chosen or h.unbalanced_edge_count > 0),
        "without_sides": h.without_sides <= 1 and not (h.without_sides and mask),
        "field": (all(2.0**-40 <= x <= 4 for x in (h.field_step, h.field_quantum))
                  and min(h.field_size) >= 2 and points <= 2**20
                  and h.field_page_count == -(-points * 8 // max(h.page_bytes, 1)) if field
                  else is_zero(*h.field_lower, h.field_step, h.field_quantum)
                  and not any(h.field_size)),
        "attributes": h.attributes < 16 and h.attributes & 1 == (h.attributes > 0)
        and h.attribute_page_count == (-(-h.indices // per_page) if per_page > 0 else 0)
        and h.value_kind <= (2 if h.attributes & 8 else 0),
        "a reserved byte": not any(h.model_reserved + h.mask_reserved + h.cap_reserved
                                   + h.side_reserved + h.attribute_reserved + h.reserved),
    }
    return [name for name, good in rules.items() if not good]


# --- File (2) -------------------------------------------------------------------------------------
Entry = namedtuple("Entry", "check octcode stored_bytes raw_bytes offset")          # of a page
EXTENSION = "name 24s  offset Q  bytes Q  check Q  required B  reserved 15s"


def parts_of(path: str) -> list[tuple[str, int]]:
    """The files whose bytes are those of the model, joined, and their lengths. See set-v1/spec.md."""
    if not path.lower().endswith(".ptreeset"):
        return [(path, os.path.getsize(path))]
    with open(path, encoding="utf-8") as stream:
        members = json.load(stream)["members"]
    parts = [(os.path.join(os.path.dirname(path), x["address"]), x["bytes"]) for x in members]
    for part, length in parts:
        require(os.path.getsize(part) == length, f"{part} has another length", "SET")
    return parts


class File:
    """An open file or set. With a list of issues, as checker.py gives it, opening goes on after an issue
    as long as it can."""

    def __init__(self, path: str, issues: list[Issue] | None = None):
        require(os.path.isfile(path) or not os.path.exists(path), "no file", "NOT_PLANETREE")
        self.issues, self.parts = issues, parts_of(path)            # paths and lengths
        self.length = sum(length for _, length in self.parts)
        self.pages: dict[int, Any] = {}                             # or the issue of a page
        h = self.header = self.choose_header()
        require(h.version >> 8 == 1 and h.incompatible_features == 0,
                f"version {h.version} instead of 256 to 511, or features", "FORMAT_UNSUPPORTED")
        self.expect(h.file_bytes == self.length, "FILE_LENGTH",
                    f"{self.length} bytes instead of {h.file_bytes}")
        require(not out_of_range(h), ", ".join(out_of_range(h)) + " out of range", "HEADER_FIELD")
        _, self.c, self.e, self.a, self.d, self.n = h.layers
        self.box = scaled(h.box_lower, h.scale_exponent), scaled(h.box_upper, h.scale_exponent)
        self.least = scaled(h.core_lower, h.scale_exponent)         # corner of the octree
        lower, upper = (scaled(x, h.scale_exponent) for x in (h.region_lower, h.region_upper))
        self.walls = (                                              # 3
            tuple(x if h.input_triangles and x > y else -math.inf for x, y in zip(
                lower, self.box[0])),
            tuple(x if h.input_triangles and x < y else math.inf for x, y in zip(
                upper, self.box[1])))
        self.has_walls = any(map(math.isfinite, sum(self.walls, ())))
        self.sizes = [self.n]                                       # entries of each level, 2.6
        while self.sizes[0] > 512:
            self.sizes.insert(0, -(-self.sizes[0] // 512))
        self.start = HEADER_BYTES + 64 * h.extension_count + 24 * sum(self.sizes)   # of page 0
        self.end = self.start + sum(h.stored_bytes)                 # of the last page
        require(self.end + HEADER_BYTES <= h.file_bytes, "the pages do not lie within the file",
                "HEADER_FIELD")
        self.open_extensions()
        self.open_directory()

    def expect(self, condition: Any, code: str, message: str, page: int | None = None) -> None:
        if not condition and self.issues is None:
            raise Issue(code, message, page)
        if not condition:
            self.issues.append(Issue(code, message, page))

    def read(self, at: int, count: int) -> bytes:
        data = b""
        for path, length in self.parts:
            if at < length and len(data) < count:
                with open(path, "rb") as stream:
                    stream.seek(at)
                    data += stream.read(min(count - len(data), length - at))
            at = max(at - length, 0)
        return data

    def choose_header(self) -> Header:
        """2.3, step 1."""
        first = self.read(0, HEADER_BYTES)
        last = self.read(max(HEADER_BYTES, self.length - HEADER_BYTES), HEADER_BYTES)
        headers = [Header(x) for x in (first, last) if len(x) == HEADER_BYTES]
        chosen = next((h for h in headers if h.is_whole), None)
        version = int.from_bytes(first[8:10], "little")
        if chosen is None:
            begins = first[:8] == MAGIC[:max(1, len(first))]
            require(begins or b"PTREE" in first[:10], "no magic", "NOT_PLANETREE")
            require(not begins or len(first) == HEADER_BYTES, "shorter than a header",
                    "FILE_LENGTH")
            require(not begins or version >> 8 == 1,
                    f"version {version} instead of 256 to 511", "FORMAT_UNSUPPORTED")
            raise Issue("HEADER_LOST", "neither of the two headers is whole")
        self.expect(first == last or self.issues is None, "HEADER_COPY", "the two headers differ")
        return chosen

    def open_directory(self) -> None:
        """2.6, and the fields of the header that are sums and maxima of entries."""
        h, start, levels = self.header, self.start - 24 * sum(self.sizes), []
        require(self.start <= self.length, "the directory is cut short", "FILE_LENGTH")
        for size in self.sizes:
            data = self.read(start, 24 * size)
            form = "<QQII" if size == self.n else "<QQQ"
            parts = [data[i:i + 24 * 512] for i in range(0, len(data), 24 * 512)]
            levels.append([(part, list(struct.iter_unpack(form, part))) for part in parts])
            start += 24 * size
        self.entries: list[Entry] = []
        self.walk_directory(levels, 0, 0, None, 0, self.end - self.start, True)
        raw, stored = [x.raw_bytes for x in self.entries], [x.stored_bytes for x in self.entries]
        sums = [sum(stored[x:y]) for x, y in itertools.pairwise(h.layers)]
        good = all(k in h.layers or x.octcode + (k > self.d) <= y.octcode                # 4.3
                   for k, (x, y) in enumerate(itertools.pairwise(self.entries), 1))
        self.expect(self.issues or good, "DIRECTORY", "the octcodes do not ascend")
        self.expect(self.issues or (h.max_raw_bytes, h.max_stored_bytes, list(h.stored_bytes)) == (
            max(raw), max(stored), sums), "HEADER_FIELD", "other lengths than in the directory")

    def walk_directory(self, levels: list, level: int, number: int, up: Any, start: int, end: int,
                       is_known: bool) -> None:
        """A block and what is below it. `up` is its entry in the block above, and `is_known` tells
        whether all blocks above are right; where one is not, this goes on without a check."""
        h, (data, entries) = self.header, levels[level][number]
        last, at = level == len(levels) - 1, start
        is_right = is_known and (
            up[0] == xxh3_64_intdigest(data) and up[1] == entries[0][1] if up else
            int.from_bytes(h.content_id, "little") == xxh3_128_intdigest(data))
        if last:
            if not is_known and self.entries:
                at = self.entries[-1].offset + self.entries[-1].stored_bytes - self.start
            for k, entry in enumerate(entries, 512 * number):
                _, octcode, stored, raw = entry
                is_right &= (1 <= stored <= h.max_stored_bytes and raw <= h.max_raw_bytes
                             and stored <= raw <= 255 * stored and (
                                 k % 512 == 0 or k in h.layers
                                 or entries[k % 512 - 1][1] <= octcode))
                self.entries.append(Entry(*entry, self.start + at))
                at += stored
            is_right &= at == end
        else:
            places = [x[2] for x in entries] + [end]
            is_right &= places[0] == start and all(x < y for x, y in itertools.pairwise(places))
        self.expect(is_right or not is_known, "DIRECTORY", f"block {number} of level {level}")
        for i, entry in enumerate(() if last else entries):
            self.walk_directory(levels, level + 1, 512 * number + i, entry, *places[i:i + 2],
                                is_right)

    def open_extensions(self) -> None:
        """2.9"""
        h, at, last = self.header, self.end, b""
        self.extensions: dict[str, Record] = {}
        data = self.read(HEADER_BYTES, 64 * h.extension_count)
        if len(data) < 64 * h.extension_count:                      # FILE_LENGTH says so
            return
        good = xxh3_64_intdigest(data) == h.extensions_hash
        for x in (Record(EXTENSION, data, i) for i in range(0, len(data), 64)):
            name = x.name.rstrip(b"\0").decode("latin-1")
            good &= bool(re.fullmatch("[a-z0-9._-]{1,24}", name) and last < x.name
                         and x.offset == at and x.required <= 1 and not any(x.reserved))
            self.expect(not good or not x.required, "EXTENSION",
                        f"{name} is required and not known" if name != "metadata" else
                        "metadata is required")
            self.extensions[name], at, last = x, at + x.bytes, x.name
        good &= at == h.file_bytes - HEADER_BYTES
        self.expect(good, "EXTENSION",
                    "the records break a rule, or pages and extensions do not fill the file")
        if not good or any(x.required for x in self.extensions.values()):
            self.extensions = {}

    def extension(self, name: str) -> bytes:
        x = self.extensions[name]
        data = self.read(x.offset, min(x.bytes, self.length))
        require(len(data) == x.bytes, f"the bytes of {name} are cut short", "FILE_LENGTH")
        require(xxh3_64_intdigest(data) == x.check, f"the bytes of {name} are others", "EXTENSION")
        return data

    def metadata(self) -> dict[str, str]:
        """2.10"""
        data = self.extension("metadata") if "metadata" in self.extensions else b""
        text = data.decode(errors="replace")
        pairs = [line.partition(": ")[::2] for line in text.split("\n")[:-1]]
        require(len(data) <= 65536 and text.encode() == data and text[-1:] in ("", "\n") and all(
            re.fullmatch("[a-z0-9_]{1,64}", key) and re.fullmatch(r"[^\0-\x1f\x7f]+", value)
            for key, value in pairs) and all(x[0] < y[0] for x, y in itertools.pairwise(pairs)),
            "metadata breaks a rule", "EXTENSION")
        return dict(pairs)

    def raw_page(self, k: int) -> bytes:
        entry = self.entries[k]
        stored, raw = entry.stored_bytes, entry.raw_bytes
        require(1 <= stored <= raw <= min(255 * stored, 2**20)
                and entry.offset + stored <= self.length, "lengths that cannot be", "PAGE_ENTRY")
        try:
            data = self.read(entry.offset, stored)
            require(xxh3_64_intdigest(data) == entry.check, "another hash", "PAGE_CHECKSUM")
            if stored < raw:                                                        # 2.8
                data = lz4.block.decompress(data, uncompressed_size=raw)
        except (OSError, lz4.block.LZ4BlockError) as error:
            code = "PAGE_READ" if isinstance(error, OSError) else "PAGE_CODEC"
            raise Issue(code, str(error)) from None
        require(len(data) == raw, "the page decodes to another length", "PAGE_CODEC")
        return data

    def page(self, k: int) -> Any:
        """A decoded page. One that was found wrong raises the same issue each time."""
        if k not in self.pages:
            decode = (decode_tree if k < self.e else decode_field if k < self.a
                      else decode_attributes if k < self.d else decode_mask)
            try:
                streams = Streams(self.raw_page(k))
                self.pages[k] = decode(self, k, streams)
                require(streams.at == len(streams.raw), "the last stream ends before the page")
            except Issue as issue:
                issue.page = k
                self.pages[k] = issue
        if isinstance(self.pages[k], Issue):
            raise self.pages[k]
        return self.pages[k]

    def known_page(self, k: int) -> Any:
        """A page, or None if its issue is reported already."""
        try:
            return self.page(k)
        except Issue:
            if self.issues is None:
                raise
            return None

    def all_linked(self, first: int, end: int, linked: set[tuple[int, int]]) -> bool:
        """4.1: does a link lead to each subtree or family, and is no page lost?"""
        pages = [self.known_page(k) for k in range(first, end)]
        if None in pages:
            return False
        for k, page in enumerate(pages, first):
            good = all((k, i) in linked for i in range(page.root_count))
            self.expect(good, "SUBTREE_UNLINKED", "no link leads to a subtree or a family", k)
        return True

    @cached_property
    def surface(self) -> Tree:
        return Tree(self, 0, self.c, "", self.header.triangle_count, self.header.indices)

    @cached_property
    def caps(self) -> Tree:
        return Tree(self, self.c, self.e, "cap_", self.header.cap_count, self.header.cap_count)

    def nearest(self, point: Vec) -> dict[str, Any]:
        square, found = nearest(self, self.to_model(point))
        distance = math.ldexp(math.sqrt(square), -self.header.scale_exponent)
        return {"triangle": found[0][0], "distance": distance}

    def side(self, point: Vec) -> str:
        return side(self, self.to_model(point))

    def to_model(self, point: Vec) -> Vec:
        p = scaled([float(x) for x in point], self.header.scale_exponent)
        if len(p) != 3 or not all(abs(x) < 2.0**500 for x in p):
            raise ValueError(f"{point} is no point")
        return p

    def triangle(self, index: int) -> dict[str, Any]:
        """12: the corners and the attributes of an index; no corners if no block has it."""
        h = self.header
        require(0 <= index < h.indices, f"there is no index {index}", "TRIANGLE_RANGE")
        rows = [row for row, x in enumerate(self.surface.ids) if x == index]
        corners = [scaled(p, -h.scale_exponent) for p in self.surface.at(rows[0])] if rows else None
        page, place = divmod(index, h.attributes_per_page or 1)
        kept = self.page(self.a + page)[place] if h.attributes else {}
        return {"index": index, "corners": corners, **kept}

    def clamp(self, p: Vec) -> Vec:
        """3"""
        return tuple(min(max(p[i], self.walls[0][i]), self.walls[1][i]) for i in AXES)


class Tree:
    """A whole tree (4.1, 5.5, 5.10, 7.3). `spans` tells which rows of `corners` a link leads to."""

    def __init__(self, file: File, first: int, end: int, kind: str, count: int, indices: int):
        nodes, blocks, height = (getattr(file.header, kind + name)
                                 for name in ("node_count", "block_count", "height"))
        root = self.root = (NODE if nodes else BLOCK, first, 0)
        self.records: dict[Link, Any] = {}                          # in the order of a walk
        stack, links = [(root, None)] if first < end else [], 0
        while stack:
            link, child = stack.pop()
            links, (_, k, number) = links + 1, link
            page, twice = file.known_page(k), link in self.records
            if page is None:
                continue
            records = (page.nodes, page.blocks)[link[0]]
            good = number < (page.root_count if child is not None else len(records))
            file.expect(good, "LINK_TARGET", f"no subtree has the number {number}", k)
            file.expect(not twice, "LINK_TWICE", f"two links lead to record {number}", k)
            if good and not twice:
                record = self.records[link] = records[number]
                file.expect(child is None or (child["lower"] <= record.lower).all()
                            and (record.upper <= child["upper"]).all(), "SUBTREE_BOX",
                            "the box of a root is not within that of its parent", k)
                if link[0] == NODE:
                    stack += [(x, record.children[i] if x[1] != k else None)
                              for i, x in enumerate(record.links)][::-1]
        blocks_found = [x for x in self.records if x[0] == BLOCK]
        self.ids = [i for x in blocks_found for i in self.records[x].ids]
        self.blocks = [x[1:] for x in blocks_found for _ in self.records[x].ids]    # by row
        parts = [self.records[x].corners for x in blocks_found]
        self.corners = np.concatenate(parts or [np.empty((0, 3, 3))])
        self.lower, self.upper = self.corners.min(axis=1), self.corners.max(axis=1)
        ends = itertools.accumulate(map(len, parts))
        self.spans = {x: (y - len(part), y) for x, y, part in zip(blocks_found, ends, parts)}
        linked = file.all_linked(first, end, {x[1:] for x in self.records if x[0] == NODE})
        self.is_whole = linked and links == len(self.records)
        if not self.is_whole:
            return
        for link, record in reversed(self.records.items()):
            if link[0] == NODE:
                self.spans[link] = self.spans[record.links[0]][0], self.spans[record.links[-1]][1]
                below = max(self.records[x].height if x[0] == NODE else 0 for x in record.links)
                file.expect(record.height == below + 1, "HEIGHT", "it is another", link[1])
        file.expect((links, len(parts), len(self.ids)) == (nodes + blocks, blocks, count), "COUNT",
                    "other numbers of nodes, blocks or triangles than stated")
        file.expect(height == (self.records[root].height if links and nodes else 0), "HEIGHT",
                    "the header's height is not that of the root")
        file.expect(max(self.ids, default=-1) < indices, "TRIANGLE_RANGE", "an index is too great")
        if root == (NODE, 0, 0) and not file.has_walls:
            lower, upper = np.subtract(file.box, file.header.centre)
            file.expect((self.records[root].lower <= lower).all()
                        and (upper <= self.records[root].upper).all(), "ROOT_BOX",
                        "the root's box does not enclose the header's box")

    def at(self, row: int) -> list[Vec]:
        return list(map(tuple, self.corners[row].tolist()))

    def meeting(self, lower: Vec, upper: Vec) -> list[int]:
        """The rows of the triangles whose own boxes meet a box."""
        return np.flatnonzero(((self.lower <= upper) & (self.upper >= lower)).all(axis=1)).tolist()


class Streams:
    """The raw bytes of a page, cut into its head and its streams."""

    def __init__(self, raw: bytes):
        self.raw, self.at = raw, 0

    def bytes(self, count: int) -> bytes:
        self.at += count
        require(self.at <= len(self.raw), "the streams pass the end of the page")
        return self.raw[self.at - count:self.at]

    def split(self, width: int, count: int) -> np.ndarray:
        """5.3: a row of `width` bytes for each element."""
        part = np.frombuffer(self.bytes(width * count), np.uint8)
        return np.ascontiguousarray(part.reshape(width, count).T)

    def take(self, form: str, count: int) -> np.ndarray:
        """Numbers. Whole ones of up to four bytes become int64, so that sums do not overflow."""
        values = self.split(int(form[1]), count).view("<" + form).ravel()
        return values.astype(np.int64) if form[0] in "ui" and int(form[1]) <= 4 else values

    def head(self, file: File, k: int, fields: str) -> Record:
        head = Record("page_number I  ordinal I  octcode Q " + fields, self.raw)
        self.at = 24 if len(fields) < 20 else 40
        require(head.page_number == k and head.octcode == file.entries[k].octcode,
                "page_number or octcode")
        return head


def in_range(values: np.ndarray, least: int, greatest: int) -> bool:
    return bool(((least <= values) & (values <= greatest)).all())


# --- Distance page and cap page (5) ---------------------------------------------------------------
TREE_HEAD = """nodes H  blocks H  roots H  children H  page_links H
vertices H  vertex_refs H  triangles H  reserved 8s"""
CHILD = np.dtype([          # 6: the bounds of a child, relative to the centre
    ("lower", "f4", 3), ("upper", "f4", 3), ("middle", "f4", 3), ("unit", "f4"),
    ("normal", "f4", 3), ("slab_lower", "f4"), ("slab_upper", "f4"), ("radius", "f4")])
Node = namedtuple("Node", "lower upper height links children moments")      # children: CHILDs
# Of a block: corners as t x 3 x 3 coordinates, and their numbers in the page; vertices by number.
Block = namedtuple("Block", "ids corners flag numbers vertices")
TreePage = namedtuple("TreePage", "root_count nodes blocks ordinal vertices")


def decode_tree(file: File, k: int, s: Streams) -> TreePage:
    """5.1 to 5.10, A.3"""
    h, caps = file.header, k >= file.c
    head = s.head(file, k, TREE_HEAD)
    n, m, roots, node_weight = head.nodes, head.children, head.roots, 7 if caps else 5
    capacity = h.page_bytes // 64 - 1 - -(-h.page_bytes // 8192)                    # 5.9
    only = (h.cap_page_count if caps else file.c) == 1
    require(not any(head.reserved) and (1 <= roots <= n if n else roots == m == 0 and only
                                        and head.blocks == 1), "the head of the page")
    own = s.take("f4", 6 * roots).reshape(roots, 2, 3)
    counts, heights, kinds = s.take("u1", n), s.take("u1", n), s.take("u2", n)
    boxes = s.take("u1", 6 * m).reshape(2, 3, m).transpose(0, 2, 1)
    normals, slabs = s.take("i2", 2 * m).reshape(2, m), s.take("i2", 2 * m).reshape(2, m)
    child = np.zeros(m, CHILD)
    child["radius"] = s.take("u2", m)
    moments = np.zeros((10, m), np.int64)               # x y z, xx yy xy yz zx, area, second
    if caps:
        moments[:3], moments[3:8] = s.take("i2", 3 * m).reshape(3, m), s.take("i1", 5 * m).reshape(
            5, m)
        moments[8:] = s.take("u2", m), s.take("u2", m)
        require(in_range(moments[:3], -32767, 32767) and in_range(moments[3:8], -127, 127)
                and in_range(moments[8:], 0x80, 0x7F7F), "moments")
    link_pages, link_nodes = s.take("u4", head.page_links), s.take("u2", head.page_links)
    flags, totals, news = (s.take("u1", head.blocks) for _ in range(3))
    sizes, widths = flags & 63, 4 + (totals > 16) + (totals > 32)
    require(in_range(sizes, 1, 16) and sizes.sum() == head.triangles and in_range(totals, 1, 48)
            and (news <= totals).all() and news.sum() == head.vertices
            and (totals - news).sum() == head.vertex_refs, "triangle counts or vertex counts")
    refs = iter(s.take("u2", head.vertex_refs).tolist())
    packed = [int.from_bytes(s.bytes(x), "little") for x in (-(-3 * sizes * widths // 8)).tolist()]
    vertices = s.take("f8" if h.vertex_kind else "f4", 3 * head.vertices).astype(float)
    vertices = vertices.reshape(3, -1).T
    first_ids = s.take(f"u{h.triangle_id_bytes}", head.blocks).tolist()
    steps = iter(s.take(f"u{h.triangle_id_bytes}", head.triangles - head.blocks).tolist())
    require((abs(vertices) <= 2.0**112).all(), "vertices")                           # 1.7
    blocks, used, weight = [], 0, node_weight * n                                   # 5.6 to 5.9
    weights = (11, 16, 20, 29) if h.vertex_kind else (5, 7, 8, 11)
    rows = zip(packed, first_ids, *(x.tolist() for x in (flags, totals, news, widths)))
    for bits, first_id, flag, total, new, width in rows:
        known = list(itertools.accumulate(next(refs) for _ in range(total - new)))
        require(all(map(int.__lt__, known, known[1:] + [used])), "vertex refs")
        known += range(used, used + new)
        used += new
        count = 3 * (flag & 63)
        corners = [bits >> width * i & (1 << width) - 1 for i in range(count)]
        require(max(corners) < total and bits >> width * count == 0, "corners")
        more = (next(steps) for _ in range(count // 3 - 1))
        ids = list(itertools.accumulate(more, initial=first_id))
        require(all(map(int.__lt__, ids, ids[1:])) and ids[-1] < 256**h.triangle_id_bytes,
                "id steps")
        compact = (h.vertex_kind == 0 and h.triangle_id_bytes == 4 and total <= 16
                   and ids[-1] - ids[0] <= 65535)
        require(compact == flag >> 6 & 1 and not (caps and flag >> 7), "bits 6 and 7")
        weight += weights[(total > 16) + (total > 24) + (total > 32)] - compact + (
            h.triangle_id_bytes == 8)
        numbers = np.array(known)[corners]
        corners = vertices[numbers].reshape(-1, 3, 3)
        blocks.append(Block(ids, corners, flag, numbers.tolist(), known))
    require(weight <= capacity, "the records exceed the capacity of the page")
    require(in_range(counts, 1, 8) and counts.sum() == m and in_range(heights, 1, 96),
            "child counts or heights")
    kinds = kinds[:, None] >> 2 * np.arange(8) & 3                                  # 5.5
    is_child = np.arange(8) < counts[:, None]
    require((kinds < 3).all() and not kinds[~is_child].any(), "child kinds")
    kinds, parents = kinds[is_child], np.repeat(np.arange(n), counts)
    numbers, pages, inner = np.zeros(m, int), np.full(m, k), kinds == NODE
    require(inner.sum() == n - roots and (kinds == OTHER_PAGE).sum() == head.page_links
            and (kinds == BLOCK).sum() == (head.blocks if n else 0), "records or links are left")
    numbers[inner], numbers[kinds == BLOCK] = range(roots, n), range(head.blocks if n else 0)
    numbers[kinds == OTHER_PAGE], pages[kinds == OTHER_PAGE] = link_nodes, link_pages
    require((parents < numbers)[inner].all()
            and (heights[numbers[inner]] < heights[parents[inner]]).all(), "order or heights")
    require((k < link_pages).all() and (link_pages < (file.e if caps else file.c)).all()
            and (link_nodes < capacity // node_weight).all(), "links")
    require(np.isfinite(own[:, 1] - own[:, 0]).all() and (own[:, 0] <= own[:, 1]).all()
            and (boxes[0] + boxes[1] <= 255).all() and in_range(normals, -32767, 32767)
            and (slabs[0] <= slabs[1]).all(), "root boxes, child boxes, normals or slabs")
    own = np.concatenate([own, np.zeros((n - roots, 2, 3), np.float32)])
    ends = [0, *np.cumsum(counts).tolist()]
    for i in range(n):
        at = slice(ends[i], ends[i + 1])
        (lower, upper), (low, high) = own[i], boxes[:, at].astype(np.float32)
        step = (upper - lower) * np.float32(1 / 255)                                # 6.2, in f32
        child["lower"][at], child["upper"][at] = lower, upper = (lower + low * step,
                                                                 upper - high * step)
        own[numbers[at][inner[at]]] = np.stack([lower, upper], axis=1)[inner[at]]
    require((child["lower"] <= child["upper"]).all(), "child boxes")
    set_discs(child, normals, slabs)
    links = list(zip((kinds == BLOCK).astype(int).tolist(), pages.tolist(), numbers.tolist()))
    nodes = [Node(*own[i], heights[i], links[x:y], child[x:y], moments[:, x:y].T)
             for i, (x, y) in enumerate(itertools.pairwise(ends))]
    return TreePage(roots, nodes, blocks, head.ordinal, vertices)


def set_discs(child: np.ndarray, normals: np.ndarray, slabs: np.ndarray) -> None:
    """6.3, 6.4, in f32"""
    x, y = normals.astype(np.float32) / np.float32(32767)
    z = (1 - abs(x)) - abs(y)
    folded = [(1 - abs(b)) * np.where(a < 0, np.float32(-1), np.float32(1))
              for a, b in ((x, y), (y, x))]
    x, y = np.where(z < 0, folded[0], x), np.where(z < 0, folded[1], y)
    child["normal"] = (np.array([x, y, z]) / np.sqrt((x * x + y * y) + z * z)).T
    dx, dy, dz = (child["upper"] - child["lower"]).T
    unit = child["unit"] = np.sqrt((dx * dx + dy * dy) + dz * dz) * np.float32(1 / 32000)
    child["middle"] = (child["lower"] + child["upper"]) * np.float32(0.5)
    child["slab_lower"], child["slab_upper"] = slabs.astype(np.float32) * unit
    child["radius"] *= unit


# --- Mask page (8, 9) -----------------------------------------------------------------------------
MASK_HEAD = """records H  roots H  nodes H  page_links H  plain H
with_corners H  special H  planes H  listed H  block_links H  reserved I"""
LINKED_NODE = 1                         # kinds above it are leaves
MaskPage = namedtuple("MaskPage", "root_count kinds families leaves")
# Of the node with that number; signs: of the winding numbers of octants that are not grey.
Family = namedtuple("Family", "page first octants are_leaves signs")
# Corners: None if they are not stated; blocks: page, number and octants of each.
Leaf = namedtuple("Leaf", "corners planes behind beyond blocks slab",
                  defaults=[None, (), 0, 0, (), ()])


def decode_mask(file: File, k: int, s: Streams) -> MaskPage:
    """9.1 to 9.4, A.4"""
    h, head = file.header, s.head(file, k, MASK_HEAD)
    kinds = s.take("u1", head.records).tolist()
    tally = [kinds.count(x) for x in range(6)]
    require(1 <= head.roots <= head.records == sum(tally) and head.reserved == head.ordinal == 0
            and head.nodes == tally[0] + tally[1] and tally[1:] == [
                head.page_links, head.plain, head.with_corners, head.special, head.listed]
            and (k > file.d or head.roots == 1 and kinds[0] != LINKED_NODE), "the head of the page")
    grey, leaf, black, inverted = (s.take("u1", head.nodes) for _ in range(4))
    links = zip(*(s.take(x, head.page_links).tolist() for x in ("u4", "u2")))
    plain = s.take("u1", head.plain)
    corners = s.take("i1", 8 * head.with_corners).reshape(-1, 8)
    plane_counts, behind, beyond = (s.take(x, head.special) for x in ("u1", "i1", "i1"))
    planes = s.take("f8" if h.vertex_kind else "f4", 9 * head.planes)
    least, higher, counts, slabs, lowers, uppers = (
        s.take(x, head.listed) for x in ("i1", "u1", "u1", "u2", "u1", "u1"))
    octants, pages, numbers = (s.take(x, head.block_links) for x in ("u1", "u4", "u2"))
    require(not (leaf & ~grey | black & grey | inverted & (grey | black)).any(), "masks")
    require((corners[(corners != -128).any(axis=1)] >= -126).all(), "corners")
    require(in_range(plane_counts, 1, 4) and plane_counts.sum() == head.planes
            and in_range(behind, -127, 127) and in_range(beyond, -127, 127)
            and (behind != beyond).all() and (abs(planes) < 2.0**60).all(), "special leaves")
    require(in_range(least, -126, 126) and in_range(counts, 1, 16) and in_range(slabs & 3, 0, 2)
            and in_range(slabs >> 2 & 127, 0, 64) and in_range(slabs >> 9, 0, 64)
            and (lowers <= uppers).all() and counts.sum() == head.block_links, "listed leaves")
    ascend = np.diff(np.repeat(np.arange(head.listed) << 48, counts) + (pages << 16) + numbers) > 0
    require(ascend.all() and octants.all() and (pages < file.e).all()
            and (numbers < h.page_bytes // 256).all(), "lists of blocks")
    require(head.records + 9 * head.planes + (-(-counts // 8) + (counts + 2) // 2).sum()
            <= h.page_bytes // 8 - h.page_bytes // 512 - 8, "the page exceeds its capacity")
    families, end = {}, head.roots                                                  # 9.3
    masks = zip(*map(np.ndarray.tolist, (grey, leaf, black, inverted)))
    for i, kind in enumerate(kinds):
        require(i < end, "a record belongs to no family")
        if kind > LINKED_NODE:
            continue
        bits, *more = next(masks)
        page, first = next(links) if kind == LINKED_NODE else (k - file.d, end)
        members = [o for o in range(8) if bits >> o & 1]
        leaf_bits, blacks, others = ([x >> o & 1 for o in range(8)] for x in more)
        families[i] = Family(file.d + page, first, members, [leaf_bits[o] for o in members], {
            o: blacks[o] - others[o] for o in range(8) if o not in members})
        if kind == LINKED_NODE:
            require(bits and k < file.d + page < file.n, "links")
        else:
            end += len(members)
            require([x > LINKED_NODE for x in kinds[first:end]] == families[i].are_leaves,
                    "the kinds of a family")
    require(end == head.records, "records are left")
    bits, places = np.arange(8), np.split(planes.astype(float).reshape(-1, 3, 3),
                                          np.cumsum(plane_counts)[:-1])
    lists = map(np.ndarray.tolist, np.split(np.array([pages, numbers, octants]).T,
                                            np.cumsum(counts)[:-1]))
    leaves = {2: (Leaf((x >> bits & 1).tolist()) for x in plain),
              3: (Leaf(x.tolist() if x[0] != -128 else None) for x in corners),
              4: (Leaf(None, *x) for x in zip(places, behind.tolist(), beyond.tolist())),
              5: (Leaf((int(x) + (y >> bits & 1)).tolist(), blocks=z, slab=slab)
                  for x, y, z, *slab in zip(least, higher, lists, *map(np.ndarray.tolist, (
                      slabs, lowers, uppers))))}
    return MaskPage(head.roots, kinds, families, {
        i: next(leaves[kind]) for i, kind in enumerate(kinds) if kind > LINKED_NODE})


def small_head(file: File, k: int, s: Streams, first: int, each: int, total: int) -> int:
    """The number of elements of a page: `each`, or the rest of `total` in the last page."""
    head = s.head(file, k, "count I  reserved I")
    require(head.octcode == head.reserved == 0 and head.ordinal == k - first
            and head.count == min(each, total - (k - first) * each), "the head of the page")
    return head.count


def decode_field(file: File, k: int, s: Streams) -> np.ndarray:
    """The stored points of a page, in units of `field_quantum`."""
    h = file.header
    count = small_head(file, k, s, file.e, h.page_bytes // 8, math.prod(h.field_size))
    stored = np.array([s.take("u2", count) for _ in AXES])
    steps = np.where(stored & 1, -(stored + 1) // 2, stored // 2)
    return (np.cumsum(steps, axis=1) & 65535).T


def decode_attributes(file: File, k: int, s: Streams) -> list[dict[str, Any]]:
    """For each index of the page: the page and the number of its block, and what else is kept."""
    h = file.header
    n = small_head(file, k, s, file.a, h.attributes_per_page, h.indices)
    links = list(zip(s.take("u4", n).tolist(), s.take("u2", n).tolist()))
    kept = {"link": [x if x != (2**32 - 1, 2**16 - 1) else None for x in links]}
    require(all(x is None or x[0] < file.c and x[1] < h.page_bytes // 256 for x in kept["link"]),
            "links")
    if h.attributes & 2:
        kept["colours"] = s.split(12, n).tolist()
    if h.attributes & 4:
        kept["uvs"] = s.take("f4", 6 * n).reshape(n, 6).tolist()
    if h.attributes & 8:
        kept["value"] = s.take(("u8", "i8", "f8")[h.value_kind], n).tolist()
    return [dict(zip(kept, values)) for values in zip(*kept.values())]


# --- Nearest triangle (A.5) -----------------------------------------------------------------------
def closest(p: Vec, corners: list[Vec]) -> tuple[Fraction, tuple[Fraction, ...]]:
    """The square of the distance to a triangle, and the nearest point of it, exactly."""
    scale, (q, *t) = whole(p, *corners)
    edges, n = [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])], normal_of(*t)
    if any(n) and all(dot(n, cross(sub(v, u), sub(q, u))) >= 0 for u, v in edges):
        height = dot(n, sub(q, t[0]))
        best = Fraction(height**2, dot(n, n)), q, n, Fraction(-height, dot(n, n))
    else:
        feet = []
        for u, v in edges:
            e, w = sub(v, u), sub(q, u)
            s = Fraction(min(max(dot(w, e), 0), dot(e, e)), dot(e, e) or 1)
            feet.append((dot(w, w) - 2 * s * dot(w, e) + s * s * dot(e, e), u, e, s))
        best = min(feet, key=lambda foot: foot[0])
    square, origin, direction, s = best
    return square / scale**2, tuple((origin[i] + s * direction[i]) / scale for i in AXES)


def lower_bounds(children: np.ndarray, q: np.ndarray) -> np.ndarray:
    """Of the distances from q, which is relative to the centre, to what is below the children."""
    slack = 2.0**-50 * (1 + abs(q).max())
    f = {name: children[name].astype(float) for name in children.dtype.names}
    gap = np.maximum(0, np.maximum(f["lower"] - q, q - f["upper"]))
    box = np.linalg.norm(gap, axis=1) * (1 - 2.0**-50) - slack
    e = q - f["middle"]
    h = (f["normal"] * e).sum(axis=1)
    s = np.maximum(0, np.maximum(f["slab_lower"] - h, h - f["slab_upper"]))
    t = np.sqrt(np.maximum(0, (1 - 2.0**-19) * (e * e).sum(axis=1) - h * h)) - f["radius"]
    disc = np.hypot(s, np.maximum(0, t)) * (1 - 2.0**-20) - slack
    return np.where(np.isfinite(f["unit"]), np.maximum(box, disc), box)


def nearest(file: File, p: Vec) -> tuple[Fraction, list[tuple[int, list[Vec], Vec]]]:
    """The square of the distance; index, corners and nearest point of all triangles so near."""
    q, order, best, found = np.subtract(p, file.header.centre), itertools.count(), None, []
    heap = [(0.0, next(order), file.surface.root)]
    while heap and not (best is not None and heap[0][0] > 0 and Fraction(heap[0][0])**2 > best):
        _, _, link = heapq.heappop(heap)
        record = file.surface.records[link]
        if link[0] == NODE:
            for bound, child in zip(lower_bounds(record.children, q).tolist(), record.links):
                heapq.heappush(heap, (bound, next(order), child))
            continue
        for i, index in enumerate(record.ids):
            corners = list(map(tuple, record.corners[i].tolist()))
            square, point = closest(p, corners)
            if best is None or square < best:
                best, found = square, []
            if square == best:
                found.append((index, corners, point))
    return best, sorted(found)


# --- Side of a point (A.6 to A.8) -----------------------------------------------------------------
def side(file: File, p: Vec) -> str:
    """A.6, by crossings on a line to a known point, and by the solid angles of all caps."""
    h = file.header
    if file.clamp(p) != p or h.without_sides and not h.side_rule and file.has_walls:
        return "unknown"
    if h.side_rule == 1:
        return sheet(file, p)
    if is_on(p, file.surface):
        return "on the surface"
    if is_on(p, file.caps):             # no jump of k - s is here, so a point beside p will do
        p = tuple(x + 2.0**-40 * y for x, y in zip(p, (1, 0.7, 0.4)))
    if h.without_sides:                                                             # 1.3
        terms = [solid_angle(p, file.surface.at(i)) for i in range(h.triangle_count)]
    else:
        terms = [-solid_angle(p, file.caps.at(i)) for i in range(h.cap_count)] + [winding(file, p)]
    w, error = abs(math.fsum(terms)), 2.0**-50 * (len(terms) + 4)                   # 8.1
    return "inside" if w - error > 0.5 else "outside" if w + error < 0.5 else "unknown"


def sheet(file: File, p: Vec) -> str:
    """2.4, `side_rule` 1."""
    square, found = nearest(file, p)
    gap = min(map(min, sub(p, file.walls[0]), sub(file.walls[1], p)))
    if square == 0 or gap < math.inf and square > Fraction(gap)**2:
        return "unknown" if square else "on the surface"
    normals: dict[Vec, np.ndarray] = defaultdict(lambda: np.zeros(3))
    for _, corners, x in found:
        n, weight = np.array(normal_of(*whole(*corners)[1]), float), 1.0
        for i in AXES:
            if x == corners[i]:
                u, v = (np.subtract(corners[i - j], x).astype(float) for j in (1, 2))
                weight = math.atan2(np.linalg.norm(np.cross(u, v)), u @ v)
        normals[x] += weight * n / (np.linalg.norm(n) or 1)
    answers = {"outside" if n @ [float(Fraction(a) - b) for a, b in zip(p, x)] >= 0 else "inside"
               for x, n in normals.items()}
    return answers.pop() if len(answers) == 1 else "unknown"


def is_on(p: Vec, tree: Tree) -> bool:
    return any(closest(p, tree.at(row))[0] == 0 for row in tree.meeting(p, p))


def winding(file: File, p: Vec) -> int:
    """8.1, 8.4: k, the winding number of the closed surface, at a perturbed point."""
    q, k = file.clamp(file.least), file.header.region_winding
    for i in AXES:
        for wall, limit, step in zip(file.walls, file.box, (-1, 1)):
            if math.isinf(wall[i]):                                 # outside of the mesh's box
                q, k = (*p[:i], limit[i] + step * (1 + abs(limit[i])), *p[i + 1:]), 0
    for tree in (file.surface, file.caps):
        rows = tree.meeting(tuple(map(min, p, q)), tuple(map(max, p, q)))
        k += sum(crossing(p, q, tree.at(row)) for row in rows)
    return k


def crossing(p: Vec, q: Vec, corners: list[Vec]) -> int:
    """A.7"""
    _, (p, q, a, b, c) = whole(p, q, *corners)
    n, d = normal_of(a, b, c), sub(q, p)
    at_p, at_q = (sign(dot(n, sub(x, a)), *n) for x in (p, q))
    sides = {sign(dot(d, cross(sub(u, p), sub(v, p))), *cross(d, sub(v, u)))
             for u, v in ((a, b), (b, c), (c, a))}
    return 0 if at_p == 0 or at_p == at_q or len(sides) > 1 else -at_p


def solid_angle(p: Vec, corners: list[Vec]) -> float:
    """Of a triangle, divided by 4 pi. Its sign is exact; 0 in the plane of the triangle."""
    scale, (q, *t) = whole(p, *corners)
    x, y, z = (sub(v, q) for v in t)
    volume = dot(x, cross(y, z))
    if volume == 0:
        return 0.0
    x, y, z = (tuple(v / scale for v in w) for w in (x, y, z))
    i, j, k = (math.hypot(*w) for w in (x, y, z))
    turn = i * j * k + dot(x, y) * k + dot(y, z) * i + dot(z, x) * j
    return math.atan2(volume / scale**3, turn) / (2 * math.pi)


# --- Command line ---------------------------------------------------------------------------------
def describe(file: File) -> dict[str, Any]:
    h, kinds = file.header, ("distance", "cap", "field", "attribute", "mask")
    return {
        "header": {x: y for x, y in vars(h).items() if isinstance(y, (int, float, tuple))},
        "content_id": f"{int.from_bytes(h.content_id, 'little'):032x}",
        "watertight": h.unbalanced_edge_count == 0, "metadata": file.metadata(),
        "pages": {kind: y - x for kind, x, y in zip(kinds, h.layers, h.layers[1:])},
        "extensions": {name: x.bytes for name, x in file.extensions.items()}}


def main() -> int:
    parser = argparse.ArgumentParser(description="Read a .ptree file.")
    parser.add_argument("file")
    parser.add_argument("--answers", metavar="POINTS", help="a JSON file with points and indices")
    arguments = parser.parse_args()
    try:
        file = File(arguments.file)
        if arguments.answers:
            with open(arguments.answers, encoding="utf-8") as stream:
                questions = json.load(stream)
            functions = {"nearest": file.nearest, "side": file.side, "triangles": file.triangle}
            print(json.dumps({key: [functions[key](x) for x in questions[key]]
                              for key in questions}))
        else:
            print(json.dumps(describe(file)))
        return 0
    except Issue as issue:
        print(issue, file=sys.stderr)
        return 1
    except (OSError, ValueError, TypeError, KeyError, ArithmeticError) as error:
        print(repr(error), file=sys.stderr)
        return 2


if __name__ == "__main__":
    np.seterr(all="ignore")
    sys.exit(main())
