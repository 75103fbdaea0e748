"""The torque's parts give the torque back at any speed and acceleration, and each limit is repaired by its own law."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from kinematics import Heli4, Mechanism, Peppermill, Redundant3T1R, inverse_dynamics
from trajectory import AdeptCycle, Limits, LimitsExceeded, TimedPath, repair, verify
from trajectory.motions import torque_terms
from trajectory.motions.torque_terms import torque_along, torque_by_rate

CLOSE = 5e-5  # of the least stretch, which a proof between the samples may add
FREE = Limits(speed=1e6)
ROBOTS = [Heli4(), Peppermill(), Redundant3T1R()]


def some_motion(robot: Mechanism) -> list[np.ndarray]:
    rng = np.random.default_rng(4)
    sizes = (0.03, 2.0, 60.0)
    return [c + rng.uniform(-s, s, (200, 4)) for c, s in zip((robot.home, 0.0, 0.0), sizes, strict=True)]


@pytest.mark.parametrize("robot", ROBOTS, ids=lambda r: type(r).__name__)
def test_the_same_way_travelled_at_another_rate_takes_the_torque_of_its_parts(robot: Mechanism) -> None:
    pose, velocity, acceleration = some_motion(robot)
    parts = torque_by_rate(robot, 1.0, pose, velocity, acceleration)
    for r in (0.1, 0.7, 3.0):
        exact = inverse_dynamics(robot, 1.0, pose, r * velocity, r**2 * acceleration)
        found = parts.constant + r * parts.linear + r**2 * parts.quadratic
        assert np.abs(found - exact).max() < 1e-10 * np.abs(exact).max()
    assert np.abs(parts.linear).max() < 1e-10 * np.abs(parts.quadratic).max()  # without friction


@pytest.mark.parametrize("robot", ROBOTS, ids=lambda r: type(r).__name__)
def test_parts_along_a_path_give_the_torque_at_any_speed_and_acceleration(robot: Mechanism) -> None:
    pose, first, second = some_motion(robot)
    parts = torque_along(robot, 1.0, (pose, first, second), 2.0, 50.0)
    rng = np.random.default_rng(8)
    v, a = rng.uniform(0, 4, (200, 1)), rng.uniform(-200, 200, (200, 1))
    exact = inverse_dynamics(robot, 1.0, pose, first * v, second * v**2 + first * a)
    found = parts.inertia * a + parts.centrifugal * v**2 + parts.viscous * v + parts.constant
    assert np.abs(found - exact).max() < 1e-9 * np.abs(exact).max()


def test_friction_goes_to_the_constant_and_the_linear_part(robot: Heli4, monkeypatch: pytest.MonkeyPatch) -> None:
    pose, velocity, acceleration = some_motion(robot)
    bare = torque_by_rate(robot, 1.0, pose, velocity, acceleration)
    speed = np.einsum("kij,kj->ki", robot.actuator_jacobian(pose), velocity)

    def rubbing(robot: Mechanism, payload: float, pose: np.ndarray, v: np.ndarray, a: np.ndarray) -> np.ndarray:
        rate = np.einsum("kij,kj->ki", robot.actuator_jacobian(pose), v)
        return inverse_dynamics(robot, payload, pose, v, a) + 3.0 * np.sign(rate) + 0.7 * rate

    monkeypatch.setattr(torque_terms, "inverse_dynamics", rubbing)
    found = torque_by_rate(robot, 1.0, pose, velocity, acceleration)
    size = np.abs(bare.quadratic).max()
    assert np.abs(found.constant - bare.constant - 3.0 * np.sign(speed)).max() < 1e-10 * size
    assert np.abs(found.linear - 0.7 * speed).max() < 1e-10 * size
    assert np.abs(found.quadratic - bare.quadratic).max() < 1e-10 * size


def assert_repaired_by_the_least_stretch(robot: Heli4, timed: TimedPath, limits: Limits, quantity: str) -> None:
    mended = repair(robot, timed, limits, 1.0)
    assert 1.0 - 2 * CLOSE < mended.verification.peak_over_limit[quantity] <= 1.0
    assert 1.0 < mended.factor < 1.009
    assert not verify(robot, timed.stretched(mended.factor - CLOSE), limits, 1.0).ok


def test_the_rms_torque_is_repaired_by_the_least_stretch(robot: Heli4, timed: TimedPath) -> None:
    limit = verify(robot, timed, FREE, 1.0).rms_torque / np.array([0.9, 1.0, 1.009, 1.005])
    limits = replace(FREE, rms_torque=tuple(limit))
    assert_repaired_by_the_least_stretch(robot, timed, limits, "rms torque")


def test_the_speed_torque_line_is_repaired_by_the_least_stretch(robot: Heli4, timed: TimedPath) -> None:
    line = replace(FREE, stall_torque=150.0, no_load_speed=25.0)
    ratio = verify(robot, timed, line, 1.0).peak_over_limit["torque at speed"]
    k = ratio / 1.009
    limits = replace(FREE, stall_torque=150.0 * k, no_load_speed=25.0 * k)  # every ratio over k
    assert_repaired_by_the_least_stretch(robot, timed, limits, "torque at speed")


def test_the_line_is_measured_as_it_is_written(robot: Heli4, timed: TimedPath) -> None:
    limits = replace(FREE, stall_torque=200.0, no_load_speed=30.0)
    peak = next(p for p in verify(robot, timed, limits, 1.0).peaks if p.quantity == "torque at speed")
    motion = timed.at(np.array(peak.time))
    torque = np.abs(inverse_dynamics(robot, 1.0, motion.pose, motion.velocity, motion.acceleration))
    speed = np.abs(robot.actuator_jacobian(motion.pose) @ motion.velocity)
    k = robot.actuator_names.index(peak.joint)
    assert peak.ratio == pytest.approx(torque[k] / 200.0 + speed[k] / 30.0, rel=1e-2)  # torque steps at a knot
    assert (peak.value <= peak.limit) == (peak.ratio <= 1.0)


@pytest.mark.parametrize("quantity", ["rms_torque", "line"])
def test_no_stretch_repairs_what_the_weight_alone_exceeds(robot: Heli4, timed: TimedPath, quantity: str) -> None:
    slow = timed.stretched(1000.0)
    at_rest = verify(robot, slow, FREE, 1.0).rms_torque.max() / 1.005
    limit = {"rms_torque": at_rest} if quantity == "rms_torque" else {"stall_torque": at_rest, "no_load_speed": 1e6}
    with pytest.raises(LimitsExceeded, match="torque"):
        repair(robot, slow, replace(FREE, **limit), 1.0)


def test_a_joint_out_of_its_range_is_found_and_cannot_be_repaired(
    robot: Heli4, path: AdeptCycle, timed: TimedPath
) -> None:
    joints = robot.inverse(path.evaluate(np.linspace(0.0, path.length, 2001), 0)[0])
    ranges = np.stack([joints.min(axis=0) - 0.01, joints.max(axis=0) + 0.01], axis=-1)
    assert verify(robot, timed, replace(FREE, position=ranges), 1.0).ok
    ranges[2, 1] -= 0.011
    limits = replace(FREE, position=ranges)
    (peak,) = (p for p in verify(robot, timed, limits, 1.0).peaks if p.quantity == "joint position")
    assert (peak.joint, peak.limit) == ("q3", pytest.approx(ranges[2, 1]))
    assert peak.value == pytest.approx(ranges[2, 1] + 0.001, abs=1e-5)
    with pytest.raises(LimitsExceeded, match="joint position"):
        repair(robot, timed, limits, 1.0)
