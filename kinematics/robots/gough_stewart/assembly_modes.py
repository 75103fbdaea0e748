"""Every assembly mode of a 6-UPS platform, by continuation from a generic one over the complex numbers.

In Study's coordinates the closure is seven quadrics in eight homogeneous unknowns; outside their common singular set
(e = 0) a generic platform has 40 complex solutions, no more (Husty 1996; Ronga and Vust 1995). Three stages:

1. Once a process: a random complex platform with one known pose; loops through its parameters (monodromy) turn that
   pose into all 40.
2. Once a geometry: the 40 are followed to this geometry with random complex leg lengths. What arrives with K = e . e
   other than zero is regular (almost every value of a smooth map is), so nothing that is real later is dropped; a
   special geometry keeps fewer, such as 16 where the platform is a triangle.
3. For each set of leg lengths: those are followed to it. Every isolated pose is the end of some path; an end may also
   lie on a continuum of poses, which the caller has to refuse (`gough_stewart_self_motion`). The regular ends are
   certified: none twice, and the complex ones in conjugate pairs; else another way is taken. A way can fail, as it may
   pass so near a platform with a pose at infinity that rounding hides the path.
"""

from __future__ import annotations

from functools import cache, lru_cache
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Array
from kinematics.errors import LinkwrightError
from kinematics.mathematics import leg_quadrics, refine, study_quadric, track
from kinematics.robots.gough_stewart.architecture_singularity import dependence

GENERIC_COUNT = 40
_LOOPS = 60
_SURE = 1e-4  # smallest ratio of singular values, at the best pose, for which the count was found reliable
_ROUTES = 8  # how many ways to a target are tried
_ROTATION = 4  # coordinates of e, the first block
_NEAR_END = 1.0 - 1e-4  # a path that sticks before did not come to a singular end
_SAME = 1e-6  # distance of unit points below which they are one solution
_FINITE = 1e-10  # |K| over the square of e's norm above which a point is a displacement
_REGULAR = 1e-9  # the last Newton step at an end that counts as a regular solution


class LostPaths(LinkwrightError):
    """The continuation could not be certified, so the assembly modes are not known."""

    exit_status = 1

    def __init__(self, stage: str, found: object, expected: str) -> None:
        self.stage, self.found, self.expected = stage, found, expected
        super().__init__(f"assembly modes, {stage}: found {found}; expected {expected}")


class Platform(NamedTuple):
    """Joint centres (6, 3) and squared leg lengths (6,), real or complex."""

    base: Array
    platform: Array
    squares: Array

    def system(self) -> Array:
        """(7, 8, 8) differences of the legs' quadrics, which vanish with e, one leg's, and Study's."""
        legs = leg_quadrics(*self)
        return np.concatenate([legs[:5] - legs[5], legs[5:], study_quadric()])

    def path_to(self, other: Platform) -> Array:
        """(3, 7, 8, 8) the quadrics along the straight line of parameters to the other, of degree two in t."""
        first, last = self.system(), other.system()
        middle = Platform(*((u + v) / 2 for u, v in zip(self, other, strict=True))).system()
        second = 2.0 * (first + last - 2.0 * middle)
        return np.stack([first, last - first - second, second])


@cache
def generic() -> tuple[Platform, Array]:
    """A random complex platform and its 40 solutions (40, 8); found once a process, the same in each.

    Raises:
        LostPaths: monodromy did not find 40.
    """
    rng = np.random.default_rng(1996)
    home, known = _with_a_pose(rng, _complex(rng, 6, 3), _complex(rng, 6, 3))
    for _ in range(_LOOPS):
        stations = [home, _random_platform(rng), _random_platform(rng), home]
        ends = known
        for here, there in pairwise(stations):
            ends, reached = track(here.path_to(there), ends, _ROTATION)
            ends = ends[reached == 1.0]
        known = distinct(np.concatenate([known, _regular(home, ends)]))
        if len(known) >= GENERIC_COUNT:
            return home, known
    raise LostPaths("generic platform", f"{len(known)} poses", f"{GENERIC_COUNT}")


@lru_cache(maxsize=64)
def solver(base: bytes, platform: bytes) -> ModeSolver:
    """The solver of a geometry, from the bytes of its points (6, 3); kept for the next call."""
    return ModeSolver(*(np.frombuffer(points).reshape(6, 3) for points in (base, platform)))


class ModeSolver:
    """Solutions of one geometry for generic complex leg lengths, from where any leg lengths are reached.

    Args:
        base, platform: (6, 3) joint centres, each about its centroid and of size near 1.

    Raises:
        LostPaths: two ways to the geometry kept different poses, or it is so near a singular architecture that some
            of its poses may be too far away to be followed.
    """

    def __init__(self, base: Array, platform: Array) -> None:
        independent = dependence(base, platform)
        if independent < _SURE:
            raise LostPaths("this geometry", f"legs independent by {independent:.1e} only", f"at least {_SURE:g}")
        rng = np.random.default_rng(40)
        self.start, pose = _with_a_pose(rng, base, platform)  # near a singular architecture too, its poses are finite
        origin, known = generic()
        found = [_regular(self.start, self._follow([origin, self.start], known)[0])]
        for _ in range(_ROUTES):  # a second way around must not find more, or there is a third, and so on
            around = [origin, _random_platform(rng), self.start]
            found.append(distinct(np.concatenate([found[-1], _regular(self.start, self._follow(around, known)[0])])))
            if len(found[-1]) == len(found[-2]) and _distances(pose, found[-1]).min(initial=1.0) < _SAME:
                self.solutions = found[-1]
                return
        raise LostPaths("this geometry", [len(f) for f in found], "the same poses on two ways to it")

    @staticmethod
    def _follow(stations: list[Platform], points: Array) -> tuple[Array, Array]:
        """Ends of the paths through the stations, and the t each came to on the last leg: 0 if it stuck before."""
        reached = np.ones(len(points))
        for here, there in pairwise(stations):
            before = reached
            points, reached = track(here.path_to(there), points, _ROTATION)
            reached = np.where(before == 1.0, reached, 0.0)
        return points, reached

    @property
    def count(self) -> int:
        """How many complex poses a generic set of leg lengths has."""
        return len(self.solutions)

    def ends(self, squares: Array) -> Array:
        """(6,) squared lengths -> (count, 8), all complex solutions; a multiple one appears that often.

        Raises:
            LostPaths: the ends could not be certified.
        """
        target = Platform(self.start.base, self.start.platform, squares)
        rng = np.random.default_rng(6)
        stations = [self.start, target]
        for _ in range(_ROUTES):
            ends, reached = self._follow(stations, self.solutions)
            refined, last = refine(target.system(), ends, _ROTATION)
            regular = last < _REGULAR
            ends = np.where(regular[:, None], refined, ends)
            if reached.min() > _NEAR_END and _certified(ends, regular):
                return ends
            around = self.start._replace(squares=3.0 * _complex(rng, 6))
            stations = [self.start, around, target]
        raise LostPaths("these leg lengths", f"{_ROUTES} ways with a lost path", "one that loses none")

    def system(self, squares: Array) -> Array:
        """(6,) squared lengths -> (7, 8, 8) the quadrics that `ends` solves."""
        return Platform(self.start.base, self.start.platform, squares).system().real


def turned_real(points: Array) -> tuple[Array, Array]:
    """(k, 8) points, each turned by a phase to make e . e + f . f real, and the norm (k,) of what stays imaginary."""
    turned = points * np.exp(-0.5j * np.angle(np.sum(points * points, axis=1)))[:, None]
    return turned, np.linalg.norm(turned.imag, axis=1)


def distinct(points: Array) -> Array:
    """(k, n) unit points, each solution once."""
    near = _distances(points, points) < _SAME
    return points[[not near[i, :i].any() for i in range(len(points))]]


def _certified(ends: Array, regular: Array) -> bool:
    """No regular end twice, and with each its complex conjugate (the target being real)."""
    kept = ends[regular]
    once = np.sum(_distances(kept, kept) < _SAME, axis=1) == 1
    paired = np.sum(_distances(kept, kept.conj()) < _SAME, axis=1) == 1
    return bool(np.all(once & paired))


def _distances(x: Array, y: Array) -> Array:
    """(k, l) distances of unit points, whatever their phases."""
    inner = x.conj() @ y.T
    size = np.abs(inner)
    phase = np.where(size > 0.0, inner / np.where(size > 0.0, size, 1.0), 1.0)
    result: Array = np.linalg.norm(x[:, None, :] * phase[..., None] - y[None], axis=-1)
    return result


def _regular(target: Platform, ends: Array) -> Array:
    """Those of the ends that are regular displacements (K != 0), refined."""
    refined, last = refine(target.system(), ends, _ROTATION)
    e = refined[:, :_ROTATION]
    size = np.abs(np.sum(e * e, axis=1)) / np.sum(np.abs(e) ** 2, axis=1)
    result: Array = refined[(last < _REGULAR) & (size > _FINITE)]
    return result


def _complex(rng: np.random.Generator, *shape: int) -> Array:
    return rng.normal(size=shape) + 1j * rng.normal(size=shape)


def _random_platform(rng: np.random.Generator) -> Platform:
    return Platform(_complex(rng, 6, 3), _complex(rng, 6, 3), 3.0 * _complex(rng, 6))


def _with_a_pose(rng: np.random.Generator, base: Array, platform: Array) -> tuple[Platform, Array]:
    """A platform whose leg lengths follow from a random complex displacement, and that displacement (1, 8)."""
    e, f = _complex(rng, 4), _complex(rng, 4)
    f -= e * (e @ f) / (e @ e)
    x = np.concatenate([e, f])
    at_zero = leg_quadrics(base, platform, np.zeros(6))
    squares = np.einsum("i,kij,j->k", x, at_zero, x) / (e @ e)
    return Platform(base, platform, squares), x[None] / np.linalg.norm(x)
