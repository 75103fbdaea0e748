"""The law `free`: path and timing together, the tool free outside the clearance arch, all limits kept, jerk among them.

The pose's third derivative is constant in each of equal intervals of time; IPOPT finds it together with the duration
(`interval_nlp`). Limits are kept at samples of each interval, jerk on both sides of every knot; what is left between
the samples is for `repair`. The start is the time-optimal law on the cycle's own path.
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

_AT_INSTANTS = (Place, Cap, Linear, Disc)
_AT = (0.0, 0.5)  # where in an interval speed, acceleration, torque are kept
_ARCH_AT = 480  # instants, about, at which the tool stays outside the arch: a tenth of a blend apart at most
_PROOF = 100_000  # parts of the motion, over each of which the arch is proved to be kept
_FINER = 2  # times as many intervals, where they are too wide
_CLOSER = 8  # instants of an interval at which the limits are looked at again
_NEARLY = 5e-3  # of a limit, that the repair mends
_SLOWER = (1.1, 1.15, 1.3)  # durations of the guess over the time-optimal law, until one leads to an answer
_ROOM = 0.25  # of the path's extent, by which the pose may leave the path's box


def free_motion(
    robot: Mechanism,
    path: Path,
    limits: Limits,
    payload: float,
    intervals: int = 60,
    within: PoseBounds | None = None,
) -> PoseSpline:
    """The fastest jerk-limited motion from a cycle's one end to the other, outside its arch.

    Args:
        robot: any mechanism with the path's kind of pose.
        path: an Adept cycle or its way back; its ends, its arch and the guess come from it.
        limits: of joints and tool, with jerk; all are kept.
        payload: mass at the tool [kg].
        intervals: of equal time, to start with.
        within: what every pose stays in, at every instant; anywhere about the path when None.

    Raises:
        InvalidValue: another kind of path or pose, or no limit of jerk.
        TimingFailed: the solver did not converge.
    """
    require_poses_of(robot, path)
    LAWS["free"].require_kept(limits)
    arch = Arch.of(path)
    try:
        return _on_intervals(robot, path, arch, limits, payload, intervals, within)
    except TimingFailed:
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
    """The fastest motion on so many intervals.

    Raises:
        TimingFailed: the solver did not converge, or the tool or a limit asks for closer intervals.
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
    if (used := _between(robot, limits, payload, motion)) > 1.0 + _NEARLY:
        raise TimingFailed("free", asked, f"between its instants it uses {used:.4g} of a limit")
    return motion


def _between(robot: Mechanism, limits: Limits, payload: float, motion: PoseSpline) -> float:
    """The most that a motion uses of a limit at instants closer than those at which it is kept."""
    _, at = motion.within(np.linspace(0.0, 1.0, _CLOSER + 1))
    rates = [rate.reshape(-1, rate.shape[-1]).T for rate in (at.pose, at.velocity, at.acceleration)]
    limited, _, _ = _limited(robot, limits, payload)
    return float(np.abs(np.array(limited.map(rates[0].shape[1])(*rates))).max())


def _require_clear(arch: Arch, motion: PoseSpline) -> None:
    """Raise TimingFailed where the tool may cut the arch between the samples."""
    parts = math.ceil(_PROOF / (motion.times.size - 1))
    half = np.diff(motion.times)[:, None, None] / (2 * parts)
    _, at = motion.within((np.arange(parts) + 0.5) / parts)
    away = half * (np.abs(at.velocity) + half * (np.abs(at.acceleration) + half * np.abs(at.jerk)))
    if not arch.kept_clear(at.pose[..., :3].reshape(-1, 3), away[..., :3].reshape(-1, 3)):
        asked = {"intervals": motion.times.size - 1, "tolerance of the arch, of the blend": TOLERANCE}
        raise TimingFailed("free", asked, "the tool cuts the arch between the samples")


def _guess(robot: Mechanism, path: Path, limits: Limits, payload: float, intervals: int) -> tuple[Array, Array, float]:
    """From toppra's law: the intervals' starts (k, 4 n) and the end (3 n,), by t / T, and its duration."""
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
    limited, jerk, squares = _limited(robot, limits, payload)
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
            add(limited(*rates[:3]), -1.0, 1.0)
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
def _limited(robot: Mechanism, limits: Limits, payload: float) -> tuple[ca.Function, ca.Function, ca.Function]:
    """What is kept between -1 and 1 at a pose, velocity and acceleration; the joints' jerk; squares of the torque."""
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

    instants, jerks, squares = kept(*_AT_INSTANTS), kept(Third), kept(Squared) ** 2
    fixed = ca.SX(robot.geometry.vector())
    inputs = [model.pose, velocity, acceleration]
    limited, jerks, squares = (ca.substitute(v, model.geometry, fixed) for v in (instants, jerks, squares))
    return (
        ca.Function("limited", inputs, [limited], {"cse": True}),
        ca.Function("jerk", [*inputs, jerk], [jerks], {"cse": True}),
        ca.Function("squares", inputs, [squares], {"cse": True}),
    )
