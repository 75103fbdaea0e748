"""The law `free`: path and timing together. The tool is free outside the clearance arch.

The pose's third derivative is constant in each of equal intervals of time. IPOPT finds it together with the duration
(`interval_nlp`). All limits are kept at samples of each interval, and jerk on both sides of every knot. `repair`
corrects a small excess between the samples. With a larger one the motion is sought again on shorter intervals. The
search starts from the time-optimal law on the cycle's own path.
"""

from __future__ import annotations

import math
from functools import lru_cache

import casadi as ca
import numpy as np

from kinematics import Array, Mechanism, derivatives_along, friction, torques
from trajectory.errors import TimingFailed
from trajectory.laws import LAWS
from trajectory.laws.free.interval_nlp import IntervalConstraints, IntervalProgram
from trajectory.laws.toppra import time_optimal
from trajectory.limits import Cap, Constraint, Disc, Limits, Linear, Place, Squared, SymbolicMotion, Third
from trajectory.motions import PoseSpline
from trajectory.paths import TOLERANCE, Arch, Path, PoseBounds, bezier_points, places, require_poses_of

_AT_INSTANTS = (Cap, Linear, Disc)
_AT = (0.0, 0.5)  # places in an interval where the limits of speed, acceleration and torque are required
_ARCH_AT = 480  # about so many instants where the tool stays outside the arch
_PROOF = 100_000  # parts of the motion; over each of them the arch is proved to be kept
_FINER = 2  # times as many intervals, where they are too wide
_CLOSER = 8  # parts of an interval; at their ends the limits are measured again
_NEARLY = 5e-3  # excess over a limit, relative to it, that the repair corrects; it corrects none of a position
_SLOWER = (1.1, 1.15, 1.3)  # durations of the guess over the time-optimal law; they are tried in turn
_ROOM = 0.25  # times the path's extent: the pose may leave the path's box by this


class _TooWide(TimingFailed):
    """What was found on these intervals does not hold between the samples. Shorter ones may help."""


def free_motion(
    robot: Mechanism,
    path: Path,
    limits: Limits,
    payload: float,
    intervals: int = 60,
    within: PoseBounds | None = None,
) -> PoseSpline:
    """The fastest jerk-limited motion from one end of a cycle to the other, outside its arch.

    Args:
        robot: any mechanism with the path's kind of pose.
        path: an Adept cycle or its way back. It gives the ends, the arch and the guess.
        limits: limits of joints and tool, with jerk; all are kept.
        payload: mass at the tool [kg].
        intervals: number of equal intervals of time at the start.
        within: bounds of every pose at every instant; None allows poses near the path.

    Raises:
        InvalidValue: the path or the pose is of another kind, or there is no jerk limit.
        TimingFailed: the solver did not converge, or the motion breaks a limit or enters the arch between the samples,
            on twice as many intervals too.
    """
    require_poses_of(robot, path)
    LAWS["free"].require_kept(limits)
    arch = Arch.of(path)
    try:
        return _on_intervals(robot, path, arch, limits, payload, intervals, within)
    except _TooWide:
        return _on_intervals(robot, path, arch, limits, payload, _FINER * intervals, within)


def _on_intervals(
    robot: Mechanism,
    path: Path,
    arch: Arch,
    limits: Limits,
    payload: float,
    intervals: int,
    within: PoseBounds | None,
) -> PoseSpline:
    """The fastest motion on `intervals` intervals.

    Raises:
        TimingFailed: the solver did not converge; as `_TooWide`, the arch or a limit needs shorter intervals.
    """
    program = _program(robot, arch, limits, payload, intervals, within)
    guess, end, duration = _guess(robot, path, limits, payload, intervals)
    pose = guess[:, : len(robot.pose_names)]
    room = _ROOM * np.ptp(pose, axis=0) + _ROOM * np.ptp(pose[:, : places(path.pose_names)], axis=0).max()
    low, high = pose.min(axis=0) - room, pose.max(axis=0) + room
    if within is not None:
        least, most = within.box()
        low, high = np.maximum(low, least), np.minimum(high, most)
    for slower in _SLOWER:
        answer = program.solve(guess, end, low, high, slower * duration)
        if answer.status == "Solve_Succeeded":
            break
    asked = {**limits.as_dict(), "payload": payload, "intervals": intervals, "path": path.as_dict()}
    if answer.status != "Solve_Succeeded":
        raise TimingFailed("free", asked, f"IPOPT ended with {answer.status}")
    times = np.linspace(0.0, answer.duration, intervals + 1)
    (ends,) = path.evaluate(np.array([0.0, path.length]), 0)
    p, v, a, j = (r / answer.duration**order for order, r in enumerate(np.split(answer.start, 4, axis=1)))
    motion = PoseSpline("free", times, p, v, a, j, ends)
    _require_clear(arch, motion)
    _require_kept(robot, limits, payload, motion, asked)
    return motion


def _require_kept(
    robot: Mechanism, limits: Limits, payload: float, motion: PoseSpline, asked: dict[str, object]
) -> None:
    """Raise `_TooWide` if a limit of instants is broken at closer instants than those where it is required."""
    _, at = motion.within(np.linspace(0.0, 1.0, _CLOSER + 1))
    rates = [rate.reshape(-1, rate.shape[-1]).T for rate in (at.pose, at.velocity, at.acceleration, at.jerk)]
    placed, limited, jerks, _ = _limited(robot, limits, payload)
    for function, inputs, allowed in ((placed, 3, 1.0), (limited, 3, 1.0 + _NEARLY), (jerks, 4, 1.0 + _NEARLY)):
        used = np.abs(np.array(function.map(rates[0].shape[1])(*rates[:inputs]))).max(initial=0.0)
        if not used <= allowed:  # NaN, out of reach, is none
            raise _TooWide("free", asked, f"between its instants the motion uses {used:.4g} times a limit")


def _require_clear(arch: Arch, motion: PoseSpline) -> None:
    """Raise `_TooWide` if the tool may enter the arch between the samples."""
    parts = math.ceil(_PROOF / (motion.times.size - 1))
    half = np.diff(motion.times)[:, None, None] / (2 * parts)
    _, at = motion.within((np.arange(parts) + 0.5) / parts)
    away = half * (np.abs(at.velocity) + half * (np.abs(at.acceleration) + half * np.abs(at.jerk)))
    if not arch.kept_clear(at.pose[..., :3].reshape(-1, 3), away[..., :3].reshape(-1, 3)):
        asked = {"intervals": motion.times.size - 1, "tolerance of the arch over the blend": TOLERANCE}
        raise _TooWide("free", asked, "the tool enters the clearance arch between the samples")


def _guess(robot: Mechanism, path: Path, limits: Limits, payload: float, intervals: int) -> tuple[Array, Array, float]:
    """A guess from toppra's law: the intervals' starts (k, 4 n) and the end (3 n,), by t / T, and the duration."""
    plain = limits.without(*LAWS["toppra"].refuses, Place)
    law = time_optimal(robot, path, plain, payload, 1000)
    motion = law.at(np.linspace(0.0, law.duration, intervals + 1))
    velocity = motion.velocity * law.duration
    acceleration = np.gradient(velocity, 1.0 / intervals, axis=0)
    state = np.hstack([motion.pose, velocity, acceleration])
    n = motion.pose.shape[1]
    state[[0, -1], :n] = path.evaluate(np.array([0.0, path.length]), 0)[0]
    state[[0, -1], n:] = 0.0
    jerk = np.diff(state[:, 2 * n :], axis=0) * intervals
    return np.hstack([state[:-1], jerk]), state[-1], law.duration


@lru_cache(maxsize=4)
def _program(
    robot: Mechanism, arch: Arch, limits: Limits, payload: float, intervals: int, within: PoseBounds | None
) -> IntervalProgram:
    return IntervalProgram(_constraints(robot, arch, limits, payload, intervals, within), intervals)


def _constraints(
    robot: Mechanism, arch: Arch, limits: Limits, payload: float, intervals: int, within: PoseBounds | None
) -> IntervalConstraints:
    n = len(robot.pose_names)
    start, duration = ca.SX.sym("start", 4 * n), ca.SX.sym("duration")
    placed, limited, jerk, squares = _limited(robot, limits, payload)
    rows: list[ca.SX] = []
    mean = ca.SX(0, 1)
    low: list[float] = []
    high: list[float] = []

    def add(expression: ca.SX, least: float | Array, most: float | Array) -> None:
        rows.append(expression)
        low.extend(np.broadcast_to(least, expression.numel()).tolist())
        high.extend(np.broadcast_to(most, expression.numel()).tolist())

    for share in (*_AT, 1.0):
        state = _within(start, share / intervals, n)
        rates = [rate / duration**order for order, rate in enumerate(state)]
        if share < 1.0:
            add(ca.vertcat(placed(*rates[:3]), limited(*rates[:3])), -1.0, 1.0)
            square = squares(*rates[:3]) / (len(_AT) * intervals)
            mean = square if not mean.numel() else mean + square
        add(jerk(*rates), -1.0, 1.0)
    parts = math.ceil(_ARCH_AT / intervals)
    for part in range(parts):
        pose = _within(start, part / (parts * intervals), n)[0]
        *sides, floor = arch.sides(pose[0], pose[1], pose[2])
        add(arch.outside(*sides), 1.0, np.inf)
        add(floor, 0.0, np.inf)
    if within is not None:
        add(*within.rows(bezier_points(ca.vertsplit(start, n), 1.0 / intervals)))
    return IntervalConstraints(start, duration, ca.vertcat(*rows), np.array(low), np.array(high), mean)


def _within(start: ca.SX, t: float, n: int) -> list[ca.SX]:
    """The pose and its derivatives by t / T, a time t / T after an interval's start."""
    p, v, a, j = (start[k * n : (k + 1) * n] for k in range(4))
    return [p + t * (v + t * (a / 2 + t * j / 6)), v + t * (a + t * j / 2), a + t * j, j]


@lru_cache(maxsize=4)
def _limited(robot: Mechanism, limits: Limits, payload: float) -> tuple[ca.Function, ...]:
    """Values to keep between -1 and 1: of the place, of the motion, of the joints' jerk; and squares of the torque."""
    model = robot.model()
    rates = velocity, acceleration, jerk = [
        ca.SX.sym(name, model.pose.shape[0]) for name in ("velocity", "acceleration", "jerk")
    ]
    joints, first, second, third = derivatives_along(model.drives @ model.inverse, model.pose, rates)
    tau = torques(robot, payload, velocity, acceleration) + friction(robot, first)
    tool = places(robot.pose_names)
    motion = SymbolicMotion((joints, first, second, third), velocity[:tool], acceleration[:tool], tau)

    def kept(*kinds: type[Constraint]) -> ca.SX:
        return ca.vertcat(ca.SX(0, 1), *(one.symbolic(motion, limits) for one in limits if issubclass(one.kind, kinds)))

    rows = kept(Place), kept(*_AT_INSTANTS), kept(Third), kept(Squared) ** 2
    fixed = ca.SX(robot.geometry.vector())
    inputs = [model.pose, velocity, acceleration]
    placed, limited, jerks, squares = (ca.substitute(v, model.geometry, fixed) for v in rows)
    return (
        ca.Function("placed", inputs, [placed], {"cse": True}),
        ca.Function("limited", inputs, [limited], {"cse": True}),
        ca.Function("jerk", [*inputs, jerk], [jerks], {"cse": True}),
        ca.Function("squares", inputs, [squares], {"cse": True}),
    )
