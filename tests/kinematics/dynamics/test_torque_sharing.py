"""The least peak over the null space, against scipy's linear programming."""

import numpy as np
import pytest
from scipy.optimize import linprog

from kinematics import Heli4, InvalidValue, Redundant3T1R, inverse_dynamics
from kinematics.dynamics.torque_sharing import least_peak

ROBOT, LIMITS = Redundant3T1R(), np.array([600.0, 500.0, 700.0, 400.0, 600.0, 300.0])


def motions(count, seed):
    rng = np.random.default_rng(seed)
    pose = rng.uniform([-0.1, -0.3, -0.3, -1.5], [0.1, 0.3, 0.3, 1.5], (count, 4))
    return pose, rng.normal(size=(count, 4)) * 2, rng.normal(size=(count, 4)) * 40


def best_by_linprog(jacobian, torque, limits):
    """min t with |tau_i| <= t limit_i and J^T tau = J^T torque."""
    m, n = jacobian.shape
    bounds = np.vstack([np.column_stack([side * np.eye(m), -limits]) for side in (1, -1)])
    equal = np.column_stack([jacobian.T, np.zeros(n)])
    free = [(None, None)] * m + [(0, None)]
    return linprog([0] * m + [1], bounds, np.zeros(2 * m), equal, jacobian.T @ torque, bounds=free).fun


def test_peak_is_the_linear_programmes_and_the_work_is_the_same():
    motion = motions(60, seed=1)
    jacobian = ROBOT.actuator_jacobian(motion[0])
    norm = inverse_dynamics(ROBOT, 1.0, *motion)
    peak = inverse_dynamics(ROBOT, 1.0, *motion, sharing="least_peak", torque_limits=LIMITS)
    work = np.einsum("kmn,km->kn", jacobian, norm)
    assert np.abs(np.einsum("kmn,km->kn", jacobian, peak) - work).max() < 1e-10 * np.abs(work).max()
    found = (np.abs(peak) / LIMITS).max(axis=-1)
    expected = [best_by_linprog(j, t, LIMITS) for j, t in zip(jacobian, norm, strict=True)]
    np.testing.assert_allclose(found, expected, rtol=1e-8)
    assert (found < (np.abs(norm) / LIMITS).max(axis=-1) * (1 + 1e-12)).all()
    assert (found < 0.95 * (np.abs(norm) / LIMITS).max(axis=-1)).mean() > 0.5


def test_symmetric_and_degenerate_loads_are_solved_too():
    """Whole numbers, where vertices coincide and systems are singular; and a load that the null space cancels."""
    rng = np.random.default_rng(2)
    for _ in range(100):
        jacobian = rng.integers(-1, 2, (6, 4)).astype(float)
        if np.linalg.matrix_rank(jacobian) < 4:
            continue
        torque, limits = rng.integers(-2, 3, 6).astype(float), np.ones(6)
        found = np.abs(least_peak(jacobian, torque, limits)).max()
        assert found == pytest.approx(best_by_linprog(jacobian, torque, limits), rel=1e-9, abs=1e-12)


def test_one_redundant_drive_shares_by_the_same_rule():
    rng = np.random.default_rng(3)
    for _ in range(20):
        jacobian, torque, limits = rng.normal(size=(4, 3)), rng.normal(size=4), rng.uniform(0.5, 2, 4)
        found = (np.abs(least_peak(jacobian, torque, limits)) / limits).max()
        assert found == pytest.approx(best_by_linprog(jacobian, torque, limits), rel=1e-9)


def test_out_of_reach_is_nan_and_without_redundancy_nothing_changes():
    pose = np.array([[0.0, 0, 0, 0], [0, 0, 3.0, 0]])
    torque = inverse_dynamics(ROBOT, 1.0, pose, 0 * pose, 0 * pose, sharing="least_peak")
    assert np.isnan(torque).all(axis=-1).tolist() == [False, True]
    still = np.zeros(4)
    args = (Heli4(), 1.0, Heli4().home, still, still)
    np.testing.assert_array_equal(inverse_dynamics(*args, sharing="least_peak"), inverse_dynamics(*args))


def test_bad_input_is_named():
    args = (ROBOT, 1.0, ROBOT.home, np.zeros(4), np.zeros(4))
    with pytest.raises(InvalidValue, match="sharing: found even; expected one of least_norm, least_peak"):
        inverse_dynamics(*args, sharing="even")
    for limits in ([1.0] * 5, [1.0] * 5 + [0.0], [1.0] * 5 + [np.inf]):
        with pytest.raises(InvalidValue, match="6 finite numbers > 0"):
            inverse_dynamics(*args, sharing="least_peak", torque_limits=limits)
