"""Inverse and forward geometric model of the redundant robot, (1)-(22)."""

import numpy as np
import pytest
from scipy.optimize import least_squares

from kinematics import InvalidGeometry, InvalidShape, Redundant3T1R, UnreachablePose
from tests.kinematics.robots.redundant_3t1r.redundant_by_hand import ByHand, box, random_geometry, reachable
from tests.sizes import few_or_many


@pytest.fixture(scope="module")
def robot():
    return Redundant3T1R()


def test_the_geometry_is_the_papers_with_its_relations(robot):
    g, hand = robot.geometry, ByHand()
    assert (g.outer_arm_length, g.middle_arm_length, g.outer_rail_y, g.middle_rail_y) == (1.25, 1.0926, -0.375, -0.4602)
    assert (g.outer_rail_z, g.platform_length, g.platform_height) == (0.3, 0.1126, 0.2)
    b, z, y = hand.platform(np.array([0.1, 0.2, 0.3, 0.4])), hand.z, hand.y
    assert np.array_equal(b[0::2], b[1::2])
    assert y[0] == y[4] == -y[1] == -y[5]
    assert y[2] == -y[3]
    assert z[0] == z[1] == -z[4] == -z[5]
    assert z[2] == z[3] == 0
    assert abs(z[0] - z[2]) > abs(hand.local[0, 2] - hand.local[2, 2])
    assert np.isclose(np.linalg.norm(b[0] - b[4]), g.platform_height)


def test_inverse_is_expression_7_as_printed(robot):
    poses = box(100_000, seed=1)
    assert np.allclose(robot.inverse(poses), ByHand().inverse(poses), rtol=0, atol=1e-14, equal_nan=True)


def test_the_slides_are_before_the_platform_and_move_with_x(robot):
    poses = reachable(robot, box(10_000, seed=2))
    joints = robot.inverse(poses)
    assert (ByHand().platform(poses)[..., 0] >= joints).all()  # (6), (21)
    shifted = robot.inverse(poses + 0.7 * np.eye(4)[0])
    assert np.abs(shifted - joints - 0.7).max() < 1e-15 * 8


@few_or_many(50_000, 1_010_000)
def test_poses_of_the_workspace_come_back(robot, count):
    poses = reachable(robot, box(count, seed=3))
    assert len(poses) > 0.99 * count
    joints = robot.inverse(poses)
    found = robot.forward(joints)
    assert np.abs(found - poses).max() < 1e-12
    assert np.abs(ByHand().gaps(found, joints)).max() < 1e-13
    assert np.abs(robot.inverse(found) - joints).max() < 1e-11


def test_round_trip_right_to_the_edge_of_reach(robot):
    poses = box(400_000, seed=4, y=1.2, z=1.2)
    poses = poses[(robot.margin("reach", poses) > 0) & (robot.margin("reach", poses) < 1e-3)]
    assert len(poses) > 300
    assert np.abs(robot.forward(robot.inverse(poses)) - poses).max() < 1e-11


def test_round_trip_on_the_planes_of_symmetry_and_at_home(robot):
    for zeroed in ([1], [2], [1, 2], [1, 2, 3]):
        poses = box(20_000, seed=5)
        poses[:, zeroed] = 0.0
        poses = reachable(robot, poses)
        assert np.abs(robot.forward(robot.inverse(poses)) - poses).max() < 1e-12
    assert np.abs(robot.forward(robot.inverse(np.array(robot.home))) - robot.home).max() < 1e-15


@few_or_many(30, 1000)
def test_round_trips_of_random_geometries(count):
    rng, asked = np.random.default_rng(6), box(10, seed=7, y=0.3, z=0.3)
    for _ in range(count):
        robot = Redundant3T1R(random_geometry(rng))
        poses = reachable(robot, asked)
        assert len(poses) > 0, robot
        assert np.abs(robot.forward(robot.inverse(poses)) - poses).max() < 1e-11, robot


def test_round_trip_of_whole_robots_of_other_geometries():
    rng = np.random.default_rng(8)
    for _ in range(60):
        other = Redundant3T1R(random_geometry(rng))
        poses = reachable(other, box(500, seed=9, y=0.5, z=0.5), margin=1e-6)
        joints = other.inverse(poses)
        assert np.abs(ByHand(other.geometry).gaps(poses, joints)).max(initial=0) < 1e-14
        assert np.abs(other.forward(joints) - poses).max(initial=0) < 1e-11, other


def test_the_four_candidates_are_the_papers(robot):
    hand = ByHand()
    for pose in reachable(robot, box(100, seed=10)):
        joints = robot.inverse(pose)
        ours = robot._candidates(joints)[0]
        for _, _, printed in hand.direct(joints):
            assert np.abs(ours - printed).max(axis=-1).min() < 1e-12


def test_relation_21_leaves_one_candidate(robot):
    poses = reachable(robot, box(200_000, seed=11, y=0.8, z=1.1))
    _, _, ahead = robot._candidates(robot.inverse(poses))
    assert ((ahead >= -1e-9).sum(axis=-1) == 1).all()


def test_one_pose_closes_all_arms_except_on_two_planes(robot):
    """Arms 1, 2, 5 and 6 hold B_1 by four spheres; their centres share a plane where y_b1 = 0 or z = 0."""
    for pose in reachable(robot, box(300, seed=12)):
        modes = robot.assembly_modes(robot.inverse(pose))
        assert modes.shape == (1, 4)
        assert np.abs(modes[0] - pose).max() < 1e-12


@pytest.mark.parametrize("plane", ["y_b1 = 0", "z = 0"])
def test_on_those_planes_the_mirrored_point_closes_the_outer_arms_too(robot, plane):
    """The four centres then share a plane, and B_1 mirrored in it closes arms 1, 2, 5 and 6, though not 3 and 4."""
    half, hand = robot.geometry.platform_length / 2, ByHand()
    for pose in reachable(robot, box(200, seed=13)):
        if plane == "z = 0":
            pose[2] = 0.0
        else:
            pose[1] = half * np.sin(pose[3])
        joints = robot.inverse(pose)
        candidates = robot._candidates(joints)[0]
        gaps = hand.gaps(candidates, joints)[:, [0, 1, 4, 5]]
        mirrored = candidates[2:][~np.isnan(candidates[2:, 0])]
        if len(mirrored):
            assert np.abs(gaps[2:][~np.isnan(candidates[2:, 0])]).max() < 1e-12
        assert len(robot.assembly_modes(joints)) == 1 + sum(np.abs(hand.gaps(m, joints)).max() < 1e-6 for m in mirrored)


def test_at_home_the_whole_robot_can_stand_mirrored_behind_its_slides():
    """At y = z = theta = 0 the mirrored pose, on the slides' other side, exists where all arms span the same x."""
    g = Redundant3T1R.Geometry(middle_rail_y=-0.5)
    reach_1 = np.sqrt(g.outer_arm_length**2 - g.outer_rail_y**2 - (g.outer_rail_z - g.platform_height / 2) ** 2)
    length = np.sqrt(reach_1**2 + g.middle_rail_y**2)  # both mirrors at the same x
    robot = Redundant3T1R(g.with_values(middle_arm_length=float(length)))
    joints, hand = robot.inverse(np.zeros(4)), ByHand(robot.geometry)
    modes = robot.assembly_modes(joints)
    assert len(modes) == 2
    assert np.abs(hand.gaps(modes, joints)).max() < 1e-13
    assert np.abs(modes[0]).max() < 1e-13
    assert np.isclose(modes[1, 0], -2 * reach_1)


def test_assembly_modes_are_all_that_a_numeric_search_finds(robot):
    rng, g = np.random.default_rng(14), robot.geometry
    mirrored = Redundant3T1R(
        g.with_values(middle_arm_length=float(np.sqrt(1.25**2 - 0.375**2 - 0.2**2 + g.middle_rail_y**2)))
    )
    for tested, pose in ((robot, [0.1, 0.1, 0.2, 0.4]), (robot, [0, 0.05, 0, -1.0]), (mirrored, [0.0, 0, 0, 0])):
        joints, hand = tested.inverse(np.array(pose)), ByHand(tested.geometry)
        modes, found = tested.assembly_modes(joints), []
        for start in rng.uniform([-3, -1, -1, -3.1], [2, 1, 1, 3.1], (60, 4)):
            solution = least_squares(lambda p: hand.gaps(p, joints), start, xtol=1e-13, ftol=1e-13, gtol=1e-13)  # noqa: B023
            if np.abs(solution.fun).max() < 1e-10:
                angle = (solution.x[3] + np.pi) % (2 * np.pi) - np.pi
                found.append(np.append(solution.x[:3], angle))
        distances = np.abs(np.array(found)[:, None] - modes).max(axis=-1)
        assert (distances.min(axis=1) < 1e-6).all()
        assert (distances.min(axis=0) < 1e-6).all()


def test_joints_that_no_pose_has_give_nan(robot):
    joints = robot.inverse(np.zeros(4))
    for joint in range(6):
        faulty = joints + 1e-3 * np.eye(6)[joint]
        assert np.isnan(robot.forward(faulty)).all()
        assert robot.assembly_modes(faulty).shape == (0, 4)
    assert np.isnan(robot.forward(joints + 3.0 * np.eye(6)[0])).all()


def test_the_papers_model_never_looks_at_joint_6(robot):
    pose = np.array([0.1, 0.1, 0.2, 0.4])
    joints = robot.inverse(pose) + 0.05 * np.eye(6)[5]
    assert np.abs(robot.paper_forward(joints) - pose).max() < 1e-13


def test_out_of_reach_gives_nan_rows_and_an_error_that_names_the_limb(robot):
    poses = np.array([[0.0, 0, 0, 0], [0, 0, 2.0, 0], [0, np.nan, 0, 0]])
    joints = robot.inverse(poses)
    assert not np.isnan(joints[0]).any()
    assert np.isnan(joints[1:]).all()
    assert np.isnan(robot.forward(joints)[1:]).all()
    assert np.isnan(robot.fvi(poses)[1:]).all()
    with pytest.raises(UnreachablePose) as caught:
        robot.require_reachable(np.array([[0.0, 0, 0, 0], [0, 0.62, 0, np.pi / 2]]))
    hand = ByHand()
    from_rail = (hand.platform(np.array([0, 0.62, 0, np.pi / 2])) - hand.rails(np.zeros(6)))[:, 1:]
    margins = hand.lengths - np.linalg.norm(from_rail, axis=-1)
    assert caught.value.limb == margins.argmin() + 1
    assert np.isclose(caught.value.margin, margins.min())


def test_wrong_shapes_are_named(robot):
    with pytest.raises(InvalidShape, match="theta"):
        robot.inverse(np.zeros(3))
    with pytest.raises(InvalidShape, match="x6"):
        robot.forward(np.zeros((5, 4)))
    with pytest.raises(InvalidShape, match="one at a time"):
        robot.assembly_modes(np.zeros((2, 6)))


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("outer_rail_y", 0.0), ("middle_rail_y", 0.0), ("outer_rail_z", 0.1), ("platform_length", 0.0),
        ("platform_height", -0.1), ("outer_arm_length", np.nan), ("middle_arm_length", np.inf),
        ("parallelogram_width", 0.0), ("outer_rail_z", 0.1 + 1e-13), ("outer_rail_z", 0.1 - 1.24e-4),
        ("outer_rail_y", 1e-12), ("outer_rail_y", -1.24e-4), ("middle_rail_y", 1.09e-4),
    ],
)  # fmt: skip
def test_degenerate_geometry_is_refused_by_name(field, value):
    with pytest.raises(InvalidGeometry, match=field):
        Redundant3T1R.Geometry(**{field: value})


@pytest.mark.parametrize(
    "values",
    [{"outer_rail_z": 0.1 + 1.26e-4}, {"outer_rail_z": 0.1 - 1.26e-4}, {"outer_rail_y": 1.26e-4},
     {"middle_rail_y": -1.1e-4}, {"outer_rail_z": 0.1 - 1.26e-4, "outer_rail_y": -1.26e-4, "middle_rail_y": 1.1e-4}],
)  # fmt: skip
def test_just_within_the_admitted_geometries_round_trips_hold(values):
    other = Redundant3T1R(Redundant3T1R.Geometry(**values))
    poses = reachable(other, box(20_000, seed=15, y=0.6, z=0.6))
    assert len(poses) > 10_000
    assert np.abs(other.forward(other.inverse(poses)) - poses).max() < 1e-9
