"""Margins where smaller is better: required, searched, proved, mapped and optimised with `at_most`."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from design import (
    Bounds,
    Box,
    Cylinder,
    OtherCertificate,
    Problem,
    Requirement,
    Section,
    UnreadableCertificate,
    best_bound,
    certified_cells,
    certified_cylinder,
    certify,
    index_of,
    level_set,
    load_certificate,
    map_of,
    replay,
    save_certificate,
    synthesise,
    worst_poses,
)
from design.synthesis.nlp import active_sets
from kinematics import Delta, Heli4, InvalidValue, Mechanism, Peppermill, Planar3RRR, Redundant3T1R

DELTA, ERROR = Delta(), "position_accuracy"
REGION = Box(x=(-0.2, 0.2), y=(-0.1, 0.1), z=(-0.75, -0.65))
BOUND = 7.3e-5
PLANE = Section(Box(x=(-0.2, 0.2), y=(-0.2, 0.2), z=-0.7), ("x", "y"))


def test_the_worst_pose_is_where_the_error_is_largest() -> None:
    found = worst_poses(DELTA, REGION, ERROR, about=3000)
    poses = REGION.from_unit(np.random.default_rng(3).uniform(size=(20_000, 3)), DELTA.pose_names)
    errors = DELTA.margin(ERROR, poses)
    assert (np.diff(found.values) <= 0.0).all()
    assert found.value == pytest.approx(DELTA.margin(ERROR, found.pose), rel=1e-12)
    assert 0.98 * found.value < errors.max() <= found.value
    assert found.typical == pytest.approx(errors.mean(), rel=0.2)


def test_out_of_reach_the_error_is_infinite() -> None:
    assert worst_poses(DELTA, Box(x=(0.0, 2.0), y=0.0, z=-0.7), ERROR, about=300).value == math.inf


CASES: list[tuple[Mechanism, Box | Cylinder, str]] = [
    (DELTA, REGION, ERROR),
    (DELTA, REGION, "mass"),
    (Heli4(), Box(x=(0.1, 0.15), y=(-0.05, 0.0), z=(-0.72, -0.7), theta=(-0.5, 0.5)), "angle_accuracy"),
    (Redundant3T1R(), Box(x=0.0, y=(0.1, 0.12), z=(0.05, 0.07), theta=(-0.05, 0.05)), ERROR),
    (Peppermill(), Box(x=0.05, y=0.02, z=(-0.03, 0.03), theta=(-1.0, 1.0)), ERROR),
    (Planar3RRR(), Box(x=(-0.02, 0.02), y=(-0.02, 0.02), theta=(-0.1, 0.1)), "angle_accuracy"),
]


@pytest.mark.parametrize(("robot", "region", "margin"), CASES, ids=[f"{type(r).__name__}-{m}" for r, _, m in CASES])
def test_an_upper_bound_is_proved_up_to_the_worst_value_and_refuted_beyond(
    robot: Mechanism, region: Box, margin: str
) -> None:
    worst = worst_poses(robot, region, margin, about=2000).value
    proved = certify(robot, region, margin, at_most=1.01 * worst)
    assert proved.status == "proved"
    assert replay(proved, robot, margin=margin, at_most=1.02 * worst) > 0
    refuted = certify(robot, region, margin, at_most=0.999 * worst)
    assert refuted.status == "refuted"
    assert robot.margin(margin, refuted.counterexample) > 0.999 * worst


def test_no_upper_bound_is_proved_out_of_reach() -> None:
    for margin in (ERROR, "mass"):
        assert certify(DELTA, Box(x=(0.0, 2.0), y=0.0, z=-0.7), margin, at_most=1e6).status == "refuted"


def test_the_best_upper_bound_is_the_smallest_to_its_tolerance() -> None:
    worst = worst_poses(DELTA, REGION, ERROR).value
    found = best_bound(DELTA, REGION, ERROR, 0.02 * worst)
    assert found is not None
    bound = found.certificate.bound
    assert bound.word == "at_most"
    assert worst < bound.value <= worst * 1.0201
    assert replay(found.certificate, DELTA, at_most=bound.value) > 0
    with pytest.raises(OtherCertificate, match="at most"):
        replay(found.certificate, DELTA, at_most=0.99 * bound.value)


def test_a_certificate_keeps_its_word_in_a_file_and_the_other_word_is_refused(tmp_path: Path) -> None:
    found, file = certify(DELTA, REGION, ERROR, at_most=1e-3), tmp_path / "c.npz"
    assert str(found).startswith("Delta: position_accuracy <= 0.001 proved")
    save_certificate(found, file)
    assert repr(load_certificate(file)) == repr(found)
    with np.load(file) as archive:
        parts = dict(archive)
    header = json.loads(str(parts["header"]))
    assert header["at_most"] == 1e-3
    assert "at_least" not in header
    for change in ({"at_least": 0.0}, {}):
        changed = {k: v for k, v in header.items() if k != "at_most"} | change
        np.savez_compressed(file, **{**parts, "header": np.array(json.dumps(changed))})
        with pytest.raises((OtherCertificate, UnreadableCertificate)):
            replay(load_certificate(file), DELTA)


def test_the_wrong_word_is_told_which_is_right() -> None:
    with pytest.raises(InvalidValue, match=r"at_least = 1.0; expected at_most, as mass is better smaller"):
        certify(DELTA, REGION, "mass", at_least=1.0)
    with pytest.raises(InvalidValue, match=r"at_most = 1.0; expected at_least, as J_q is better larger"):
        certified_cylinder(DELTA, Cylinder(0.2, z=(-0.7, -0.65)), "J_q", at_most=1.0)
    with pytest.raises(InvalidValue, match="found no bound; expected at_most"):
        certified_cells(DELTA, PLANE.region, PLANE.axes, ERROR)
    with pytest.raises(InvalidValue, match="requirement of mass: found two bounds"):
        Requirement("mass", 1.0, 2.0)
    with pytest.raises(InvalidValue, match="bound of mass"):
        problem(Requirement("mass", at_least=1.0))


def test_the_level_set_is_where_the_error_is_at_most_the_bound() -> None:
    index, bound = index_of(DELTA, ERROR), BOUND
    found = level_set(index, PLANE, DELTA.pose_names, bound)
    x, y = np.meshgrid(*(np.linspace(-0.2, 0.2, 801),) * 2)
    errors = DELTA.margin(ERROR, np.stack([x, y, np.full_like(x, -0.7)], axis=-1))
    keeps = errors <= bound
    assert 0.05 < keeps.mean() < 0.95
    assert found.settled
    assert found.figures.area == pytest.approx(keeps.mean() * 0.16, rel=5e-3)
    assert found.figures.mean == pytest.approx(errors[keeps].mean(), rel=1e-3)
    assert found.map.worst[0] == pytest.approx(errors.max(), rel=1e-9)
    for ring in found.boundary:
        edge = DELTA.margin(ERROR, np.column_stack([ring, np.full(len(ring), -0.7)]))
        assert edge.max() <= bound * (1 + 1e-3)


def test_a_map_holds_the_largest_error_behind_each_node() -> None:
    section = Section(REGION, ("x", "y"))
    chart = map_of(index_of(DELTA, ERROR), section, DELTA.pose_names, (5, 3))
    heights = np.linspace(-0.75, -0.65, 201)
    for row, column in ((0, 0), (1, 2), (2, 4)):
        at = np.column_stack([np.tile([chart.first[column], chart.second[row]], (201, 1)), heights])
        assert chart.values[row, column] == pytest.approx(DELTA.margin(ERROR, at).max(), rel=1e-4)


def test_the_proved_cells_keep_the_upper_bound() -> None:
    found = certified_cells(DELTA, PLANE.region, PLANE.axes, ERROR, at_most=BOUND, depth=4)
    sampled = level_set(index_of(DELTA, ERROR), PLANE, DELTA.pose_names, BOUND).figures.area
    assert 0.7 * sampled < found.area(PLANE.axes) <= sampled * (1 + 1e-3)


def problem(*requirements: Requirement, objective: str = "fvi") -> Problem:
    return Problem(
        robot=DELTA,
        objective=objective,
        variables=(Bounds("arm_length", 0, 0.25, 0.45), Bounds("rod_length", 0, 0.7, 0.9)),
        requirements=requirements,
        sums=(),
        fvi_bounds=DELTA.fvi_bounds,
        characteristic_length=DELTA.characteristic_length,
    )


def test_an_optimum_keeps_an_upper_bound_everywhere_and_says_that_it_is_limited_by_it() -> None:
    worst = worst_poses(DELTA, REGION, ERROR, about=5000).value
    asked = problem(Requirement(ERROR, at_most=0.9 * worst))
    found = synthesise(asked, REGION, starts=1, about=5000)
    error = worst_poses(found.robot, REGION, ERROR, about=20_000).value
    assert 0.895 * worst < error <= 0.9 * worst
    active = active_sets(asked, found.robot, found.after)
    assert f"position_accuracy at its upper bound {0.9 * worst:g}" in active


def test_an_objective_that_is_better_smaller_is_made_small() -> None:
    asked = problem(Requirement("fvi", at_least=1.0), objective=ERROR)
    found = synthesise(asked, REGION, starts=1, about=3000)
    assert 0.0 < found.after[ERROR].value < 0.95 * found.before[ERROR].value
    assert found.rounds[-1].promised > 0.0
    other = replace(found.robot.geometry, arm_length=found.robot.geometry.arm_length * 1.02)
    heavier = worst_poses(found.robot.with_geometry(other), REGION, ERROR, about=3000).value
    assert heavier > found.after[ERROR].value
