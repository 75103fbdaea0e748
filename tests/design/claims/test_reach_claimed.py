"""No margin of any mechanism is proved, mapped or optimised where a limb cannot reach."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from design import (
    Box,
    OtherCertificate,
    Section,
    certify,
    index_of,
    load_certificate,
    map_of,
    replay,
    save_certificate,
    worst_poses,
)
from kinematics import MECHANISMS, GoughStewart, Heli4, InvalidValue, Mechanism, Planar3RRR, Redundant3T1R
from kinematics.evaluation.interval_interpreter import operate
from kinematics.evaluation.program import Op
from tests.design.words import bound_of, trivial
from tests.sizes import few_of

LIMITED = {Redundant3T1R: Redundant3T1R.Ranges(joints=((-3.0, 3.0), *[(-math.inf, math.inf)] * 5))}
ROBOTS = [mechanism(ranges=LIMITED.get(mechanism)) for mechanism in MECHANISMS.values()]


def _partly_beyond(robot: Mechanism, rng: np.random.Generator) -> Box | None:
    """A small box around a pose at the edge of reach; None where every pose is in reach."""
    names, home = robot.pose_names, np.array(robot.home)
    for _ in range(40):
        way = rng.standard_normal(len(names))
        steps = home + np.geomspace(0.01, 30.0, 200)[:, None] * way
        out = ~(robot.margin("reach", steps) >= 0.0)
        if out.any() and (first := int(out.argmax())):
            middle, half = steps[first], 0.05 * np.abs(steps[first] - home) + 1e-3
            return Box(**{n: (float(m - h), float(m + h)) for n, m, h in zip(names, middle, half, strict=True)})
    return None


REGIONS = [(robot, _partly_beyond(robot, np.random.default_rng(8))) for robot in ROBOTS]
CASES = [(robot, margin, region) for robot, region in REGIONS if region is not None for margin in robot.margins]


@pytest.mark.parametrize(
    ("robot", "margin", "region"),
    few_of(CASES, lambda robot, margin, _: isinstance(robot, Planar3RRR) or margin == "J_q"),
    ids=[f"{type(robot).__name__}-{margin}" for robot, margin, _ in CASES],
)
def test_a_region_that_a_limb_cannot_reach_refutes_every_margin_and_boxes_never_prove_it(
    robot: Mechanism, margin: str, region: Box, monkeypatch: pytest.MonkeyPatch
) -> None:
    weakest = bound_of(robot, margin, 0.0) if margin == "reach" else trivial(robot, margin, 1e3)
    for asked in (weakest, bound_of(robot, margin, 1e-9)):
        found = certify(robot, region, margin, **asked, most_boxes=300)
        assert found.status == "refuted"
        assert found.counterexample is not None
        assert found.within_reach == bool(robot.margin("reach", found.counterexample) >= 0.0)
        assert asked is not weakest or not found.within_reach
    monkeypatch.setattr("design.certificates.refutation.Refuter.refutation", lambda *_: None)
    assert certify(robot, region, margin, **weakest, most_boxes=300).status == "undecided"


def test_arms_too_short_for_the_region_refute_the_determinant_of_the_other_two() -> None:
    """The internal determinant is of arms 3 and 4 alone, which are long enough here."""
    robot = Redundant3T1R(Redundant3T1R.Geometry(middle_arm_length=1.5))
    region = Box(x=0.0, y=(-0.05, 0.05), z=(1.10, 1.15), theta=0.0)
    found = certify(robot, region, "internal_determinant", at_least=1e-6)
    assert found.status == "refuted"
    assert not found.within_reach
    assert "out of reach" in str(found)
    assert worst_poses(robot, region, "internal_determinant", about=1000).value == -math.inf
    chart = map_of(index_of(robot, "internal_determinant"), Section(region, ("y", "z")), robot.pose_names, (9, 9))
    assert np.isnan(chart.values).all()


def test_reach_itself_is_never_claimed_of_a_pose_out_of_reach() -> None:
    beyond = Box(x=(1.3, 1.4), y=0.0, z=-0.7, theta=0.0)
    found = certify(Heli4(), beyond, "reach", at_least=0.0)
    assert (found.status, found.within_reach) == ("refuted", False)


def test_a_bound_of_reach_below_0_would_claim_nothing_more_and_is_refused() -> None:
    region = Box(x=0.0, y=0.0, z=-0.7, theta=0.0)
    with pytest.raises(InvalidValue, match=r"at_least of reach: found -0\.01; expected 0 m or more"):
        certify(Heli4(), region, "reach", at_least=-0.01)


def test_joints_without_limits_have_all_the_room_there_is_where_the_limbs_reach() -> None:
    free = Heli4(ranges=Heli4.Ranges(joints=(-math.inf, math.inf)))
    assert certify(free, Box(x=(0.0, 0.1), y=0.0, z=-0.7, theta=0.0), "joint_travel", at_least=9.0).status == "proved"
    assert certify(free, Box(x=(0.0, 1.4), y=0.0, z=-0.7, theta=0.0), "joint_travel", at_least=9.0).status == "refuted"


def test_a_certificate_of_an_edition_that_did_not_claim_reach_is_refused(tmp_path: Path) -> None:
    robot = Redundant3T1R()
    region = Box(x=0.0, y=(-0.1, 0.1), z=(-0.1, 0.1), theta=(-0.5, 0.5))
    found = certify(robot, region, "internal_determinant", at_least=1e-3)
    assert found.status == "proved"
    save_certificate(found, tmp_path / "c.npz")
    assert replay(load_certificate(tmp_path / "c.npz"), robot) > 0
    with pytest.raises(OtherCertificate, match="edition: made for 1; expected 2"):
        replay(replace(found, edition=1), robot)


@pytest.mark.parametrize("op", [Op.SQ, Op.MUL])
def test_the_square_of_what_is_undefined_is_undefined(op: Op) -> None:
    undefined = operate(Op.SQRT, (-1.0, 4.0), (-1.0, 4.0), True)
    assert operate(op, undefined, undefined, True) == (-math.inf, math.inf)


def test_a_leg_along_its_joints_axis_has_the_whole_angle_and_no_more() -> None:
    """At home every leg lies along the axes of its joints, so the exact room is the limit itself."""
    robot = GoughStewart(ranges=GoughStewart.Ranges(passive=(0.9, 0.9)))
    at_home = Box(**dict(zip(robot.pose_names, map(float, robot.home), strict=True)))
    for below in (0.0, 5e-9, 1e-12, 1e-15):
        assert certify(robot, at_home, "passive_joint", at_least=0.9 - below).status != "refuted"
    assert certify(robot, at_home, "passive_joint", at_least=0.9 - 1e-6).status == "proved"
    assert certify(robot, at_home, "passive_joint", at_least=0.9 + 1e-12).status == "refuted"
    assert float(robot.margin("passive_joint", np.array(robot.home))) == pytest.approx(0.9, abs=2e-13)


@pytest.mark.parametrize(
    "given",
    [{"most_boxes": v} for v in (0, 1.5, math.nan, True, "10", 10**9)]
    + [{"at_least": v} for v in ("0.3", True, math.inf)],
)
def test_a_number_that_means_nothing_is_named(given: dict[str, object]) -> None:
    asked: dict[str, object] = {"at_least": 0.1, **given}
    with pytest.raises(InvalidValue, match=next(iter(given))) as caught:
        certify(Heli4(), Box(x=0.0, y=0.0, z=-0.7, theta=0.0), "J_q", **asked)  # type: ignore[arg-type]
    assert "np." not in str(caught.value)


@pytest.mark.parametrize("value", [1e200, 1e-200, math.nan, math.inf, 0.0, -1.0, "1", True, None, np.float64(-2.0)])
def test_fvi_bounds_whose_squares_are_no_numbers_are_named(value: object) -> None:
    with pytest.raises(InvalidValue, match="FviBounds force") as caught:
        replace(Heli4.fvi_bounds, force=value)  # type: ignore[arg-type]
    assert "np." not in str(caught.value)
