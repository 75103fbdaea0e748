"""Six measured joints, four freedoms: the best fit, and which encoder the disagreement accuses."""

from itertools import combinations

import numpy as np
import pytest
from scipy.optimize import least_squares as reference

from kinematics import InvalidShape, InvalidValue, Redundant3T1R
from kinematics.model.joint_redundancy import fault_signatures, least_squares, signature_angles
from tests.kinematics.robots.redundant_3t1r.redundant_by_hand import ByHand, box, random_geometry, reachable
from tests.sizes import few_or_many

ROBOT = Redundant3T1R()


def poses_of(count, seed, margin=0.02):
    return reachable(ROBOT, box(count, seed, theta=np.pi / 2), margin)


def faulty(joints, joint, seed, size=(1e-4, 5e-3)):
    rng = np.random.default_rng(seed)
    error = rng.uniform(*size, len(joints)) * rng.choice([-1, 1], len(joints))
    return joints + error[:, None] * np.eye(6)[joint]


def test_consistent_joints_give_the_pose_itself():
    poses = poses_of(100_000, seed=1)
    fit = ROBOT.forward_least_squares(ROBOT.inverse(poses))
    assert np.abs(fit.pose - poses).max() < 1e-12
    assert np.abs(fit.residuals).max() < 1e-13


def test_from_a_pose_nearby_it_converges_quadratically():
    """Each step squares the error, up to a factor: three steps from 1 mm, one more from 1 cm, for noisy joints too."""
    rng, poses = np.random.default_rng(2), poses_of(2_000, seed=2, margin=0.2)
    for noise in (0.0, 1e-3):
        joints = ROBOT.inverse(poses) + noise * rng.normal(size=(len(poses), 6))
        answer = ROBOT.forward_least_squares(joints).pose
        starts = [answer + size * rng.uniform(-1, 1, poses.shape) for size in (1e-4, 1e-3, 1e-2)]
        steps = [ROBOT.forward_least_squares(joints, start).steps for start in starts]
        assert [np.median(s) for s in steps] == [2, 3, 3] or [np.median(s) for s in steps] == [3, 3, 4]
        one_step = np.abs(newton_once(joints, starts[1]) - answer).max(axis=1)
        assert np.median(one_step) < 20 * 1e-3**2


def newton_once(joints, start):
    """One Newton step of 1/2 |joints - inverse(pose)|^2 by central differences."""
    h, eye = 1e-5, np.eye(4)

    def gradient(p):
        return -np.einsum("kij,ki->kj", ROBOT.inverse_jacobian(p), joints - ROBOT.inverse(p))

    hessian = np.stack([(gradient(start + h * e) - gradient(start - h * e)) / (2 * h) for e in eye], axis=-1)
    return start - np.linalg.solve(hessian, gradient(start)[..., None])[..., 0]


def test_noisy_joints_give_the_minimum_that_scipy_finds():
    rng, hand = np.random.default_rng(3), ByHand()
    poses = poses_of(30, seed=3, margin=0.1)
    joints = ROBOT.inverse(poses) + 2e-3 * rng.normal(size=(len(poses), 6))
    fit = ROBOT.forward_least_squares(joints)
    for pose, q, found in zip(poses, joints, fit.pose, strict=True):
        other = reference(lambda p, q=q: q - hand.inverse(p), pose, xtol=1e-15, ftol=1e-15, gtol=1e-15)
        assert np.abs(other.x - found).max() < 1e-6
        assert ((q - hand.inverse(found)) ** 2).sum() <= 2 * other.cost * (1 + 1e-9)
    j_m = hand.inverse_jacobian(fit.pose)
    assert np.abs(np.einsum("kij,ki->kj", j_m, fit.residuals)).max() < 1e-14  # a stationary point


def test_the_fit_averages_noise_better_than_five_joints_do():
    rng, poses = np.random.default_rng(4), poses_of(20_000, seed=4, margin=0.1)
    joints = ROBOT.inverse(poses) + 1e-5 * rng.normal(size=(len(poses), 6))
    fitted = np.abs(ROBOT.forward_least_squares(joints).pose - poses)[:, :3]
    papers = np.abs(ROBOT.paper_forward(joints) - poses)[:, :3]
    assert np.sqrt((fitted**2).mean()) < 0.9 * np.sqrt((papers**2).mean())


def test_what_cannot_be_fitted_is_nan():
    fit = ROBOT.forward_least_squares(np.full((2, 6), np.nan))
    assert np.isnan(fit.pose).all()
    assert np.isnan(fit.residuals).all()
    start = np.array([0.0, 0, 3, 0])  # out of reach
    assert np.isnan(ROBOT.forward_least_squares(ROBOT.inverse(np.zeros(4)), start).pose).all()
    with pytest.raises(InvalidShape):
        ROBOT.forward_least_squares(np.zeros(4))
    with pytest.raises(InvalidValue, match="weights"):
        least_squares(ROBOT, np.zeros(6), np.zeros(4), weights=-np.ones(6))
    with pytest.raises(InvalidValue, match="accuracy"):
        ROBOT.check_encoders(np.zeros(6), accuracy=0.0)


def test_a_fault_that_leaves_the_papers_model_without_a_pose_is_nan_or_a_minimum():
    joints = ROBOT.inverse(np.array([0.3, 0.05, 0.1, 0.2]))
    assert np.isnan(ROBOT.paper_forward(joints + np.array([0, 0, 1.1, -1.1, 0, 0]))).all()
    assert np.isnan(ROBOT.forward_least_squares(joints + np.array([0, 0, 1.1, -1.1, 0, 0])).pose).all()
    fit = ROBOT.forward_least_squares(joints + np.array([0, 0, 0.3, -0.4, 0, 0]))
    assert np.abs(ROBOT.inverse_jacobian(fit.pose).T @ fit.residuals).max() < 1e-12


def test_sound_encoders_are_not_accused():
    poses = poses_of(5_000, seed=5)
    noise = np.random.default_rng(5).uniform(-5e-7, 5e-7, (len(poses), 6))
    check = ROBOT.check_encoders(ROBOT.inverse(poses) + noise)
    assert check.consistent.all()
    assert not check.suspects.any()
    assert (check.faulty == 0).all()
    assert np.abs(check.pose - poses).max() < 2e-5


@pytest.mark.parametrize("joint", [0, 1, 4, 5])
@few_or_many(1_500, 6_000)
def test_a_faulty_outer_encoder_is_named_and_the_pose_saved(joint, count):
    poses = poses_of(count, seed=10 + joint)
    check = ROBOT.check_encoders(faulty(ROBOT.inverse(poses), joint, seed=20 + joint))
    assert not check.consistent.any()
    assert check.suspects[:, joint].all()  # never another one alone
    named = check.faulty == joint + 1
    assert named.mean() > 0.98
    assert np.abs(check.pose - poses)[named].max() < 1e-12
    # where it is not named, its signature is mostly near another suspect's
    angles = signature_angles(ROBOT, poses[~named])[:, joint]
    others = np.where(check.suspects[~named] & (np.arange(6) != joint), angles, np.inf)
    assert np.mean(np.min(others, axis=1) < 0.2) > 0.95


@pytest.mark.parametrize("joint", [2, 3])
@few_or_many(1_500, 6_000)
def test_faulty_middle_encoders_are_never_taken_for_each_other(joint, count):
    """Both are suspected; only where no angle at all fits the wrong one is it named, and then rightly."""
    poses = poses_of(count, seed=30 + joint)
    check = ROBOT.check_encoders(faulty(ROBOT.inverse(poses), joint, seed=40 + joint))
    seen = ~check.consistent
    assert seen.mean() > 0.99  # where the arm is level with the turn its fault hides in the angle
    assert check.suspects[seen, joint].all()
    assert set(np.unique(check.faulty)) <= {0, joint + 1}
    both = check.suspects[:, 2:4].all(axis=1)
    assert both.mean() > 0.9
    assert np.isnan(check.pose[both]).all()  # without 3 and 4 the angle is unknown


@pytest.mark.parametrize(("size", "named"), [(0.05, 0.98), (0.3, 0.95), (3.0, 0.0)])
@few_or_many(100, 600)
def test_a_large_fault_is_never_cleared(size, named, count):
    """Of 0.3 m it is still named; where metres leave no pose to look from, nobody is, rather than the wrong one."""
    poses = poses_of(count, seed=6, margin=0.1)
    for joint in range(6):
        check = ROBOT.check_encoders(ROBOT.inverse(poses) + size * np.eye(6)[joint])
        assert check.suspects[:, joint].all()
        if joint not in (2, 3):
            assert (check.faulty == joint + 1).mean() >= named


def test_the_smallest_fault_that_is_seen():
    """In units of the accuracy; by the signatures, and by the check itself."""
    poses = poses_of(3_000, seed=8)
    v = fault_signatures(ROBOT, poses)
    least = 1 / np.abs(v @ np.swapaxes(v, 1, 2)).max(axis=2)
    assert np.abs(np.median(least, axis=0) - [2.5, 2.5, 3.8, 3.8, 2.5, 2.5]).max() < 0.2
    assert least[:, [0, 1, 4, 5]].max() < 6
    assert (np.quantile(least[:, 2:4], 0.95, axis=0) < 25).all()
    assert (least[:, 2:4].max(axis=0) > 500).all()
    for joint in range(6):
        for size in (3e-6, 6e-6, 2.5e-5):
            sharp = np.abs(least[:, joint] * 1e-6 / size - 1) > 0.01  # beyond first order
            fit = ROBOT.forward_least_squares(ROBOT.inverse(poses) + size * np.eye(6)[joint])
            seen = np.abs(fit.residuals).max(axis=1) > 1e-6
            assert np.array_equal(seen[sharp], least[sharp, joint] * 1e-6 < size)


def test_two_faults_break_the_assumption_and_at_few_poses_a_sound_encoder_is_named():
    joints = faulty(faulty(ROBOT.inverse(poses_of(3_000, seed=7)), 0, seed=7), 2, seed=8)
    named = ROBOT.check_encoders(joints).faulty
    assert 0 < np.mean((named != 0) & (named != 1) & (named != 3)) < 0.01


@pytest.mark.parametrize("lead", [(), (0,), (2, 3)])
def test_encoders_are_checked_in_arrays_of_any_shape(lead):
    poses = np.broadcast_to([0.1, 0.05, 0.2, 0.3], (*lead, 4))
    check = ROBOT.check_encoders(ROBOT.inverse(poses) + 1e-3 * np.eye(6)[0])
    assert [v.shape for v in check] == [(*lead, 4), (*lead, 6), lead, (*lead, 6)]
    assert check.faulty.shape == lead
    assert (check.faulty == 1).all()
    assert np.abs(check.pose - poses).max(initial=0.0) < 1e-12


def test_two_faults_accuse_nobody_alone():
    joints = faulty(faulty(ROBOT.inverse(poses_of(1_000, seed=7)), 0, seed=7), 5, seed=8)
    check = ROBOT.check_encoders(joints)
    assert (check.suspects.sum(axis=1) == 0).mean() > 0.98


def test_signatures_span_the_left_null_space_and_predict_the_residual_of_a_small_fault():
    poses = poses_of(500, seed=9, margin=0.1)
    v = fault_signatures(ROBOT, poses)
    assert v.shape == (len(poses), 6, 2)
    assert np.abs(np.swapaxes(v, 1, 2) @ ROBOT.inverse_jacobian(poses)).max() < 1e-12
    assert np.abs(np.swapaxes(v, 1, 2) @ v - np.eye(2)).max() < 1e-13
    for joint in range(6):
        fit = ROBOT.forward_least_squares(ROBOT.inverse(poses) + 1e-6 * np.eye(6)[joint])
        predicted = 1e-6 * np.einsum("kij,kj->ki", v, v[:, joint])
        assert np.abs(fit.residuals - predicted).max() < 1e-9
    assert np.isnan(fault_signatures(ROBOT, np.array([0.0, 0, 3, 0]))).all()


def test_two_encoders_look_alike_just_where_the_other_four_arms_are_singular():
    """sin(angle) |v_i| |v_j| = |det of the other four rows of J_m| / sqrt(det J_m^T J_m)."""
    poses = poses_of(2_000, seed=11, margin=0.01)
    v, angles, j_m = fault_signatures(ROBOT, poses), signature_angles(ROBOT, poses), ROBOT.inverse_jacobian(poses)
    size = np.linalg.norm(v, axis=2)
    volume = np.prod(np.linalg.svd(j_m)[1], axis=1)
    for i, j in combinations(range(6), 2):
        others = [k for k in range(6) if k not in (i, j)]
        expected = np.abs(np.linalg.det(j_m[:, others])) / volume
        assert np.abs(np.sin(angles[:, i, j]) * size[:, i] * size[:, j] - expected).max() < 1e-11


def test_encoders_3_and_4_look_alike_at_every_pose_of_every_geometry():
    """The outer arms turn about one upright axis, so those four alone are always singular."""
    rng = np.random.default_rng(12)
    for _ in range(20):
        other = Redundant3T1R(random_geometry(rng))
        poses = reachable(other, box(300, seed=13, y=0.4, z=0.4), margin=0.02)
        angles = signature_angles(other, poses)[:, 2, 3]
        assert np.nanmax(angles, initial=0.0) < 1e-8
