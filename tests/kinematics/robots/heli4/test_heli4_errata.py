"""What Heli4's paper prints and what holds: each printed formula contradicts the closure, the mended one agrees.

Oblique limbs at two heights show what Table 1's symmetry hides; where it does hide a slip, that is asserted too.
"""

import numpy as np
import pytest

from kinematics import Heli4
from kinematics.robots.heli4.graph import heli4_joint_graph
from tests.kinematics.by_hand import OBLIQUE, UPPER, ByHand, cylinder
from tests.kinematics.robots.redundant_3t1r.printed_forward import conic_values, conics, eliminated, spheres

TABLE_1 = Heli4.Geometry()
LEVEL = OBLIQUE.with_values(height_step=0.0)
POSE = np.array([0.13, -0.08, -0.68, 0.7])


def joints_at(geometry, pose=POSE):
    return Heli4(geometry).inverse(pose)


def test_table_1_pitch_is_per_turn_and_6_wants_it_per_radian():
    """One turn of the tool moves the upper plate by 50 mm: limbs 3 and 4 stand as at a tool 50 mm higher."""
    robot = Heli4()
    turned, raised, unturned = robot.inverse([np.add(POSE, [0, 0, 0, 2 * np.pi]), np.add(POSE, [0, 0, 0.050, 0]), POSE])
    assert np.abs(turned - raised)[2:].max() < 1e-14
    assert np.array_equal(turned[:2], unturned[:2])
    assert np.isnan(robot.inverse(np.add(POSE, [0, 0, 0.050 * 2 * np.pi * 2, 0]))).any()  # what (6) makes of two turns


def test_the_workspace_is_one_metre_in_diameter_not_in_radius():
    robot = Heli4()
    rim = cylinder(1000, seed=1)
    rim[:, :2] *= 1.0 / np.linalg.norm(rim[:, :2], axis=1, keepdims=True)
    assert robot.margin("reach", rim).max() < 0.0
    assert robot.margin("reach", cylinder(100_000, seed=1)).min() > 0.0


def inverse_terms(geometry, pose):
    """M_i, N_i of (11) and |B_i P_i|^2."""
    hand = ByHand(geometry)
    to_actuator = hand.actuators - hand.platforms(pose)
    twice = 2 * geometry.arm_length
    return twice * to_actuator[..., 2], twice * (to_actuator * hand.u).sum(-1), (to_actuator**2).sum(-1)


@pytest.mark.parametrize("geometry", [TABLE_1, OBLIQUE], ids=["table 1", "oblique"])
def test_12_has_the_sign_of_the_squared_distance_wrong(geometry):
    m, n, square = inverse_terms(geometry, POSE)
    q = joints_at(geometry)
    left = m * np.cos(q) + n * np.sin(q)
    assert np.abs(left - (geometry.rod_length**2 - square - geometry.arm_length**2)).max() < 1e-15
    assert np.abs(left - (geometry.rod_length**2 + square - geometry.arm_length**2)).min() > 0.1


def test_14_jumps_by_a_turn_where_an_arm_passes_pi():
    robot, poses = Heli4(), cylinder(100_000, seed=2)
    m, n, square = inverse_terms(TABLE_1, poses)
    right = TABLE_1.rod_length**2 - square - TABLE_1.arm_length**2
    a, b, c = right + m, -2 * n, right - m
    printed = 2 * np.arctan((-b + np.sqrt(b**2 - 4 * a * c)) / (2 * a))
    joints = robot.inverse(poses)
    jumped = joints > np.pi
    assert np.abs(printed - joints)[~jumped].max() < 1e-12
    assert np.abs(printed + 2 * np.pi - joints)[jumped].max() < 1e-12
    assert np.abs(jumped.mean(axis=0) - 0.05).max() < 0.01  # of the workspace, for each limb
    assert np.abs(jumped.any(axis=-1).mean() - 0.20) < 0.02  # for one limb or another


def sphere_values(geometry, printed):
    """|X + s_i|^2 - l^2 of (16), with (x, y, z) or (x, y, z + p theta) for X."""
    hand = ByHand(geometry)
    centre = POSE[:3] + (UPPER * hand.pitch * POSE[3])[:, None] * [0, 0, 1]
    s = spheres(hand, joints_at(geometry), printed)
    return ((centre + s) ** 2).sum(-1) - geometry.rod_length**2


def test_18_forgets_the_height_of_actuators_3_and_4():
    assert np.abs(sphere_values(OBLIQUE, printed=False)).max() < 1e-15
    assert np.abs(sphere_values(OBLIQUE, printed=True)[2:]).min() > 0.01
    assert np.abs(sphere_values(LEVEL, printed=True)).max() < 1e-15  # hidden by H = 0


@pytest.mark.parametrize("geometry", [TABLE_1, OBLIQUE], ids=["table 1", "oblique"])
def test_19_and_20_want_half_the_last_term(geometry):
    hand, joints = ByHand(geometry), joints_at(geometry)
    heights = POSE[2], POSE[2] + hand.pitch * POSE[3]
    for mended, printed, z in zip(conics(hand, joints), conics(hand, joints, {"19"}), heights, strict=True):
        assert abs(np.dot(mended.plane, [*POSE[:2], 1.0]) - z) < 1e-13
        assert abs(np.dot(printed.plane, [*POSE[:2], 1.0]) - z) > 0.1


@pytest.mark.parametrize(("plane", "pair"), [([0.0, 0.1], slice(0, 2)), ([0.1, 0.0], slice(2, 4))], ids=["x=0", "y=0"])
def test_19_and_20_divide_by_zero_on_a_whole_plane(plane, pair):
    """Where both limbs of a pair stand alike, a_j = a_k, though nothing is singular there."""
    pose = np.array([*plane, -0.7, 0.3])
    a = spheres(ByHand(TABLE_1), joints_at(TABLE_1, pose))[pair, 2]
    assert abs(a[0] - a[1]) < 1e-15
    assert np.abs(Heli4().forward(joints_at(TABLE_1, pose)) - pose).max() < 1e-12


def misfit(geometry, slips):
    """How far the pose is from (21), for both conics."""
    pair = conics(ByHand(geometry), joints_at(geometry), slips)
    return np.abs([conic_values(conic, *POSE[:2]) for conic in pair])


def test_22_to_25_mended_hold():
    for geometry in (TABLE_1, OBLIQUE):
        assert misfit(geometry, set()).max() < 1e-12


@pytest.mark.parametrize("slip", ["22", "23", "24", "25"])
def test_22_to_25_each_slip_alone_breaks_the_conics(slip):
    assert misfit(OBLIQUE, {slip}).min() > 1e-4


def test_22_is_hidden_by_table_1():
    assert misfit(TABLE_1, {"22"}).max() < 1e-12


def quartic_at(value, geometry, slips=()):
    """The quartic's value, over the sum of its terms' sizes."""
    coefficients, _ = eliminated(*conics(ByHand(geometry), joints_at(geometry)), slips)
    return abs(np.polyval(coefficients, value)) / np.polyval(np.abs(coefficients), abs(value))


@pytest.mark.parametrize("geometry", [TABLE_1, OBLIQUE], ids=["table 1", "oblique"])
def test_26_is_a_quartic_in_y(geometry):
    x, y = POSE[:2]
    assert quartic_at(y, geometry) < 1e-11
    assert quartic_at(x, geometry) > 1e-3


@pytest.mark.parametrize(("geometry", "slip"), [(TABLE_1, "29 u3"), (OBLIQUE, "29 u3"), (OBLIQUE, "29 u4")])
def test_29_takes_v3_where_v5_belongs(geometry, slip):
    assert quartic_at(POSE[1], geometry) < 1e-11
    assert quartic_at(POSE[1], geometry, {slip}) > 1e-4


def test_29_is_hidden_by_table_1_in_u4():
    first, second = conics(ByHand(TABLE_1), joints_at(TABLE_1))
    v = eliminated(first, second)[1]
    assert abs(v[0]) < 1e-12 * abs(v[1])
    assert quartic_at(POSE[1], TABLE_1, {"29 u4"}) < 1e-11


@pytest.mark.parametrize("geometry", [TABLE_1, OBLIQUE], ids=["table 1", "oblique"])
def test_34_gives_x_from_y(geometry):
    x, y = POSE[:2]
    v = eliminated(*conics(ByHand(geometry), joints_at(geometry)))[1]

    def expression(other):
        return -(v[1] * other**2 + v[3] * other + v[4]) / (v[0] * other + v[2])

    assert abs(expression(y) - x) < 1e-11
    assert abs(expression(x) - y) > 1e-2


@pytest.mark.parametrize("geometry", [TABLE_1, OBLIQUE], ids=["table 1", "oblique"])
def test_35_wants_the_upper_pair(geometry):
    hand, at = ByHand(geometry), np.array([*POSE[:2], 1.0])
    lower, upper = (np.dot(conic.plane, at) for conic in conics(hand, joints_at(geometry)))
    assert abs((upper - POSE[2]) / hand.pitch - POSE[3]) < 1e-10
    assert abs((lower - POSE[2]) / hand.pitch) < 1e-10  # as printed, no angle at all


def test_four_roots_are_real_and_the_largest_is_almost_never_the_working_one():
    robot, wrong, poses = Heli4(), 0, cylinder(300, seed=3)
    for pose, joints in zip(poses, robot.inverse(poses), strict=True):
        coefficients, _ = eliminated(*conics(ByHand(TABLE_1), joints))
        roots = np.roots(coefficients)
        assert len(robot.assembly_modes(joints)) == 4
        assert np.abs(roots.imag).max() < 1e-3
        largest = roots.real[np.abs(roots.real).argmax()]
        wrong += abs(largest - pose[1]) > 1e-4
    assert wrong > 0.9 * len(poses)


def graph_motions(geometry, pose):
    """Joint rates (k, 4) and v (k, 8) of (49) for every motion that the joints themselves allow."""
    graph = heli4_joint_graph(Heli4(geometry), pose)
    motions, parts = graph.motions(), graph.parts
    omega = {part: motions[:, i, :3] for i, part in enumerate(parts)}
    tool = motions[:, parts.index("tool")]
    rates = np.stack([omega[j.second] @ j.axes[0] for j in graph.joints if j.driven], axis=-1)
    relative = [(omega[plate] - omega["tool"])[:, 2:] for plate in ("lower plate", "upper plate")]
    return rates, np.concatenate([tool[:, 3:] + np.cross(tool[:, :3], pose[:3]), tool[:, :3], *relative], axis=-1)


def with_printed_sign(geometry, pose, j_r):
    """J_r of (49) with +p l . e_z where -p l . e_z belongs."""
    rods = ByHand(geometry).rods(np.asarray(pose), joints_at(geometry, pose))
    result = j_r.copy()
    result[:, 7] += 2 * np.repeat(UPPER * ByHand(geometry).pitch * rods[:, 2], 2)
    return result


def test_44_holds_with_a_minus():
    geometry = TABLE_1.with_values(azimuths=(0.0, np.pi / 2, np.pi, 3 * np.pi / 2))
    graph = heli4_joint_graph(Heli4(geometry), Heli4().home)
    found = graph.mobility()
    assert found.kinematic - found.constraint == graph.count().mobility
    assert found.kinematic + found.constraint != graph.count().mobility


def test_49_has_eight_unknowns():
    """A ninth would leave the plate a motion that no rod sees."""
    _, j_r = Heli4(OBLIQUE).rod_system(POSE)
    assert j_r.shape == (8, len(Heli4.rod_velocities)) == (8, 8)
    assert np.linalg.matrix_rank(j_r) == 8


@pytest.mark.parametrize("geometry", [TABLE_1, OBLIQUE], ids=["table 1", "oblique"])
def test_49_and_53_have_the_sign_of_p_wrong(geometry):
    """Against the motions of the joint graph, whose screw moves as (6) says."""
    rates, v = graph_motions(geometry, POSE)
    j_l, j_r = Heli4(geometry).rod_system(POSE)
    assert np.abs(rates @ j_l.T - v @ j_r.T).max() < 1e-9
    assert np.abs(rates @ j_l.T - v @ with_printed_sign(geometry, POSE, j_r).T).max() > 1e-3
    j_q, j_x = Heli4(geometry).jacobians(POSE)
    printed = j_x * [1, 1, 1, -1]
    twist = v[:, [0, 1, 2, 5]]
    assert np.abs(rates @ j_q.T - twist @ j_x.T).max() < 1e-9
    assert np.abs(rates @ j_q.T - twist @ printed.T).max() > 1e-3


def test_54_has_the_sign_of_p_wrong():
    """It only shows where plates turn: on an internal singularity."""
    geometry = TABLE_1.with_values(azimuths=(0.0, np.pi / 2, np.pi, 3 * np.pi / 2))
    robot, pose = Heli4(geometry), np.array(Heli4().home)
    rates, v = graph_motions(geometry, pose)
    own = np.linalg.solve(robot.column_combinations, v.T).T  # (x', v_int)
    assert np.abs(own[:, 4:]).max() > 1e-3
    j_q, j_x, j_int_x, _ = robot.block_triangular(pose)
    hand = ByHand(geometry)
    printed = j_int_x.copy()
    printed[:, 3] += 2 * UPPER * hand.pitch * hand.rods(pose, robot.inverse(pose))[:, 2]
    left = rates @ j_q.T - own[:, :4] @ j_x.T
    assert np.abs(left - own[:, 4:] @ j_int_x.T).max() < 1e-9
    assert np.abs(left - own[:, 4:] @ printed.T).max() > 1e-4
