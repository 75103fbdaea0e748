"""Two bodies, each on two spheres of radius 1, level with each other and a bar apart: Par4's forward model.

Each body's point h lies on the circle where its spheres meet. At the height z, with n from one centre to the other, m
their middle and n' the horizontal part of n, h = m + (z - m_z) t + C a: t = (-n_z n' / |n'|^2, 1) goes up in the
circle's plane, a is horizontal in it, and C^2 = 1 - |n|^2 / 4 - (z - m_z)^2 |t|^2. Both are at the same z; that they
are b apart reads

    P + Q_1 C_1 + Q_2 C_2 + K C_1 C_2 = 0

with P of degree 2, Q_1 and Q_2 of degree 1 in z and K constant. Squaring twice frees it of C_2 and C_1 and leaves an
octic in z. Points of the horizontal plane are complex numbers.
"""

from __future__ import annotations

from itertools import product as pairs
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Array
from kinematics.mathematics import product, real_roots

_CANDIDATE = 1e-3  # error of the bar's squared length at which a candidate is worth a closer look: near a double root


class Halves(NamedTuple):
    """Sphere centres (k, 4, 3), two for each body, and the bar's length, both over the spheres' radius."""

    centres: Array
    bar: float


class Circle(NamedTuple):
    """h = middle + (z - height) rise + C across, C^2 = square - (z - height)^2 steepness; each (k,)."""

    middle: Array
    height: Array
    rise: Array
    across: Array
    square: Array
    steepness: Array

    @classmethod
    def of(cls, first: Array, second: Array) -> Circle:
        """Of two spheres with centres (k, 3), neither above the other."""
        n, middle = second - first, (first + second) / 2
        flat, square = n[:, 0] + 1j * n[:, 1], np.sum(n * n, axis=1)
        level = np.abs(flat)
        return cls(
            middle[:, 0] + 1j * middle[:, 1], middle[:, 2], -n[:, 2] * flat / level**2, 1j * flat / level,
            1 - square / 4, square / level**2,
        )  # fmt: skip

    def squared(self, origin: Array) -> Array:
        """(k, 3) C^2 in w = z - origin."""
        up = self.height - origin
        return np.stack([-self.steepness, 2 * self.steepness * up, self.square - self.steepness * up**2], axis=-1)


def candidates(problem: Halves, every: bool) -> tuple[Array, Array]:
    """Placements near to all real ones.

    Args:
        problem: k of them.
        every: also use the octic's stationary points, for two placements that have the same height by symmetry.

    Returns:
        rows (j,): the problem of each placement; (j, 2, 3) the two bodies' points. Some appear twice, some may be
        wrong. There is none if one sphere of a body is above the other.
    """
    apart = np.abs(problem.centres[:, 1::2, :2] - problem.centres[:, ::2, :2]).max(axis=2)
    posed = np.flatnonzero(np.isfinite(problem.centres).all(axis=(1, 2)) & (apart > 0.0).all(axis=1))
    c = problem.centres[posed]
    circles = Circle.of(c[:, 0], c[:, 1]), Circle.of(c[:, 2], c[:, 3])
    origin = (circles[0].height + circles[1].height) / 2
    octic = _octic(circles, origin, problem.bar)
    roots = [real_roots(octic)]
    if every:
        roots.append(real_roots(octic[:, :-1] * np.arange(8, 0, -1)))
    w = np.concatenate(roots, axis=1)
    rows, place = np.nonzero(np.isfinite(w))
    z = w[rows, place] + origin[rows]
    first, second = (Circle(*(part[rows] for part in circle)) for circle in circles)
    found = []
    for sides in pairs((1.0, -1.0), repeat=2):
        h = [
            s.middle + (z - s.height) * s.rise
            + side * s.across * np.sqrt(np.maximum(s.square - s.steepness * (z - s.height) ** 2, 0.0))
            for side, s in zip(sides, (first, second), strict=True)
        ]  # fmt: skip
        good = np.abs(np.abs(h[1] - h[0]) ** 2 - problem.bar**2) < _CANDIDATE
        points = np.stack([np.stack([p.real, p.imag, z], axis=-1) for p in h], axis=1)
        found.append((rows[good], points[good]))
    return posed[np.concatenate([f[0] for f in found])], np.concatenate([f[1] for f in found])


def _octic(circles: tuple[Circle, Circle], origin: Array, bar: float) -> Array:
    """(k, 9) in w = z - origin, highest power first."""
    one, two = circles
    slope = two.rise - one.rise
    constant = two.middle - one.middle - (two.height - origin) * two.rise + (one.height - origin) * one.rise
    g1, g2 = one.squared(origin), two.squared(origin)
    p = g1 + g2 + np.stack(
        [np.abs(slope) ** 2, 2 * (slope.conj() * constant).real, np.abs(constant) ** 2 - bar**2], axis=-1
    )  # fmt: skip
    q1, q2 = (
        2 * sign * np.stack([(slope.conj() * c.across).real, (constant.conj() * c.across).real], axis=-1)
        for sign, c in ((-1, one), (1, two))
    )
    k = -2 * (one.across.conj() * two.across).real[:, None]
    even = product(p, p) + product(product(q1, q1), g1) - product(g2, _sum(product(q2, q2), k**2 * g1))
    odd = 2 * _sum(product(p, q1), -k * product(g2, q2))
    return _sum(product(even, even), -product(g1, product(odd, odd)))


def _sum(first: Array, second: Array) -> Array:
    """Of polynomials of the same or of different degree."""
    if first.shape[1] < second.shape[1]:
        first, second = second, first
    result = first.copy()
    result[:, first.shape[1] - second.shape[1] :] += second
    return result
