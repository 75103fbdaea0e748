"""Proved, refuted and undecided, each where the truth is known."""

from __future__ import annotations

import math
from collections.abc import Callable

import casadi as ca
import numpy as np
import pytest

from design import Box, Cylinder, InvalidRegion, Region, best_bound, certify, worst_poses
from kinematics import (
    MECHANISMS,
    Delta,
    GoughStewart,
    Heli4,
    Hexa,
    InvalidValue,
    LinkwrightError,
    Margin,
    Measure,
    Mechanism,
    Par4,
    Peppermill,
    Planar3RRR,
    Redundant3T1R,
    by_name,
)
from kinematics.evaluation import threads
from tests.design.words import bound_of, trivial
from tests.sizes import later

PI = math.pi
CYLINDER = Cylinder(radius=0.5, z=(-0.8, -0.6), theta=(-PI, PI))
PART = Cylinder(radius=0.3, z=(-0.72, -0.68), theta=(-0.5, 0.5))
YZ = Box(x=0.0, y=(-0.3, 0.3), z=(-0.3, 0.3), theta=(-PI / 2, PI / 2))
CORNER = Box(x=0.0, y=(0.25, 0.3), z=(0.25, 0.3), theta=(0.5, 0.9))
HEXAPOD = Box(x=(-0.1, 0.1), y=(-0.1, 0.1), z=(0.5, 0.7), roll=(-0.2, 0.2), pitch=(-0.2, 0.2), yaw=(-0.2, 0.2))
SCREWS = Box(x=(-0.2, 0.2), y=(-0.2, 0.2), z=(-0.05, 0.05), theta=(-2 * PI, 2 * PI))


@pytest.mark.parametrize(
    ("robot", "region", "margin", "at_least"),
    [
        (Heli4(), CYLINDER, "internal_determinant", 0.45),
        (Heli4(), CYLINDER, "det_J_x", 0.45),
        (Heli4(), CYLINDER, "J_q", 0.4),
        (Heli4(), CYLINDER, "reach", 0.01),
        (Heli4(), CYLINDER, "fvi", 0.8),
        (Heli4(), PART, "det_J_q", 0.1),
        (Peppermill(), SCREWS, "det_J_x", 1e-6),
        (Peppermill(), SCREWS, "J_q", 1e-6),
        (Redundant3T1R(), CORNER, "fvi", 1.0),
        (Redundant3T1R(), CORNER, "det_J_x", 0.02),
        (Redundant3T1R(), CORNER, "internal_determinant", 0.01),
    ],
)
def test_what_holds_everywhere_is_proved(robot: Mechanism, region: Region, margin: str, at_least: float) -> None:
    found = certify(robot, region, margin, at_least=at_least)
    assert found.status == "proved"
    assert found.counterexample is None
    assert found.boxes > 0
    assert len(found.left) == 0
    assert worst_poses(robot, region, margin, about=20_000).value >= at_least


def test_a_hexapod_has_no_singularity_in_six_dimensions() -> None:
    assert certify(GoughStewart(), HEXAPOD, "det_J_x", at_least=1e-6).status == "proved"


@pytest.mark.parametrize(
    ("robot", "shift", "turn", "margin", "share", "most_boxes"),
    [
        (GoughStewart(), 0.1, 0.2, "fvi", 0.5, 40_000),
        (Hexa(), 0.05, 0.1, "fvi", 0.5, 4_000),
        (Hexa(), 0.05, 0.1, "det_J_x", 0.9, 30_000),
        (Hexa(), 0.05, 0.1, "det_J_q", 0.9, 100),
        (Planar3RRR(), 0.1, 0.5, "det_J_x", 0.99, 4_000),
        (Par4(), 0.1, 0.5, "det_J_x", 0.9, 1_000),
    ],
)
def test_bounds_around_home_are_proved_within_few_boxes(
    robot: Mechanism, shift: float, turn: float, margin: str, share: float, most_boxes: int
) -> None:
    sides = [turn if k in robot.rotations else shift for k in range(len(robot.home))]
    around = {n: (h - s, h + s) for n, h, s in zip(robot.pose_names, robot.home.tolist(), sides, strict=True)}
    worst = worst_poses(robot, Box(**around), margin, about=20_000).value
    found = certify(robot, Box(**around), margin, at_least=share * worst, most_boxes=most_boxes)
    assert found.status == "proved"


def test_the_redundant_robot_keeps_its_fvi_above_one_everywhere() -> None:
    """The paper checks nine angles of this region."""
    assert certify(Redundant3T1R(), YZ, "fvi", at_least=1.0).status == "proved"


@pytest.mark.parametrize(
    ("robot", "region", "margin", "at_least"),
    [
        (Heli4(), CYLINDER, "internal_determinant", 0.49),
        (Heli4(), CYLINDER, "J_q", 0.44),
        (Heli4(), CYLINDER, "fvi", 1.0),
        (Redundant3T1R(), YZ, "fvi", 1.01),
        (GoughStewart(), HEXAPOD, "det_J_x", 0.22),
        (Peppermill(), SCREWS, "J_q", 0.51),
    ],
)
def test_what_fails_somewhere_is_refuted_by_a_pose_inside(
    robot: Mechanism, region: Region, margin: str, at_least: float
) -> None:
    found = certify(robot, region, margin, at_least=at_least)
    assert found.status == "refuted"
    assert found.counterexample is not None
    assert region.contains(found.counterexample[None], robot.pose_names).all()
    assert float(robot.margin(margin, found.counterexample)) < at_least


def test_a_claim_false_only_between_two_grid_angles_is_refuted() -> None:
    """On nine angles the FVI keeps above a bound that it breaks between them."""
    robot = Redundant3T1R()
    region = Box(x=0.0, y=0.3, z=0.3, theta=(-PI / 2, PI / 2))
    angles = np.linspace(-PI / 2, PI / 2, 9)
    poses = np.column_stack([np.zeros(9), np.full(9, 0.3), np.full(9, 0.3), angles])
    on_grid = float(robot.margin("fvi", poses).min())
    true_worst = worst_poses(robot, region, "fvi", about=10_000).value
    assert true_worst < on_grid - 1e-3
    at_least = 0.5 * (true_worst + on_grid)
    assert (robot.margin("fvi", poses) >= at_least).all()
    found = certify(robot, region, "fvi", at_least=at_least)
    assert found.status == "refuted"
    assert found.counterexample is not None
    assert np.abs(angles - found.counterexample[3]).min() > 1e-3
    assert certify(robot, region, "fvi", at_least=true_worst - 1e-4).status == "proved"


def test_boxes_alone_refute_where_the_first_search_finds_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    robot = Heli4()
    monkeypatch.setattr("design.certificates.certificate.suspects", lambda *_: np.empty((0, 4)))
    found = certify(robot, CYLINDER, "internal_determinant", at_least=0.4862)
    assert found.status == "refuted"
    assert float(robot.margin("internal_determinant", found.counterexample)) < 0.4862


def test_few_boxes_decide_nothing() -> None:
    found = certify(Heli4(), CYLINDER, "internal_determinant", at_least=0.45, most_boxes=100)
    assert found.status == "undecided"
    assert found.boxes <= 100
    assert len(found.left) > 0
    assert found.counterexample is None
    assert len(found.codes) == 0


def test_the_boxes_left_hold_every_pose_that_is_not_proved() -> None:
    """No proved box may hold a pose below the bound, so the poses near the worst one are all left."""
    robot = Heli4()
    worst = worst_poses(robot, CYLINDER, "J_q", about=20_000)
    found = certify(robot, CYLINDER, "J_q", at_least=worst.value - 1e-13, most_boxes=30_000)
    assert found.status == "undecided"
    low, high = found.left[:, 0], found.left[:, 1]
    assert ((low <= worst.pose + 1e-9) & (worst.pose - 1e-9 <= high)).all(axis=1).any()


@pytest.mark.parametrize("margin", ["fvi", "internal_determinant", "det_J_x", "J_q", "det_J_q", "reach"])
@pytest.mark.parametrize("at_least", [0.0, 1e-9])
def test_a_region_partly_out_of_reach_is_never_proved(margin: str, at_least: float) -> None:
    beyond = Box(x=(0.0, 1.4), y=0.0, z=-0.7, theta=0.0)
    found = certify(Heli4(), beyond, margin, at_least=at_least, most_boxes=20_000)
    assert found.status == "refuted"


@pytest.mark.long
def test_a_bound_below_zero_is_not_proved_out_of_reach_either(monkeypatch: pytest.MonkeyPatch) -> None:
    """The moduli are trivially above it wherever they have a value."""
    monkeypatch.setattr("design.certificates.refutation.Refuter.refutation", lambda *_: None)
    beyond = Box(x=(0.0, 1.4), y=0.0, z=-0.7, theta=0.0)
    for margin in Heli4.margins:
        weak = bound_of(Heli4(), margin, 0.0) if margin == "reach" else trivial(Heli4(), margin, 1e3)
        found = certify(Heli4(), beyond, margin, **weak, most_boxes=5_000)
        assert found.status == "undecided", margin


@pytest.mark.parametrize(
    ("robot", "beyond"),
    [
        later(Redundant3T1R(), Box(x=0.0, y=(0.0, 2.0), z=0.0, theta=0.0)),
        (Peppermill(), Box(x=(0.0, 1.0), y=0.0, z=0.0, theta=0.0)),
    ],
)
def test_no_margin_of_any_robot_is_proved_beyond_reach(
    robot: Mechanism, beyond: Region, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked = [(name, weak) for name in robot.margins if name != "reach" for weak in _weak(robot, name)]
    for margin, weak in asked:
        assert certify(robot, beyond, margin, **weak, most_boxes=3_000).status == "refuted"
    monkeypatch.setattr("design.certificates.refutation.Refuter.refutation", lambda *_: None)
    for margin, weak in asked:
        assert certify(robot, beyond, margin, **weak, most_boxes=3_000).status == "undecided", margin


def _weak(robot: Mechanism, margin: str) -> tuple[dict[str, float], ...]:
    return trivial(robot, margin, 1e3), bound_of(robot, margin, 1e-9 if robot.margins[margin].sense > 0 else 1.0)


def test_a_modulus_is_above_any_negative_bound_even_where_it_vanishes() -> None:
    """The sign changes inside, so that no single sign would prove it."""
    robot = Redundant3T1R()
    poses = np.array([[0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.4]])
    assert robot.margin("det_J_x", poses).min() >= 0.0
    region = Box(x=0.0, y=(-0.05, 0.05), z=(-0.05, 0.05), theta=(-0.2, 0.2))
    for margin in ("internal_determinant", "det_J_x", "J_q"):
        assert certify(robot, region, margin, at_least=-1e-3).status == "proved"


def test_a_single_pose_is_a_region() -> None:
    home = Box(x=0.0, y=0.0, z=-0.7, theta=0.0)
    value = float(Heli4().margin("J_q", np.array([0.0, 0.0, -0.7, 0.0])))
    assert certify(Heli4(), home, "J_q", at_least=value - 1e-9).status == "proved"
    assert certify(Heli4(), home, "J_q", at_least=value + 1e-9).status == "refuted"
    assert certify(Heli4(), home, "J_q", at_least=value).status in ("proved", "undecided")


def test_one_thread_gives_the_same_answer(monkeypatch: pytest.MonkeyPatch) -> None:
    both = certify(Heli4(), CYLINDER, "J_q", at_least=0.4)
    monkeypatch.setattr(threads, "CORES", 1)
    one = certify(Heli4(), CYLINDER, "J_q", at_least=0.4)
    assert one.status == both.status == "proved"
    assert one.boxes == both.boxes
    assert (one.codes == both.codes).all()


def test_the_best_bound_is_within_its_tolerance_of_the_sampled_worst() -> None:
    found = best_bound(Heli4(), CYLINDER, "internal_determinant", 1e-3)
    assert found is not None
    assert found.certificate.status == "proved"
    assert 0.0 <= found.sampled - found.certificate.bound.value <= 1e-3 * (1 + 1e-9)
    independent = worst_poses(Heli4(), CYLINDER, "internal_determinant", about=50_000).value
    assert found.certificate.bound.value <= independent <= found.sampled + 1e-9


def test_a_best_bound_beyond_the_allowance_is_the_closest_that_is_not() -> None:
    """Of the tolerance doubled again and again, the smallest that its share of the boxes proves."""
    tolerance, most_boxes = 2e-3, 32_000
    found = best_bound(Heli4(), CYLINDER, "J_q", tolerance, most_boxes=most_boxes)
    assert found is not None
    doublings = math.log2((found.sampled - found.certificate.bound.value) / tolerance)
    assert doublings == pytest.approx(round(doublings), abs=1e-6)
    assert round(doublings) >= 1
    nearer = found.sampled - tolerance * 2.0 ** (round(doublings) - 1)
    assert certify(Heli4(), CYLINDER, "J_q", at_least=nearer, most_boxes=most_boxes // 4).status == "undecided"


def test_a_strength_that_is_hard_to_prove_has_a_best_bound_above_0_within_few_boxes() -> None:
    """The widest distance is tried before those that cost more boxes than are allowed."""
    region = Box(x=(-0.15, 0.15), y=(-0.15, 0.15), z=(-0.8, -0.7))
    worst = worst_poses(Delta(), region, "strength", about=10_000).value
    found = best_bound(Delta(), region, "strength", 0.01 * worst, most_boxes=500)
    assert found is not None
    assert found.certificate.bound.value == pytest.approx(0.36 * worst, rel=0.01)


def test_that_a_strength_is_not_negative_is_decided() -> None:
    region = Box(x=(-0.15, 0.15), y=(-0.15, 0.15), z=(-0.8, -0.7))
    assert certify(Delta(), region, "strength", at_least=0.0, most_boxes=10_000).status == "proved"


def test_progress_counts_the_boxes_up_to_the_answer() -> None:
    told: list[str] = []
    found = certify(Heli4(), CYLINDER, "J_q", at_least=0.4, progress=told.append)
    assert all(line.startswith("certify J_q >= 0.4: ") for line in told)
    assert told[-1].endswith(f"{found.boxes} boxes bounded, 0 more waiting")


def test_there_is_no_best_bound_out_of_reach() -> None:
    beyond = Box(x=(0.0, 1.4), y=0.0, z=-0.7, theta=0.0)
    assert best_bound(Heli4(), beyond, "J_q", 1e-3) is None


def test_wrong_questions_are_named() -> None:
    with pytest.raises(InvalidRegion):
        certify(Heli4(), Box(x=0.0, y=0.0, z=-0.7), "J_q", at_least=0.1)
    with pytest.raises(InvalidValue, match="at_least"):
        certify(Heli4(), CYLINDER, "J_q", at_least=math.nan)
    with pytest.raises(InvalidValue, match="most_boxes"):
        certify(Heli4(), CYLINDER, "J_q", at_least=0.1, most_boxes=0)
    with pytest.raises(InvalidValue, match="margin"):
        certify(Heli4(), CYLINDER, "no_such", at_least=0.1)
    with pytest.raises(InvalidValue, match="characteristic_length"):
        certify(Heli4(), CYLINDER, "fvi", at_least=0.1, characteristic_length=0.0)
    with pytest.raises(InvalidValue, match="tolerance"):
        best_bound(Heli4(), CYLINDER, "J_q", 0.0)


class Made(Margin):
    """A margin of the distance of x from 0.1."""

    words = "made for a test"

    def __init__(self, name: str, of: Callable[[ca.SX], ca.SX]) -> None:
        self.name, self._of = name, of  # type: ignore[misc]

    def components(self, robot: Mechanism, measure: Measure) -> ca.SX:  # noqa: ARG002
        return self._of(robot.model().pose[0] - 0.1)


class Jumping(Heli4):
    """With margins that jump, or have a kink, where x is 0.1.

    Around 0.1 they are flat or lead upward, so that a slope alone would prove what is false beyond.
    """

    margins = by_name(
        Heli4.margins["reach"],
        Made("branch", lambda x: ca.if_else(x < 0.0, 1.0 + x, -1.0 + x)),
        Made("sign", lambda x: 2.0 - ca.sign(x) * (3.0 + x)),
        Made("turn", lambda x: 1.0 + ca.atan2(x, x - 1.0)),  # -> 1 + pi above the cut, 1 - pi below
        Made("kink", lambda x: ca.fabs(x) + 0.5),
    )


@pytest.mark.parametrize("margin", ["branch", "sign", "turn"])
def test_no_slope_speaks_for_the_far_side_of_a_jump(margin: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("design.certificates.refutation.Refuter.refutation", lambda *_: None)
    good = (0.11, 0.2) if margin == "turn" else (-0.02, 0.09)
    across, aside = (Box(x=x, y=0.0, z=-0.7, theta=0.0) for x in ((-0.02, 0.2), good))
    assert certify(Jumping(), across, margin, at_least=0.5, most_boxes=5_000).status == "undecided"
    assert certify(Jumping(), aside, margin, at_least=0.5).status == "proved"


def test_a_kink_is_no_jump() -> None:
    found = certify(Jumping(), Box(x=(-0.02, 0.2), y=0.0, z=-0.7, theta=0.0), "kink", at_least=0.4999)
    assert found.status == "proved"
    assert found.boxes < 50


def test_equal_links_are_proved_up_to_where_they_fold_and_never_beyond() -> None:
    robot = Peppermill(Peppermill.Geometry(proximal_lengths=(0.6, 0.6), distal_lengths=(0.6, 0.6)))
    fixed = {"x": 0.0, "y": 0.0, "theta": 0.0}
    near, onto = (Box(z=(0.0, top), **fixed) for top in (0.49, robot.geometry.half_distance))
    for margin in ("reach", "J_q"):
        assert certify(robot, near, margin, at_least=1e-3).status == "proved"
        at_least = 0.0 if margin == "reach" else -1.0
        assert certify(robot, onto, margin, at_least=at_least, most_boxes=3_000).status != "proved"


@pytest.mark.parametrize(
    ("robot", "region", "margin"),
    [
        (Heli4(), CYLINDER, "joint_travel"),
        (Heli4(), CYLINDER, "passive_joint"),
        (Redundant3T1R(), Box(x=0.0, y=(-0.2, 0.2), z=(-0.2, 0.2), theta=(-1.0, 1.0)), "clearance"),
        (Redundant3T1R(), YZ, "joint_travel"),
        (Redundant3T1R(), YZ, "passive_joint"),
        (GoughStewart(), HEXAPOD, "joint_travel"),
        (GoughStewart(), HEXAPOD, "passive_joint"),
        (Peppermill(), SCREWS, "joint_travel"),
        (Peppermill(), SCREWS, "passive_joint"),
    ],
)
def test_room_is_proved_close_to_the_worst_found_and_refuted_just_above(
    robot: Mechanism, region: Region, margin: str
) -> None:
    worst = worst_poses(robot, region, margin, about=20_000).value
    assert worst > 0.0
    assert certify(robot, region, margin, at_least=0.98 * worst).status == "proved"
    assert certify(robot, region, margin, at_least=1.001 * worst).status == "refuted"


def test_a_bound_beyond_the_whole_range_is_never_proved(monkeypatch: pytest.MonkeyPatch) -> None:
    """The sine and cosine of an angle below 0 would allow what the angle does not."""
    monkeypatch.setattr("design.certificates.refutation.Refuter.refutation", lambda *_: None)
    for robot, region in ((Heli4(), PART), (GoughStewart(), HEXAPOD)):
        for beyond in (0.1, 2 * math.pi):
            bound = max(robot.ranges.passive) + beyond
            assert certify(robot, region, "passive_joint", at_least=bound, most_boxes=500).status == "undecided"


def test_arms_that_touch_are_never_proved_apart(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("design.certificates.refutation.Refuter.refutation", lambda *_: None)
    touching = Box(x=0.0, y=(0.3, 0.75), z=(-0.3, -0.15), theta=(-0.3, 0.3))
    assert worst_poses(Redundant3T1R(), touching, "clearance", about=20_000).value < 1e-3
    for bound in (0.0, 0.002):
        assert certify(Redundant3T1R(), touching, "clearance", at_least=bound, most_boxes=4_000).status == "undecided"


@pytest.mark.parametrize("turns", [0, 10, 1_000_000, 100_000_000])
def test_millions_of_turns_away_the_same_is_proved(turns: int) -> None:
    middle = turns * 2 * PI
    region = Box(x=(-0.02, 0.02), y=(-0.02, 0.02), theta=(middle - 0.1, middle + 0.1))
    assert certify(Planar3RRR(), region, "det_J_x", at_least=0.01, most_boxes=1_000).status == "proved"


@pytest.mark.parametrize("x", [0.1, (0.1, 0.1), (0.0, 5e-324), (0.1, math.nextafter(0.1, 1.0)), (-1e-300, 1e-300)])
@pytest.mark.parametrize("at_least", [0.3, 1e-300, 0.0, -0.0, -1e300])
def test_a_region_of_hardly_any_width_is_decided_as_a_pose_is(x: float | tuple[float, float], at_least: float) -> None:
    assert certify(Heli4(), Box(x=x, y=0.0, z=-0.7, theta=0.0), "J_q", at_least=at_least).status == "proved"
    assert certify(Heli4(), Box(x=x, y=0.0, z=-0.7, theta=0.0), "J_q", at_least=1e300).status == "refuted"


@pytest.mark.long
@pytest.mark.parametrize("mechanism", list(MECHANISMS.values()), ids=list(MECHANISMS))
def test_no_answer_about_a_random_robot_is_false(mechanism: type[Mechanism]) -> None:
    """Random geometries, regions and margins, many of them partly out of reach."""
    rng = np.random.default_rng(77)
    for _ in range(60):
        usual = mechanism()
        vector = usual.geometry.vector()
        try:
            geometry = mechanism.Geometry.from_vector(vector * rng.uniform(0.8, 1.25, len(vector)))
            robot = mechanism(geometry)
        except LinkwrightError:
            continue
        middle = np.array(robot.home) + rng.normal(0.0, 0.15, len(robot.home))
        half = 10.0 ** rng.uniform(-3.0, -1.0, len(middle)) * rng.choice([0.0, 1.0], len(middle), p=[0.2, 0.8])
        region = Box(
            **{n: (float(m - h), float(m + h)) for n, m, h in zip(robot.pose_names, middle, half, strict=True)}
        )
        poses = region.random(robot.pose_names, 5_000, rng)
        margin = str(rng.choice(list(robot.margins)))
        values = robot.margin(margin, poses)
        reached = robot.margin("reach", poses) >= 0.0
        sense = robot.margins[margin].sense
        worst = sense * float(np.nanmin(sense * values)) if np.isfinite(values).any() else 0.5
        bound = worst + float(rng.choice([-1.0, 1.0])) * 10.0 ** rng.uniform(-9.0, -0.5)
        bound = max(bound, 0.0) if margin == "reach" else bound  # every claim claims reach itself
        found = certify(robot, region, margin, most_boxes=5_000, **bound_of(robot, margin, bound))
        told = (mechanism.__name__, margin, bound, region, geometry)
        if found.status == "proved":
            assert reached.all(), told
            assert (sense * (values - bound) >= -1e-12 * max(1.0, abs(bound))).all(), told
        if found.status == "refuted":
            pose = found.counterexample
            assert pose is not None
            assert region.contains(pose, robot.pose_names), told
            value = float(robot.margin(margin, pose))
            assert found.within_reach == bool(robot.margin("reach", pose) >= 0.0), told
            assert not found.within_reach or sense * (value - bound) < 0.0, told
