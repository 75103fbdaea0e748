"""The distance between two convex bodies given by their corners: segments, flat polygons, boxes; in expressions."""

from __future__ import annotations

from collections.abc import Sequence
from functools import reduce
from itertools import pairwise
from typing import NamedTuple

import casadi as ca

from kinematics.mathematics.segment_distance import nearest_symbolic

_NO_AREA = 1e-100  # m^4: a normal with a smaller square has no direction


_BOX = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))  # see `box`


class Convex(NamedTuple):
    """The hull of some points: a segment, a flat polygon or a box.

    Attributes:
        corners: (3, k) [m].
        faces: the corners of each face in order: none for a segment, one for a polygon, six for a box, each
            counter-clockwise seen from outside.
    """

    corners: ca.SX
    faces: tuple[tuple[int, ...], ...] = ()

    @classmethod
    def polygon(cls, outline: ca.SX) -> Convex:
        """Flat and convex, with its corners (3, k) in order."""
        return cls(outline, (tuple(range(outline.shape[1])),))

    @classmethod
    def box(cls, low: Sequence[float], high: Sequence[float]) -> Convex:
        """Along the axes; bit i of a corner's number tells whether it is at the upper bound of coordinate i."""
        sides = (low, high)
        return cls(ca.SX([[sides[k >> i & 1][i] for k in range(8)] for i in range(3)]), _BOX)

    @property
    def edges(self) -> list[tuple[int, int]]:
        """The pairs of corners with an edge between them."""
        if not self.faces:
            return [(0, 1)]
        rings = ([*face, face[0]] for face in self.faces)
        return sorted({(min(pair), max(pair)) for ring in rings for pair in pairwise(ring)})

    @property
    def directions(self) -> tuple[list[tuple[int, ...]], list[tuple[int, int]]]:
        """One face and one edge of each direction."""
        if self.faces == _BOX:
            return [_BOX[0], _BOX[2], _BOX[4]], [(0, 1), (0, 2), (0, 4)]
        return list(self.faces), self.edges

    def line(self, edge: tuple[int, int]) -> ca.SX:
        """(3, 2) the ends of an edge."""
        return self.corners[:, list(edge)]

    def normal(self, face: tuple[int, ...]) -> ca.SX:
        """(3,) across a face, of any length."""
        first, second, third = (self.corners[:, i] for i in face[:3])
        return ca.cross(second - first, third - first)


def shortest_way(one: Convex, two: Convex) -> ca.SX:
    """(3,) the shortest way from one body to the other, if they do not intersect.

    It is between two edges, or between a corner and a face.
    """
    ways = [nearest_symbolic(one.line(e), two.line(f))[0] for e in one.edges for f in two.edges]
    best = reduce(lambda a, b: ca.if_else(ca.sumsqr(b) < ca.sumsqr(a), b, a), ways)
    for body, other, sign in ((one, two, 1), (two, one, -1)):
        for face in body.faces:
            normal = body.normal(face)
            for k in range(other.corners.shape[1]):
                point = other.corners[:, k]
                height = ca.dot(normal, point - body.corners[:, face[0]])
                way = sign * height / ca.fmax(ca.sumsqr(normal), _NO_AREA) * normal
                nearer = ca.fmin(_within(body, face, normal, point), ca.sumsqr(best) - ca.sumsqr(way))
                best = ca.if_else(nearer >= 0, way, best)
    return best


def signed_distance(one: Convex, two: Convex) -> ca.SX:
    """The distance [m]; if the bodies intersect, minus the length of the shortest displacement that ends it."""
    apart = ca.norm_2(shortest_way(one, two))
    if not one.faces and not two.faces:
        return apart
    return ca.if_else(_pierced(one, two) > 0, _overlap(one, two), apart)


# Conditions are numbers here, and hold where they are at least 0 or above it: `fmin` is "and", `fmax` is "or".


def _within(body: Convex, face: tuple[int, ...], normal: ca.SX, point: ca.SX) -> ca.SX:
    """At least 0 if a point's foot on the plane of a face lies in the face."""
    sides = []
    for i, j in pairwise([*face, face[0]]):
        start = body.corners[:, i]
        sides.append(ca.dot(ca.cross(normal, body.corners[:, j] - start), point - start))
    return reduce(ca.fmin, sides)


def _pierced(one: Convex, two: Convex) -> ca.SX:
    """Above 0 if an edge of a body passes through a face of the other, or a corner lies inside the other."""
    found = []
    for body, other in ((one, two), (two, one)):
        heights = []
        for face in body.faces:
            normal, start = body.normal(face), body.corners[:, face[0]]
            above = [ca.dot(normal, other.corners[:, k] - start) for k in range(other.corners.shape[1])]
            heights.append(above)
            for i, j in other.edges:
                share = ca.fabs(above[i]) / ca.fmax(ca.fabs(above[i]) + ca.fabs(above[j]), _NO_AREA)
                point = other.corners[:, i] + share * (other.corners[:, j] - other.corners[:, i])
                found.append(ca.fmin(-above[i] * above[j], _within(body, face, normal, point)))
        if len(body.faces) > 1:
            found += [-reduce(ca.fmax, of_corner) for of_corner in zip(*heights, strict=True)]
    return reduce(ca.fmax, found)


def _overlap(one: Convex, two: Convex) -> ca.SX:
    """Minus the depth: the direction of least displacement is across a face, or across an edge of each body."""
    across = [body.normal(face) for body in (one, two) for face in body.directions[0]]
    across += [
        ca.cross(a[:, 1] - a[:, 0], b[:, 1] - b[:, 0])
        for a in (one.line(e) for e in one.directions[1])
        for b in (two.line(f) for f in two.directions[1])
    ]
    best = ca.SX(-ca.inf)
    for w in across:
        square = ca.sumsqr(w)
        first, second = w.T @ one.corners, w.T @ two.corners
        room = ca.fmax(ca.mmin(second) - ca.mmax(first), ca.mmin(first) - ca.mmax(second))
        best = ca.fmax(best, ca.if_else(square > _NO_AREA, room / ca.sqrt(ca.fmax(square, _NO_AREA)), -1e100))
    return best
