"""The mechanism's picture: in the region, in equal scales, of a robot of any size."""

from __future__ import annotations

import warnings
from unittest.mock import patch

import numpy as np
import pytest
from matplotlib.figure import Figure
from scipy.spatial.transform import Rotation

from design import Box, Cylinder, Region
from kinematics import (
    MECHANISMS,
    Delta,
    GoughStewart,
    Heli4,
    Mechanism,
    Obstacle,
    PayloadHull,
    Redundant3T1R,
    Surroundings,
    placed_payload,
)
from studies.building import load_study
from studies.report import map_plot, plots
from studies.stages.map_options import map_request
from studies.stages.map_stage import run_map
from studies.study_file import read_toml, study_path

SMALL_DELTA = Delta(Delta.Geometry(base_radius=0.13201, platform_radius=0.0332, arm_length=0.112, rod_length=0.232))
BELOW = Box(x=(-0.04, 0.04), y=(-0.04, 0.04), z=(-0.25, -0.2))


@pytest.fixture(autouse=True)
def fake_mechanism() -> None:
    """The real mechanisms here, in place of the other files' stand-in."""


def drawn(robots: dict[str, Mechanism], region: Region) -> Figure:
    with patch.object(plots, "png", lambda figure: figure), warnings.catch_warnings():
        warnings.simplefilter("error")
        figure = plots.mechanism_picture(robots, region)
    assert isinstance(figure, Figure)
    return figure


def around_home(robot: Mechanism) -> Region:
    return Box(**{n: (h - 0.01, h + 0.01) for n, h in zip(robot.pose_names, robot.home.tolist(), strict=True)})


@pytest.mark.parametrize("name", MECHANISMS)
def test_a_metre_is_as_long_on_every_axis(name: str) -> None:
    robot = MECHANISMS[name]()
    (axes,) = drawn({"result": robot}, around_home(robot)).axes
    lengths = np.ptp([axes.get_xlim3d(), axes.get_ylim3d(), axes.get_zlim3d()], axis=1)
    assert axes.get_box_aspect() / axes.get_box_aspect().max() == pytest.approx(lengths / lengths.max(), rel=1e-6)
    assert np.all(lengths > 0.0)


@pytest.mark.parametrize(
    ("robot", "region"),
    [(SMALL_DELTA, BELOW), (Heli4(), Cylinder(radius=0.3, z=(-0.85, -0.8), theta=(-1.0, 1.0)))],
)
def test_the_robot_stands_in_the_region_within_its_reach(robot: Mechanism, region: Region) -> None:
    pose = plots.pose_in(robot, region)
    assert region.contains(pose, robot.pose_names)
    assert np.isfinite(robot.inverse(pose)).all()


def test_a_robot_that_reaches_no_pose_of_the_region_is_drawn_as_far_as_it_can_be() -> None:
    far = Box(x=(2.0, 2.1), y=(0.0, 0.1), z=(-0.3, -0.2))
    left, right = drawn({"given": SMALL_DELTA, "result": Delta()}, far).axes
    assert left.get_xlim3d() == right.get_xlim3d()
    assert left.get_xlim3d()[1] >= 2.1


AROUND = Surroundings(
    floor=-0.95,
    obstacles=(
        Obstacle("conveyor", (-5.0, -0.2, -0.94), (5.0, 0.2, -0.88)),
        Obstacle("cell", (-0.5, -9.0, -9.0), (0.5, 9.0, 9.0), inside=True),
        Obstacle("fence", (5.0, -9.0, -9.0), (5.1, 9.0, 9.0)),
    ),
    payload_hull=PayloadHull(0.03, -0.06, -0.01),
)


def test_floor_boxes_and_payload_are_named_and_drawn_near_the_robot_alone() -> None:
    robot = Delta().with_surroundings(AROUND)
    figure = drawn({"result": robot}, Cylinder(radius=0.3, z=(-0.8, -0.6)))
    names = [text.get_text() for text in figure.legends[0].get_texts()]
    assert names == [
        "floor at z = -0.95 m",
        "conveyor",
        "cell (the robot stays inside)",
        "fence (too far away to be drawn)",
        "payload",
    ]
    (plain,) = drawn({"result": Delta()}, Cylinder(radius=0.3, z=(-0.8, -0.6))).axes
    (axes,) = figure.axes
    sizes = [np.ptp([a.get_xlim3d(), a.get_ylim3d(), a.get_zlim3d()], axis=1).max() for a in (axes, plain)]
    assert sizes[0] < 1.7 * sizes[1]


def test_the_payload_is_drawn_where_the_tool_holds_it() -> None:
    robot = GoughStewart().with_surroundings(Surroundings(payload_hull=PayloadHull(0.02, 0.1, 0.3)))
    pose = [0.01, 0.02, 0.6, 0.3, -0.2, 0.1]
    payload = placed_payload(robot, pose)
    ends = np.array(pose[:3]) + np.outer([0.1, 0.3], Rotation.from_euler("xyz", pose[3:]).as_matrix()[:, 2])
    np.testing.assert_allclose(payload.corners, ends, atol=1e-14)


def test_a_map_of_a_constant_margin_has_a_readable_colour_bar_and_its_title_fits() -> None:
    study = load_study(read_toml(study_path("redundant_3t1r")))
    request = map_request(study, Redundant3T1R(), margin="mass", at=("theta_deg=0",), over=("y=0:0.01", "z=0:0.3"))
    with patch.object(map_plot, "png", lambda figure: figure):
        figure = map_plot.map_picture(run_map(request, 1e-3, False, lambda _: None))
    figure.canvas.draw()
    bar = figure.axes[1]
    assert bar.yaxis.get_offset_text().get_text() == ""
    shown = [text.get_text() for text in bar.get_yticklabels()]
    assert len(set(shown)) == len(shown) > 3
    title = figure._suptitle.get_window_extent()
    assert title.x0 >= 0.0
    assert title.x1 <= figure.bbox.x1
    assert "deviation 0" in figure._suptitle.get_text().replace("\n", " ")
