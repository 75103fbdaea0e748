"""Failures that nothing tells of: each passes the check that one would make, and the verifier finds it."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import pytest
from toppra.algorithm import ParameterizationReturnCode

from kinematics import Heli4
from tests.bench.timing.cases import Case, reference
from tests.bench.timing.toppra_peer import ExactPath, defaults, problem_of, solved, spline
from trajectory import (
    AdeptCycle,
    Limits,
    Path,
    Reversed,
    RoughPath,
    RoundedPath,
    TimedPath,
    TimeLaw,
    Verification,
    motion_of,
    pose_motion,
    repair,
    require_smooth,
    time_optimal,
    verify,
)


@pytest.fixture(scope="module")
def case() -> Case:
    """The reference, without its jerk limit."""
    found = reference()
    return replace(found, limits=found.without_jerk)


@pytest.fixture(scope="module")
def right(case: Case) -> TimedPath:
    """What keeps every limit in that case."""
    return repair(case.robot, on(case), case.limits, case.payload).motion


def on(case: Case) -> TimedPath:
    return time_optimal(case.robot, case.path, case.limits, case.payload)


def by_toppra(case: Case, intervals: int | None = None) -> TimedPath:
    """Timed by toppra on the exact path, which it says went well."""
    problem = problem_of(case, ExactPath(case.path), intervals)
    timed = solved(case, problem)
    assert problem.problem_data.return_code == ParameterizationReturnCode.Ok
    return timed


def at_gridpoints(case: Case, timed: TimedPath) -> float:
    """The naive check: the largest peak over limit on both sides of the law's own gridpoints."""
    _, along = timed.law.within(np.array([0.0, 1.0]))
    motion = motion_of(case.robot, pose_motion(timed.path, along), case.payload)
    used = (motion.torque / case.limit("torque"), motion.joints.first / case.limit("speed"))
    return max(float(np.abs(ratio).max()) for ratio in used)


def found_by_verifier(case: Case, timed: TimedPath) -> Verification:
    return verify(case.robot, timed, case.limits, case.payload)


def test_a_right_law_passes(case: Case, right: TimedPath) -> None:
    assert found_by_verifier(case, right).ok


def test_a_default_spline_is_12_to_22_percent_over_where_its_gridpoints_keep_the_limits(case: Case) -> None:
    assert at_gridpoints(case, solved(case, problem_of(case, spline(case)))) < 1.0005
    failures = verify(case.robot, defaults(case), case.limits, case.payload).failures
    assert failures.keys() == {"torque"}
    assert 1.12 < failures["torque"] < 1.22


@pytest.mark.parametrize(("intervals", "over"), [(30, 0.30), (50, 0.10), (100, 0.02)])
def test_a_coarse_grid_breaks_the_torque_between_gridpoints_that_keep_it(
    case: Case, intervals: int, over: float
) -> None:
    timed = by_toppra(case, intervals)
    assert at_gridpoints(case, timed) == pytest.approx(1.0, abs=1e-6)
    failures = found_by_verifier(case, timed).failures
    assert failures.keys() == {"torque"}
    assert failures["torque"] > 1.0 + over


@pytest.mark.parametrize("intervals", [100, 101, 1000, 1001])
def test_a_cusp_passed_at_six_metres_a_second_is_found_on_a_gridpoint_and_between_two(
    case: Case, straight: type, joined: type, intervals: int
) -> None:
    """Up and down again without a stop: each side is a straight line, so no sample shows it; the speed jumps by 2 v."""
    up = straight()
    turning = replace(case, path=joined(up, Reversed(up)))
    timed = by_toppra(turning, intervals)
    assert np.interp(up.length, timed.law.position, timed.law.speed) > 6.0
    assert at_gridpoints(turning, timed) == pytest.approx(1.0, abs=1e-6)
    found = found_by_verifier(turning, timed)
    assert found.failures.keys() >= {"integral of acceleration"}
    assert found.residuals["integral of acceleration"] == pytest.approx(2.0, abs=1e-3)
    with pytest.raises(RoughPath):
        require_smooth(turning.path)


def test_a_payload_that_is_not_the_timed_one_breaks_the_torque_as_its_mass_says(case: Case, right: TimedPath) -> None:
    """The torque is affine in the payload: two others say what 1.3 kg asks for."""
    assert found_by_verifier(case, right).ok
    failures = verify(case.robot, right, case.limits, 1.3).failures
    _, tool = right.within(np.linspace(0.0, 1.0, 21))
    light, heavy = (motion_of(case.robot, tool, mass).torque for mass in (0.5, 2.5))
    expected = np.abs(0.6 * light + 0.4 * heavy).max() / 127.0
    assert failures.keys() == {"torque"}
    assert failures["torque"] == pytest.approx(expected, rel=1e-4)
    assert failures["torque"] > 1.12


@pytest.mark.parametrize("place", [(0.0, 0.0), (0.05, 0.0)])
def test_swapped_axes_look_the_same_at_the_tool_and_break_the_torque(case: Case, place: tuple[float, float]) -> None:
    """The same law on the path whose x and y are exchanged: each tool speed and acceleration is as it was."""
    x, y = place
    asked = replace(case, path=AdeptCycle.centred((x, y, -0.8)))
    timed = repair(case.robot, on(asked), case.limits, case.payload).motion
    swapped = TimedPath(AdeptCycle.centred((y, x, -0.8), heading=math.pi / 2), timed.law)
    right, wrong = (found_by_verifier(case, t) for t in (timed, swapped))
    at_tool = [[p.value for p in found.peaks if p.joint is None] for found in (right, wrong)]
    assert at_tool[1] == pytest.approx(at_tool[0], rel=1e-9)
    assert right.ok
    assert wrong.failures.keys() == {"torque"}
    assert wrong.failures["torque"] > 1.25


def test_what_happens_between_two_ticks_of_the_bus_is_found(case: Case, right: TimedPath) -> None:
    """s'' swings between two ticks, and all the ticks are as before: at 1 kHz nothing can be seen."""
    slow = right.stretched(1.1)
    swung = TimedPath(slow.path, with_swing(slow.law, start=0.0601, quarter=0.0002, size=60.0))
    ticks = np.arange(math.floor(slow.duration * 1e3) + 1) * 1e-3
    before, after = (motion_of(case.robot, timed.at(ticks), case.payload) for timed in (slow, swung))
    assert np.abs(after.joints.position - before.joints.position).max() < 1e-9
    assert after.torque == pytest.approx(before.torque, abs=1e-6)
    assert np.abs(after.torque).max() < 0.85 * 127.0
    failures = found_by_verifier(case, swung).failures
    assert failures.keys() == {"torque"}
    assert failures["torque"] > 1.05


def with_swing(law: TimeLaw, start: float, quarter: float, size: float) -> TimeLaw:
    """s'' more by +, -, -, + `size` for a quarter each: speed and place afterwards are as they were."""
    edges = start + quarter * np.arange(5)
    times = np.union1d(law.times, edges)
    middle, steps = (times[1:] + times[:-1]) / 2, np.diff(times)
    inside = np.clip(np.searchsorted(edges, middle) - 1, 0, 3)
    swing = size * np.array([1.0, -1.0, -1.0, 1.0])[inside] * ((middle > edges[0]) & (middle < edges[-1]))
    acceleration = law.at(middle).acceleration + swing
    speed = np.concatenate([[0.0], np.cumsum(steps * acceleration)])
    ways = steps * (speed[:-1] + steps * acceleration / 2)
    position = np.concatenate([[0.0], np.cumsum(ways)])
    none = np.zeros_like(steps)
    return TimeLaw(law.name, times, position, np.maximum(speed, 0.0), acceleration, none, none)


class Hidden(RoundedPath):
    """Does not tell where it has to stop."""

    stops = None


@pytest.mark.parametrize("blend", [7e-8, 1e-5])
def test_a_tiny_rounded_corner_is_no_kink(robot: Heli4, blend: float) -> None:
    """Rounding of the arc length moves its second derivative by far more than of a wide corner's."""
    poses = ((-0.1, 0.0, -0.75, 0.0), (0.05, 0.02, -0.7, 0.4), (0.1, -0.03, -0.8, -0.2))
    path = RoundedPath(("x", "y", "z", "theta"), poses, (blend,))
    assert time_optimal(robot, path, Limits(speed=1.0, torque=500.0), 0.0, 1000).kink < 1e-12


@pytest.mark.parametrize("turn", [5e-5, 1.5e-4, 4e-3])
def test_a_corner_too_small_for_the_integrals_is_found_all_the_same(robot: Heli4, limits: Limits, turn: float) -> None:
    """A tangent that jumps by a hair: the speed steps, and no proof inside the parts can see it."""
    corner, end = np.array([-0.08, 0.0, -0.8, 0.0]), 0.18 * np.array([math.cos(turn), 0.0, math.sin(turn), 0.0])
    poses = ((-0.1, 0.0, -0.8, 0.0), tuple(corner.tolist()), tuple((corner + end).tolist()))
    kinked = Hidden(("x", "y", "z", "theta"), poses, (0.0,))
    found = verify(robot, time_optimal(robot, kinked, limits, 1.0, 1000).stretched(1.01), limits, 1.0)
    assert found.failures["kink of the path"] > 100.0


@dataclass(frozen=True)
class Twitching:
    """Along x; theta''' is -d, +d, -d over a few tenths of a micrometre: theta, theta' and theta'' are continuous."""

    size: float = 2e7  # d [rad/m^3]
    step: float = 2e-7
    length: float = 0.2
    pose_names: tuple[str, ...] = ("x", "y", "z", "theta")
    stops: None = None

    @property
    def knots(self) -> tuple[float, ...]:
        return (0.0, *(0.1 + self.step * np.array([0.0, 1.0, 3.0, 4.0])).tolist(), self.length)

    def evaluate(self, s: np.ndarray, order: int = 3) -> tuple[np.ndarray, ...]:
        knots, third = np.array(self.knots), self.size * np.array([0.0, -1.0, 1.0, -1.0, 0.0])
        state, states = np.zeros(3), list[np.ndarray]()
        for h, j in zip(np.diff(knots), third, strict=True):
            states.append(state)
            p, v, a = state
            state = np.array([p + h * (v + h * (a / 2 + h * j / 6)), v + h * (a + h * j / 2), a + h * j])
        k = np.clip(np.searchsorted(knots, s, side="right") - 1, 0, 4)
        (p, v, a), h, j = np.moveaxis(np.array(states)[k], -1, 0), s - knots[k], third[k]
        theta = (p + h * (v + h * (a / 2 + h * j / 6)), v + h * (a + h * j / 2), a + h * j, j, 0.0 * s)
        x = (s - 0.1, 1.0 + 0.0 * s, *[0.0 * s] * 3)
        z = (0.0 * s - 0.8, *[0.0 * s] * 4)
        return tuple(np.stack([x[o], 0.0 * s, z[o], theta[o]], axis=-1) for o in range(order + 1))

    def steepest(self, s: np.ndarray, order: int) -> np.ndarray:  # noqa: ARG002
        return np.zeros((s.size, 4))


def test_a_third_derivative_that_jumps_is_found_although_no_proof_inside_the_parts_sees_it(
    robot: Heli4, s_curve: Callable[[Path, float], TimedPath]
) -> None:
    limits = Limits(speed=20.0, jerk=1e5)
    moved = s_curve(Twitching(), 0.4)
    middle = moved.at(0.2 + np.linspace(-2e-6, 2e-6, 4001))
    assert motion_of(robot, middle, 1.0).joints.third.max() > 3.0 * limits.jerk
    assert verify(robot, moved, limits, 1.0).failures["kink of the path"] > 1e3
