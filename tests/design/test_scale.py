"""A question asked of a robot a thousand times smaller or larger has the same answer, in its size."""

from __future__ import annotations

import math

import numpy as np
import pytest

from design import Bounds, Box, Requirement, Section, SumLimit, certify, index_of, level_set, worst_poses
from design.synthesis.nlp import Problem
from design.synthesis.synthesis import synthesise
from kinematics import MECHANISMS, Delta, FviBounds, Mechanism
from tests.design.scaled import around_home, scale_of, scaled, scaled_bounds, scaled_box
from tests.design.words import eased
from tests.sizes import QUICK, later

ROBOTS = [mechanism() for mechanism in MECHANISMS.values()]
IDS = [type(robot).__name__ for robot in ROBOTS]
EACH_SIZE = pytest.mark.parametrize("factor", [1e-3, later(1e3)])


def _asked(robot: Mechanism, box: Box, factor: float) -> tuple[Mechanism, Box, dict[str, object]]:
    measured = {"bounds": scaled_bounds(robot, factor), "characteristic_length": robot.characteristic_length * factor}
    return scaled(robot, factor), scaled_box(robot, box, factor), measured


@EACH_SIZE
@pytest.mark.parametrize(
    "robot", [robot if name in QUICK else later(robot) for name, robot in zip(IDS, ROBOTS, strict=True)], ids=IDS
)
def test_the_worst_pose_of_every_margin_scales(robot: Mechanism, factor: float) -> None:
    box = around_home(robot)
    other, region, measured = _asked(robot, box, factor)
    for margin in robot.margins:
        usual = worst_poses(robot, box, margin, about=300, descents=8)
        found = worst_poses(other, region, margin, about=300, descents=8, **measured)  # type: ignore[arg-type]
        if not math.isnan(scale := scale_of(robot, margin, factor)):
            assert found.value == pytest.approx(usual.value * scale, rel=1e-9, abs=1e-12), margin


@EACH_SIZE
@pytest.mark.parametrize("robot", ROBOTS, ids=IDS)
def test_what_is_proved_or_refuted_is_so_in_every_size(robot: Mechanism, factor: float) -> None:
    box = around_home(robot, 0.002)
    other, region, measured = _asked(robot, box, factor)
    for margin in ("reach", "J_q"):
        worst = worst_poses(robot, box, margin, about=300, descents=8).value
        scale = scale_of(robot, margin, factor)
        for share, status in ((0.9, "proved"), (1.001, "refuted")):
            found = certify(other, region, margin, at_least=share * worst * scale, **measured)  # type: ignore[arg-type]
            assert found.status == status, (margin, share)


@pytest.mark.long
@pytest.mark.parametrize("robot", ROBOTS, ids=IDS)
def test_every_claim_needs_about_as_many_boxes_in_every_size(robot: Mechanism) -> None:
    box = around_home(robot, 0.005)
    for margin in robot.margins:
        worst = worst_poses(robot, box, margin, about=3000, descents=8).value
        if not 0.0 < worst < math.inf:
            continue
        usual = certify(robot, box, margin, **eased(robot, margin, worst, 0.9), most_boxes=200_000)
        for factor in (1e-3, 0.02, 50.0, 1e3):
            scale = scale_of(robot, margin, factor)
            if math.isnan(scale):
                continue
            other, region, measured = _asked(robot, box, factor)
            asked = eased(robot, margin, worst * scale, 0.9) | {"most_boxes": 200_000} | measured
            found = certify(other, region, margin, **asked)
            assert found.status == usual.status, (margin, factor)
            assert found.boxes <= 1.2 * usual.boxes + 50, (margin, factor)


def test_a_map_scales() -> None:
    robot = Delta()
    box = Box(x=(-0.5, 0.5), y=(-0.5, 0.5), z=-0.7)
    usual = level_set(index_of(robot, "fvi"), Section(box, ("x", "y")), robot.pose_names, 1.0, 1e-2)
    for factor in (1e-3, 1e3):
        other, region, measured = _asked(robot, box, factor)
        index = index_of(other, "fvi", **measured)  # type: ignore[arg-type]
        found = level_set(index, Section(region, ("x", "y")), robot.pose_names, 1.0, 1e-2)
        assert found.map.values.shape == usual.map.values.shape
        assert found.figures.area == pytest.approx(usual.figures.area * factor**2, rel=1e-9)
        assert found.figures.mean == pytest.approx(usual.figures.mean, rel=1e-9)


DELTA_BOX = Box(x=(-0.3, 0.3), y=(-0.3, 0.3), z=(-0.8, -0.6))


def _delta(factor: float) -> Problem:
    robot = scaled(
        Delta(Delta.Geometry(base_radius=0.2, platform_radius=0.045, arm_length=0.35, rod_length=0.8)), factor
    )
    ranges = {
        "base_radius": (0.1, 0.4),
        "platform_radius": (0.03, 0.1),
        "arm_length": (0.1, 0.5),
        "rod_length": (0.2, 1.0),
    }
    return Problem(
        robot=robot,
        objective="fvi",
        variables=tuple(Bounds(name, 0, low * factor, high * factor) for name, (low, high) in ranges.items()),
        requirements=(Requirement("reach", 0.01 * factor),),
        sums=(SumLimit(("arm_length", "rod_length"), 1.4 * factor),),
        fvi_bounds=FviBounds(20.0, 127.0, 2.5 * factor, 100.0 / factor),
        characteristic_length=robot.characteristic_length,
    )


@pytest.mark.parametrize("factor", [1e-3, later(0.02), later(1.0), 1e3])
def test_an_optimum_scales(factor: float) -> None:
    """A Delta of a few millimetres is found as one of a metre is: 2.74131."""
    problem = _delta(factor)
    found = synthesise(problem, scaled_box(problem.robot, DELTA_BOX, factor), starts=1, about=20_000)
    assert found.after["fvi"].value == pytest.approx(2.74131, abs=5e-5)
    geometry = found.robot.geometry
    assert (geometry.arm_length / factor, geometry.rod_length / factor) == pytest.approx((0.447975, 0.781156), abs=2e-4)
    assert (geometry.base_radius - geometry.platform_radius) / factor == pytest.approx(0.364, abs=1e-3)
    for number in geometry.vector():
        assert float(f"{number:.8g}") == number or number in problem.robot.geometry.vector()


@pytest.mark.long
@pytest.mark.parametrize("robot", ROBOTS, ids=IDS)
def test_an_optimum_of_every_mechanism_scales(robot: Mechanism) -> None:
    box, sizes = around_home(robot), type(robot.geometry).sizes()
    named = [f for f in sizes if f in _LENGTH_FIELDS[type(robot).__name__]]
    found = []
    for factor in (1e-3, 1.0, 1e3):
        other, region, measured = _asked(robot, box, factor)
        variables = tuple(
            Bounds(name, 0, *sorted((0.9 * value, 1.1 * value)))
            for name in named
            if (value := float(np.ravel(getattr(other.geometry, name))[0]))
        )
        problem = Problem(
            robot=other,
            objective="fvi",
            variables=variables,
            requirements=(),
            sums=(),
            fvi_bounds=measured["bounds"],  # type: ignore[arg-type]
            characteristic_length=measured["characteristic_length"],  # type: ignore[arg-type]
        )
        found.append(synthesise(problem, region, starts=1, about=20_000).after["fvi"].value)
    assert found == pytest.approx([found[1]] * 3, rel=3e-5)


_LENGTH_FIELDS = {
    "Heli4": ("base_radius", "arm_length", "rod_length"),
    "Redundant3T1R": ("outer_arm_length", "middle_arm_length", "middle_rail_y"),
    "Peppermill": ("half_distance", "proximal_lengths"),
    "GoughStewart": ("platform_points",),
    "Planar3RPR": ("base_points", "platform_points"),
    "Planar3PRR": ("rod_lengths", "platform_points"),
    "Planar3RRR": ("arm_lengths", "rod_lengths"),
    "Delta": ("base_radius", "arm_length", "rod_length"),
    "Hexa": ("arm_length", "rod_length"),
    "Par4": ("base_radius", "arm_length", "rod_length"),
}
