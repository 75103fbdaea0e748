"""Drake's Toppra, which knows a robot only as an open tree: no torque limit of a closed loop can be given to it.

What it can be given is the drives' path q(s), their speed, and one acceleration, the same for all drives, that stands in
for the torque: the largest whose law keeps it, found by solving again.
"""

from __future__ import annotations

import numpy as np
from pydrake.math import RigidTransform
from pydrake.multibody.optimization import Toppra
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import PrismaticJoint, SpatialInertia
from pydrake.trajectories import PiecewisePolynomial

from tests.bench.timing.cases import Case
from tests.bench.timing.samples import Samples, sampled
from trajectory import TimedPath, TimeLaw, TimingFailed
from trajectory.path import Array

INTERVALS = 1000
_ROUNDS = 8
_CLOSE = 1e-4  # relative, of the acceleration


def toppra(case: Case) -> TimedPath:
    """With the largest stand-in for the torque."""
    at = sampled(case, np.linspace(0.0, case.path.length, INTERVALS + 1))
    path = PiecewisePolynomial.CubicWithContinuousSecondDerivatives(at.s, at.joints.position.T, *at.joints.first[[0, -1]][:, :, None])
    plant = _drives(at.a.shape[1])
    acceleration = float(np.abs(at.joints.first).max()) * 100
    raise NotImplementedError
