"""The synthesis finds an optimum that stands everywhere, or says why there is none."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

from design import (
    Bounds,
    Box,
    Cylinder,
    ImpossibleSum,
    Region,
    Requirement,
    SumLimit,
    SynthesisFailed,
    WorstPoses,
    certify,
    worst_poses,
)
from design.synthesis.exchange import rounded
from design.synthesis.nlp import NlpSolution, Problem, active_sets, solve
from design.synthesis.synthesis import _offenders, synthesise
from kinematics import Delta, GoughStewart, Heli4, Hexa, InvalidValue, Peppermill, Redundant3T1R
from tests.sizes import few_or_many, later

REGION = Cylinder(radius=0.5, z=(-0.8, -0.6), theta=(-math.pi, math.pi))
ROBOT = Heli4()
ABOUT = 60_000


def problem(*variables: tuple[str, float, float], **others: object) -> Problem:
    return Problem(
        robot=ROBOT,
        objective="fvi",
        variables=tuple(Bounds(name, 0, low, high) for name, low, high in variables),
        requirements=others.pop("requirements", ()),  # type: ignore[arg-type]
        sums=others.pop("sums", ()),  # type: ignore[arg-type]
        fvi_bounds=ROBOT.fvi_bounds,
        characteristic_length=ROBOT.characteristic_length,
        **others,  # type: ignore[arg-type]
    )


def test_one_variable_agrees_with_a_golden_section_over_dense_searches() -> None:
    asked = problem(("arm_length", 0.30, 0.42))

    def worst(arm: float) -> float:
        return -worst_poses(Heli4(replace(ROBOT.geometry, arm_length=arm)), REGION, "fvi", about=ABOUT).value

    oracle = minimize_scalar(worst, bounds=(0.30, 0.42), method="bounded", options={"xatol": 1e-5})
    found = synthesise(asked, REGION, starts=1, about=ABOUT)
    assert found.after["fvi"].value == pytest.approx(-oracle.fun, rel=2e-4)
    assert found.robot.geometry.arm_length == pytest.approx(oracle.x, abs=2e-4)


def test_an_optimum_from_a_coarse_sample_collapses_and_the_exchange_mends_it() -> None:
    found = synthesise(problem(("base_radius", 0.2, 0.45), ("rod_length", 0.7, 0.9)), REGION, starts=1, about=ABOUT)
    first, last = found.rounds[0], found.rounds[-1]
    assert first.found < first.promised * 0.97
    assert last.found >= last.promised * (1 - 1e-4)
    assert last.poses > first.poses


@few_or_many(200_000, 500_000)
def test_requirements_hold_between_the_poses_that_were_solved_on(count: int) -> None:
    requirements = (Requirement("J_q", 0.5), Requirement("internal_determinant", 0.5))
    found = synthesise(
        problem(("base_radius", 0.2, 0.45), ("platform_radius", 0.03, 0.08), requirements=requirements),
        REGION,
        starts=1,
        about=ABOUT,
    )
    for requirement in requirements:
        denser = worst_poses(found.robot, REGION, requirement.margin, about=count)
        assert requirement.bound.room(denser.value) >= 0.0


def test_what_holds_the_optimum_back_is_named() -> None:
    asked = problem(("platform_radius", 0.03, 0.08), requirements=(Requirement("internal_determinant", 0.4),))
    found = synthesise(asked, REGION, starts=1, about=ABOUT)
    at_bound = abs(found.robot.geometry.platform_radius - 0.08) < 1e-6
    at_requirement = found.after["internal_determinant"].value < 0.401
    active = active_sets(asked, found.robot, found.after)
    assert ("platform_radius at its upper bound 0.08" in active) == at_bound
    assert ("internal_determinant at its lower bound 0.4" in active) == at_requirement
    assert active


def test_the_azimuths_can_be_variables() -> None:
    azimuths = ROBOT.geometry.azimuths
    variables = tuple(Bounds("azimuths", k, azimuths[k] - 0.3, azimuths[k] + 0.3) for k in (2, 3))
    found = synthesise(replace(problem(), variables=variables), REGION, starts=1, about=ABOUT)
    assert found.after["fvi"].value >= found.before["fvi"].value * (1 - 1e-5)
    assert found.robot.geometry.azimuths[:2] == azimuths[:2]


def test_an_impossible_requirement_fails_by_its_name() -> None:
    with pytest.raises(SynthesisFailed, match=r"internal_determinant >= 0\.99 falls short") as error:
        synthesise(
            problem(("pitch", 0.02, 0.12), requirements=(Requirement("internal_determinant", 0.99),)),
            REGION,
            starts=1,
            about=ABOUT,
        )
    assert error.value.exit_status == 1


def test_an_impossible_sum_fails_by_its_name() -> None:
    sums = (SumLimit(("arm_length", "rod_length"), 0.5),)
    with pytest.raises(ImpossibleSum, match=r"arm_length \+ rod_length <= 0\.5") as error:
        synthesise(problem(("arm_length", 0.25, 0.5), sums=sums), REGION, starts=1, about=ABOUT)
    assert (error.value.number, error.value.exit_status) == (0, 2)


def test_too_few_rounds_are_a_failure_and_not_an_answer() -> None:
    with pytest.raises(SynthesisFailed, match="did not settle"):
        synthesise(
            problem(("base_radius", 0.2, 0.45), ("rod_length", 0.7, 0.9)), REGION, starts=1, about=ABOUT, max_rounds=1
        )


def test_the_same_seed_gives_the_same_geometry() -> None:
    asked = problem(("base_radius", 0.2, 0.45), ("arm_length", 0.25, 0.5))
    first, second = (synthesise(asked, REGION, seed=5, starts=2, about=ABOUT) for _ in range(2))
    assert first.robot.geometry == second.robot.geometry


def test_the_characteristic_length_stays_the_prototypes_while_the_pitch_varies() -> None:
    """Else a longer pitch would count as a better robot without moving the tool any faster."""
    asked = problem(("pitch", 0.02, 0.12))
    assert asked.characteristic_length == pytest.approx(0.05 / (2 * math.pi))
    solution = solve(asked, REGION.spread(ROBOT.pose_names), np.array([0.05]))
    robot = Heli4(replace(ROBOT.geometry, pitch=float(solution.values[0])))
    own = robot.fvi(REGION.spread(ROBOT.pose_names), characteristic_length=asked.characteristic_length).min()
    assert solution.objective == pytest.approx(own, rel=1e-6)


def test_a_region_that_no_geometry_reaches_is_told_with_limb_and_margin() -> None:
    below = Cylinder(radius=0.5, z=(-2.0, -1.9), theta=0.0)
    with pytest.raises(SynthesisFailed, match=r"none of 200 geometries.*limb \d.*reach margin of -"):
        synthesise(problem(("arm_length", 0.25, 0.5)), below, starts=1, about=ABOUT)


def test_a_prototype_that_cannot_reach_is_replaced_by_a_random_start() -> None:
    short = replace(problem(("rod_length", 0.6, 1.0)), robot=Heli4(replace(ROBOT.geometry, rod_length=0.61)))
    assert short.robot.margin("reach", REGION.spread(ROBOT.pose_names)).min() < 0
    found = synthesise(short, REGION, starts=1, about=ABOUT)
    assert found.after["fvi"].value > 0.9


def test_a_sum_over_tuples_holds_in_every_entry() -> None:
    mill = Peppermill()
    limit = SumLimit(("proximal_lengths", "half_distance"), 0.72)
    asked = replace(problem(), robot=mill, sums=(limit,))
    sums = [mill.geometry.vector()[places].sum() for places in asked.summed(limit)]
    assert sums == pytest.approx([r + mill.geometry.half_distance for r in mill.geometry.proximal_lengths])


def test_the_least_lean_is_that_of_the_longest_rod_that_reaches() -> None:
    asked = replace(
        problem(("rod_length", 0.6, 1.0), requirements=(Requirement("reach", 0.02),)), objective="passive_joint"
    )
    found = synthesise(asked, REGION, starts=1, about=20_000)
    rod = found.robot.geometry.rod_length
    assert found.after["passive_joint"].value == pytest.approx(1.0 - math.asin(0.5 / rod), abs=1e-3)
    assert found.after["reach"].value == pytest.approx(0.02, abs=2e-4)


@pytest.mark.long
def test_room_for_joints_and_arms_can_be_asked_for_and_is_then_certified() -> None:
    robot = Redundant3T1R()
    region = Box(x=0.0, y=(-0.26, 0.26), z=(-0.26, 0.26), theta=(-math.pi / 2, math.pi / 2))
    wanted = {"clearance": 0.025, "passive_joint": 0.35, "joint_travel": 0.6}
    bounds = (("middle_rail_y", -0.6, -0.3), ("outer_rail_z", 0.2, 0.5), ("platform_height", 0.1, 0.3))
    asked = replace(
        problem(requirements=tuple(Requirement(margin, least) for margin, least in wanted.items())),
        robot=robot,
        variables=tuple(Bounds(name, 0, low, high) for name, low, high in bounds),
        fvi_bounds=robot.fvi_bounds,
        characteristic_length=robot.characteristic_length,
    )
    assert worst_poses(robot, region, "clearance", about=ABOUT).value < wanted["clearance"]
    found = synthesise(asked, region, starts=1, about=20_000)
    for margin, least in wanted.items():
        assert certify(found.robot, region, margin, at_least=least).status == "proved", margin


DELTA_BOX = Box(x=(-0.3, 0.3), y=(-0.3, 0.3), z=(-0.8, -0.6))


def delta(*variables: tuple[str, float, float], **others: object) -> Problem:
    robot = Delta()
    measured = {"fvi_bounds": robot.fvi_bounds, "characteristic_length": robot.characteristic_length}
    return replace(problem(*variables, **others), robot=robot, **measured)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("margin", "word", "bound"),
    [
        ("strength", "at_least", 5.5),
        later("stiffness", "at_least", 1.0e5),
        later("natural_frequency", "at_least", 35.0),
        later("internal_stiffness", "at_least", 4000.0),
        later("position_accuracy", "at_most", 9e-5),
        later("mass", "at_most", 3.7),
    ],
)
def test_each_margin_of_the_bodies_can_be_asked_for(margin: str, word: str, bound: float) -> None:
    """None of them holds for the prototype."""
    asked = delta(
        ("arm_length", 0.25, 0.40),
        ("rod_length", 0.70, 0.90),
        ("arm_radius", 0.010, 0.040),
        ("rod_radius", 0.004, 0.012),
        requirements=(Requirement(margin, **{word: bound}),),
    )
    found = synthesise(asked, DELTA_BOX, starts=1, about=20_000)
    before, after = (worst_poses(robot, DELTA_BOX, margin, about=ABOUT).value for robot in (asked.robot, found.robot))
    sense = asked.robot.margins[margin].sense
    assert sense * before < sense * bound
    assert sense * after >= sense * bound - 2e-4 * abs(bound)


@pytest.mark.parametrize("seed", [0, later(1)])
def test_bounds_from_a_millimetre_to_ten_metres_with_sums_and_floors_give_the_narrow_bounds_answer(seed: int) -> None:
    wide = delta(
        *((name, 0.001, 10.0) for name in ("base_radius", "platform_radius", "arm_length", "rod_length")),
        requirements=(Requirement("J_q", 0.1), Requirement("reach", 0.05)),
        sums=(SumLimit(("arm_length", "rod_length"), 2.0),),
    )
    narrow = delta(("base_radius", 0.3, 0.5), ("arm_length", 0.3, 0.6), ("rod_length", 0.6, 1.0))
    best = synthesise(narrow, DELTA_BOX, starts=1, about=20_000).after["fvi"].value
    found = synthesise(wide, DELTA_BOX, starts=2, seed=seed, about=20_000, seconds=120.0)
    assert found.after["fvi"].value == pytest.approx(best, rel=2e-5)


def test_six_freedoms_with_bounds_over_four_decades_are_solved() -> None:
    robot = Hexa()
    tilts = dict.fromkeys(("roll", "pitch", "yaw"), (-0.2, 0.2))
    region = Box(x=(-0.1, 0.1), y=(-0.1, 0.1), z=(-0.7, -0.6), **tilts)
    asked = replace(
        delta(("arm_length", 0.001, 10.0), ("rod_length", 0.001, 10.0), requirements=(Requirement("reach", 0.01),)),
        robot=robot,
        fvi_bounds=robot.fvi_bounds,
        characteristic_length=robot.characteristic_length,
    )
    found = synthesise(asked, region, starts=1, about=20_000, seconds=120.0)
    assert found.after["fvi"].value == pytest.approx(4.09132, abs=2e-4)


@pytest.mark.parametrize(
    ("asked", "region", "best"),
    [
        (
            problem(
                ("base_radius", 0.1, 0.5),
                ("arm_length", 0.2, 0.6),
                ("rod_length", 0.5, 1.2),
                ("platform_radius", 0.03, 0.2),
                requirements=(Requirement("internal_determinant", 0.2),),
            ),
            Cylinder(radius=0.3, z=(0.6, 0.8), theta=(-1.0, 1.0)),
            1.70186,
        ),
        (
            delta(("base_radius", 0.1, 0.5), ("arm_length", 0.2, 0.6), ("rod_length", 0.5, 1.2)),
            Box(x=(-0.3, 0.3), y=(-0.3, 0.3), z=(0.5, 0.8)),
            1.88843,
        ),
    ],
    ids=["Heli4", "Delta"],
)
def test_a_region_above_the_base_has_an_optimum_too(asked: Problem, region: Region, best: float) -> None:
    found = synthesise(asked, region, starts=1, about=20_000, seconds=120.0)
    assert found.after["fvi"].value == pytest.approx(best, abs=5e-5)


def test_when_time_runs_out_the_best_geometry_seen_is_told_and_none_is_returned() -> None:
    asked = problem(("base_radius", 0.2, 0.45), ("rod_length", 0.7, 0.9), ("arm_length", 0.25, 0.5))
    with pytest.raises(SynthesisFailed, match=r"the time of 0\.5 s ended") as caught:
        synthesise(asked, REGION, starts=3, about=1_000_000, seconds=0.5)
    best = caught.value.best
    assert best is not None
    assert best.objective == pytest.approx(best.worst["fvi"].value)
    assert "the best geometry found: " in str(caught.value)
    for wrong in (0.0, -1.0, math.nan, "1"):
        with pytest.raises(InvalidValue, match="seconds"):
            synthesise(asked, REGION, seconds=wrong)  # type: ignore[arg-type]


def test_the_best_seen_meets_its_requirements_where_any_geometry_does() -> None:
    asked = problem(("pitch", 0.02, 0.12), requirements=(Requirement("internal_determinant", 0.45),))
    with pytest.raises(SynthesisFailed, match="did not settle") as caught:
        synthesise(asked, REGION, starts=1, about=ABOUT, max_rounds=1, tolerance=1e-15)
    best = caught.value.best
    assert best is not None
    assert best.shortfall <= 0.0
    assert best.objective >= worst_poses(ROBOT, REGION, "fvi", about=ABOUT).value


def test_an_answer_that_breaks_a_requirement_is_drawn_back_to_where_it_holds() -> None:
    """With a spare below 0 the NLP aims beyond the requirement, so that its answer is sure to break it."""
    asked = problem(("arm_length", 0.3, 0.42), requirements=(Requirement("J_q", 0.42),), spare=-0.02)
    with pytest.raises(SynthesisFailed, match="did not settle") as caught:
        synthesise(asked, REGION, starts=1, about=ABOUT, max_rounds=1)
    best = caught.value.best
    assert best is not None
    assert best.shortfall <= 0.0
    assert best.objective > worst_poses(ROBOT, REGION, "fvi", about=ABOUT).value * 1.001


def test_an_entry_with_equal_bounds_stays_there_while_the_others_move() -> None:
    """It need not be the prototype's value; two limbs turned alike keep the worst index, and no bound is told."""
    first, _, *others = ROBOT.geometry.azimuths
    bounds = [(first, first), (math.pi - 0.1, math.pi + 0.2), *((a + 0.01, a + 0.01) for a in others)]
    asked = replace(problem(), variables=tuple(Bounds("azimuths", k, *pair) for k, pair in enumerate(bounds)))
    found = synthesise(asked, REGION, starts=2, about=ABOUT)
    assert found.robot.geometry.azimuths[0] == first
    assert found.robot.geometry.azimuths[2:] == pytest.approx([a + 0.01 for a in others], rel=1e-7)
    assert all("[1]" in line for line in active_sets(asked, found.robot, found.after))


def test_eighteen_free_coordinates_of_a_hexapod_have_an_optimum() -> None:
    robot = GoughStewart()
    points = np.ravel(robot.geometry.platform_points)
    asked = replace(
        problem(),
        robot=robot,
        variables=tuple(Bounds("platform_points", k, v - 0.05, v + 0.05) for k, v in enumerate(points)),
        requirements=(Requirement("joint_travel", 0.02),),
        fvi_bounds=robot.fvi_bounds,
        characteristic_length=robot.characteristic_length,
    )
    region = Box(x=(-0.1, 0.1), y=0.0, z=(0.55, 0.75), roll=(-0.2, 0.2), pitch=0.0, yaw=0.0)
    found = synthesise(asked, region, starts=1, about=ABOUT)
    assert found.after["fvi"].value > 1.05 * found.before["fvi"].value


def test_lowest_poses_that_keep_the_promise_are_not_solved_on_again() -> None:
    """A hexapod's worst index has hundreds of lowest poses within the tolerance; they once used up the time."""
    asked = problem(requirements=(Requirement("J_q", 0.4),))
    promised = NlpSolution(np.empty(0), 1.0, "Solve_Succeeded", True, {}, 1, 0.0)
    poses = np.arange(12.0).reshape(3, 4)
    worst = WorstPoses(np.array([0.5, 1.0 - 2e-5, 1.0 - 1e-6]), poses, 3, True, 1.0)
    sizes = {"fvi": 1.0, "J_q": 1.0}
    assert np.array_equal(_offenders(asked, promised, sizes, 1e-5, "fvi", worst), poses[:2])
    assert not len(_offenders(asked, promised, sizes, 1e-5, "J_q", worst))


def test_an_optimum_of_a_margin_that_holds_two_arms_only_reaches_everywhere() -> None:
    """The internal determinant is of arms 3 and 4; shorter outer arms would not lower it."""
    robot = Redundant3T1R()
    region = Box(x=0.0, y=(-0.2, 0.2), z=(-0.2, 0.2), theta=(-0.6, 0.6))
    asked = replace(
        problem(("outer_arm_length", 0.3, 1.2), ("middle_arm_length", 0.3, 1.2)),
        robot=robot,
        objective="internal_determinant",
        fvi_bounds=robot.fvi_bounds,
        characteristic_length=robot.characteristic_length,
    )
    found = synthesise(asked, region, starts=2, about=20_000)
    assert worst_poses(found.robot, region, "reach", about=ABOUT).value >= 0.0
    assert np.isfinite(found.after["internal_determinant"].value)


def test_a_result_written_and_read_back_is_the_very_number() -> None:
    asked = problem(("arm_length", 0.30, 0.42), ("base_radius", 0.0413, 0.0413 * 1.0000001))
    vector = rounded(asked, np.array([0.3512345678912, 0.041300000041]))
    assert [float(f"{v:.8g}") for v in vector] == vector.tolist()
    assert vector[1] == 0.0413


def test_an_optimum_is_never_worse_than_a_geometry_that_was_seen_on_the_way() -> None:
    """From both starts the NLP comes to a local optimum that is a little worse than the prototype."""
    robot = Peppermill()
    region = Box(x=(-0.0996, -0.006), y=(-0.2387, 0.1487), z=(-0.1118, 0.0728), theta=(0.0082, 0.1545))
    asked = replace(
        problem(("half_distance", 0.0357, 7.0), requirements=(Requirement("J_q", 0.05),)),
        robot=robot,
        fvi_bounds=robot.fvi_bounds,
        characteristic_length=robot.characteristic_length,
    )
    found = synthesise(asked, region, starts=1, about=20_000)
    assert found.after["fvi"].value > found.before["fvi"].value


def test_a_geometry_that_its_mechanism_refuses_is_no_optimum_and_named() -> None:
    """Nothing in J_q keeps the outer rails off half the platform's height, where its closure would be singular."""
    robot = Redundant3T1R()
    half = robot.geometry.platform_height / 2
    asked = replace(
        problem(("outer_rail_z", 0.99999 * half, 1.00001 * half)),
        robot=robot,
        objective="J_q",
        fvi_bounds=robot.fvi_bounds,
        characteristic_length=robot.characteristic_length,
    )
    region = Box(x=0.0, y=(-0.1, 0.1), z=(-0.1, 0.1), theta=0.0)
    with pytest.raises(
        SynthesisFailed,
        match=r"none of 200 random choices within the bounds is a possible geometry; the last: .*outer_rail_z",
    ):
        synthesise(asked, region, starts=1, about=5_000)


@pytest.mark.parametrize(("least", "misses"), [(0.1, False), (0.999, True)])
def test_the_best_geometry_is_told_with_each_requirement_it_misses_or_that_it_keeps_all(
    least: float, misses: bool
) -> None:
    asked = problem(("base_radius", 0.2, 0.45), requirements=(Requirement("internal_determinant", least),))
    with pytest.raises(SynthesisFailed) as caught:
        synthesise(asked, REGION, starts=1, about=ABOUT, max_rounds=1, tolerance=1e-15)
    lines = str(caught.value).splitlines()
    assert any(line.startswith("  base_radius = 0.") for line in lines)
    assert ("  it keeps every requirement, but the solver did not confirm it as an optimum" in lines) != misses
    told = [line for line in lines if line.startswith("  it misses internal_determinant: found 0.")]
    assert len(told) == misses
    assert all(" at pose (" in line and line.endswith("; expected at least 0.999") for line in told)
