"""Members: the bodies that a mechanism is made of, with their sections."""

from __future__ import annotations

import math
from typing import NamedTuple

import casadi as ca
import numpy as np

_ONE = 1e-9  # of their size: points that are no further apart are one
_FLAT = 1e-9  # of their size: what rounding leaves of a plane


class Tube(NamedTuple):
    """A straight tube with round ends: all points within `radius` of the line from `start` to `end`.

    Attributes:
        start, end: (3,) [m].
        radius: outside [m].
        wall: thickness of the wall [m]; as much as the radius for a solid bar.
    """

    start: ca.SX
    end: ca.SX
    radius: ca.SX
    wall: ca.SX

    @property
    def corners(self) -> ca.SX:
        """(3, 2) its ends, of which all of its points are within `around` of the hull."""
        return ca.horzcat(self.start, self.end)

    @property
    def around(self) -> ca.SX:
        """[m]"""
        return self.radius

    @property
    def area(self) -> ca.SX:
        """Of the section [m^2]."""
        return math.pi * self.wall * (2 * self.radius - self.wall)


class Plate(NamedTuple):
    """A flat convex plate with a round rim: all points within half the thickness of the polygon `outline`.

    Attributes:
        outline: (3, k) corners in order [m].
        thickness: [m].
    """

    outline: ca.SX
    thickness: ca.SX

    @property
    def corners(self) -> ca.SX:
        """(3, k) of the hull that all of its points are within `around` of."""
        return self.outline

    @property
    def around(self) -> ca.SX:
        """[m]"""
        return self.thickness / 2


class Member(NamedTuple):
    """A rigid body.

    Attributes:
        name: what people call it, such as "rod 3 b".
        joints: what holds it, by any names. Two members that share a joint are joined, and may touch.
        material: which field of `Structure` it is made of; empty for what belongs to the base or slides on it.
        shapes: what it consists of.
        link: the link of `bodies` that it is part of, where that has another name.
    """

    name: str
    joints: tuple[str, ...]
    material: str
    shapes: tuple[Tube | Plate, ...]
    link: str = ""

    @property
    def tube(self) -> Tube:
        """The first tube."""
        return next(shape for shape in self.shapes if isinstance(shape, Tube))


def bar(name: str, joints: tuple[str, ...], material: str, start: ca.SX, end: ca.SX, radius: ca.SX) -> Member:
    """A member that is one solid bar."""
    return Member(name, joints, material, (Tube(start, end, radius, radius),))


def shared_joints(name: str, points: np.ndarray) -> list[str]:
    """(k, 2 or 3) points -> (k,) names, "B1" and so on; points that are one, to rounding, have one name."""
    size = np.abs(points).max()
    first = [int(np.flatnonzero(np.abs(points - point).max(axis=1) <= _ONE * size)[0]) for point in points]
    return [f"{name}{i + 1}" for i in first]


def platform(points: ca.SX, numbers: np.ndarray, thickness: ca.SX) -> tuple[Tube | Plate, ...]:
    """A plate whose corners are the outermost of some points, or bars to them if they are not in one plane.

    Args:
        points: (3, k) where the joints are.
        numbers: (k, 2 or 3) the same points in the platform's frame.
        thickness: of plate or bars [m].
    """
    centred = numbers - numbers.mean(axis=0)
    _, sizes, axes = np.linalg.svd(centred, full_matrices=False)
    flat, wide = sizes[2:].sum() <= _FLAT * sizes[0], sizes[1] > _FLAT * sizes[0]
    if flat and wide:
        return (Plate(points[:, _hull(centred @ axes[:2].T)], thickness),)
    middle = ca.sum2(points) / points.shape[1]
    return tuple(Tube(middle, points[:, i], thickness / 2, thickness / 2) for i in range(points.shape[1]))


def _hull(flat: np.ndarray) -> list[int]:
    """(k, 2) points -> the corners of their convex hull, in order; Andrew's monotone chain."""
    order = np.lexsort((flat[:, 1], flat[:, 0])).tolist()
    least = _FLAT * np.abs(flat).max() ** 2

    def chain(indices: list[int]) -> list[int]:
        kept: list[int] = []
        for i in indices:
            while len(kept) > 1:
                (ax, ay), (bx, by) = flat[kept[-1]] - flat[kept[-2]], flat[i] - flat[kept[-1]]
                if ax * by - ay * bx > least:
                    break
                kept.pop()
            kept.append(i)
        return kept[:-1]

    return chain(order) + chain(order[::-1])
