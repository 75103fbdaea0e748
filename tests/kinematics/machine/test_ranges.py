"""Room to the joints' limits, driven and passive, against the angles measured by hand."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from kinematics import (
    MECHANISMS,
    Array,
    Delta,
    GoughStewart,
    Heli4,
    Hexa,
    InvalidValue,
    Mechanism,
    Par4,
    Peppermill,
    Redundant3T1R,
)
from tests.kinematics import by_hand
from tests.kinematics.robots.family import family_by_hand
from tests.kinematics.robots.gough_stewart import gough_stewart_by_hand
from tests.kinematics.robots.peppermill import peppermill_by_hand
from tests.kinematics.robots.redundant_3t1r import redundant_by_hand

ALL = pytest.mark.parametrize("kind", list(MECHANISMS.values()), ids=list(MECHANISMS))
WITH_PASSIVE = [kind for kind in MECHANISMS.values() if "passive_joint" in kind.margins]


def poses_of(robot: Mechanism, count: int = 500) -> Array:
    home, rng = np.array(robot.home), np.random.default_rng(41)
    poses = home + 0.05 * rng.standard_normal((count, len(home)))
    return poses[np.isfinite(robot.inverse(poses)).all(axis=1)]


def between(one: Array, two: Array) -> Array:
    """Angle of two vectors (..., 3)."""
    cosine = (one * two).sum(-1) / np.linalg.norm(one, axis=-1) / np.linalg.norm(two, axis=-1)
    return np.arccos(np.clip(cosine, -1.0, 1.0))


def lean(axis: Array, rod: Array) -> Array:
    return np.abs(math.pi / 2 - between(axis, rod))


@ALL
def test_travel_is_the_least_distance_of_a_joint_from_its_limits(kind: type[Mechanism]) -> None:
    poses = poses_of(kind())
    joints = kind().inverse(poses)
    low, high = joints.min(axis=0) - 0.01 * np.arange(1, joints.shape[1] + 1), joints.max(axis=0) + 0.02
    each = kind(ranges=kind.Ranges(joints=tuple(zip(low, high, strict=True))))
    wanted = np.minimum(joints - low, high - joints).min(axis=1)
    np.testing.assert_allclose(each.margin("joint_travel", poses), wanted, atol=1e-14)
    alike = kind(ranges=kind.Ranges(joints=(-math.inf, 0.7)))
    np.testing.assert_allclose(alike.margin("joint_travel", poses), (0.7 - joints).min(axis=1), atol=1e-14)


@ALL
def test_every_prototype_is_within_its_own_ranges_at_home(kind: type[Mechanism]) -> None:
    for margin in {"joint_travel", "passive_joint"} & set(kind.margins):
        assert kind().margin(margin, np.array(kind().home)) > 0.05


def test_without_limits_the_room_is_infinite() -> None:
    robot = Heli4(ranges=Heli4.Ranges(joints=(-math.inf, math.inf)))
    assert robot.margin("joint_travel", np.array(robot.home)) == math.inf


@pytest.mark.parametrize("kind", WITH_PASSIVE, ids=lambda kind: kind.__name__)
@pytest.mark.parametrize("end", [0, 1])
def test_a_passive_joint_has_the_room_that_its_angle_by_hand_leaves(kind: type[Mechanism], end: int) -> None:
    """With the other end's limit out of the way."""
    limits = (0.9, math.pi) if end == 0 else (math.pi, 0.9)
    robot = kind(ranges=kind.Ranges(passive=limits))
    poses = poses_of(robot)
    angles = _angles_by_hand(robot, poses)[end]
    np.testing.assert_allclose(robot.margin("passive_joint", poses), 0.9 - angles.max(axis=1), atol=2e-8)
    assert np.ptp(angles) > 0.05


def _angles_by_hand(robot: Mechanism, poses: Array) -> tuple[Array, Array]:
    """(k, m) at the drives' ends and at the platform's, from the points of the oracles."""
    joints = robot.inverse(poses)
    if isinstance(robot, Heli4):
        hand = by_hand.ByHand(robot.geometry)
        leans = lean(hand.axes, hand.rods(poses, joints))
        return leans, leans
    if isinstance(robot, Delta | Par4 | Hexa):
        limbs = family_by_hand.ByHand(robot)
        azimuths = robot.geometry.arm_azimuths if isinstance(robot, Hexa) else robot.geometry.azimuths
        axes = np.cross(by_hand.E_Z, family_by_hand.radial(azimuths))
        rods = limbs.tangents_and_ends(joints)[1] - limbs.platform(poses)
        turned = axes
        if isinstance(robot, Hexa):
            turned = axes @ np.swapaxes(family_by_hand.rotation(poses[:, 3:]), -1, -2)
        return lean(axes, rods), lean(turned, rods)
    if isinstance(robot, Redundant3T1R):
        leans = lean(by_hand.E_Z, redundant_by_hand.ByHand().arms(poses, joints))
        return leans, leans
    if isinstance(robot, Peppermill):
        mill = peppermill_by_hand.ByHand(robot.geometry)
        links = mill.distal(poses, joints)
        rest = np.array([[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]])
        return np.abs(math.pi / 2 - between(mill.u(joints), links)), between(rest, links)
    assert isinstance(robot, GoughStewart)
    rest = gough_stewart_by_hand.leg_vectors(robot, np.array(robot.home))[0]
    legs = np.stack([gough_stewart_by_hand.leg_vectors(robot, pose)[0] for pose in poses])
    turned = rest @ np.swapaxes(gough_stewart_by_hand.matrix_of(poses), -1, -2)
    return between(rest, legs), between(turned, legs)


def test_a_hexapods_joints_keep_their_angles_in_any_frames() -> None:
    plain = GoughStewart()
    moved = GoughStewart(plain.geometry.canonical())
    poses = poses_of(plain)
    np.testing.assert_allclose(
        moved.margin("passive_joint", poses), plain.margin("passive_joint", poses), rtol=0, atol=1e-9
    )


@pytest.mark.parametrize("kind", [Heli4, Redundant3T1R, Peppermill])
def test_out_of_reach_there_is_no_room(kind: type[Mechanism]) -> None:
    far = np.array(kind().home)
    far[1] += 5.0
    for margin in ("joint_travel", "passive_joint"):
        assert np.isnan(kind().margin(margin, far))


@pytest.mark.parametrize(
    ("kind", "change", "field"),
    [
        (Heli4, {"joints": (1.0, 1.0)}, "joints"),
        (Heli4, {"joints": (0.0, math.nan)}, "joints"),
        (Heli4, {"joints": ((0.0, 1.0),) * 3}, "joints"),
        (Peppermill, {"joints": (1.0, 2.0, 3.0, 4.0)}, "joints"),
        (Heli4, {"joints": "text"}, "joints"),
        (Heli4, {"joints": ((0.0, 1.0), 2.0)}, "joints"),
        (Heli4, {"passive": (0.0, 1.0)}, "passive"),
        (Heli4, {"passive": None}, "passive"),
        (Redundant3T1R, {"passive": (1.0, 3.2)}, "passive"),
        (Redundant3T1R, {"passive": 1.0}, "passive"),
        (GoughStewart, {"rest": (0.0, 0.6)}, "rest"),
        (GoughStewart, {"rest": "home"}, "rest"),
        (GoughStewart, {"rest": (0.0, 0.0, math.inf)}, "rest"),
    ],
)
def test_impossible_ranges_are_named(kind: type[Mechanism], change: dict[str, object], field: str) -> None:
    with pytest.raises(InvalidValue, match=field):
        kind(ranges=replace(kind.Ranges(), **change))


def test_another_mechanisms_ranges_are_refused() -> None:
    with pytest.raises(InvalidValue, match="Heli4 ranges"):
        Heli4(ranges=GoughStewart.Ranges())


def test_robots_of_other_ranges_or_working_modes_are_told_apart_by_their_conditions() -> None:
    same = Heli4(home=[0.0, 0.0, -0.71, 0.0])
    assert Heli4().conditions_digest() == same.conditions_digest()
    assert Heli4().conditions_digest() != Heli4(ranges=Heli4.Ranges(passive=(1.0, 0.9))).conditions_digest()
    assert Heli4().conditions_digest() != Heli4(home=[0.0, 0.0, 0.7, 0.0]).conditions_digest()
    legs = GoughStewart(home=[0.0, 0.0, 0.61, 0.0, 0.0, 0.0])
    assert GoughStewart().conditions_digest() != legs.conditions_digest()  # whose joints rest at home


def test_a_peppermill_whose_links_point_elsewhere_is_told_apart() -> None:
    """The same elbows and cuts, but at this home both distal links point up, where their ends then rest."""
    usual = Peppermill()
    other = Peppermill(home=[-0.3328, 0.2661, 0.2297, -10.4252])
    assert other.mode == usual.mode
    assert other.sides != usual.sides
    assert other.margin("passive_joint", other.home) != pytest.approx(usual.margin("passive_joint", other.home))
    assert other.conditions_digest() != usual.conditions_digest()
