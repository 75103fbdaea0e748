"""The time-optimal law on a fixed path by reachability analysis, as in toppra: s'' is constant between gridpoints.

The rows of `path_rows` are linear in u = s'' and x = s'^2, and x is linear in s between gridpoints. They are kept at
both ends of each interval (the interpolation scheme). The law finds its own grid. The path's knots are in the grid. An
interval is halved if its middle exceeds a limit or wastes time, until little is left. `verify` measures the law between
the gridpoints, and shares nothing with this code.

Viscous friction is linear in sqrt(x), so this law refuses it. It also refuses limits that it cannot keep, such as a
jerk
limit: its s'' steps from one extreme to the other.
"""

from __future__ import annotations

import math

import numpy as np

from kinematics import Array, InvalidField, InvalidValue, Mechanism
from trajectory.errors import TimingFailed
from trajectory.laws import LAWS
from trajectory.laws.at_rest import require_held, require_possible
from trajectory.laws.toppra.path_rows import PathRows, path_rows
from trajectory.laws.toppra.reachability import fastest_profile
from trajectory.limits import Limits
from trajectory.motions import TimedPath, TimeLaw
from trajectory.paths import Path, require_poses_of, require_smooth

INTERVALS = 1000
_LEAST_IN_PIECE = 8  # intervals between two knots of the path, at first
_EXCESS = 1e-4  # over a limit in the middle of an interval that is not halved
_BESIDES, _OVER = (0.25, 0.75), 1e-3  # where else an interval is looked at last, and what it may be over a limit there
_UNUSED = 5e-4  # mean over the duration of the share of the limits that is left unused: twice what time may be lost
_MOST = 40_000  # points on which time is still gained; where more were needed, more may be left unused
_KEPT = 0.5  # of that: what the intervals that are not halved may leave
_GRADING = 4.0  # times as long as its neighbour an interval may be: its middle alone does not show what it exceeds
_TOGETHER = 50  # points, of which the one is named where the weight is furthest beyond a torque
_ROUNDS = 40  # of halving


def time_optimal(robot: Mechanism, path: Path, limits: Limits, payload: float, intervals: int = INTERVALS) -> TimedPath:
    """The fastest law from rest to rest on the path.

    Args:
        robot: any mechanism with the path's kind of pose.
        path: smooth, without a stop inside.
        limits: limits of joints and tool, without jerk, speed-torque line and RMS torque.
        payload: mass at the tool [kg].
        intervals: about so many intervals at the start; the law adds more if needed.

    Raises:
        InvalidValue: a limit that it cannot keep, viscous friction with limited torque, a negative payload, no
            interval, or another kind of pose.
        RoughPath: the path has a stop, a cusp or a kink inside.
        UnreachablePose: a limb cannot reach a pose of the path; the message names the limb and its margin.
        PathBeyondLimit: a position is outside its range, or the weight needs more torque than a drive has where the
            robot must hold it.
        TimingFailed: there is no law within the limits.
    """
    _require_kept(robot, limits, payload, intervals)
    require_poses_of(robot, path)
    require_smooth(path)
    s = _first_grid(path, intervals)
    robot.require_reachable(path.evaluate(s, 0)[0])
    require_possible(robot, path, limits, payload, s)
    asked = {**limits.as_dict(), "payload": payload, "path": path.as_dict()}
    rows = path_rows(robot, path, limits, payload, s)
    rows.friction[[0, -1]] = 0.0  # at rest
    for _ in range(_ROUNDS):
        x, blocked = _profile(rows, asked)
        if blocked >= 0:
            _refuse(robot, path, limits, payload, rows.s[blocked:], asked)
        middle = path_rows(robot, path, limits, payload, 0.5 * rows.s[1:] + 0.5 * rows.s[:-1])
        open_ = _unsettled(rows, middle, x)
        if not open_.any():
            for share in _BESIDES:
                s = (1.0 - share) * rows.s[:-1] + share * rows.s[1:]
                open_ |= _used(rows, path_rows(robot, path, limits, payload, s), x, share) > 1.0 + _OVER
        if not open_.any():
            return TimedPath(path, TimeLaw.constant_acceleration("toppra", rows.s, np.sqrt(x)))
        rows = rows.merged(middle.chosen(open_))
    raise TimingFailed("toppra", asked, f"no settled answer on {rows.s.size} points")


def _require_kept(robot: Mechanism, limits: Limits, payload: float, intervals: int) -> None:
    LAWS["toppra"].require_kept(limits)
    viscous = robot.inertia.drive_train.viscous
    if any(limit.of_torque for limit in limits) and np.any(np.asarray(viscous) > 0.0):
        raise InvalidField(
            "DriveTrain", "viscous", viscous, "0: its limits are linear in s'^2, not s'", "for the toppra law"
        )
    if intervals < 1:
        raise InvalidValue("intervals of the toppra law", intervals, "at least 1")
    if not (math.isfinite(payload) and payload >= 0.0):
        raise InvalidValue("payload", payload, "a finite mass >= 0 kg")


def _first_grid(path: Path, intervals: int) -> Array:
    """Evenly over the whole, and some in each piece between two knots."""
    knots = np.array(path.knots)
    counts = np.maximum(np.ceil(np.diff(knots) / path.length * intervals), _LEAST_IN_PIECE).astype(int)
    edges = [np.linspace(a, b, n, endpoint=False) for a, b, n in zip(knots[:-1], knots[1:], counts, strict=True)]
    return np.append(np.concatenate(edges), knots[-1])


def _profile(rows: PathRows, asked: dict[str, object]) -> tuple[Array, int]:
    """(k,) the fastest x on a grid [m^2/s^2], and the interval that no motion passes, or -1."""
    if not all(np.isfinite(v).all() for v in rows):
        raise TimingFailed("toppra", asked, "the path's coefficients are not finite: the path has a singular pose")
    x = np.empty(rows.s.size)
    rows_ = (rows.a, rows.b, rows.c, rows.friction)
    return x, fastest_profile(np.diff(rows.s), rows_, rows.highest, x)


def _refuse(robot: Mechanism, path: Path, limits: Limits, payload: float, s: Array, asked: dict[str, object]) -> None:
    """Raise for the first place after s[0] that no motion passes. Where the robot can hold still, it can also go on."""
    for some in np.array_split(s, max(1, s.size // _TOGETHER)):
        require_held(robot, path, limits, payload, some)
    pose = ", ".join(f"{v:.6g}" for v in path.evaluate(s[0], 0)[0])
    near = "" if (waypoint := path.waypoint(float(s[0]))) is None else f", nearest to waypoint {waypoint}"
    raise TimingFailed("toppra", asked, f"no motion within the limits passes s = {s[0]:.6g} m, pose ({pose}){near}")


def _used(rows: PathRows, inside: PathRows, x: Array, share: float) -> Array:
    """(k,) the most of a limit that is used in each interval, at a share of its length, whose rows are `inside`."""
    u, there = (np.diff(x) / (2 * np.diff(rows.s)))[:, None], ((1.0 - share) * x[:-1] + share * x[1:])[:, None]
    without = inside.a * u + inside.b * there + inside.c
    used = np.max(
        [np.abs(without + f).max(axis=-1, initial=0.0) for f in (rows.friction[:-1], rows.friction[1:])], axis=0
    )
    result: Array = np.maximum(used, there[:, 0] / inside.highest)
    return result


def _unsettled(rows: PathRows, middle: PathRows, x: Array) -> Array:
    """(k,) the intervals in whose middle a limit is exceeded, or time is lost as none is used up."""
    lengths, used, speed = np.diff(rows.s), _used(rows, middle, x, 0.5), np.sqrt(x)
    lasting = 2 * lengths / (speed[1:] + speed[:-1])
    unused, exceeded = np.maximum(1.0 - used, 0.0) * lasting / lasting.sum(), used > 1.0 + _EXCESS
    exceeded |= lengths > _GRADING * np.minimum(np.append(lengths[1:], np.inf), np.append(np.inf, lengths[:-1]))
    if unused.sum() <= _UNUSED or x.size > _MOST:
        return exceeded
    order = np.argsort(unused)
    lost = np.empty(unused.size)
    lost[order] = np.cumsum(unused[order])
    return exceeded | (lost > _KEPT * _UNUSED)
