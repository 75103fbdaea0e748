"""Maps against what is known of them: analytic indices, quadrature, random poses, and the search over the region."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import dblquad

from design import (
    Box,
    Cylinder,
    Index,
    InvalidRegion,
    InvalidSection,
    OutOfTime,
    Region,
    Section,
    index_of,
    level_set,
    map_of,
    worst_poses,
)
from design.maps.level_sets import FINEST, boundary, integrals
from kinematics import Array, Heli4, InvalidValue, Peppermill, Redundant3T1R
from tests.bench.table_1 import AXES, conventions

PI = math.pi
NAMES = ("x", "y", "z", "theta")
SQUARE = Box(x=(-1.0, 1.0), y=(-1.0, 1.0), z=0.0, theta=0.0)
HELI = Cylinder(radius=0.5, z=(-0.8, -0.6), theta=(-PI, PI))
YZ = Box(x=0.0, y=(0.0, 0.3187), z=(0.0, 0.8), theta=(-PI / 2, PI / 2))


def made(value: Callable[[Array], Array]) -> Index:
    return Index("made", value)


def shoelace(ring: Array) -> float:
    x, y = ring.T
    return 0.5 * float(np.sum(x[:-1] * y[1:] - x[1:] * y[:-1]))


def bump(poses: Array) -> Array:
    return 2.0 - poses[..., 0] ** 2 - 4.0 * poses[..., 1] ** 2


def test_area_and_boundary_of_an_ellipse() -> None:
    found = level_set(made(bump), Section(SQUARE, ("x", "y")), NAMES, 1.5, 1e-4)
    area = PI * math.sqrt(0.5) * math.sqrt(0.125)
    assert abs(found.figures.area - area) < 3e-4 * area
    (ring,) = found.boundary
    assert np.array_equal(ring[0], ring[-1])
    assert np.abs(ring[:, 0] ** 2 + 4 * ring[:, 1] ** 2 - 0.5).max() < 1e-3
    assert abs(shoelace(ring) - area) < 3e-4 * area


def test_mean_and_deviation_are_those_of_quadrature() -> None:
    """Over the part of the square where a smooth index is at least a bound, which leaves the square on two sides."""

    def wave(x: float, y: float) -> float:
        return math.exp(x) * (1.0 + 0.3 * math.sin(2.0 * y))

    def low(y: float) -> float:  # exp(x) (1 + 0.3 sin 2y) = 0.8
        return max(-1.0, math.log(0.8 / (1.0 + 0.3 * math.sin(2.0 * y))))

    def integral(power: int) -> float:
        return dblquad(lambda x, y: wave(x, y) ** power, -1.0, 1.0, low, 1.0, epsabs=1e-10)[0]

    area, first, second = (integral(power) for power in range(3))
    index = made(lambda p: np.exp(p[..., 0]) * (1.0 + 0.3 * np.sin(2.0 * p[..., 1])))
    found = level_set(index, Section(SQUARE, ("x", "y")), NAMES, 0.8, 1e-4).figures
    assert abs(found.area - area) < 2e-4 * area
    assert abs(found.mean - first / area) < 2e-4
    assert abs(found.deviation - math.sqrt(second / area - (first / area) ** 2)) < 2e-4


def test_a_linear_index_is_integrated_exactly_on_any_grid() -> None:
    index, section = made(lambda p: p[..., 0] + 0.5 * p[..., 1]), Section(SQUARE, ("x", "y"))
    for counts in ((2, 2), (5, 4), (33, 17)):
        found = integrals(map_of(index, section, NAMES, counts), 0.0)
        assert abs(found.area - 2.0) < 1e-12
        # Over x + y/2 >= 0: integral of the value 1/2 ((1 + y/2)^2) over y, of its square 1/3 ((1 + y/2)^3).
        mean = (1.0 + 1.0 / 12.0) / 2.0
        assert abs(found.mean - mean) < 1e-12
        assert abs(found.deviation - math.sqrt((2.0 + 0.5) / 3.0 / 2.0 - mean**2)) < 1e-12


def test_the_error_of_the_area_falls_with_the_square_of_the_step() -> None:
    section, area = Section(SQUARE, ("x", "y")), PI * math.sqrt(0.5) * math.sqrt(0.125)
    errors = [abs(integrals(map_of(made(bump), section, NAMES, (n, n)), 1.5).area - area) for n in (17, 33, 65, 129)]
    assert all(fine < 0.4 * coarse for coarse, fine in pairwise(errors))


def test_the_redundant_robots_area_is_that_of_random_poses() -> None:
    """Worst over a dense set of angles at uniform points of the plane."""
    robot = Redundant3T1R()
    found = level_set(index_of(robot, "fvi"), Section(YZ, ("y", "z")), NAMES, 1.0).figures
    rng, count = np.random.default_rng(3), 8000
    poses = np.zeros((count, 61, 4))
    poses[..., 1:3] = rng.uniform([0.0, 0.0], [0.3187, 0.8], (count, 2))[:, None]
    poses[..., 3] = np.linspace(-PI / 2, PI / 2, 61)
    worst = np.nan_to_num(robot.fvi(poses), nan=-np.inf).min(axis=1)
    inside = worst >= 1.0
    spread = math.sqrt(inside.mean() * (1 - inside.mean()) / count)
    assert abs(found.area / (0.3187 * 0.8) - inside.mean()) < 4 * spread
    assert abs(found.mean - worst[inside].mean()) < 4 * found.deviation / math.sqrt(inside.sum())
    assert abs(found.deviation - worst[inside].std()) < 0.003


def test_table_1_converged_and_what_nine_angles_leave_out() -> None:
    robot, nine = Redundant3T1R(), tuple(np.deg2rad([-90, -60, -45, -30, 0, 30, 45, 60, 90]).tolist())
    index = index_of(robot, "fvi")
    cases = [
        Section(YZ, ("y", "z"), {"theta": (0.0,)}),
        Section(YZ, ("y", "z"), {"theta": nine}),
        Section(YZ, ("y", "z")),
    ]
    level, listed, every = (level_set(index, section, NAMES, 1.0, 1e-3) for section in cases)
    for found, printed in ((level, (1.21, 0.08)), (listed, (1.14, 0.07))):
        assert (round(found.figures.mean, 2), round(found.figures.deviation, 2)) == printed
    assert abs(4 * level.figures.area - 0.79) < 0.0075
    assert abs(4 * listed.figures.area - 0.69) < 0.005
    assert 0.001 < 4 * (listed.figures.area - every.figures.area) < 0.002
    assert np.nanmax(every.map.values - map_of(index, cases[1], NAMES, every.map.values.shape).values) <= 0.0


def test_counting_nodes_at_multiples_of_10_mm_gives_every_printed_digit_of_table_1() -> None:
    counted = [one for one in conventions(Redundant3T1R(), (0.010,)) if (one.axis, one.rule) == (AXES[0], "nodes")]
    assert [one.case for one in counted] == ["theta = 0", "nine angles"]
    assert all(one.matches for one in counted)


@pytest.mark.parametrize("axes", [("x", "y"), ("y", "z"), ("z", "theta"), ("theta", "x")])
def test_every_section_of_a_cylinder_holds_its_worst_pose(axes: tuple[str, str]) -> None:
    robot = Heli4()
    chart = map_of(index_of(robot, "fvi"), Section(HELI, axes), NAMES, (17, 17))
    value, pose = chart.worst
    assert math.isclose(value, worst_poses(robot, HELI, "fvi", about=50_000).value, rel_tol=1e-9)
    assert HELI.contains(pose[None], NAMES).all()
    assert math.isclose(float(robot.fvi(pose)), value, rel_tol=1e-12)


def test_a_disc_has_its_own_area_and_boundary() -> None:
    found = level_set(
        index_of(Heli4(), "reach"), Section(HELI, ("x", "y"), {"z": (-0.7,), "theta": (0.0,)}), NAMES, 0.0
    )
    assert abs(found.figures.area - PI * 0.25) < 1e-3
    (ring,) = found.boundary
    assert np.abs(np.hypot(*ring.T) - 0.5).max() < 2e-3


def test_a_chord_leaves_the_others_inside_the_cylinder() -> None:
    chart = map_of(index_of(Heli4(), "J_q"), Section(HELI, ("y", "theta")), NAMES, (33, 5))
    assert HELI.contains(chart.poses.reshape(-1, 4), NAMES).all()
    assert np.ptp(chart.poses[..., 0]) > 0.5


@pytest.mark.parametrize("robot", [Heli4(), Redundant3T1R(), Peppermill()])
def test_every_margin_mapped_at_fixed_coordinates_is_the_robots_own(robot: Heli4 | Redundant3T1R | Peppermill) -> None:
    home = np.array(robot.home)
    region = Box(x=(home[0] - 0.05, home[0] + 0.05), y=(-0.05, 0.05), z=home[2], theta=home[3])
    x, y = np.meshgrid(*(np.linspace(*region.intervals[name], 3) for name in ("x", "y")))
    poses = np.stack([x, y, np.full_like(x, home[2]), np.full_like(x, home[3])], axis=-1)
    own = {"inverse_condition_number": lambda p: 1 / robot.condition_number(p)}
    own |= {"v_w": lambda p: robot.isotropic(p)[0], "f_w": lambda p: robot.isotropic(p)[1]}
    for name in robot.margins:
        expected = own[name](poses) if name in own else robot.margin(name, poses)
        found = map_of(index_of(robot, name), Section(region, ("x", "y")), NAMES, (3, 3)).values
        assert np.allclose(found, expected, rtol=1e-12), name


def test_what_is_out_of_reach_is_no_part_of_the_area() -> None:
    region = Box(x=(0.0, 1.4), y=(-0.1, 0.1), z=-0.7, theta=0.0)
    section, robot = Section(region, ("x", "y")), Heli4()
    chart = map_of(index_of(robot, "fvi"), section, NAMES, (65, 9))
    assert np.isnan(chart.values).any()
    assert chart.worst[0] == -np.inf
    reach = integrals(map_of(index_of(robot, "reach"), section, NAMES, (257, 33)), 0.0).area
    everything = integrals(map_of(index_of(robot, "fvi"), section, NAMES, (257, 33)), None).area
    assert everything <= reach
    assert reach - everything < 0.2 * 1.4 / 64  # less than four columns of cells


def test_no_part_above_the_bound_has_no_mean() -> None:
    chart = map_of(made(bump), Section(SQUARE, ("x", "y")), NAMES, (9, 9))
    found = integrals(chart, 3.0)
    assert found.area == 0.0
    assert math.isnan(found.mean)
    assert boundary(chart, 3.0) == []


def test_a_part_between_the_nodes_of_the_coarse_grids_is_found() -> None:
    """A cap in the middle of a cell of the second grid, a third of the cell wide."""
    x, y = 2.0 / 64 * 10.5, 2.0 / 64 * 20.5
    cap = made(lambda p: 1.0 - (p[..., 0] - x) ** 2 - (p[..., 1] - y) ** 2)
    found = level_set(cap, Section(SQUARE, ("x", "y")), NAMES, 1.0 - 1e-4)
    assert found.figures.area == pytest.approx(math.pi * 1e-4, rel=0.2)


def test_where_nothing_is_seen_the_finest_grid_was_looked_at_and_says_its_step() -> None:
    found = level_set(made(bump), Section(SQUARE, ("x", "y")), NAMES, 1e6)
    assert found.figures.area == 0.0
    assert len(found.map.first) == FINEST
    assert found.step == pytest.approx((2.0 / (FINEST - 1),) * 2)


def test_a_constant_index_that_misses_the_bound_is_not_refined_any_further() -> None:
    found = level_set(made(lambda p: np.full(p.shape[:-1], 0.1)), Section(SQUARE, ("x", "y")), NAMES, 0.2)
    assert (found.figures.area, found.settled) == (0.0, True)
    assert len(found.map.first) == 65


def test_a_constant_index_has_no_deviation() -> None:
    found = level_set(made(lambda p: np.full(p.shape[:-1], 0.1)), Section(SQUARE, ("x", "y")), NAMES, 0.05)
    assert (found.figures.area, found.figures.deviation) == (pytest.approx(4.0), 0.0)


def test_a_map_of_reach_counts_what_is_in_reach_whatever_the_bound() -> None:
    robot, section = Heli4(), Section(Box(x=(-1.5, 1.5), y=(-1.5, 1.5), z=-0.7, theta=0.0), ("x", "y"))
    index = index_of(robot, "reach")
    areas = [level_set(index, section, NAMES, bound).figures.area for bound in (None, -1.0, 0.0)]
    assert areas == [areas[0]] * 3
    poses = section.region.random(NAMES, 100_000, np.random.default_rng(3))
    share = float((robot.margin("reach", poses) >= 0.0).mean())
    assert areas[0] == pytest.approx(9.0 * share, rel=0.02)


def test_a_plane_out_of_reach_is_empty_and_so_is_its_boundary() -> None:
    beyond = Cylinder(radius=0.5, z=(2.5, 2.5), theta=(0.5, 0.5))
    found = level_set(index_of(Heli4(), "fvi"), Section(beyond, ("x", "y")), NAMES, None)
    assert found.figures.area == 0.0
    assert found.boundary == []
    assert found.map.worst[0] == -np.inf


def test_figures_that_do_not_stand_still_say_how_far_they_still_move(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("design.maps.level_sets.FINEST", 129)
    noise = np.random.default_rng(0)
    found = level_set(made(lambda p: noise.random(p.shape[:-1])), Section(SQUARE, ("x", "y")), NAMES, 0.5, 1e-6)
    assert not found.settled
    assert found.moved > found.tolerance == 1e-6
    assert found.moved == found.figures.moved(found.coarser, 4.0)
    assert found.figures.area == pytest.approx(2.0, abs=0.2)


@pytest.mark.parametrize("share", [1e-5, 1e-9, 1e-15])
def test_a_part_of_a_billionth_of_the_plane_is_measured(share: float) -> None:
    """Under a cone and under a cap, both far narrower than the finest grid's step."""
    x, y, area = 0.1234567, -0.3456789, 4.0 * share
    cap = made(lambda p: 1.0 - (p[..., 0] - x) ** 2 - (p[..., 1] - y) ** 2)
    cone = made(lambda p: 1.0 - np.hypot(p[..., 0] - x, 2.0 * (p[..., 1] - y + 0.3 * p[..., 0])))
    for index, bound in ((cap, 1.0 - area / PI), (cone, 1.0 - math.sqrt(2.0 * area / PI))):
        found = level_set(index, Section(SQUARE, ("x", "y")), NAMES, bound)
        true = PI * (1.0 - bound) if index is cap else 0.5 * PI * (1.0 - bound) ** 2  # of the bound as it is rounded
        assert found.settled
        assert found.figures.area == pytest.approx(true, rel=2e-2)
        assert found.boundary


def test_a_part_at_the_regions_circle_that_is_narrower_than_the_grid_is_measured() -> None:
    disc = Cylinder(radius=1.0, z=0.0, theta=0.0)
    tip = made(lambda p: p[..., 0])
    found = level_set(tip, Section(disc, ("x", "y")), NAMES, 1.0 - 1e-9)
    half = math.acos(1.0 - 1e-9)
    assert found.figures.area == pytest.approx(half - math.sin(half) * math.cos(half), rel=2e-2)


def test_a_map_says_when_its_time_was_too_short_and_a_level_set_what_it_reached() -> None:
    with pytest.raises(OutOfTime, match="map of fvi"):
        map_of(index_of(Heli4(), "fvi"), Section(HELI, ("x", "y")), NAMES, (200, 200), seconds=1e-6)
    found = level_set(index_of(Heli4(), "fvi"), Section(HELI, ("x", "y")), NAMES, 0.99, 1e-9, seconds=3.0)
    assert not found.settled
    assert found.figures.area > 0.0
    for wrong in (0.0, math.nan, "1", True):
        with pytest.raises(InvalidValue, match="seconds"):
            level_set(index_of(Heli4(), "fvi"), Section(HELI, ("x", "y")), NAMES, 1.0, seconds=wrong)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("section", "words"),
    [
        (Section(YZ, ("y", "y")), "two different"),
        (Section(YZ, ("y", "w")), "one of x, y, z, theta"),
        (Section(YZ, ("x", "y")), "fixes at 0"),
        (Section(YZ, ("y", "z"), {"z": (0.1,)}), "one of x, theta"),
        (Section(YZ, ("y", "z"), {"w": (0.1,)}), "one of x, theta"),
        (Section(YZ, ("y", "z"), {"theta": (3.0,)}), "in the region"),
        (Section(YZ, ("y", "z"), {"theta": ()}), "at least one"),
        (Section(HELI, ("z", "theta"), {"x": (0.4,), "y": (0.0, 0.4)}), "a pose in Cylinder"),
    ],
)
def test_a_plane_that_the_region_does_not_have_is_refused(section: Section, words: str) -> None:
    with pytest.raises(InvalidSection, match=words):
        map_of(index_of(Redundant3T1R(), "fvi"), section, NAMES, (3, 3))


def test_an_unknown_index_a_bad_bound_and_another_robots_region_are_refused() -> None:
    robot, section = Redundant3T1R(), Section(YZ, ("y", "z"))
    with pytest.raises(InvalidValue, match="inverse_condition_number"):
        index_of(robot, "manipulability")
    with pytest.raises(InvalidValue, match="bound"):
        level_set(index_of(robot, "fvi"), section, NAMES, math.nan)
    with pytest.raises(InvalidValue, match="tolerance"):
        level_set(index_of(robot, "fvi"), section, NAMES, 1.0, 0.0)
    other: Region = Box(x=0.0, y=(0.0, 1.0), z=(0.0, 1.0))
    with pytest.raises(InvalidRegion):
        map_of(index_of(robot, "fvi"), Section(other, ("y", "z")), NAMES, (3, 3))
