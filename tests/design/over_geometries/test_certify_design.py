"""Nothing better exists: what is proved over all geometries, and what is never proved because it is false."""

from __future__ import annotations

import math
from dataclasses import replace
from fractions import Fraction

import casadi as ca
import numpy as np
import pytest

from design import (
    Bounds,
    Box,
    BrokenCertificate,
    OtherCertificate,
    Problem,
    Requirement,
    SumLimit,
    certify,
    certify_design,
    replay_design,
    worst_poses,
)
from design.over_geometries.affine_dependence import free_directions
from design.over_geometries.design_box import DesignBox
from design.over_geometries.geometry_search import excluded
from design.over_geometries.necessary_rows import necessary_rows
from design.over_geometries.upper_bounds import UpperBounds
from kinematics import MECHANISMS, Delta, FviBounds, Heli4, InvalidValue, Mechanism, Program, Redundant3T1R
from tests.heli4_problem import PROBLEM, ROOM
from tests.sizes import every_mechanism, few_or_many

YZ = Box(x=0.0, y=(-0.28, 0.28), z=(-0.28, 0.28), theta=(-math.pi / 2, math.pi / 2))
HELI4_BEST = {
    "base_radius": 0.2,
    "platform_radius": 0.08,
    "arm_length": 0.33431478,
    "rod_length": 0.78153262,
    "plate_offset": 0.02,
    "pitch": 0.048806849,
}


def asked(robot: Mechanism, variables: dict[str, tuple[float, float]], objective: str = "fvi") -> Problem:
    bounds = tuple(Bounds(name, 0, low, high) for name, (low, high) in variables.items())
    required = (Requirement("reach", at_least=0.0),)
    return Problem(robot, objective, bounds, required, (), robot.fvi_bounds, robot.characteristic_length)


def heli4_best() -> Mechanism:
    robot = Heli4()
    return robot.with_geometry(robot.geometry.with_values(**HELI4_BEST))


def test_no_heli4_within_the_studys_bounds_beats_its_optimum_by_a_hundredth_of_a_percent() -> None:
    """The optimum has 1.202583, proved over its region."""
    problem = PROBLEM
    found = certify_design(problem, ROOM, at_most=1.2027, best=heli4_best(), most_boxes=100_000)
    assert found.status == "proved"
    assert len(found.variables) == 5  # base_radius - platform_radius counts, not both
    assert replay_design(found, problem) < found.boxes


def test_a_target_that_the_optimum_keeps_is_refuted_by_a_robot_that_is_proved_to_keep_it() -> None:
    problem = PROBLEM
    found = certify_design(problem, ROOM, at_most=1.202, best=heli4_best())
    assert found.status == "refuted"
    assert found.better is not None
    robot = Heli4(Heli4.Geometry.from_vector(found.better))
    length = problem.characteristic_length
    assert certify(robot, ROOM, "fvi", at_least=1.202, characteristic_length=length).status == "proved"


def test_no_heli4_within_the_studys_bounds_has_an_internal_determinant_of_0_65() -> None:
    problem = replace(PROBLEM, objective="internal_determinant")
    assert certify_design(problem, ROOM, at_most=0.65, best=heli4_best(), most_boxes=50_000).status == "proved"


def test_no_redundant_robot_of_four_variables_beats_its_optimum_by_half_a_percent() -> None:
    problem = asked(
        Redundant3T1R(),
        {
            "outer_rail_y": (-0.5, -0.25),
            "middle_rail_y": (-0.6, -0.35),
            "outer_rail_z": (0.2, 0.4),
            "platform_length": (0.08, 0.15),
        },
    )
    paper = FviBounds(joint_speed=1, joint_effort=1, speed=0.5, force=0.5)
    problem = replace(problem, fvi_bounds=paper, requirements=(Requirement("reach", at_least=0.01),))
    values = np.array([-0.2503325, -0.36412253, 0.38583611, 0.08])
    best = problem.robot_with(values)
    measured = problem.fvi_bounds, problem.characteristic_length
    worst = worst_poses(best, YZ, "fvi", bounds=measured[0], characteristic_length=measured[1], about=30_000).value
    found = certify_design(problem, YZ, at_most=1.005 * worst, best=best, most_boxes=10_000)
    assert found.status == "proved"
    assert replay_design(found, problem) <= found.boxes


def variables_of(robot: Mechanism) -> dict[str, tuple[float, float]]:
    """Up to four plain lengths of its limbs, 10 % either way."""
    own = robot.geometry.as_dict()
    names = [n for n, v in own.items() if n.endswith("_length") and isinstance(v, float) and v > 0.05]
    names += [n for n in ("base_radius", "half_distance", "outer_rail_y") if n in own]
    return {n: tuple(sorted((0.9 * own[n], 1.1 * own[n]))) for n in names[:4]}


@pytest.mark.parametrize("name", every_mechanism(n for n in MECHANISMS if variables_of(MECHANISMS[n]())))
@few_or_many(20, 300)
def test_no_box_is_excluded_that_holds_a_geometry_which_reaches_the_target_by_a_billionth(
    name: str, count: int
) -> None:
    """At random poses around home; the target is the worst of these, less a billionth."""
    robot, rng = MECHANISMS[name](), np.random.default_rng(17)
    problem = asked(robot, variables_of(robot))
    tried = 0
    for _ in range(count):
        low, high = problem.bounds()
        values = low + (high - low) * rng.random(len(low))
        own = problem.robot_with(values)
        poses = robot.home + 0.05 * robot.pose_units() * rng.uniform(-1, 1, (3, len(robot.home)))
        worst = float(own.margin("fvi", poses, problem.fvi_bounds, problem.characteristic_length).min())
        if not worst > 0.0 or float(own.margin("reach", poses).min()) < 0.0:
            continue
        necessary = necessary_rows(problem, worst * (1.0 - 1e-9), ("reach",))
        box = DesignBox.of(problem, necessary)
        kept = [k for k in range(len(values)) if k not in box.held]
        for held, direction in zip(box.held, box.directions, strict=True):
            values = values - (values[held] - box.start[held]) * np.array([float(part) for part in direction])
        at = values[kept]
        bounds = [UpperBounds(problem, necessary, box, pose) for pose in poses]
        sides = (box.high - box.low) * 10.0 ** rng.uniform(-10, 0, (40, len(at)))
        lows, highs = at - rng.random(sides.shape) * sides, at + rng.random(sides.shape) * sides
        none, _ = excluded(bounds, lows, highs)
        assert not none.any(), "seed 17"
        tried += 1
    assert tried > count // 4


def test_heli4s_radii_count_only_by_their_difference() -> None:
    problem = PROBLEM
    box = DesignBox.of(problem, necessary_rows(problem, 1.2, ("reach", "J_q", "internal_determinant")))
    assert box.together == ("+1 base_radius +1 platform_radius",)
    assert box.names == ("platform_radius", "arm_length", "rod_length", "plate_offset", "pitch")


def test_the_redundant_robots_heights_count_only_by_their_difference() -> None:
    robot = Redundant3T1R()
    problem = asked(robot, {"outer_rail_z": (0.2, 0.4), "platform_height": (0.1, 0.3)})
    box = DesignBox.of(problem, necessary_rows(problem, 1.2, ("reach",)))
    assert box.together == ("+0.5 outer_rail_z +1 platform_height",)


def test_a_direction_is_found_only_where_nothing_changes_along_it() -> None:
    x, c = ca.SX.sym("x", 3), ca.SX.sym("c", 2)

    def directions(*outputs: ca.SX) -> list[tuple[float, ...]]:
        program = Program.of(ca.Function("f", [x, c], [ca.vertcat(*outputs)]))
        return [tuple(map(float, found)) for found in free_directions(program, 3)]

    assert directions(ca.sin(x[0] - x[1]) * x[2]) == [(1.0, 1.0, 0.0)]
    assert directions(ca.sqrt(c[0] * x[0] - c[0] * x[1]) + x[2]) == [(1.0, 1.0, 0.0)]
    assert directions(ca.sqrt(c[0] * x[0] - c[1] * x[1]) + x[2]) == []  # c0 and c1 may differ
    assert directions(x[0] * x[1], x[2]) == []
    assert directions(x[0] + x[1] + x[2]) == [(-1.0, 1.0, 0.0), (-1.0, 0.0, 1.0)]
    exact = Program.of(ca.Function("f", [x, c], [ca.vertcat(ca.sin(x[0] - x[1] + 1e-300 * x[1]), x[2])]))
    assert free_directions(exact, 3)[0][0] == 1 - Fraction(1e-300)


def test_a_replay_refuses_what_was_made_for_another_problem_or_leaves_a_part_open() -> None:
    problem = PROBLEM
    found = certify_design(problem, ROOM, at_most=2.0, best=heli4_best())
    wider = replace(problem, sums=(SumLimit(("arm_length", "rod_length"), 1.2),))
    with pytest.raises(OtherCertificate):
        replay_design(found, wider)
    for broken in (
        replace(found, target=replace(found.target, value=1.2)),
        replace(found, codes=np.array([-1], dtype=np.int8)),
        replace(found, codes=found.codes[:-1]),
        replace(found, poses=found.poses + 10.0),
        replace(found, status="undecided"),
    ):
        with pytest.raises(BrokenCertificate):
            replay_design(broken, problem)


def test_a_search_out_of_boxes_is_undecided_with_what_is_left() -> None:
    found = certify_design(PROBLEM, ROOM, at_most=1.21, best=heli4_best(), most_boxes=500)
    assert found.status == "undecided"
    assert len(found.left)
    assert not len(found.codes)


def test_a_question_that_is_none_is_told() -> None:
    problem = asked(Delta(), {"arm_length": (0.2, 0.3)})
    region = Box(x=(-0.1, 0.1), y=(-0.1, 0.1), z=(-0.75, -0.7))
    with pytest.raises(InvalidValue, match="at_most, as fvi is better larger"):
        certify_design(problem, region, at_least=1.0)
    with pytest.raises(InvalidValue, match="requirements: found mass; expected some of reach"):
        certify_design(problem, region, at_most=1.0, requirements=["mass"])
    with pytest.raises(InvalidValue, match="one whose bounds differ"):
        certify_design(asked(Delta(), {"arm_length": (0.3, 0.3)}), region, at_most=1.0)
