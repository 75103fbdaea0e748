"""Check that a path can be passed at speed.

A path that is built from smooth shapes knows where its tangent jumps. Any other path is sampled, at its own scale. If
the tangent's change over an interval differs from the integral of its derivative, the interval is halved. For a curve,
even a sharp one, the two agree at last. For a jump they never do, and the narrow interval that is left shows its place.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from kinematics import Array
from trajectory.errors import RoughPath
from trajectory.paths.path import Path, places

_UNIT = 1e-9  # how far from 1 the length of the tangent may be
_JUMP = 0.01  # of a tangent's size: how far its change may be from the trapezoid of its derivative
_PARTS = 8  # of each piece between two knots, at first
_INTERVALS = 1000  # of the whole path at first, at least
_NARROWEST = 64 * np.finfo(float).eps  # of the length: narrower intervals are not halved


def require_smooth(path: Path) -> None:
    """Check that the tangent of a path jumps nowhere inside.

    Args:
        path: any path. If it knows its stops, no samples are needed.

    Raises:
        RoughPath: it has a stop inside, its tangent jumps or is not of unit length, or it is not a number somewhere.
    """
    if path.stops is None:
        _require_no_jump(path)
    for stop in path.stops or ():
        before, after = (path.evaluate(np.array(s), 1)[1] for s in (np.nextafter(stop, 0.0), stop))
        raise RoughPath(stop, "a jump of the tangent", float(np.linalg.norm(after - before)), 0.0, path.waypoint(stop))


class _Samples(NamedTuple):
    """Arc lengths (k,), and the first two derivatives there, (k, n) each."""

    s: Array
    first: Array
    second: Array


def _require_no_jump(path: Path) -> None:
    inside = np.linspace(0.0, 1.0, _PARTS, endpoint=False)
    knots = np.array(path.knots)
    within_pieces = knots[:-1, None] + np.diff(knots)[:, None] * inside
    s = np.unique(np.concatenate([np.linspace(0.0, path.length, _INTERVALS + 1), within_pieces.ravel()]))
    samples = _sampled(path, s)
    sizes = np.abs(samples.first).max(axis=0)
    sizes[: places(path.pose_names)] = 1.0
    low, high = (_Samples(*(v[k] for v in samples)) for k in (slice(None, -1), slice(1, None)))
    while low.s.size:
        change = high.first - low.first
        explained = (high.s - low.s)[:, None] * (low.second + high.second) / 2
        open_ = (np.abs(change - explained) > _JUMP * sizes).any(axis=-1)
        narrow = open_ & (high.s - low.s <= _NARROWEST * path.length)
        if narrow.any():
            k = int(np.flatnonzero(narrow)[0])
            _refuse(path, float(low.s[k]), change[k], sizes)
        low, high = (_Samples(*(v[open_] for v in side)) for side in (low, high))
        middle = _sampled(path, 0.5 * low.s + 0.5 * high.s)
        low, high = _after(low, middle), _after(middle, high)


def _sampled(path: Path, s: Array) -> _Samples:
    """Samples whose tangent is one by arc length; where the tool point stands still, some angle must change."""
    _, first, second = path.evaluate(s, 2)
    size = np.linalg.norm(first[:, : places(path.pose_names)], axis=-1)
    defect = np.where((size == 0.0) & (first != 0.0).any(axis=-1), 0.0, np.abs(size - 1.0))
    defect = defect + 0.0 * (first + second).sum(axis=-1)  # what is not a number stays so
    if (bad := ~(defect <= _UNIT)).any():
        k = int(np.argmax(np.where(np.isnan(defect), np.inf, np.where(bad, defect, 0.0))))
        raise RoughPath(float(s[k]), "the tangent's length minus 1", float(defect[k]), _UNIT)
    return _Samples(s, first, second)


def _after(first: _Samples, second: _Samples) -> _Samples:
    return _Samples(*(np.concatenate(pair) for pair in zip(first, second, strict=True)))


def _refuse(path: Path, at: float, change: Array, sizes: Array) -> None:
    count = places(path.pose_names)
    if np.linalg.norm(change[:count]) > _JUMP:
        raise RoughPath(at, "a jump of the tangent", float(np.linalg.norm(change[:count])), _JUMP)
    k = count + int(np.argmax(np.abs(change[count:]) / sizes[count:]))
    what = f"a jump of d {path.pose_names[k]} / ds [rad/m]"
    raise RoughPath(at, what, float(abs(change[k])), _JUMP * float(sizes[k]))
