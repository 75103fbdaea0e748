"""Drake's Toppra, which knows a robot only as an open tree: a closed loop's torque limit cannot be given to it.

What it can be given is the drives' path q(s), their speeds, and constant accelerations that stand in for the torque:
the largest whose law keeps the torque at its stations, found by solving again; the same for all drives, or in
proportion to their largest q', whichever is faster.
"""

from __future__ import annotations

import numpy as np
from pydrake.multibody.optimization import Toppra
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import PrismaticJoint, SpatialInertia
from pydrake.trajectories import PiecewisePolynomial

from kinematics.arrays import Array
from tests.bench.timing.cases import Case
from tests.bench.timing.samples import Samples, sampled
from trajectory import TimedPath, TimeLaw, TimingFailed

INTERVALS = 1000
_ROUNDS = 8
_CLOSE = 1e-3  # relative, of the torque


def toppra(case: Case) -> TimedPath:
    """The faster of the two."""
    at = sampled(case, np.linspace(0.0, case.path.length, INTERVALS + 1))
    ends = [at.joints.first[k, :, None] for k in (0, -1)]
    path = PiecewisePolynomial.CubicWithContinuousSecondDerivatives(at.s, at.joints.position.T, *ends)
    shape = np.abs(at.joints.first).max(axis=0)
    shape /= shape.max()
    laws = [_fastest(case, path, at, each) for each in (np.ones_like(shape), shape)]
    return min(laws, key=lambda law: law.duration)


def _fastest(case: Case, path: PiecewisePolynomial, at: Samples, shape: Array) -> TimedPath:
    """With the largest accelerations in this proportion."""
    limit, torque, speed = (case.limit(name) for name in ("acceleration", "torque", "speed"))
    assert torque is not None
    assert speed is not None
    room = np.full(shape.size, np.inf) if limit is None else limit
    # A first guess: what the curvature asks for at a third of the highest speed.
    fastest = (speed / np.abs(at.joints.first).max(axis=0)).min()
    each = shape * float(np.abs(at.joints.second).max() * (fastest / 3) ** 2)
    for _ in range(_ROUNDS):
        found = _solved(case, path, at.s, np.minimum(each, room))
        used = float((_torque(at, found) / torque).max())
        if abs(used - 1.0) <= _CLOSE or (used < 1.0 and (each >= room).all()):
            return TimedPath(case.path, TimeLaw.constant_acceleration("Drake Toppra", at.s, found))
        each = each / used
    raise TimingFailed("Drake Toppra", {"rounds": _ROUNDS}, f"the torque is at {used:.4g} of its limit")


def _solved(case: Case, path: PiecewisePolynomial, s: Array, acceleration: Array) -> Array:
    """(k,) speed at the stations."""
    problem = Toppra(path, _drives(acceleration.size), s)
    speed = case.limit("speed")
    problem.AddJointVelocityLimit(-speed, speed)
    problem.AddJointAccelerationLimit(-acceleration, acceleration)
    found = problem.SolvePathParameterization(0.0, 0.0)
    if found is None:
        raise TimingFailed("Drake Toppra", {"acceleration": acceleration}, "no solution")
    times = np.array(found.get_segment_times())
    rate = found.derivative()
    at_knots = np.array([rate.value(t)[0, 0] for t in times])
    if not np.allclose([found.value(t)[0, 0] for t in times], s, rtol=0.0, atol=1e-9 * s[-1]):
        raise TimingFailed("Drake Toppra", {}, "its knots are not the stations")
    at_knots[[0, -1]] = 0.0
    return np.maximum(at_knots, 0.0)


def _torque(at: Samples, speed: Array) -> Array:
    """(2, k, m) magnitudes before and after each station."""
    x = speed**2
    u = np.diff(x) / (2 * np.diff(at.s))
    sides = np.stack([np.append(u, u[-1]), np.append(u[0], u)])[..., None]
    return np.abs(at.a * sides + at.b * x[:, None] + at.c)


def _drives(count: int) -> MultibodyPlant:
    """As many sliding bodies as there are drives: all that the limits of speed and acceleration need."""
    plant = MultibodyPlant(0.0)
    inertia = SpatialInertia.SolidSphereWithMass(1.0, 0.1)
    for k in range(count):
        body = plant.AddRigidBody(f"drive {k}", inertia)
        plant.AddJoint(PrismaticJoint(f"drive {k}", plant.world_frame(), body.body_frame(), [1.0, 0.0, 0.0]))
    plant.Finalize()
    return plant
