"""The problem as a peer's interface takes it: numbers at stations along the path, and a law from a peer's numbers."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from kinematics import actuator_motion, inverse_dynamics
from kinematics.arrays import Array
from kinematics.dynamics.chain_rule import JointMotion
from tests.bench.timing.cases import Case
from trajectory import TimedPath, TimeLaw, TimingFailed

_UNFAIR = 1e-3  # relative: a peer's law that had to be changed so much is not its own


class Samples(NamedTuple):
    """At stations s (k,): joints and their derivatives by s; torque = a s'' + b s'^2 + c, without friction, (k, m)."""

    s: Array
    joints: JointMotion
    a: Array
    b: Array
    c: Array


def sampled(case: Case, s: Array) -> Samples:
    """At arc lengths (k,)."""
    pose, first, second, third = case.path.evaluate(s, 3)
    none = np.zeros_like(pose)
    weight = inverse_dynamics(case.robot, case.payload, pose, none, none)
    by_u = inverse_dynamics(case.robot, case.payload, pose, none, first) - weight
    by_x = inverse_dynamics(case.robot, case.payload, pose, first, second) - weight
    return Samples(s, actuator_motion(case.robot, pose, first, second, third), by_u, by_x, weight)


def smooth_law(case: Case, name: str, times: Array, acceleration: Array) -> TimedPath:
    """The path by s'' at times (k,), linear in between: so s''' is constant there, and nothing jumps.

    So a peer's s' and s are integrated anew; what is missing at the end, to be at rest there, is spread over s''.

    Raises:
        TimingFailed: more than rounding and interpolation is missing.
    """
    length, acceleration = case.path.length, acceleration.copy()
    acceleration[[0, -1]] = 0.0
    steps = np.diff(times)
    share = np.zeros_like(times)  # of each s'' in the last speed
    share[:-1] += steps / 2
    share[1:] += steps / 2
    weight = np.where((times > 0) & (times < times[-1]), np.minimum(times, times[-1] - times), 0.0)
    correction = (share @ acceleration) / (share @ weight) * weight
    acceleration -= correction
    jerk = np.diff(acceleration) / steps
    speed = np.concatenate([[0.0], np.cumsum(steps * (acceleration[1:] + acceleration[:-1]) / 2)])
    ways = steps * (speed[:-1] + steps * (acceleration[:-1] / 2 + steps * jerk / 6))
    position = np.concatenate([[0.0], np.cumsum(ways)])
    scale = length / position[-1]
    changed = max(abs(scale - 1.0), float(np.abs(correction).max() / np.abs(acceleration).max()))
    if changed > _UNFAIR:
        raise TimingFailed(
            name, {"stations": times.size}, f"its numbers had to be changed by {changed:.2g} to end at rest"
        )
    position, speed, acceleration, jerk = (scale * v for v in (position, speed, acceleration, jerk))
    position[-1], speed[-1] = length, 0.0
    law = TimeLaw(name, times, position, speed, acceleration[:-1], jerk, np.zeros_like(jerk))
    return TimedPath(case.path, law)
