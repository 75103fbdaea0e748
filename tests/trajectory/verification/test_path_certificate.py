"""The proof along a path holds where samples may look, and finds what lies between them."""

from __future__ import annotations

import math

import numpy as np
import pytest

from kinematics import Delta, GoughStewart, Heli4, Hexa, InvalidValue, Mechanism, Peppermill, Planar3RRR, Redundant3T1R
from trajectory import AdeptCycle, Path, PathRefused, Reversed, RoundedPath, certify_path

SIX = GoughStewart.pose_names
TILTED = AdeptCycle(
    span=0.15, pick=(-0.075, 0.0, 0.6), turn=0.2, start_angle=0.1, tilt=(0.12, -0.08), rise=0.01, pose_names=SIX
)
TRIANGLE = RoundedPath(("x", "y", "theta"), ((0, 0, 0), (0.05, 0, 0.1), (0, 0.05, 0.2), (0, 0, 0)), (0.02, 0.0))
CASES: list[tuple[Mechanism, Path]] = [
    (Heli4(), AdeptCycle()),
    (Redundant3T1R(), AdeptCycle(pick=(0.0, -0.1525, 0.0), heading=math.pi / 2, turn=math.pi / 2)),
    (Peppermill(), AdeptCycle(pick=(-0.1525, 0.0, -0.0125))),
    (GoughStewart(), TILTED),
    (Hexa(), AdeptCycle(span=0.1, pick=(-0.05, 0.0, Hexa().home[2]), turn=0.2, tilt=(0.1, 0.0), pose_names=SIX)),
    (Delta(), AdeptCycle(pick=(-0.1525, 0.0, Delta().home[2]), turn=0.0, pose_names=("x", "y", "z"))),
    (Planar3RRR(), TRIANGLE),
]


@pytest.mark.parametrize(("robot", "path"), CASES, ids=[type(robot).__name__ for robot, _ in CASES])
def test_what_is_proved_holds_at_every_sample_and_is_close_to_their_worst(robot: Mechanism, path: Path) -> None:
    found = certify_path(robot, path)
    poses = path.evaluate(np.linspace(0.0, path.length, 5001), 0)[0]
    assert {"reach", "J_q", "det_J_x"} <= found.margins.keys()
    for name, bound in found.margins.items():
        worst = robot.margin(name, poses).min()
        assert 0.89 * worst <= bound <= worst
        assert 0.999 * bound < float(dict(found.rows())[name]) <= bound


def test_the_way_back_has_the_same_margins() -> None:
    there, back = certify_path(Heli4(), AdeptCycle()), certify_path(Heli4(), Reversed(AdeptCycle()))
    assert back.margins == pytest.approx(there.margins, rel=1e-2)


def test_a_leg_too_short_for_a_few_hundredths_of_a_millimetre_is_found_between_samples() -> None:
    """The leg's length sqrt(d^2 + (s - s0)^2) is below its limit, d + 1 nm, for 2 x 17 um of a way of 0.2 m."""
    geometry = GoughStewart().geometry
    base, end = geometry.in_reference_frame()[0], geometry.in_tool_frame()[0]
    height, nearest = 0.15, 0.0777777
    start = np.array([base[0] - end[0], base[1] - end[1] - nearest, base[2] - end[2] + height])
    far = start + np.array([0.0, 0.2, 0.0])
    path = RoundedPath(SIX, ((*start.tolist(), 0, 0, 0), (*far.tolist(), 0, 0, 0)), ())
    robot = GoughStewart(geometry, ranges=GoughStewart.Ranges(joints=(height + 1e-9, 2.0), passive=(math.pi, math.pi)))
    (sampled,) = path.evaluate(np.linspace(0.0, path.length, 2001), 0)
    assert robot.margin("joint_travel", sampled).min() > 0.0
    with pytest.raises(PathRefused) as caught:
        certify_path(robot, path)
    error = caught.value
    assert (error.margin, error.place, error.proved) == ("joint_travel", "the lower end of q1", True)
    assert error.at == pytest.approx(nearest, abs=2e-5)
    assert robot.margin("joint_travel", np.array(error.pose)) < 0.0
    assert -1e-9 <= error.bound <= 0.0


def test_a_singular_pose_on_the_way_is_found() -> None:
    """Yaw through a quarter turn, where all legs of a symmetric hexapod meet one screw axis."""
    path = AdeptCycle(span=0.1, pick=(-0.05, 0.0, 0.6), turn=math.radians(190), start_angle=-1.0, pose_names=SIX)
    with pytest.raises(PathRefused, match="det_J_x") as caught:
        certify_path(GoughStewart(ranges=GoughStewart.Ranges(joints=(0.1, 2.0))), path)
    assert caught.value.proved
    assert caught.value.place is None


def test_a_margin_that_touches_zero_is_undecided_not_proved() -> None:
    """At the very start the leg has just its shortest length."""
    robot = GoughStewart()
    path = RoundedPath(SIX, ((0, 0, 0.6, 0, 0, 0), (0, 0, 0.7, 0, 0, 0)), ())
    shortest = float(robot.inverse(np.array(path.poses[0]))[0])
    touching = GoughStewart(robot.geometry, ranges=GoughStewart.Ranges(joints=(shortest, 2.0)))
    with pytest.raises(PathRefused, match="undecided") as caught:
        certify_path(touching, path)
    assert not caught.value.proved
    assert caught.value.at < 1e-8


def test_a_pose_out_of_reach_is_refused_with_its_limb() -> None:
    with pytest.raises(PathRefused, match=r"reach margin of limb \d is at most -") as caught:
        certify_path(Heli4(), AdeptCycle(span=1.5, pick=(-0.75, 0.0, -0.8)))
    assert caught.value.proved


def test_another_kind_of_pose_is_refused() -> None:
    with pytest.raises(InvalidValue, match="pose of the path for GoughStewart"):
        certify_path(GoughStewart(), AdeptCycle())


def test_clearance_is_proved_on_a_path_where_no_single_direction_parts_two_pairs_of_rods() -> None:
    wide = Heli4.Geometry(base_radius=0.2, platform_radius=0.08, arm_length=0.334, rod_length=0.78, plate_offset=0.02)
    robot = Heli4(wide)
    proved = certify_path(robot, AdeptCycle()).margins["clearance"]
    poses, _ = AdeptCycle().evaluate(np.linspace(0.0, AdeptCycle().length, 2000), 1)
    lowest = robot.margin("clearance", poses).min()
    assert 0.89 * lowest < proved < lowest
