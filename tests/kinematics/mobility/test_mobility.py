"""Gruebler's count of Heli4, and the rank of all its joints' velocity equations that confirms it."""

import numpy as np
import pytest

from kinematics import Heli4, InvalidValue, JointGraph, UnreachablePose
from kinematics.mobility.joint_graph import Joint
from kinematics.robots.heli4.graph import heli4_joint_graph
from tests.kinematics.by_hand import OBLIQUE, cylinder

SINGULAR = Heli4.Geometry(azimuths=(0.0, np.pi / 2, np.pi, 3 * np.pi / 2))
X, Y, Z = np.eye(3)


def test_the_papers_count():
    count = heli4_joint_graph(Heli4(), Heli4().home).count()
    assert count == (16, 22, 7, 54, 42, 78, 90)
    assert count.mobility == count.force_equations - count.unknown_forces == 12


def test_the_papers_joints():
    graph = heli4_joint_graph(Heli4(), Heli4().home)
    kinds = [joint.kind for joint in graph.joints]
    assert [kinds.count(k) for k in "RSH"] == [5, 16, 1]
    assert graph.constraints().shape == (78, 90)


@pytest.mark.parametrize("geometry", [Heli4.Geometry(), OBLIQUE], ids=["prototype", "oblique"])
def test_twelve_motions_and_no_redundant_constraint_at_regular_poses(geometry):
    robot = Heli4(geometry)
    for pose in cylinder(20, seed=1, radius=0.3):
        found = heli4_joint_graph(robot, pose).mobility()
        assert (found.kinematic, found.constraint) == (12, 0)
        assert found.smallest_kept > 1e-5
        locked = heli4_joint_graph(robot, pose).with_drives_locked().mobility()
        assert (locked.kinematic, locked.constraint) == (8, 0)


@pytest.mark.parametrize("geometry", [Heli4.Geometry(), OBLIQUE], ids=["prototype", "oblique"])
def test_every_motion_turns_only_the_tool_and_obeys_the_inverse_jacobian(geometry):
    """The 90 unknowns know nothing of J_m, nor that the plates must keep their orientation."""
    robot = Heli4(geometry)
    pose = np.array([0.12, -0.07, -0.68, 0.9])
    graph = heli4_joint_graph(robot, pose)
    parts, motions = graph.parts, graph.motions()
    omega, at_origin = motions[..., :3], motions[..., 3:]
    tool = parts.index("tool")
    rates = np.stack([omega[:, parts.index(f"arm {j.second[-1]}")] @ j.axes[0] for j in graph.joints if j.driven], -1)
    velocity = at_origin[:, tool] + np.cross(omega[:, tool], pose[:3])
    twist = np.concatenate([velocity, omega[:, tool, 2:]], axis=-1)
    assert np.abs(rates - twist @ robot.inverse_jacobian(pose).T).max() < 1e-9
    assert np.linalg.matrix_rank(rates, tol=1e-9) == 4
    for plate in ("lower plate", "upper plate"):
        assert np.abs(omega[:, parts.index(plate)]).max() < 1e-9
    assert np.abs(omega[:, tool, :2]).max() < 1e-9


def test_an_internal_singularity_makes_a_constraint_redundant():
    """Then m_K + m_S, as (44) prints, is 14; m_K - m_S is still the count's 12."""
    graph = heli4_joint_graph(Heli4(SINGULAR), Heli4().home)
    found = graph.mobility()
    assert (found.kinematic, found.constraint) == (13, 1)
    assert found.mobility == graph.count().mobility == 12
    assert found.largest_dropped < 1e-14
    assert found.smallest_kept > 1e-4


def test_away_from_it_the_same_geometry_is_regular():
    found = heli4_joint_graph(Heli4(SINGULAR), [0.1, 0.05, -0.7, 0.4]).mobility()
    assert (found.kinematic, found.constraint) == (12, 0)


def test_with_drives_locked_the_parallel_singularity_shows_too():
    """Internal and parallel determinant both vanish here: two motions that the drives do not hold."""
    locked = heli4_joint_graph(Heli4(SINGULAR), Heli4().home).with_drives_locked().mobility()
    assert (locked.kinematic, locked.constraint) == (10, 2)


def test_nothing_is_built_out_of_reach():
    with pytest.raises(UnreachablePose):
        heli4_joint_graph(Heli4(), [2.0, 0.0, -0.7, 0.0])


def planar_four_bar() -> JointGraph:
    places = {"a": [0, 0, 0], "b": [0, 1, 0], "c": [2, 1.5, 0], "d": [2, 0, 0]}
    links = [("base", "crank"), ("crank", "coupler"), ("coupler", "rocker"), ("rocker", "base")]
    return JointGraph(
        tuple(Joint("R", *link, np.array(p, float), (Z,)) for link, p in zip(links, places.values(), strict=True))
    )


def test_a_planar_four_bar_moves_though_its_count_says_it_should_not():
    graph = planar_four_bar()
    assert graph.count().mobility == -2
    assert graph.mobility()[:2] == (1, 3)


def platform_twists(joints: list[Joint]) -> tuple[np.ndarray, np.ndarray]:
    """(k, 3) rotations and (k, 3) velocities at the origin of the part `platform`, over all motions."""
    graph = JointGraph(tuple(joints))
    twists = graph.motions()[:, graph.parts.index("platform")]
    return twists[:, :3], twists[:, 3:]


def schoenflies_chain(name: str, axis: np.ndarray, place: np.ndarray) -> list[Joint]:
    """Three slides and a turn about `axis`, from the base to the platform."""
    parts = ["base", f"{name} 1", f"{name} 2", f"{name} 3", "platform"]
    slides = [Joint("P", *parts[i : i + 2], place, (e,)) for i, e in enumerate((X, Y, Z))]
    return [*slides, Joint("R", *parts[3:], place, (axis,))]


def test_36_two_schoenflies_chains_about_different_axes_leave_translations_only():
    rng = np.random.default_rng(3)
    places = rng.normal(size=(2, 3))
    for other, turns in ((X, 0), (np.array([0.6, 0.0, 0.8]), 0), (Z, 1)):
        joints = schoenflies_chain("one", Z, places[0]) + schoenflies_chain("two", other, places[1])
        omega, velocity = platform_twists(joints)
        assert np.linalg.matrix_rank(np.hstack([omega, velocity]), tol=1e-9) == 3 + turns
        assert np.linalg.matrix_rank(omega, tol=1e-9) == turns
        assert np.linalg.matrix_rank(velocity, tol=1e-9) == 3


def test_a_limb_of_two_rods_leaves_three_translations_and_two_rotations():
    """It holds only the rotation about d x l: what makes (36) the wrong tool for Heli4."""
    d, rod, arm = 0.1 * Y, np.array([0.2, 0.1, -0.7]), np.array([0.3, 0.0, 0.1])
    joints = [Joint("R", "base", "arm", np.zeros(3), (Y,))]
    for side, name in ((-0.5, "rod 1"), (0.5, "rod 2")):
        joints.append(Joint("S", "arm", name, arm + side * d))
        joints.append(Joint("S", name, "platform", arm + rod + side * d))
    omega, velocity = platform_twists(joints)
    assert np.linalg.matrix_rank(np.hstack([omega, velocity]), tol=1e-9) == 5
    assert np.linalg.matrix_rank(omega, tol=1e-9) == 2
    assert np.abs(omega @ np.cross(d, rod)).max() < 1e-12


@pytest.mark.parametrize(
    ("kind", "axes", "freedoms"),
    [("fixed", (), 0), ("R", (Z,), 1), ("P", (Z,), 1), ("H", (Z,), 1), ("C", (Z,), 2), ("U", (X, Y), 2), ("S", (), 3)],
)
def test_one_joint_leaves_its_freedoms_and_nothing_else(kind, axes, freedoms):
    place = np.array([0.3, -0.2, 0.5])
    graph = JointGraph((Joint(kind, "base", "body", place, axes, pitch=0.1 if kind == "H" else 0.0),))
    assert graph.mobility()[:2] == (freedoms, 0)
    for twist in graph.motions()[:, 1]:
        omega, velocity = twist[:3], twist[3:] + np.cross(twist[:3], place)
        if kind in "RUS":
            assert np.abs(velocity).max() < 1e-14
        if kind == "P":
            assert np.abs(omega).max() < 1e-14
        if kind == "H":
            assert np.abs(velocity - 0.1 / (2 * np.pi) * omega).max() < 1e-14
        if kind in "RPHC":
            assert np.abs(np.cross(omega, Z)).max() < 1e-14
        if kind == "U":
            assert abs(omega[2]) < 1e-14


def test_unknown_kinds_and_missing_axes_are_refused():
    with pytest.raises(InvalidValue, match="joint kind"):
        Joint("Q", "a", "b", np.zeros(3))
    with pytest.raises(InvalidValue, match="axes of a joint U"):
        Joint("U", "a", "b", np.zeros(3), (Z,))
