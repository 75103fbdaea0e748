"""The legs and corners of a path through points.

A point is no corner if the path goes straight on there. Waypoints in a row without a blend are one leg if each step
between them is within `STRAIGHT` of the leg's own direction. Such a leg misses a waypoint by at most that share of its
steps. Any other waypoint without a blend is a stop. A waypoint whose corner would be shorter than `UNTOLD` of the path
is a stop too, because the rounding of arc lengths would be too large inside it.

If two waypoints in a row have the same place, the tool turns in place, from stop to stop. The length of such a leg is
its angle times the path's longest leg, or 1 m for each radian if the path has no other leg.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from kinematics import Array
from trajectory.errors import InvalidPath
from trajectory.paths.corner import corner_length

STRAIGHT = 1e-5  # rad: from a leg's direction to that of a step of it, and from a reversal to a corner that has a blend
UNTOLD = 1e-9  # of the path's legs: a shorter corner is a stop
_ROUNDING = 1e-12  # relative
_SAME = 1e-12  # of the largest coordinate: no further apart are two points one


class Layout(NamedTuple):
    """Legs and corners in order; `along` and `across` span the plane in which one turns by `alphas`."""

    edges: Array  # (m + 1,) arc lengths
    lengths: Array  # (m,)
    alphas: Array  # (m,)
    starts: Array  # (m, p)
    along: Array  # (m, p); the whole way over the leg's length where the tool turns in place
    across: Array  # (m, p)
    at: Array  # (k,) arc length at which each point is passed
    stops: tuple[float, ...]


def turning_in_place(points: Array) -> Array:
    """(k - 1,) whether the tool point stands still from each of the points (k, p) to the next."""
    still: Array = np.linalg.norm(np.diff(points, axis=0), axis=1) <= _SAME * np.abs(points).max()
    return still


def laid_out(points: Array, blends: Sequence[float], in_place: Array, turns: Array) -> Layout:
    """The layout of a path.

    Args:
        points: (k, p) in order [m].
        blends: (k,) what each corner takes off both of its legs [m]; 0 at both ends.
        in_place: (k - 1,) whether the tool turns in place from each point to the next.
        turns: (k - 1,) by how much [rad].

    Raises:
        InvalidPath: two equal poses in a row, a blend where the tool turns in place or where the path reverses, or
            corners that overlap; the pose is named, counted from 1.
    """
    sizes = np.linalg.norm(np.diff(points, axis=0), axis=1)
    _require_room(points, sizes, in_place, blends, turns)
    blends = _told_blends(points, blends, in_place)
    legs = _straight_runs(points, in_place, blends)
    measure = float(sizes.max()) if not in_place.all() else 1.0
    rows: list[tuple[float, float, Array, Array, Array]] = []
    at, stops, travelled = np.zeros(len(points)), list[float](), 0.0
    for k, (first, last) in enumerate(legs):
        step = points[last] - points[first]
        leg = turns[first] * measure if in_place[first] else float(np.linalg.norm(step))
        unit = step / leg
        straight = leg - blends[first] - blends[last]
        passed = points[first + 1 : last] - points[first]
        at[first + 1 : last] = travelled - blends[first] + passed @ unit
        if straight > _ROUNDING * leg:
            rows.append((straight, 0.0, points[first] + blends[first] * unit, unit, np.zeros_like(unit)))
            travelled += straight
        at[last] = travelled
        if k + 1 == len(legs):
            break
        if in_place[first] or in_place[last]:
            stops.append(travelled)
            continue
        following = points[legs[k + 1][1]] - points[last]
        alpha, across = _turn(unit, following / np.linalg.norm(following))
        length = corner_length(alpha, blends[last])
        at[last] += length / 2
        if length > 0.0:
            rows.append((length, alpha, points[last] - blends[last] * unit, unit, across))
            travelled += length
        else:
            stops.append(travelled)
    lengths, alphas, starts, along, across_ = (np.array(column) for column in zip(*rows, strict=True))
    edges = np.concatenate([[0.0], np.cumsum(lengths)])
    at[-1] = edges[-1]
    return Layout(edges, lengths, alphas, starts, along, across_, at, tuple(stops))


def _told_blends(points: Array, blends: Sequence[float], in_place: Array) -> list[float]:
    """The blends, 0 where a corner would be too short to be told.

    Raises:
        InvalidPath: a blend where the path reverses.
    """
    legs, told = _straight_runs(points, in_place, blends), list(blends)
    least = UNTOLD * float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())
    for (start, corner), (_, stop) in pairwise(legs):
        if told[corner] > 0.0:
            before, after = points[corner] - points[start], points[stop] - points[corner]
            alpha, _ = _turn(before / np.linalg.norm(before), after / np.linalg.norm(after))
            if alpha > math.pi - STRAIGHT:
                raise InvalidPath(
                    corner + 1, "blend", told[corner], "0 m, as the tool must stop where the path reverses"
                )
            if corner_length(alpha, told[corner]) <= least:
                told[corner] = 0.0
    return told


def _straight_runs(points: Array, in_place: Array, blends: Sequence[float]) -> list[tuple[int, int]]:
    """The first and the last point of each leg: points between them are no corners."""
    corners = [0]
    for k in range(1, len(points) - 1):
        passes = blends[k] == 0.0 and not in_place[k - 1] and not in_place[k]
        if not (passes and _is_straight(points[corners[-1] : k + 2])):
            corners.append(k)
    return list(pairwise([*corners, len(points) - 1]))


def _is_straight(points: Array) -> bool:
    """Whether each step is within `STRAIGHT` of the direction from the first point to the last one."""
    steps, chord = np.diff(points, axis=0), points[-1] - points[0]
    along = steps @ chord
    aside = np.linalg.norm(np.outer(along, chord) - steps * (chord @ chord), axis=1)
    return bool(((along > 0.0) & (aside <= STRAIGHT * along * np.linalg.norm(chord))).all())


def _turn(first: Array, second: Array) -> tuple[float, Array]:
    """By how much the second direction is turned from the first, and the unit vector towards it."""
    towards = second - (first @ second) * first
    size = float(np.linalg.norm(towards))
    alpha = math.atan2(size, float(first @ second))
    if size <= _ROUNDING:
        return (0.0 if alpha < 1.0 else math.pi), np.zeros_like(first)
    return alpha, towards / size


def _require_room(points: Array, sizes: Array, in_place: Array, blends: Sequence[float], turns: Array) -> None:
    """Raise InvalidPath where a leg has no length, or a corner no room at its ends."""
    for k, size in enumerate(sizes, start=1):
        both = blends[k - 1] + blends[k]
        at = k if blends[k - 1] > blends[k] else k + 1
        if in_place[k - 1]:
            if not turns[k - 1] > _SAME:
                expected = f"a place other than that of pose {k}, or another angle"
                raise InvalidPath(k + 1, "place", points[k].tolist(), expected)
            if both > 0.0:
                expected = f"0 m, as the tool turns in place from pose {k} to pose {k + 1}"
                raise InvalidPath(at, "blend", blends[at - 1], expected)
        elif both > size * (1.0 + _ROUNDING):
            expected = f"blends whose sum is at most the {size:.9g} m from pose {k} to pose {k + 1}, not {both:.9g} m"
            raise InvalidPath(at, "blend", blends[at - 1], expected)
