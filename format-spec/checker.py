#!/usr/bin/env python3
"""A checker of .ptree files, version 1.0, written from v1/spec.md and ISSUES.md.

    checker.py FILE [--full]             issues as JSON, with the codes of ISSUES.md

It reports what `planetree verify` reports, and decodes with reader.py. Exit status: 0 the file is
valid, 1 it is not, 2 the command line is at fault. Needs what reader.py needs.
"""

from __future__ import annotations

import argparse
import itertools
import json
import math
import sys
from collections import Counter, defaultdict
from functools import partial
from typing import Any, Iterator

import numpy as np

from reader import (AXES, BLOCK, CHILD, LINKED_NODE, NODE, Family, File, Issue, Leaf, Node, Tree,
                    Vec, cross, crossing, dot, nearest, normal_of, scaled, sign, sub, whole,
                    winding)

FINEST = 19                             # level of the finest cells
Cell = tuple[int, Vec]                  # level; x, y and z (8.2)


def verify(path: str, full: bool = False) -> list[Issue]:
    """The issues of a file, in the order of the checks."""
    issues: list[Issue] = []
    try:
        file = File(path, issues)
        if not any(issue.code == "HEADER_FIELD" for issue in issues):
            check_file(file, full)
    except Issue as issue:
        issues.append(issue)
    return issues


def check_file(file: File, full: bool) -> None:
    parts = (*(file.metadata if x == "metadata" else partial(file.extension, x)
               for x in file.extensions), *(partial(file.page, k) for k in range(file.n)))
    for part in parts:
        try:
            part()
        except Issue as issue:
            if issue.code != "FILE_LENGTH":                         # opening has reported it
                file.issues.append(issue)
    for first, end in (0, file.c), (file.c, file.e):
        check_pages(file, first, end)
    trees, cells = (file.surface, file.caps), check_mask(file)
    if not full or not all(tree.is_whole for tree in trees):
        return
    for tree in trees:
        check_bounds(file, tree)
    check_moments(file)
    check_surface(file)
    check_edges(file)
    proofs = (check_keys, check_region_winding, check_field, check_attributes,
              partial(check_cells, cells=cells), check_height_fields)
    for proof in proofs:
        if not file.issues:
            proof(file)


# --- Pages and keys -------------------------------------------------------------------------------
def check_pages(file: File, first: int, end: int) -> None:
    """4.3: ordinals. 5.2, 5.7: vertices. A page that breaks a rule is not looked into again."""
    octcodes = [x.octcode for x in file.entries[first:end]]
    for k in range(first, end):
        page = file.known_page(k)
        if page is None:
            continue
        rank, before = k - first - octcodes.index(octcodes[k - first]), len(file.issues)
        file.expect(page.ordinal == rank, "PAGE_STRUCTURE", f"ordinal is not {rank}", k)
        uses = list(dict.fromkeys(i for block in page.blocks for i in block.numbers))
        file.expect(uses == list(range(len(page.vertices))) and all(
            sorted(set(x.numbers)) == sorted(x.vertices) for x in page.blocks), "PAGE_STRUCTURE",
            "vertices are not in the order of their first use, or have no use", k)
        file.expect(len(set(map(tuple, page.vertices.tolist()))) == len(page.vertices)
                    and not (np.signbit(page.vertices) & (page.vertices == 0)).any(),
                    "PAGE_STRUCTURE", "a position is there twice, or a coordinate is -0", k)
        if len(file.issues) > before:
            file.pages[k] = file.issues[-1]


def morton_of(place: Any) -> int:
    return sum((place[i] >> bit & 1) << 3 * bit + i for i in AXES for bit in range(FINEST))


def octcode_of(bits: int, morton: int) -> int:
    """4.2: of the first bits of a Morton code of 57 bits."""
    kept = morton >> 57 - bits << 57 - bits
    return bits // 3 << 59 | kept << 2 | bits % 3


def check_keys(file: File) -> None:
    """4.3: the octcodes of pages."""
    for tree in (file.surface, file.caps):
        check_keys_of(file, tree)


def check_keys_of(file: File, tree: Tree) -> None:
    at = np.floor(((tree.lower + tree.upper) * 0.5 - file.least) * 2.0**18)
    cells = np.clip(np.nan_to_num(at), 0, 2**FINEST - 1).astype(int).tolist()
    codes = list(map(morton_of, cells))
    keys = defaultdict(list)
    for (kind, k, number), (start, end) in tree.spans.items():
        page = file.page(k)
        if number < max(page.root_count, 1) and (kind == NODE or not page.nodes):
            some = codes[start:end]
            keys[k].append(octcode_of(57 - (min(some) ^ max(some)).bit_length(), min(some)))
    for k, octcodes in keys.items():
        file.expect(file.entries[k].octcode == min(octcodes), "PAGE_STRUCTURE",
                    "the octcode is not the least of the subtrees", k)


# --- Bounds (7.1, 7.2) ----------------------------------------------------------------------------
def check_bounds(file: File, tree: Tree) -> None:
    for (_, k, _), node in tree.records.items():
        for link, child in zip(*node[3:5] if isinstance(node, Node) else ((), ())):
            c = {name: child[name].astype(float) for name in CHILD.names}
            d = tree.corners[slice(*tree.spans[link])].reshape(-1, 3) - file.header.centre
            file.expect(link[0] == NODE or ((c["lower"] <= d) & (d <= c["upper"])).all(),
                        "VERTEX_OUTSIDE_BOX", "a corner lies outside of a block's box", k)
            e, r = d - c["middle"], 32000 * c["unit"]
            slack, height = 8 * r * 2.0**-24 * (1 - 1e-9), e @ c["normal"]
            away = np.linalg.norm(np.cross(e, c["normal"]), axis=1)
            is_in = ((c["slab_lower"] + slack <= height) & (height <= c["slab_upper"] - slack)
                     & (away <= c["radius"] - slack)).all()
            file.expect(is_in or not math.isfinite(r) or max(c["upper"] - c["lower"]) < 2.0**-60,
                        "VERTEX_OUTSIDE_PLANES", "a corner lies outside of a disc", k)
    if tree.root in tree.records and tree.root[0] == NODE:
        box = tree.records[tree.root]
        ends = ((tree.lower.min(axis=0) - file.header.centre, box.lower, -np.inf, np.less_equal),
                (tree.upper.max(axis=0) - file.header.centre, box.upper, np.inf, np.greater_equal))
        for d, side, out, holds in ends:
            inner = np.nextafter(side, np.float32(-out))
            file.expect(holds(side.astype(float), d).all() and not holds(
                inner.astype(float), d).any(), "ROOT_BOX", "not the least box in f32", tree.root[1])


def short(bits: int) -> float:
    """6.5: the f32 with these upper 16 bits."""
    return float(np.uint32(int(bits) << 16).view(np.float32))


def moments_of(row: np.ndarray) -> tuple[float, float, np.ndarray, np.ndarray, float]:
    """6.5: area, second moment, dipole, quadrupole and the unit of the quadrupole."""
    x, y, z, xx, yy, xy, yz, zx, area, second = row.tolist()
    area, second = short(area), short(second)
    unit = math.sqrt(area * second) / 127
    form = np.array([[xx, xy, zx], [xy, yy, yz], [zx, yz, -xx - yy]]) * unit
    return area, second, area / 32767 * np.array([x, y, z]), form, unit


def check_moments(file: File) -> None:
    """7.2: of a block against its caps, of a node against its children."""
    tree = file.caps
    for link, node in tree.records.items():
        for to, child, row in zip(*node[3:] if isinstance(node, Node) else ((), (), ())):
            middle = child["middle"].astype(float)
            if max(row[8:]) < 0x7F7F:
                expected = sums_of_caps(file, to, middle) if to[0] == BLOCK else sums_of_children(
                    tree.records[to], middle)
                file.expect(moments_fit(row, *expected), "MOMENTS", "they are not those", link[1])


def sums_of_caps(file: File, link: Any, middle: np.ndarray) -> tuple:
    e = file.caps.corners[slice(*file.caps.spans[link])] - file.header.centre - middle
    vectors = np.cross(e[:, 1] - e[:, 0], e[:, 2] - e[:, 0]) / 2
    areas, sums = np.linalg.norm(vectors, axis=1), e.sum(axis=1)
    second = areas / 12 @ ((e**2).sum(axis=(1, 2)) + (sums**2).sum(axis=1))
    return areas.sum(), second, vectors.sum(axis=0), (sums / 3).T @ vectors, 0.0, 0.0


def sums_of_children(node: Node, middle: np.ndarray) -> tuple:
    total, seconds, vector, form, vector_error, form_error = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for child, row in zip(node.children, node.moments):
        area, second, v, f, unit = moments_of(row)
        by = child["middle"].astype(float) - middle
        away = float(np.linalg.norm(by))
        kept = area * (1 - 1.01 / 128) if area > 2.0**-125 else 0.0
        total, vector, form = total + kept, vector + v, form + f + np.outer(by, v)
        seconds += max(0.0, away * math.sqrt(kept) - math.sqrt(second))**2
        vector_error += 2.0**-15 * area
        form_error += 1.75 * unit + away * 2.0**-15 * area
    return total, seconds, vector, form, vector_error, form_error


def moments_fit(row: np.ndarray, total: float, seconds: float, vector: Any, form: Any,
                vector_error: float, form_error: float) -> bool:
    area, second, v, f, unit = moments_of(row)
    extent, r = math.sqrt(second / area), 2.0**-30
    form = (form + form.T) / 2 - np.trace(form) / 3 * np.eye(3)
    return bool(
        area * (1 + r) >= total
        and second * (1 + r) + 2.0**-50 * area * (extent + 2.0**-50) >= seconds
        and np.linalg.norm(v - vector) <= (2.0**-15 + r) * area + vector_error
        and np.linalg.norm(f - form) <= (
            1.75 * unit + r * area * extent + 2.0**-50 * area + form_error))


# --- Surface (2.4, 2.5, 3, 5.6, 5.11) -------------------------------------------------------------
def check_surface(file: File) -> None:
    h, surface, caps = file.header, file.surface, file.caps
    for index, times in itertools.chain(Counter(surface.ids).items(), Counter(caps.ids).items()):
        file.expect(times == 1, "TRIANGLE_TWICE", f"{times} triangles have the index {index}")
    box, stated = np.array([surface.lower.min(axis=0), surface.upper.max(axis=0)]), file.box
    file.expect((box == stated).all() or file.has_walls and (box[0] >= stated[0]).all()
                and (box[1] <= stated[1]).all(), "MODEL_BOX", "that of the triangles is another")
    least = min(surface.ids)
    samples = [surface.at(row)[0] for row, index in enumerate(surface.ids) if index == least]
    file.expect(least == h.sample_triangle and h.sample in samples, "SAMPLE",
                "not corner 0 of the triangle with the least index")
    a, b, c = caps.corners.transpose(1, 0, 2)
    area = math.fsum(np.linalg.norm(np.cross(b - a, c - a) / 2, axis=1))
    file.expect((caps.lower >= stated[0]).all() and (caps.upper <= stated[1]).all()
                and abs(area - h.cap_area) <= 1e-9 * area, "CAPS", "outside of the box, or area")
    if file.has_walls:
        ends = file.clamp(stated[0]), file.clamp(stated[1])
        margin = [2.0**-40 * max(abs(x), abs(y)) for x, y in zip(*ends)]
        ends = tuple(x - y for x, y in zip(ends[0], margin)), tuple(map(sum, zip(ends[1], margin)))
        file.expect(all(touches(surface.at(row), *ends) for row in range(len(surface.ids))),
                    "REGION", "a triangle does not touch the region")
    else:
        file.expect(abs(openness(file) - h.openness) <= 2.0**-30, "OPENNESS", "another openness")


def openness(file: File) -> float:
    """2.4"""
    surface = file.surface
    in_core = (surface.lower >= file.least).all(axis=1) & (
        surface.upper <= scaled(file.header.core_upper, file.header.scale_exponent)).all(axis=1)
    a, b, c = surface.corners[in_core].transpose(1, 0, 2)
    vectors = np.cross(b - a, c - a) / 2
    parts, areas = (np.trunc(np.clip(x, -7, 7) * 2.0**60).astype(object) for x in (
        vectors, np.sqrt((vectors**2).sum(axis=1))))
    total = sum(map(int, areas))
    if file.header.unbalanced_edge_count == 0 or total == 0:
        return 0.0
    return min(1.0, math.hypot(*(sum(map(int, x)) / total for x in parts.T)))


def check_edges(file: File) -> None:
    """Not with walls, because triangles beyond them are not in the file."""
    if file.has_walls:
        return
    h, uses = file.header, defaultdict(list)            # index and corner of the triangles along it
    runs: Counter = Counter()
    for tree in (file.surface, file.caps):
        for row, index in enumerate(tree.ids):
            t = tree.at(row)
            for i in AXES:
                x = t[i], t[(i + 1) % 3]
                if x[0] != x[1]:
                    runs[x] += 1
                    if tree is file.surface:
                        uses[x].append((index, i))
    unbalanced = sorted({min(x, x[::-1]) for x in uses
                         if len(uses[x]) != len(uses.get(x[::-1], ()))})
    first = []
    for x in unbalanced[:3]:
        (index, corner), along = min((min(uses[y]), y) for y in (x, x[::-1]) if uses.get(y))
        first.append((index, corner, along, len(uses[along]), len(uses.get(along[::-1], ()))))
    listed = [(e.triangle, (scaled(e.start, h.scale_exponent), scaled(e.end, h.scale_exponent)),
               e.along, e.against) for e in h.edges]
    file.expect(len(unbalanced) == h.unbalanced_edge_count and listed == [
        (index, x, along, against) for index, _, x, along, against in sorted(first)],
        "UNBALANCED_EDGES", f"others are listed, or another number; {len(unbalanced)} in all")
    file.expect(h.cap_count == 0 or all(runs[x] == runs[x[::-1]] for x in list(runs)), "CAPS",
                "the surface and its caps are not watertight together")


def check_region_winding(file: File) -> None:
    """3: by a line to the outside, where a side is no wall."""
    h = file.header
    file.expect(not h.input_triangles or h.without_sides or winding(
        file, file.clamp(file.least)) == h.region_winding, "REGION", "another region_winding")


# --- Field and attributes (11, 12) ----------------------------------------------------------------
def check_field(file: File) -> None:
    h, number = file.header, itertools.count()
    for k in range(file.e, file.a):
        for stored in file.page(k).tolist():
            n = next(number)
            grid = n % h.field_size[0], n // h.field_size[0] % h.field_size[1], n // math.prod(
                h.field_size[:2])
            at, point = (tuple(a + unit * x for a, x in zip(h.field_lower, place))
                         for unit, place in ((h.field_step, grid), (h.field_quantum, stored)))
            far, off = (math.sqrt(nearest(file, p)[0]) for p in (at, point))
            most = 15 / 16 * h.field_quantum
            file.expect(abs(math.dist(at, point) - far) <= most and off <= most, "FIELD",
                        f"the point stored for grid point {n} is too far away", k)


def check_attributes(file: File) -> None:
    if file.header.attributes:
        links = dict(zip(file.surface.ids, file.surface.blocks))
        kept = (x["link"] for k in range(file.a, file.d) for x in file.page(k))
        file.expect(all(link == links.get(index) for index, link in enumerate(kept)), "ATTRIBUTES",
                    "a link does not lead to the block with the index", file.a)


# --- Mask (8, 9) ----------------------------------------------------------------------------------
def check_mask(file: File) -> list[tuple[int, Cell, Any]]:
    """8.3, 9.3, 9.4: links, levels, keys and counts. Gives page, cell and record of grey cells."""
    h, seen, levels, found = file.header, set(), 0, []
    keys: dict[int, list[int]] = defaultdict(list)
    stack = [((0, (0, 0, 0)), file.d, 0, None, True)] if file.d < file.n else []
    while stack:
        (level, place), k, number, is_leaf, is_linked = stack.pop()
        page, levels = file.known_page(k), max(levels, level)
        if page is None:
            continue
        good = (number < len(page.kinds) and (number < page.root_count) == is_linked
                and is_leaf in (None, page.kinds[number] > LINKED_NODE))
        file.expect(good, "LINK_TARGET", "a link leads to no such family", k)
        file.expect((k, number) not in seen, "LINK_TWICE", "two links lead to a family", k)
        family = page.families.get(number, Family(k, 0, (), (), {}))
        file.expect(level < FINEST or not family.octants, "PAGE_STRUCTURE", "a node of level 19", k)
        if good and (k, number) not in seen and level <= FINEST:
            seen.add((k, number))
            found.append((k, (level, place), page.leaves.get(number, family)))
            linked = page.kinds[number] == LINKED_NODE
            if linked:
                code = morton_of(place) << 57 - 3 * level
                keys[family.page].append(octcode_of(3 * level, code))
            stack += [(octant_of((level, place), o), family.page, family.first + i, leaf, linked)
                      for i, (o, leaf) in enumerate(zip(family.octants, family.are_leaves))]
    if file.all_linked(file.d, file.n, seen):
        file.expect((len(seen), levels) == (h.mask_cell_count, h.mask_levels), "COUNT",
                    "other numbers of grey cells or levels")
        for k in range(file.d, file.n):
            file.expect(file.entries[k].octcode == min(keys.get(k, [0])), "PAGE_STRUCTURE",
                        "the octcode is not the least of the nodes of the first families", k)
    return sorted(found, key=lambda x: x[:2])


def octant_of(cell: Cell, octant: int) -> Cell:
    return cell[0] + 1, tuple(2 * x + (octant >> i & 1) for i, x in enumerate(cell[1]))


def corner_of(file: File, cell: Cell, corner: int) -> Vec:
    """8.2, not clamped"""
    edge = 2.0**(1 - cell[0])
    return tuple(file.least[i] + (cell[1][i] + (corner >> i & 1)) * edge for i in AXES)


def touches(t: list[Vec], lower: Vec, upper: Vec) -> bool:
    """Has a triangle a point in common with a box? Exact; all separating axes are tried."""
    _, (lower, upper, *t) = whole(lower, upper, *t)
    units = (1, 0, 0), (0, 1, 0), (0, 0, 1)
    edges = sub(t[1], t[0]), sub(t[2], t[1]), sub(t[0], t[2])
    for axis in (*units, normal_of(*t), *(cross(e, unit) for e in edges for unit in units)):
        heights = [dot(axis, v) for v in t]
        ends = [sorted((a * x, a * y)) for a, x, y in zip(axis, lower, upper)]
        if max(heights) < sum(x for x, _ in ends) or min(heights) > sum(y for _, y in ends):
            return False
    return True


def touching(tree: Tree, lower: Vec, upper: Vec) -> list[int]:
    return [row for row in tree.meeting(lower, upper) if touches(tree.at(row), lower, upper)]


class CellCheck:
    """What the mask states of one cell."""

    numbers: dict[Vec, int] = {}        # winding numbers that are counted already

    def __init__(self, file: File, page: int, cell: Cell, record: Any):
        self.file, self.page, self.cell = file, page, cell
        self.corners = [file.clamp(corner_of(file, cell, i)) for i in range(8)]
        self.lower, self.upper = self.corners[0], self.corners[7]
        if isinstance(record, Family):
            for octant, colour in record.signs.items():
                self.check_colour(octant_of(cell, octant), colour)
        elif len(record.planes):
            self.check_planes(record)
        else:
            file.expect(record.corners is None or record.corners == [
                self.number(p) for p in self.corners], "MASK_CORNER", f"{cell}", page)
            if len(record.blocks) and cell[0] < FINEST:
                self.check_list(record)
                self.check_slab(record)

    def number(self, p: Vec) -> int:
        """8.1: outside of the mesh's box it is 0."""
        lower, upper = self.file.box
        if any(x < a or x > b for x, a, b in zip(p, lower, upper)):
            return 0
        if p not in self.numbers:
            self.numbers[p] = winding(self.file, p)
        return self.numbers[p]

    def rows(self, lower: Vec, upper: Vec) -> list[list[int]]:
        return [touching(tree, lower, upper) for tree in (self.file.surface, self.file.caps)]

    def check_colour(self, cell: Cell, colour: int) -> None:
        """8.3"""
        file, (lower, upper) = self.file, (corner_of(self.file, cell, i) for i in (0, 7))
        has_part = all(x <= b and y >= a for x, y, a, b in zip(lower, upper, *file.walls))
        lower, upper = file.clamp(lower), file.clamp(upper)
        good = (not any(self.rows(lower, upper)) and sign(self.number(lower)) == colour
                if has_part else colour == 0)
        file.expect(good, "MASK_COLOUR", f"{cell}", self.page)

    def check_planes(self, leaf: Leaf) -> None:
        """8.7"""
        surface, caps = self.rows(self.lower, self.upper)
        good, passed, found = not caps, set(), set()
        for row in surface:
            sides = [[plane_side(plane, p) for p in self.file.surface.at(row)]
                     for plane in leaf.planes]
            good &= max(map(max, sides)) <= 0 and any(min(x) == 0 for x in sides)
        for p in self.corners:
            sides = [plane_side(plane, p) for plane in leaf.planes]
            passed |= {i for i, side in enumerate(sides) if side > 0}
            if max(sides):
                found.add((max(sides), self.number(p)))
        good &= len(passed) == len(leaf.planes) and found == {(1, leaf.beyond), (-1, leaf.behind)}
        self.file.expect(good, "MASK_PLANES", f"{self.cell}", self.page)

    def check_list(self, leaf: Leaf) -> None:
        """8.5"""
        file, listed = self.file, {(k, number): bits for k, number, bits in leaf.blocks}
        good = all(number < len(file.page(k).blocks) for k, number in listed)
        for octant in range(8):
            ends = (file.clamp(corner_of(file, octant_of(self.cell, octant), i)) for i in (0, 7))
            for tree, rows in zip((file.surface, file.caps), self.rows(*ends)):
                good &= all(listed.get(tree.blocks[row], 0) >> octant & 1 for row in rows)
        file.expect(good, "MASK_BLOCKS", f"{self.cell}", self.page)

    def check_slab(self, leaf: Leaf) -> None:
        """8.6"""
        direction, lower, upper = leaf.slab
        if lower == 0 and upper == 255:
            return
        a, p, q = direction & 3, (direction >> 2 & 127) - 32, (direction >> 9) - 32
        slope = np.zeros(3)
        slope[[a, (a + 1) % 3, (a + 2) % 3]] = 32, p, q
        width, scale, good = 32 + abs(p) + abs(q), 2.0**(self.cell[0] - 1), not self.file.has_walls
        found = self.rows(self.lower, self.upper)
        for tree, rows in zip((self.file.surface, self.file.caps), found):
            for row in rows:
                polygon = clip(np.array(tree.at(row)), self.lower, self.upper)
                u = (polygon - self.lower) * scale
                h = 256 * (u @ slope - min(p, 0) - min(q, 0)) / width               # in steps
                good &= bool((lower == 0 or (h >= lower + 0.5 - 2.0**-20).all())
                             and (upper == 255 or (h <= upper + 0.5 + 2.0**-20).all()))
        self.file.expect(good, "MASK_SLAB", f"{self.cell}", self.page)


def clip(polygon: np.ndarray, lower: Vec, upper: Vec) -> np.ndarray:
    """The part of a polygon that is in a box."""
    for i, side, way in ((i, side, way) for i in AXES for side, way in ((lower, 1), (upper, -1))):
        inner, kept = way * (polygon[:, i] - side[i]), []
        for x, y, g, h in zip(polygon, np.roll(polygon, -1, 0), inner, np.roll(inner, -1)):
            kept += [x] if g >= 0 else []
            kept += [x + (y - x) * (g / (g - h))] if (g < 0) != (h < 0) else []
        polygon = np.array(kept).reshape(-1, 3)
    return polygon


def plane_side(plane: np.ndarray, p: Vec) -> int:
    _, (p, a, b, c) = whole(p, *map(tuple, plane.tolist()))
    return sign(dot(normal_of(a, b, c), sub(p, a)))


def check_cells(file: File, cells: list[tuple[int, Cell, Any]]) -> None:
    CellCheck.numbers = {}
    for page, cell, record in cells:
        CellCheck(file, page, cell, record)


# --- Height fields (10, B.6) ----------------------------------------------------------------------
def check_height_fields(file: File) -> None:
    boxes = {link: child for node in file.surface.records.values() if isinstance(node, Node)
             for link, child in zip(node.links, node.children)}
    for link, block in file.surface.records.items():
        if link[0] == BLOCK and block.flag >> 7:
            good = not file.has_walls and not file.header.without_sides and Prism(
                file, block.corners).is_proof(boxes)
            file.expect(good, "BLOCK_HEIGHT_FIELD", "it is not proven to be in one", link[1])


class Prism:
    """The box of B.6."""

    def __init__(self, file: File, corners: np.ndarray):
        self.file, self.origin = file, corners[0, 0]
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]).sum(axis=0)
        length = np.linalg.norm(normals)
        across = np.cross(np.eye(3)[abs(normals).argmin()], normals)
        self.turn = np.array([across / np.linalg.norm(across), (0, 0, 0), normals / length])
        self.turn[1] = np.cross(self.turn[2], self.turn[0])
        at = self.turned(corners.reshape(-1, 3))
        self.lower, self.upper = at.min(axis=0), at.max(axis=0)
        w = max((self.upper - self.lower)[:2])
        rim = 2.0**-30 + 2.0**-16 * w
        self.lower, self.upper = self.lower - (rim, rim, rim + w), self.upper + (rim, rim, rim + w)
        middle, half = (self.lower + self.upper) / 2, (self.upper - self.lower) / 2
        self.centre, self.half = self.back(middle), abs(self.turn).T @ half
        self.ends = [tuple(self.back((*middle[:2], z)).tolist())
                     for z in (self.upper[2], self.lower[2])]
        self.is_good = length > 0 and max(abs(self.centre) + self.half) < 2.0**16

    def turned(self, points: np.ndarray) -> np.ndarray:
        return (points - self.origin) @ self.turn.T

    def back(self, point: Any) -> np.ndarray:
        return self.origin + np.array(point) @ self.turn

    def met(self, tree: Tree, boxes: dict) -> Iterator[tuple[list[Vec], np.ndarray]]:
        """The triangles that count, as they are and turned."""
        centre = self.centre - self.file.header.centre
        half = self.half + 2.0**-38 + 2.0**-23 * max(abs(centre) + self.half)
        for link, (start, end) in tree.spans.items():
            child = boxes.get(link)
            if link[0] == NODE or child is not None and ((child["lower"] > centre + half).any() or (
                    child["upper"] < centre - half).any()):
                continue
            for row in range(start, end):
                t = self.turned(tree.corners[row])
                if (t.min(axis=0) <= self.upper).all() and (t.max(axis=0) >= self.lower).all():
                    yield tree.at(row), t

    def is_proof(self, boxes: dict) -> bool:
        if not self.is_good or any(True for _ in self.met(self.file.caps, {})):
            return False
        k = 0
        for t, turned in self.met(self.file.surface, boxes):
            if not self.accepts(turned):
                return False
            k += crossing(*self.ends, t)
        return k == -1 and self.begins_outside()

    def accepts(self, t: np.ndarray) -> bool:
        """Steps 4"""
        z, edges = t[:, 2], np.roll(t, -1, 0) - t
        shortest, other, longest = sorted((edges**2).sum(axis=1))
        n = np.cross(edges[0], -edges[2])
        return bool(min(z) > self.lower[2] + 2.0**-31 and max(z) < self.upper[2] - 2.0**-31
                    and shortest > 2.0**-48 * (t[0] @ t[0] + longest)
                    and n @ n > 2.0**-24 * other * longest and n[2] > 0
                    and n[2]**2 > 2.0**-8 * (n @ n))

    def begins_outside(self) -> bool:
        """Step 5: the winding number by the mask."""
        p, file, cell, number, k = self.ends[0], self.file, (0, (0, 0, 0)), 0, self.file.d
        if any(x < a or x > b for x, a, b in zip(p, *file.box)):
            return True
        while k < file.n:
            page = file.page(k)
            if number in page.leaves:
                leaf = page.leaves[number]
                told = len(leaf.planes) or len(leaf.blocks) and cell[0] < FINEST
                return bool(told) and winding(file, p) == 0
            family, centre = page.families[number], corner_of(file, octant_of(cell, 7), 0)
            octant = sum((x >= y) << i for i, (x, y) in enumerate(zip(p, centre)))
            if octant in family.signs:
                return family.signs[octant] == 0
            cell, k = octant_of(cell, octant), family.page
            number = family.first + list(family.octants).index(octant)
        return False


# --- Command line ---------------------------------------------------------------------------------
def main() -> int:
    parser = argparse.ArgumentParser(description="Check a .ptree file.")
    parser.add_argument("file")
    parser.add_argument("--full", action="store_true", help="check triangles and the mask too")
    arguments = parser.parse_args()
    issues = [{"code": x.code, "page": x.page, "message": x.message}
              for x in verify(arguments.file, arguments.full)]
    print(json.dumps({"issues": issues[:1000]}))
    return 1 if issues else 0


if __name__ == "__main__":
    np.seterr(all="ignore")
    sys.exit(main())
