#!/usr/bin/env python3
"""A reader of .ptree files, version 1.0, written from v1/spec.md.

    reader.py FILE                       what the file holds
    reader.py FILE --verify [--full]     issues, with the codes of ISSUES.md
    reader.py FILE --answers POINTS      nearest triangles, sides, and triangles by index

All output is JSON. POINTS is a JSON file with some of these keys, in the input's coordinates:

    {"nearest": [[x, y, z], ...], "side": [[x, y, z], ...], "triangles": [index, ...]}

It is the specification as a program: plain and slow. Distances and signs are found with whole
numbers, so nothing is rounded before it is compared. What a reader may ignore for an answer (1.3)
it ignores: the mask, moments and the field.

`--verify` checks what ISSUES.md states, but it never reports MOMENTS, OPENNESS, REGION, FIELD,
ATTRIBUTES, BLOCK_HEIGHT_FIELD and the codes that begin with MASK_.

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
from collections import Counter, defaultdict, namedtuple
from fractions import Fraction
from functools import cached_property, partial
from typing import Any, Iterable, Iterator

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
    a, b = min(h.input_triangles, 2**62), min(h.cap_count, 2**62)

    def ascend(*corners: Vec) -> bool:
        return all(x[i] <= y[i] for x, y in itertools.pairwise(corners) for i in AXES)

    rules = {
        "header_bytes or page_bytes": h.header_bytes == HEADER_BYTES
        and h.page_bytes in (2**i for i in range(12, 19)),
        "page_count or extension_count": h.layers[1] >= 1 and h.extension_count <= 64,
        "max_raw_bytes or max_stored_bytes": h.max_stored_bytes <= h.max_raw_bytes <= 2**20,
        "a coordinate": all(map(math.isfinite, sum(vectors, h.field_lower))),
        "triangle_count or block_count": h.triangle_count >= 1 and h.block_count >= 1,
        "sample_triangle or first_skipped": h.sample_triangle < h.indices
        and (h.first_skipped == 2**64 - 1) == (h.skipped_count == 0),
        "node_count": (h.node_count == 0) == (h.triangle_count <= 16),
        "box": ascend(h.box_lower, h.box_upper) and all(abs(x) < 2.0**112 for x in box),
        "scale_exponent": -1200 <= h.scale_exponent <= 1200,
        "vertex_kind or triangle_id_bytes": h.vertex_kind <= 1 and h.triangle_id_bytes in (4, 8),
        "height or mask_levels": h.height <= 96 and h.mask_levels <= (19 if mask else 0),
        "unbalanced_edge": not any(h.unbalanced_edge[64 * len(h.edges):]) and all(
            e.along != e.against and e.triangle < h.indices
            and all(map(math.isfinite, e.start + e.end)) for e in h.edges),
        "input_triangles": not region or h.input_triangles >= h.triangle_count,
        "region": (ascend(h.region_lower, h.region_upper) and ascend(h.region_lower, h.box_upper)
                   and ascend(h.box_lower, h.region_upper) if region else not any(sum(walls, ()))),
        "region_winding": abs(h.region_winding) <= (
            a // 2 + b // 2 + 1 if region and not h.without_sides else 0),
        "core": (ascend(h.box_lower, h.core_lower, h.core_upper, h.box_upper) and all(
            abs(x) < 2.0**55 for x in core) and (h.stray_count > 0 or box == core)),
        "stray_count": h.stray_count == 0 or h.stray_count < h.usable,
        "stray_edge": 0 <= h.stray_edge <= (2.0**60 if h.stray_count else 0),
        "cap_count": caps == (h.unbalanced_edge_count > 0 and not h.without_sides)
        and (h.triangle_id_bytes == 8 or h.cap_count <= 2**32),
        "cap_node_count, cap_block_count or cap_page_count": caps == (h.cap_block_count > 0)
        and caps == (h.cap_page_count > 0) and (h.cap_node_count == 0) == (h.cap_count <= 16),
        "cap_area or cap_height": 0 <= h.cap_area <= (2.0**1000 if caps else 0)
        and h.cap_height <= (96 if caps else 0),
        "openness": 0 <= h.openness <= 1,
        "side_rule": h.side_rule <= 1 and h.side_is_chosen <= 1 and (
            h.side_rule == 0 or h.side_is_chosen or h.unbalanced_edge_count > 0),
        "without_sides": h.without_sides <= 1 and not (h.without_sides and mask),
        "field": (all(2.0**-40 <= x <= 4 for x in (h.field_step, h.field_quantum))
                  and min(h.field_size) >= 2 and points <= 2**20
                  and h.field_page_count == -(-points * 8 // max(h.page_bytes, 1)) if field
                  else not any((*h.field_lower, *h.field_size, h.field_step, h.field_quantum))),
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


class File:
    """An open file. With a list of issues, opening goes on after an issue as long as it can."""

    def __init__(self, path: str, issues: list[Issue] | None = None):
        require(os.path.isfile(path) or not os.path.exists(path), "no file", "NOT_PLANETREE")
        self.issues, self.path, self.length = issues, path, os.path.getsize(path)
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
        sides = (h.region_lower, -math.inf), (h.region_upper, math.inf)             # 3
        self.walls = [tuple(w if h.input_triangles and a < x < b else far for w, x, a, b in zip(
            scaled(side, h.scale_exponent), side, h.box_lower, h.box_upper)) for side, far in sides]
        self.has_walls = any(map(math.isfinite, sum(self.walls, ())))
        self.open_directory()
        self.open_extensions()

    def expect(self, condition: Any, code: str, message: str, page: int | None = None) -> None:
        if not condition and self.issues is None:
            raise Issue(code, message, page)
        if not condition:
            self.issues.append(Issue(code, message, page))

    def read(self, at: int, count: int) -> bytes:
        with open(self.path, "rb") as stream:
            stream.seek(at)
            return stream.read(count)

    def choose_header(self) -> Header:
        """2.3, step 1."""
        first = self.read(0, HEADER_BYTES)
        last = self.read(max(0, self.length - HEADER_BYTES), HEADER_BYTES)
        headers = [Header(x) for x in (first, last) if len(x) == HEADER_BYTES]
        chosen = next((h for h in headers if h.is_whole), None)
        version = int.from_bytes(first[8:10], "little")
        if chosen is None:
            require(first[:8] == MAGIC[:max(1, len(first))], "no magic", "NOT_PLANETREE")
            require(len(first) < 10 or version >> 8 == 1,
                    f"version {version} instead of 256 to 511", "FORMAT_UNSUPPORTED")
            require(headers, "the file is shorter than a header", "FILE_LENGTH")
            raise Issue("HEADER_LOST", "neither of the two headers is whole")
        self.expect(first == last or self.issues is None, "HEADER_COPY", "the two headers differ")
        return chosen

    def open_directory(self) -> None:
        """2.6, and the fields of the header that are sums and maxima of entries."""
        h, sizes = self.header, [self.n]
        while sizes[0] > 512:
            sizes.insert(0, -(-sizes[0] // 512))
        start = HEADER_BYTES + 64 * h.extension_count
        self.start = start + 24 * sum(sizes)                        # of page 0
        self.end = self.start + sum(h.stored_bytes)                 # of the last page
        require(self.end + HEADER_BYTES <= h.file_bytes, "the pages do not lie within the file",
                "HEADER_FIELD")
        require(self.start <= self.length, "the directory is cut short", "FILE_LENGTH")
        ups = [(int.from_bytes(h.content_id, "little"), None, 0)]   # what is stated of the blocks
        for level, size in enumerate(sizes):
            data, form = self.read(start, 24 * size), "<QQII" if size == self.n else "<QQQ"
            entries, start = list(struct.iter_unpack(form, data)), start + 24 * size
            for i, up in enumerate(ups):
                block, first = data[512 * 24 * i:512 * 24 * (i + 1)], entries[512 * i]
                good = up[0] == (xxh3_64_intdigest(block) if level else xxh3_128_intdigest(block))
                self.expect(good, "DIRECTORY", f"block {i} of level {level} has another hash")
                self.expect(not good or level == 0 or up[1] == first[1] and (
                    size == self.n or up[2] == first[2]), "DIRECTORY",
                    f"block {i} of level {level} is not as stated above it")
            starts, ups = [up[2] for up in ups], entries
        self.entries: list[Entry] = []
        for k, entry in enumerate(entries):
            if k % 512 == 0:
                at, start = start, self.start + starts[k // 512]
                self.expect(at == start, "DIRECTORY", f"page {k} starts at another place")
            self.entries.append(Entry(*entry, start))
            start += entry[2]
        for k, (x, y) in enumerate(itertools.pairwise(self.entries), 1):
            self.expect(k in h.layers or x.octcode + (k > self.d) <= y.octcode, "DIRECTORY",
                        f"the octcode of page {k} does not ascend")
        raw, stored = [x.raw_bytes for x in self.entries], [x.stored_bytes for x in self.entries]
        sums = [sum(stored[x:y]) for x, y in itertools.pairwise(h.layers)]
        self.expect(list(h.stored_bytes) == sums, "DIRECTORY", "other sums of stored_bytes")
        most = max(raw), max(stored)
        self.expect(self.issues or (h.max_raw_bytes, h.max_stored_bytes) == most, "HEADER_FIELD",
                    "another max_raw_bytes or max_stored_bytes")

    def open_extensions(self) -> None:
        """2.9"""
        h, at, last = self.header, self.end, b""
        data = self.read(HEADER_BYTES, 64 * h.extension_count)
        self.extensions: dict[str, Record] = {}
        good = xxh3_64_intdigest(data) == h.extensions_hash
        for x in (Record(EXTENSION, data, i) for i in range(0, len(data) if good else 0, 64)):
            name = x.name.rstrip(b"\0").decode("latin-1")
            good &= bool(re.fullmatch("[a-z0-9._-]{1,24}", name) and last < x.name
                         and x.offset == at and x.required <= 1 and not any(x.reserved))
            require(not good or name == "metadata" or not x.required,
                    f"unknown extension {name}", "FORMAT_UNSUPPORTED")
            self.extensions[name], at, last = x, at + x.bytes, x.name
        self.expect(good and at == h.file_bytes - HEADER_BYTES, "EXTENSION",
                    "the records break a rule, or pages and extensions do not fill the file")

    def extension(self, name: str) -> bytes:
        x = self.extensions[name]
        data = self.read(x.offset, min(x.bytes, self.length))
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
        stored, raw, end = entry.stored_bytes, entry.raw_bytes, min(self.length, self.end)
        require(1 <= stored <= raw <= min(255 * stored, 2**20) and entry.offset + stored <= end,
                "the entry of the page cannot be right", "PAGE_ENTRY")
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
Node = namedtuple("Node", "lower upper height links children")      # children: array of CHILD
Block = namedtuple("Block", "ids corners flag")                     # corners: t x 3 x 3
TreePage = namedtuple("TreePage", "root_count nodes blocks")


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
    if caps:
        dipoles, quadrupoles, *areas = (s.take(*x) for x in (
            ("i2", 3 * m), ("i1", 5 * m), ("u2", m), ("u2", m)))
        require(in_range(dipoles, -32767, 32767) and in_range(quadrupoles, -127, 127)
                and all(in_range(x, 0x80, 0x7F7F) for x in areas), "moments")
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
    require((abs(vertices) < 2.0**112).all(), "vertices")                           # 1.7
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
        require(compact == flag >> 6 & 1 and (flag < 128 or not (caps or h.without_sides)),
                "bits 6 and 7 of a triangle count")
        weight += weights[(total > 16) + (total > 24) + (total > 32)] - compact + (
            h.triangle_id_bytes == 8)
        blocks.append(Block(ids, vertices[np.array(known)[corners]].reshape(-1, 3, 3), flag))
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
    require((parents < numbers)[inner].all(), "a node comes before the node that refers to it")
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
    nodes = [Node(*own[i], heights[i], links[x:y], child[x:y])
             for i, (x, y) in enumerate(itertools.pairwise(ends))]
    return TreePage(roots, nodes, blocks)


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
MaskPage = namedtuple("MaskPage", "root_count kinds families")
Family = namedtuple("Family", "page first octants are_leaves")      # of the node with that number


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
    s.take("u1", head.plain)
    corners = s.take("i1", 8 * head.with_corners).reshape(-1, 8)
    plane_counts, behind, beyond = (s.take(x, head.special) for x in ("u1", "i1", "i1"))
    planes = s.take("f8" if h.vertex_kind else "f4", 9 * head.planes)
    least, _, counts, slabs, lowers, uppers = (
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
    families, masks, end = {}, zip(grey.tolist(), leaf.tolist()), head.roots        # 9.3
    for i, kind in enumerate(kinds):
        require(i < end, "a record belongs to no family")
        if kind > LINKED_NODE:
            continue
        bits, leaf_bits = next(masks)
        page, first = next(links) if kind == LINKED_NODE else (k - file.d, end)
        octants = [o for o in range(8) if bits >> o & 1]
        families[i] = Family(file.d + page, first, octants, [leaf_bits >> o & 1 for o in octants])
        if kind == LINKED_NODE:
            require(bits and k < file.d + page < file.n, "links")
        else:
            end += len(octants)
            require([x > LINKED_NODE for x in kinds[first:end]] == families[i].are_leaves,
                    "the kinds of a family")
    require(end == head.records, "records are left")
    return MaskPage(head.roots, kinds, families)


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


# --- Issues (ISSUES.md) ---------------------------------------------------------------------------
def verify(path: str, full: bool = False) -> list[Issue]:
    issues: list[Issue] = []
    try:
        file = File(path, issues)
        for part in (*(file.metadata if x == "metadata" else partial(file.extension, x)
                       for x in file.extensions), *(partial(file.page, k) for k in range(file.n))):
            try:
                part()
            except Issue as issue:
                issues.append(issue)
        trees = file.surface, file.caps
        check_mask(file)
        if full and all(tree.is_whole for tree in trees):
            for tree in trees:
                check_bounds(file, tree)
            check_surface(file)
            check_edges(file)
    except Issue as issue:
        issues.append(issue)
    return issues


def check_mask(file: File) -> None:
    """8.3, 9.3, 9.4: links, levels and counts."""
    h, seen, levels = file.header, set(), 0
    stack = [(0, file.d, 0, None, True)] if file.d < file.n else []
    while stack:
        level, k, number, is_leaf, is_linked = stack.pop()
        page, levels = file.known_page(k), max(levels, level)
        if page is None:
            continue
        good = (number < len(page.kinds) and (number < page.root_count) == is_linked
                and is_leaf in (None, page.kinds[number] > LINKED_NODE))
        file.expect(good, "LINK_TARGET", "a link leads to no such family", k)
        file.expect((k, number) not in seen, "LINK_TWICE", "two links lead to a family", k)
        file.expect(level < 19 or number not in page.families, "PAGE_STRUCTURE", "level 19", k)
        if good and (k, number) not in seen and level <= 19:
            seen.add((k, number))
            family = page.families.get(number, Family(k, 0, (), ()))
            linked = page.kinds[number] == LINKED_NODE
            stack += [(level + 1, family.page, family.first + i, leaf, linked)
                      for i, leaf in enumerate(family.are_leaves)]
    file.expect(not file.all_linked(file.d, file.n, seen) or (len(seen), levels) == (
        h.mask_cell_count, h.mask_levels), "COUNT", "other numbers of grey cells or levels")


def check_bounds(file: File, tree: Tree) -> None:
    """7.1, 7.2"""
    for (_, k, _), node in tree.records.items():
        for link, child in zip(*node[3:] if isinstance(node, Node) else ((), ())):
            c = {name: child[name].astype(float) for name in CHILD.names}
            d = tree.corners[slice(*tree.spans[link])].reshape(-1, 3) - file.header.centre
            file.expect(((c["lower"] <= d) & (d <= c["upper"])).all(), "VERTEX_OUTSIDE_BOX",
                        "a corner lies outside of a child's box", k)
            e, r = d - c["middle"], 32000 * c["unit"]
            slack, height = 8 * r * 2.0**-24 * (1 - 1e-9), e @ c["normal"]
            away = np.linalg.norm(np.cross(e, c["normal"]), axis=1)
            is_in = ((c["slab_lower"] + slack <= height) & (height <= c["slab_upper"] - slack)
                     & (away <= c["radius"] - slack)).all()
            file.expect(is_in or not math.isfinite(r) or max(c["upper"] - c["lower"]) < 2.0**-60,
                        "VERTEX_OUTSIDE_PLANES", "a corner lies outside of a disc", k)


def check_surface(file: File) -> None:
    """2.4, 3, 5.6, 5.11"""
    h, surface, caps = file.header, file.surface, file.caps
    for index, times in itertools.chain(Counter(surface.ids).items(), Counter(caps.ids).items()):
        file.expect(times == 1, "TRIANGLE_TWICE", f"{times} triangles have the index {index}")
    box, stated = np.array([surface.lower.min(axis=0), surface.upper.max(axis=0)]), file.box
    file.expect((box == stated).all() or file.has_walls and (box[0] >= stated[0]).all()
                and (box[1] <= stated[1]).all(), "MODEL_BOX", "that of the triangles is another")
    row = surface.ids.index(min(surface.ids))
    file.expect((surface.ids[row], surface.at(row)[0]) == (h.sample_triangle, h.sample), "SAMPLE",
                "not corner 0 of the triangle with the least index")
    a, b, c = caps.corners.transpose(1, 0, 2)
    area = math.fsum(np.linalg.norm(np.cross(b - a, c - a) / 2, axis=1))
    file.expect((caps.lower >= stated[0]).all() and (caps.upper <= stated[1]).all()
                and abs(area - h.cap_area) <= 1e-9 * area, "CAPS", "outside of the box, or area")


def check_edges(file: File) -> None:
    """2.5, 5.11; not with walls, because triangles beyond them are not in the file."""
    def edges(tree: Tree) -> Iterator[tuple[Vec, Vec]]:
        corners = (tree.at(row) for row in range(0 if file.has_walls else len(tree.ids)))
        return ((t[i], t[i - 2]) for t in corners for i in AXES if t[i] != t[i - 2])

    h, runs = file.header, Counter(edges(file.surface))
    listed = [(scaled(e.start, h.scale_exponent), scaled(e.end, h.scale_exponent)) for e in h.edges]
    unbalanced = {frozenset(x) for x in runs if runs[x] != runs[x[::-1]]}
    file.expect(file.has_walls or len(unbalanced) == h.unbalanced_edge_count and all(
        (runs[x], runs[x[::-1]]) == (e.along, e.against) for x, e in zip(listed, h.edges)),
        "UNBALANCED_EDGES", f"other numbers than stated; {len(unbalanced)} edges in all")
    runs.update(edges(file.caps))
    file.expect(h.cap_count == 0 or all(runs[x] == runs[x[::-1]] for x in runs), "CAPS",
                "the surface and its caps are not watertight together")


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
    parser.add_argument("--verify", action="store_true", help="check the file")
    parser.add_argument("--full", action="store_true", help="check triangles too")
    parser.add_argument("--answers", metavar="POINTS", help="a JSON file with points and indices")
    arguments = parser.parse_args()
    try:
        if arguments.verify:
            issues = [{"code": x.code, "page": x.page, "message": x.message}
                      for x in verify(arguments.file, arguments.full)]
            print(json.dumps({"issues": issues[:1000]}))
            return 1 if issues else 0
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
