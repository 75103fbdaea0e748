"""copp-py's TOPP2, without the jerk limit, and TOPP3, with it, on exact derivatives and exact torque rows.

https://github.com/TOPP-THU/copp, open-source edition. Its solver's tolerances are absolute, so it gets the problem
without units: arc length over the path's, time over TOPP2's, each row over its limit. TOPP3 is linearised about TOPP2's
answer, and then about its own last one, as its manual recommends, until the time stands.
"""

from __future__ import annotations

import copp_py as copp
import numpy as np

from kinematics.arrays import Array
from tests.bench.timing.cases import Case
from tests.bench.timing.samples import sampled, smooth_law
from trajectory import TimedPath, TimeLaw, TimingFailed

STATIONS = 1001
_ROUNDS = 20
_PARTS = 4  # of each interval
_CLOSE = 1e-5  # relative: the time stands


def topp2(case: Case, stations: int = STATIONS) -> TimedPath:
    """Time-optimal without the jerk limit."""
    problem = _Problem(case, stations, 1.0)
    speed = np.sqrt(problem.topp2()) * case.path.length
    return TimedPath(case.path, TimeLaw.constant_acceleration("copp TOPP2", problem.s * case.path.length, speed))


def topp3(case: Case, stations: int = STATIONS, at_rest: int = 1) -> TimedPath:
    """With the jerk limit, by its conic solver; `at_rest` intervals of constant jerk at both ends."""
    problem = _Problem(case, stations, topp2(case, stations).duration)
    jerk = problem.rows(case.limit("jerk"), 3)
    problem.robot.add_jerk_limits(jerk, -jerk, start_idx_s=0)
    solver, x, u, last = copp.solver.topp3_socp, problem.topp2(), None, np.inf
    for _ in range(_ROUNDS):
        found = solver.solve(
            solver.Problem(problem.robot.constraints, x, num_stationary_max=at_rest, b_linearization=u)
        )
        duration, times = copp.interpolation.s_to_t_topp3(problem.s, found)
        if abs(last - duration) < _CLOSE * duration:
            times, u = _within(problem.s, found, times)
            unit = problem.unit
            return smooth_law(case, "copp TOPP3", times * unit, u * case.path.length / unit**2)
        x, u, last = found.a, found.b, duration
    raise TimingFailed("copp TOPP3", {"stations": stations}, f"the time does not stand after {_ROUNDS} rounds")


def _within(s: Array, found: copp.interpolation.Profile3rd, times: Array) -> tuple[Array, Array]:
    """Its own interpolation: s'' is linear in s between stations, and in time next to the ends, where it rests."""
    first, last = found.num_stationary
    inner = slice(first, times.size - last)
    steps = np.diff(times[inner])
    parts = times[inner][:-1, None] + steps[:, None] * np.arange(_PARTS) / _PARTS
    dense = np.concatenate([times[:first], parts.ravel(), times[times.size - last - 1 :]])
    at = copp.interpolation.t_to_s_topp3_samples(s, found, times, dense)
    u = np.interp(at, s, found.b)
    u[:first], u[u.size - last :] = found.b[:first], found.b[times.size - last :]
    return dense, u


class _Problem:
    """Its constraints at stations of equal arc length."""

    def __init__(self, case: Case, stations: int, unit: float) -> None:
        """`unit` of time [s]."""
        self.s, self.unit, length = np.linspace(0.0, 1.0, stations), unit, case.path.length
        at = sampled(case, self.s * length)
        q, count = at.joints, at.a.shape[1]
        self.sizes = np.abs(q.first).max(axis=0) * length  # of the joints' way
        self.robot = copp.Robot(count, capacity=stations)
        self.robot.append_s(self.s)
        derivatives = (d * length**k / self.sizes for k, d in enumerate(q))
        q, first, second, third = derivatives
        self.robot.set_q(q, first, second, 0, dddq=third)
        speed = self.rows(case.limit("speed"), 1)
        self.robot.add_velocity_limits(speed, -speed, start_idx_s=0)
        if (acceleration := case.limit("acceleration")) is not None:
            acceleration = self.rows(acceleration, 2)
            self.robot.add_acceleration_limits(acceleration, -acceleration, start_idx_s=0)
        if (torque := case.limit("torque")) is not None:
            a, b, c = at.a / torque * length / unit**2, at.b / torque * (length / unit) ** 2, at.c / torque
            self.robot.constraints.add_constraint_2nd(b, a, 1.0 - c, 0)
            self.robot.constraints.add_constraint_2nd(-b, -a, 1.0 + c, 0)

    def rows(self, limit: Array | None, order: int) -> Array:
        """A limit of the joints' derivative of this order, without units."""
        assert limit is not None
        return limit * self.unit**order / self.sizes

    def topp2(self) -> Array:
        """(k,) s'^2."""
        problem = copp.solver.topp2_ra.Problem(self.robot.constraints, idx_s_interval=(0, self.s.size - 1))
        return copp.solver.topp2_ra.solve(problem)
