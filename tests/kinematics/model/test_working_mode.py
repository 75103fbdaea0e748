"""Home decides the working mode: which branch each limb keeps, which assembly mode, where the angles are cut."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from kinematics import (
    MECHANISMS,
    Delta,
    GoughStewart,
    Heli4,
    Hexa,
    InvalidShape,
    InvalidValue,
    Mechanism,
    Par4,
    Peppermill,
    Planar3PRR,
    Planar3RPR,
    Planar3RRR,
    Redundant3T1R,
    kind_of,
)
from tests.sizes import few_or_many, later

EACH = pytest.mark.parametrize("kind", MECHANISMS.values(), ids=list(MECHANISMS))
UPSIDE_DOWN = {  # coordinates of the pose that change sign when the robot is mirrored in the plane of its drives
    Delta: (2,),
    Par4: (2,),
    Hexa: (2, 3, 4),
    GoughStewart: (2, 3, 4),
}


def around(robot: Mechanism, count: int, seed: int, share: float = 0.1) -> np.ndarray:
    """(count, n) poses about home, lengths by a share of the robot's size."""
    rng, unit = np.random.default_rng(seed), np.full(len(robot.pose_names), share * robot.geometry.size)
    unit[list(robot.rotations)] = share
    return robot.home + rng.uniform(-1.0, 1.0, (count, len(unit))) * unit


def mirrored(poses: np.ndarray, coordinates: tuple[int, ...]) -> np.ndarray:
    signs = np.ones(poses.shape[-1])
    signs[list(coordinates)] = -1.0
    return poses * signs


@pytest.mark.parametrize("kind", UPSIDE_DOWN, ids=lambda kind: kind.__name__)
def test_a_platform_on_the_other_side_of_the_drives_is_the_mirror_image(kind: Any) -> None:
    """Reflected in the plane z = 0, in which the drives lie, arms turn by the supplement and legs keep their length."""
    below = kind()
    geometry = below.geometry
    if kind is Hexa or kind is GoughStewart:  # flat bases and platforms are their own mirror images
        assert not np.array(geometry.base_points)[:, 2].any()
        assert not np.array(geometry.platform_points)[:, 2].any()
    above = kind(home=mirrored(below.home, UPSIDE_DOWN[kind]))
    poses = around(below, 200, seed=1, share=0.05)
    reflected = mirrored(poses, UPSIDE_DOWN[kind])
    joints, theirs = below.inverse(poses), above.inverse(reflected)
    assert np.isfinite(joints).all()
    expected = joints if kind is GoughStewart else np.pi - joints
    assert np.abs(theirs - expected).max() < 1e-12
    assert np.abs(above.forward(theirs) - reflected).max() < 1e-9
    for margin in ("reach", "J_q", "det_J_x", "fvi"):
        assert above.margin(margin, reflected) == pytest.approx(below.margin(margin, poses), rel=1e-9), margin


def test_heli4_above_its_drives_keeps_its_elbows_outside_and_comes_back() -> None:
    """Its screw keeps its hand in the mirror, so that a climb of the upper plate turns into a fall: theta reflects."""
    below = Heli4(Heli4.Geometry(plate_offset=0.0))
    above = Heli4(below.geometry, home=mirrored(below.home, (2, 3)))
    poses = around(below, 200, seed=2)
    reflected = mirrored(poses, (2, 3))
    assert np.abs(above.inverse(reflected) - (np.pi - below.inverse(poses))).max() < 1e-12
    assert np.abs(above.forward(above.inverse(reflected)) - reflected).max() < 1e-10
    assert np.abs(above.internal_determinant(reflected)) == pytest.approx(
        np.abs(below.internal_determinant(poses)), abs=1e-12
    )


def test_slides_on_the_other_side_are_the_mirror_image_in_x() -> None:
    """theta of the mirror image counts the other way, from a platform that is turned by half a turn."""
    usual = Redundant3T1R()
    poses = around(usual, 200, seed=3)
    reflected = poses * [-1, 1, 1, -1] + [0, 0, 0, np.pi]
    ahead = Redundant3T1R(home=[0, 0, 0, np.pi], home_joints=-usual.inverse(usual.home))
    assert ahead.mode.branches == (-1,) * 6
    joints = ahead.inverse(reflected)
    assert np.abs(joints + usual.inverse(poses)).max() < 1e-12
    back = ahead.forward(joints)
    turns = np.remainder(back[:, 3] - reflected[:, 3] + np.pi, 2 * np.pi) - np.pi
    assert max(np.abs(back[:, :3] - reflected[:, :3]).max(), np.abs(turns).max()) < 1e-10


def test_a_peppermill_above_both_drive_axes_reaches_up_with_both_limbs() -> None:
    robot = Peppermill(home=[0.0, 0.0, 0.5, -10 * np.pi])
    usual = Peppermill()
    assert usual.sides == (1, -1)
    poses = robot.home + np.random.default_rng(4).uniform(-0.03, 0.03, (200, 4))
    assert np.isfinite(robot.inverse(poses)).all()
    assert robot.sides == (1, 1)
    assert np.abs(robot.forward(robot.inverse(poses)) - poses).max() < 1e-9
    assert not np.abs(usual.forward(usual.inverse(poses)) - poses).max() < 0.1  # of the layout about the origin


@pytest.mark.parametrize("kind", [Delta, Heli4, Par4, Hexa, Planar3RRR, Planar3PRR, Peppermill, Redundant3T1R])
def test_joints_at_home_choose_the_branch_of_each_limb(kind: Any) -> None:
    usual = kind()
    joints = usual.inverse(usual.home)
    rotary = [i for i, unit in enumerate(usual.joint_units) if unit == "rad"] or list(range(len(joints)))
    count = len(joints)
    for limb in rotary[:2]:
        branches = tuple(-b if i == limb else b for i, b in enumerate(usual.mode.branches))
        other = _with_branches(usual, branches)
        asked = kind(home=usual.home, home_joints=other)
        assert asked.mode.branches == branches
        found = asked.inverse(usual.home)
        assert np.abs(asked.closure_residual(usual.home, found)).max() < 1e-13
        assert np.abs(found - joints)[limb] > 0.05
        assert np.delete(np.abs(found - joints), limb).max(initial=0.0) < 1e-12
        assert np.abs(asked.forward(found) - usual.home).max() < 1e-8
        poses = around(asked, 50, seed=4, share=0.02)
        for at_pose, derived in zip(asked.jacobians(poses), asked.jacobians(poses, asked.inverse(poses)), strict=True):
            assert np.abs(at_pose - derived).max() < 1e-12, "seed 4"
        assert kind(home=usual.home, home_joints=joints).mode.branches == (1,) * count


def _with_branches(robot: Mechanism, branches: tuple[int, ...]) -> np.ndarray:
    from kinematics.model.symbolic_model import model_of

    function = model_of(type(robot), robot.mode._replace(branches=branches)).inverse_function
    return np.array(function(robot.home, robot.geometry.vector()))[:, 0]


@EACH
def test_forward_comes_back_to_every_pose_from_one_that_is_near(kind: Any) -> None:
    robot = kind()
    for seed in range(3):
        poses = around(robot, 100, seed=seed + 5)
        poses = poses[np.isfinite(robot.inverse(poses)).all(axis=-1)]
        near = poses + around(robot, len(poses), seed=seed + 50, share=0.01) - robot.home
        found = robot.forward(robot.inverse(poses), near=near)
        assert np.isfinite(found).all(axis=-1).mean() > 0.97
        assert np.nanmax(np.abs(found - poses)) < 1e-9


@EACH
def test_a_pose_followed_along_a_line_of_poses_never_changes_its_assembly_mode(kind: Any) -> None:
    """Each pose is continued from the one before; where det J_x keeps its sign, all of the line comes back."""
    robot, rng = kind(), np.random.default_rng(8)
    ends = np.stack([around(robot, 2, seed=int(rng.integers(1 << 30)), share=0.15) for _ in range(12)])
    lines = ends[:, 0] + np.linspace(0.0, 1.0, 60)[:, None, None] * (ends[:, 1] - ends[:, 0])
    joints = robot.inverse(lines)
    clear = np.nan_to_num(robot.margin("det_J_x", lines)).min(axis=0) > 1e-3
    lines, joints = lines[:, clear], joints[:, clear]
    pose = lines[0]
    for k in range(1, len(lines)):
        pose = robot.forward(joints[k], near=pose)
    assert np.abs(pose - lines[-1]).max() < 1e-8, "seed 8"
    assert clear.sum() >= 3


@EACH
def test_joint_angles_do_not_jump_within_half_a_turn_of_home(kind: Any) -> None:
    """Along lines through home no joint steps by more than its rate allows: the cut is on the far side."""
    robot = kind()
    for far in around(robot, 20, seed=9, share=0.3):
        line = robot.home + np.linspace(0.0, 1.0, 400)[:, None] * (far - robot.home)
        joints = robot.inverse(line)
        reached = np.isfinite(joints).all(axis=-1)
        line, joints = line[: np.argmin(np.append(reached, False))], joints[: np.argmin(np.append(reached, False))]
        if len(line) < 2 or robot.margin("J_q", line).min() < 0.05:
            continue
        rotary = [i for i, unit in enumerate(robot.joint_units) if unit == "rad"]
        assert np.abs(np.diff(joints[:, rotary], axis=0)).max(initial=0.0) < 0.5


def test_arms_that_work_about_the_horizontal_are_smooth_there_for_any_mounting() -> None:
    """Servo arms that lie level at home, each pointing wherever its servo does, platform above and below."""
    rng = np.random.default_rng(10)
    usual = Hexa.Geometry(arm_length=0.06, rod_length=0.5)
    for height in (0.49, -0.49):
        azimuths = tuple(rng.uniform(-np.pi, np.pi, 6))
        points = usual.base_points
        geometry = replace(usual, arm_azimuths=azimuths, platform_points=points)
        robot = Hexa(geometry, home=[0, 0, height, 0, 0, 0])
        assert np.abs(robot.inverse(robot.home) - np.pi / 2).max() < 0.8
        lift = robot.home + np.linspace(-0.03, 0.03, 200)[:, None] * np.eye(6)[2]
        joints = robot.inverse(lift)
        assert np.isfinite(joints).all()
        assert np.abs(np.diff(joints, axis=0)).max() < 0.02


def test_angles_are_counted_in_the_turn_around_the_middle_of_their_range() -> None:
    usual = Delta()
    turned = Delta(ranges=Delta.Ranges(joints=(2 * np.pi, 2 * np.pi + 3.8)))
    pose = np.array([0.1, -0.05, -0.75])
    assert np.abs(turned.inverse(pose) - usual.inverse(pose) - 2 * np.pi).max() < 1e-14
    assert turned.margin("joint_travel", pose) == pytest.approx(usual.margin("joint_travel", pose), abs=1e-12)
    assert np.abs(turned.forward(turned.inverse(pose)) - pose).max() < 1e-12


@pytest.mark.parametrize(
    ("arms", "home"), [((0.0, 3.8), 0.3), ((0.0, 3.8), 3.3), ((-1.2, 1.8), -0.9), ((2.6, 7.0), 2.7)]
)
def test_the_cut_of_an_angle_lies_outside_a_range_that_holds_home(arms: tuple[float, float], home: float) -> None:
    """A planar arm at any angle of its range, with home at one end: no turn is lost or added on the way."""
    usual = Planar3RRR.Geometry()
    base, platform = np.array(usual.base_points), np.array(usual.platform_points)
    angles = np.linspace(arms[0], arms[1], 50)[1:-1]
    elbow = base[0] + usual.arm_lengths[0] * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    reached = elbow + usual.rod_lengths[0] * np.stack([np.cos(angles + 1.0), np.sin(angles + 1.0)], axis=1)
    geometry = usual.with_values(
        zero_angles=(0.0, *usual.zero_angles[1:]), arm_lengths=(0.3, 2.0, 2.0), rod_lengths=(0.35, 2.0, 2.0)
    )
    poses = np.column_stack([reached - platform[0], np.zeros(len(angles))])
    ranges = Planar3RRR.Ranges(joints=(arms, (-20.0, 20.0), (-20.0, 20.0)))
    at_home = poses[int(np.abs(angles - home).argmin())]
    robot = Planar3RRR(geometry, home=at_home, ranges=ranges)
    side = np.sign(robot.inverse(poses)[:, 0] - angles).any()
    if side:  # the elbow is on the other side: choose it
        robot = Planar3RRR(geometry, home=at_home, ranges=ranges, home_joints=[home, *robot.inverse(at_home)[1:]])
    assert robot.inverse(poses)[:, 0] == pytest.approx(angles, abs=1e-9)


@EACH
def test_the_default_home_is_within_reach_at_any_size(kind: Any) -> None:
    for size in (1e-3, 1.0, 1e3):
        robot = kind(scaled(kind, size))
        assert robot.margin("reach", robot.home) > 0.0
        unit = np.full(len(robot.pose_names), size)
        unit[list(robot.rotations)] = 1.0
        assert robot.home == pytest.approx(kind().home * unit, rel=1e-9, abs=1e-12 * size)


@EACH
@pytest.mark.parametrize("size", [1e-3, later(0.02), later(50.0), later(1e3)])
def test_a_robot_of_another_size_does_the_same(kind: Any, size: float) -> None:
    """Lengths scale, angles stay; and with them all dimensionless margins."""
    usual, robot = kind(), kind(scaled(kind, size))
    of_pose, of_joints = np.full(len(robot.pose_names), size), np.full(len(robot.joint_names), size)
    of_pose[list(robot.rotations)] = 1.0
    of_joints[[unit == "rad" for unit in robot.joint_units]] = 1.0
    poses = around(usual, 50, seed=11)
    joints = usual.inverse(poses)
    theirs = robot.inverse(poses * of_pose)
    assert np.array_equal(np.isnan(theirs), np.isnan(joints))
    assert np.nanmax(np.abs(theirs / of_joints - joints)) < 1e-11
    for near in (None, robot.home):
        found, wanted = (
            robot.forward(theirs, near=near),
            usual.forward(joints, near=None if near is None else usual.home),
        )
        assert np.array_equal(np.isnan(found), np.isnan(wanted))
        assert np.nanmax(np.abs(found / of_pose - wanted)) < 1e-8
    for margin in ("J_q", "det_J_q", "det_J_x"):
        assert robot.margin(margin, poses * of_pose) == pytest.approx(
            usual.margin(margin, poses), rel=1e-7, nan_ok=True
        )


def scaled(kind: Any, size: float) -> Any:
    """The default geometry with every length times a number."""
    from dataclasses import fields

    usual = kind.Geometry()
    lengths = {f.name for f in fields(usual) if kind_of(f).dimension in ("length", "length_per_turn")}
    changes = {name: np.asarray(getattr(usual, name)) * size for name in lengths}
    return usual.with_values(**{name: _plain(value) for name, value in changes.items()})


def _plain(value: np.ndarray) -> Any:
    return tuple(_plain(row) for row in value) if value.ndim else float(value)


@pytest.mark.parametrize(
    ("given", "error"),
    [
        ({"home": [0.0, 0.0]}, InvalidShape),
        ({"home": [0.0, 0.0, np.nan]}, InvalidValue),
        ({"home": "middle"}, InvalidValue),
        ({"home_joints": [1.0, 1.0]}, InvalidShape),
        ({"home_joints": [[1.0, 1.0, 1.0]]}, InvalidValue),
    ],
)
def test_a_home_that_is_no_pose_is_refused(given: dict[str, Any], error: type[Exception]) -> None:
    with pytest.raises(error, match="home"):
        Delta(**given)


def test_robots_with_equal_numbers_are_equal_and_another_home_makes_another_robot() -> None:
    assert Delta() == Delta()
    assert hash(Delta()) == hash(Delta())
    assert Delta() != Delta(home=[0, 0, 0.7])
    assert Planar3RPR() != Planar3PRR()
    assert Delta(home=[0, 0, 0.7]).with_geometry(Delta.Geometry(arm_length=0.4)).home.tolist() == [0, 0, 0.7]


# Double roots.


def test_a_delta_stretched_flat_has_one_pose() -> None:
    """Arms level, rods in line with them: the three spheres touch in the plate's centre."""
    for size in (1e-3, 1.0, 1e3):
        g = Delta.Geometry(
            base_radius=0.2 * size, platform_radius=0.05 * size, arm_length=0.35 * size, rod_length=0.5 * size
        )
        pose = Delta(g).forward(np.full(3, np.pi / 2))
        assert np.abs(pose).max() < 1e-7 * size
        assert len(Delta(g).assembly_modes(np.full(3, np.pi / 2))) == 1
        beyond = replace(g, rod_length=0.499 * size)
        assert np.isnan(Delta(beyond).forward(np.full(3, np.pi / 2))).all()


@pytest.mark.parametrize("seed", range(20))
def test_a_delta_at_a_random_double_root_has_a_pose_that_closes(seed: int) -> None:
    """Rods just as long as the radius of the circle through the elbows, moved inward."""
    rng = np.random.default_rng(seed)
    joints = rng.uniform(0.5, 2.5, 3)
    g = Delta.Geometry()
    centres = np.stack([(g.base_radius - g.platform_radius + g.arm_length * np.sin(joints)), np.zeros(3)], axis=1)
    azimuth = np.array(g.azimuths)
    elbows = np.stack(
        [centres[:, 0] * np.cos(azimuth), centres[:, 0] * np.sin(azimuth), g.arm_length * np.cos(joints)], axis=1
    )
    a, b, c = (np.linalg.norm(elbows[i] - elbows[j]) for i, j in ((1, 2), (2, 0), (0, 1)))
    area = np.linalg.norm(np.cross(elbows[1] - elbows[0], elbows[2] - elbows[0])) / 2
    robot = Delta(replace(g, rod_length=float(a * b * c / (4 * area))))
    pose = robot.forward(joints)
    assert np.isfinite(pose).all()
    assert np.abs(np.linalg.norm(elbows - pose, axis=1) - robot.geometry.rod_length).max() < 1e-12


@pytest.mark.parametrize("kind", [Heli4, Planar3PRR, Planar3RRR, GoughStewart])
def test_joints_of_a_singular_pose_have_a_pose(kind: Any) -> None:
    """Where a line from home first meets det J_x = 0, found by bisection: two poses become one there."""
    robot, rng, tried = kind(), np.random.default_rng(1), 0
    for _ in range(400):
        along = rng.normal(size=len(robot.pose_names)) * robot.pose_units()
        if tried == 4:
            break
        low, high = _first_singularity(robot, along)
        if high is None:
            continue
        tried += 1
        joints = robot.inverse(robot.home + low * along)
        found = robot.forward(joints)
        assert np.isfinite(found).all()
        assert np.abs(robot.closure_gap(found, joints)).max() < 1e-11
    assert tried == 4


def _first_singularity(robot: Mechanism, along: np.ndarray) -> tuple[float, float | None]:
    def side(share: np.ndarray) -> np.ndarray:
        return np.sign(np.linalg.det(robot.jacobians(robot.home + share[..., None] * along)[1]))

    shares = np.linspace(0.0, 1.2, 400)
    reached = np.isfinite(robot.inverse(robot.home + shares[:, None] * along)).all(axis=-1)
    shares = shares[: int(np.argmin(np.append(reached, False)))]
    changes = np.flatnonzero(np.diff(side(shares))) if len(shares) > 1 else np.empty(0, dtype=int)
    if not len(changes):
        return 0.0, None
    low, high = shares[changes[0]], shares[changes[0] + 1]
    for _ in range(60):
        middle = (low + high) / 2
        same = side(np.array(middle)) == side(np.array(low))
        low, high = (middle, high) if same else (low, middle)
    return float(low), float(high)


@few_or_many(20, 60)
def test_beyond_a_singularity_no_other_assembly_mode_is_given_instead(count: int) -> None:
    """From joints that the working mode has, on to such as it has not: a pose, then none, never a far one."""
    robot, rng = Heli4(), np.random.default_rng(3)
    ended = 0
    for _ in range(count):
        way = rng.normal(size=4) * 1.5
        line = robot.inverse(robot.home) + np.linspace(0.0, 1.0, 300)[:, None] * way
        found = robot.forward(line)
        there = np.isfinite(found).all(axis=-1)
        steps = np.abs(np.diff(found, axis=0)[there[1:] & there[:-1]])
        assert steps[:, :3].max() < 0.3
        ended += int(not there.all())
    assert ended > count // 20
