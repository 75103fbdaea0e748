"""What a cycle travels is inside the study's region at every pose, or it is not written."""

from __future__ import annotations

import math
from functools import partial
from pathlib import Path

import numpy as np
import pytest

import trajectory.laws.free
from design import Box, Cylinder, Region
from studies.building.inside_region import TOLERANCE, leaving
from studies.building.load import load_study
from studies.building.objects import limits_of, path_of, region_of, robot_of
from studies.errors import RequirementFailed
from studies.stages.cycle_stage import time_cycle
from studies.study_file.toml_file import read_toml
from tests.studies.command_line import SMALL
from trajectory import AdeptCycle, PoseSpline, RoundedPath, free_motion
from trajectory.motions.pose_spline import InTime
from trajectory.paths.pose_bounds import PoseBounds

NAMES = ("x", "y", "z", "theta")
HALF = 0.1525  # m, of the reference cycle's span
TOP, TURN = (-0.8, -0.775), (0.0, math.pi)
FREE = SMALL.replace('law = "toppra"', 'law = "free"').replace("torque = 127", "torque = 127\njerk = 1e5")


@pytest.fixture(autouse=True)
def fake_mechanism() -> None:
    """The real mechanisms here, in place of the other files' stand-in."""


@pytest.mark.parametrize(
    ("tight", "shrunk"),
    [
        (Box(x=(-HALF, HALF), y=0.0, z=TOP, theta=TURN), Box(x=(-HALF, HALF), y=0.0, z=TOP, theta=(0.0, 3.14159))),
        (Cylinder(HALF, z=TOP, theta=TURN), Cylinder(HALF - 2 * TOLERANCE, z=TOP, theta=TURN)),
        (Box(x=0.0, y=(-HALF, HALF), z=TOP, theta=TURN), Box(x=0.0, y=(-HALF, HALF), z=(-0.8, -0.775002), theta=TURN)),
    ],
)
def test_a_path_along_the_boundary_is_inside_and_a_little_less_room_is_not(tight: Region, shrunk: Region) -> None:
    along_y = tight.intervals["x"] == (0.0, 0.0)
    path = AdeptCycle(pick=(0.0, -HALF, -0.8), heading=math.pi / 2) if along_y else AdeptCycle()
    assert leaving(tight, path, NAMES) is None
    found = leaving(shrunk, path, NAMES)
    assert found is not None
    assert -3 * TOLERANCE < found.room < -TOLERANCE
    assert shrunk.room(found.pose, NAMES) == pytest.approx(found.room, abs=1e-12)


def test_the_end_of_a_way_is_where_it_is_furthest_out() -> None:
    found = leaving(
        Box(x=(-0.1, 0.1), y=0.0, z=-0.8, theta=0.0),
        RoundedPath(NAMES, ((-0.1, 0.0, -0.8, 0.0), (0.2, 0.0, -0.8, 0.0)), ()),
        NAMES,
    )
    assert found is not None
    assert found.pose[0] == pytest.approx(0.2, abs=1e-12)
    assert found.room == pytest.approx(-0.1, abs=1e-12)


@pytest.mark.parametrize("size", [1e-3, 1.0, 1e3])
def test_a_way_of_any_size_may_leave_by_a_millionth_of_the_region_and_no_more(size: float) -> None:
    way = RoundedPath(NAMES, ((-0.1 * size, 0.0, 0.0, 0.0), (0.1 * size, 0.0, 0.0, 0.0)), ())
    for short, inside in ((0.5e-7, True), (2e-7, False)):
        region = Box(x=(-0.1 * size, (0.1 - short) * size), y=0.0, z=0.0, theta=0.0)
        assert (leaving(region, way, NAMES) is None) == inside


def test_a_motion_that_leaves_the_region_between_its_knots_only_is_found() -> None:
    """x = t (1 - t) (1 - 2 t) is 0 at every half, and at most 1 / (6 sqrt 3)."""
    peak, none = 1.0 / (6.0 * math.sqrt(3.0)), np.zeros((2, 4))
    rates = [none.copy() for _ in range(4)]
    for rate, (first, half) in zip(rates, ((0.0, 0.0), (1.0, -0.5), (-6.0, 0.0), (12.0, 12.0)), strict=True):
        rate[:, 0] = first, half
    way = InTime(PoseSpline("made", np.array([0.0, 0.5, 1.0]), *rates, np.zeros((2, 4))), NAMES)
    box = partial(Box, y=0.0, z=0.0, theta=0.0)
    assert leaving(box(x=(-peak, peak)), way, NAMES) is None
    found = leaving(box(x=(-peak, peak - 1e-5)), way, NAMES)
    assert found is not None
    assert -1.01e-5 < found.room < -0.9e-5
    assert found.pose[0] == pytest.approx(peak, abs=1e-6)


@pytest.mark.long
def test_the_free_law_is_given_the_region_and_a_motion_that_leaves_it_is_refused_with_its_margin(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "study.toml").write_text(FREE)
    study = load_study(read_toml(tmp_path / "study.toml"))
    assert study.trajectory is not None
    robot, region, given = robot_of(study), region_of(study), []
    path, limits = path_of(study.trajectory, NAMES), limits_of(study.trajectory.limits)
    anywhere = free_motion(robot, path, limits, 0.5, 16)

    def law(*_: object, within: PoseBounds) -> PoseSpline:
        given.append(within)
        return anywhere

    monkeypatch.setattr(trajectory.laws.free, "free_motion", law)
    with pytest.raises(
        RequirementFailed, match=r"distance inside the region's boundary on the cycle \[m or rad\]: found -0\.4"
    ) as caught:
        time_cycle(study, robot)
    assert caught.value.exit_status == 1
    failed = caught.value.failed[0]
    room = float(region.room(np.array(failed.pose), NAMES))
    assert room - 1e-10 <= failed.found <= room  # a bound over a short interval about that pose
    assert set(given) == {PoseBounds(*zip(*(region.intervals[name] for name in NAMES), strict=True), 3)}
