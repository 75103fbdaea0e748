"""Directions that part two convex bodies, and what shows that they do.

Any vector w, not 0, parts two convex bodies by at least c where w . (q - p) >= c |w| for all corners p of one and q of
the other: all of their points are so far apart along w. So w may be any function of the pose, with any numbers in it.

A fixed w suits wide gaps. Beside a thin gap between long members, the far corners leave no room: turned by the ratio of
gap to length, a fixed w no longer parts them. There w turns with the members: across one of them, or across both.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import reduce
from typing import ClassVar, NamedTuple

import casadi as ca
import numba
import numpy as np

from kinematics.arrays import Array

_LONG_ENOUGH = 1e-6  # what |w|^2, 1 in the middle of a box, must exceed
_SEEN_FIXED, _SEEN_TURNING = 3, 16  # numbers that the choice of a direction looks at


class Corner(NamedTuple):
    """A corner of one body seen from a corner of the other: what moves with the pose, and the rest; (3,) each."""

    moving: ca.SX
    fixed: ca.SX


@dataclass(frozen=True)
class Fixed:
    """Two bodies that a fixed direction parts.

    Attributes:
        corners: of the one, seen from those of the other.
        way: (3,) the shortest way between the bodies.
        thick: the sum of their radii [m].
    """

    corners: list[Corner]
    way: ca.SX
    thick: ca.SX
    numbers: ClassVar[int] = 3

    def seen(self, bound: ca.SX) -> ca.SX:  # noqa: ARG002
        """What the choice of a direction looks at."""
        return self.way

    def rows(self, bound: ca.SX, w: ca.SX) -> ca.SX:
        """Expressions that are all at least 0 only if the bodies are at least `bound` apart.

        There is one for all corners that move alike.
        """
        groups: dict[tuple[int, ...], tuple[ca.SX, list[ca.SX]]] = {}
        for moving, fixed in self.corners:
            name = tuple(moving[i].element_hash() for i in range(3))
            groups.setdefault(name, (moving, []))[1].append(ca.dot(w, fixed))
        kept = (bound + self.thick) * ca.norm_2(w)
        rows = [ca.dot(w, moving) + reduce(ca.fmin, rest) - kept for moving, rest in groups.values()]
        return ca.vertcat(ca.sumsqr(w) - _LONG_ENOUGH, *rows)


@dataclass(frozen=True)
class Turning:
    """Two segments with a thin gap.

    Attributes:
        ends: from start to start, from start to end, from end to start, and from end to end.
        segments: each from start to end, (3,).
        way: (3,) the shortest way between them.
        thick: the sum of the radii [m].
    """

    ends: list[Corner]
    segments: tuple[ca.SX, ca.SX]
    way: ca.SX
    thick: ca.SX
    numbers: ClassVar[int] = 12

    def seen(self, bound: ca.SX) -> ca.SX:
        """What the choice of a direction looks at: the shortest way, the ends, and the distance to keep."""
        return ca.vertcat(self.way, *(moving + fixed for moving, fixed in self.ends), bound + self.thick)

    def rows(self, bound: ca.SX, numbers: ca.SX) -> ca.SX:
        """Expressions that are all at least 0 only if the segments are at least `bound` apart.

        With w = w_0 + m x v + n x u + k u x v, where u and v are the segments. A point of one and a point of the other
        differ by d + t v - s u, where d is the difference of two ends; near the gap it is small. What is 0, such as
        v . (m x v), is left out.
        """
        s, t, fixed, m, n, k = ca.vertsplit(numbers, [0, 1, 2, 5, 8, 11, 12])
        shares = ((1 - s) * (1 - t), (1 - s) * t, s * (1 - t), s * t)
        d = sum((share * (end.moving + end.fixed) for share, end in zip(shares, self.ends, strict=True)), ca.SX(3, 1))
        u, v = self.segments
        both = ca.cross(u, v)
        w = fixed + ca.cross(m, v) + ca.cross(n, u) + k * both
        along_d = ca.dot(fixed, d) + ca.dot(m, ca.cross(v, d)) + ca.dot(n, ca.cross(u, d)) + k * ca.dot(both, d)
        along_u = ca.dot(fixed, u) - ca.dot(m, both)
        along_v = ca.dot(fixed, v) + ca.dot(n, both)
        near = along_d - (bound + self.thick) * ca.norm_2(w)
        rows = [near + (j - t) * along_v - (i - s) * along_u for i in (0, 1) for j in (0, 1)]
        return ca.vertcat(ca.sumsqr(w) - _LONG_ENOUGH, *rows)


def chosen(seen: Array, fixed: int) -> Array:
    """(k, rows) of `seen` of all pairs -> (k, numbers) the directions that suit the middle of each box.

    Args:
        fixed: the number of pairs with a fixed direction. They come before those whose direction turns.
    """
    count, first = len(seen), _SEEN_FIXED * fixed
    turning = (seen.shape[1] - first) // _SEEN_TURNING
    directions = _fixed_directions(seen[:, :first].reshape(count, fixed, _SEEN_FIXED))
    turned = _turning_directions(seen[:, first:].reshape(count, turning, _SEEN_TURNING))
    return np.hstack([directions.reshape(count, fixed * 3), turned.reshape(count, turning * Turning.numbers)])


def _fixed_directions(ways: Array) -> Array:
    """(..., 3) -> (..., 3) of length 1; e_x where there is no direction."""
    size = np.linalg.norm(ways, axis=-1, keepdims=True)
    usable = np.isfinite(size) & (size > 1e-150)  # far above where squares underflow
    return np.where(usable, ways / np.where(usable, size, 1.0), [1.0, 0.0, 0.0])


def _turning_directions(seen: Array) -> Array:
    """(k, pairs, 16) -> (k, pairs, 12): of the directions that may part a pair, that with the most room."""
    flat = np.ascontiguousarray(seen).reshape(-1, _SEEN_TURNING)
    result = np.zeros((len(flat), Turning.numbers))
    straight = _fixed_directions(flat[:, :3])
    _choose(straight, flat[:, 3:15].reshape(-1, 4, 3), flat[:, 15], result)
    return result.reshape(*seen.shape[:-1], Turning.numbers)


@numba.njit(nogil=True, cache=True, error_model="numpy")
def _choose(straight, ends, kept, result):  # type: ignore[no-untyped-def]
    """For each pair: straight from point to point, across u, across v, or across both. NaN is never the most."""
    far = np.empty(4)
    for k in range(len(ends)):
        for e in range(4):
            far[e] = np.sqrt(_dot(ends[k, e], ends[k, e]))
        near = np.argmin(far)
        u, v, d = ends[k, 0] - ends[k, 2], ends[k, 1] - ends[k, 0], ends[k, near]
        both = _cross(u, v)
        sine = np.sqrt(_dot(both, both) / (_dot(u, u) * _dot(v, v)))
        result[k, 0], result[k, 1] = near // 2, near % 2
        result[k, 2:5] = straight[k]
        most = _room(straight[k], ends[k], kept[k], far, near, False, False)
        for place in (5, 8, 11):
            along = v if place == 5 else u
            across = _cross(along, d)
            w = _cross(across, along) if place < 11 else np.sign(_dot(d, both)) * both
            size = np.sqrt(_dot(w, w))
            room = _room(w / size, ends[k], kept[k], far, near, place != 8, place != 5)
            if place == 11:
                room *= sine  # it turns that much faster than the members
            if room > most:
                most = room
                result[k, 2:] = 0.0
                if place < 11:
                    result[k, place : place + 3] = across / size
                else:
                    result[k, place] = np.sign(_dot(d, both)) / size


@numba.njit(nogil=True, cache=True, error_model="numpy")
def _room(w, ends, kept, far, near, across_v, across_u):  # type: ignore[no-untyped-def]
    """The least room of the ends: how much too far apart they are along w, over their distance.

    That is about the angle by which their difference may turn. Ends that are at one place along w, as w is across a
    segment, count once.
    """
    least = np.inf
    for e in range(4):
        changes_u, changes_v = e // 2 != near // 2, e % 2 != near % 2
        if e != near and (across_u or not changes_u) and (across_v or not changes_v):
            continue
        room = (_dot(w, ends[e]) - kept) / far[e]
        if not room >= least:
            least = room
    return least


@numba.njit(nogil=True, cache=True)
def _dot(u, v):  # type: ignore[no-untyped-def]
    return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]


@numba.njit(nogil=True, cache=True)
def _cross(u, v):  # type: ignore[no-untyped-def]
    return np.array([u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]])
