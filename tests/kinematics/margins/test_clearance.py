"""Clearance: exact distances of bodies, against independent ones, and the machine's own limits that follow."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import combinations

import casadi as ca
import numpy as np
import pytest

from kinematics import (
    MECHANISMS,
    Delta,
    GoughStewart,
    Heli4,
    InvalidValue,
    Mechanism,
    Obstacle,
    Par4,
    PayloadHull,
    Peppermill,
    Planar3PRR,
    Planar3RRR,
    Redundant3T1R,
    Surroundings,
    lowest_of_base,
    payload_inside,
    placed_shapes,
    require_room,
)
from kinematics.margins.clearance.solids import rooms
from kinematics.mathematics import Convex, segment_distances, signed_distance
from tests.kinematics.margins.bodies import between, components, corners, signed_by_fcl, signed_by_hull
from tests.sizes import every_mechanism

Shape = tuple[np.ndarray, Callable[[ca.SX], Convex]]


def segment(rng: np.random.Generator) -> Shape:
    return rng.normal(size=(3, 2)), Convex


def polygon(rng: np.random.Generator) -> Shape:
    """Three to six corners around a circle, no half turn apart, in any plane."""
    count = int(rng.integers(3, 7))
    angles = (np.arange(count) + rng.uniform(-0.2, 0.2, count)) * 2 * np.pi / count
    frame = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    flat = rng.uniform(0.3, 1.0) * np.vstack([np.cos(angles), np.sin(angles), 0 * angles])
    return frame @ flat + 0.5 * rng.normal(size=(3, 1)), Convex.polygon


def box(rng: np.random.Generator) -> Shape:
    low = rng.normal(size=3) / 2
    made = Convex.box(low.tolist(), (low + rng.uniform(0.2, 1.2, 3)).tolist())
    return np.array(ca.DM(made.corners)), lambda points: Convex(points, made.faces)


@pytest.mark.parametrize(
    ("first", "second"), [(segment, segment), (segment, polygon), (polygon, polygon), (segment, box), (polygon, box)]
)
def test_signed_distances_are_those_of_the_hull_of_all_differences(
    first: Callable[[np.random.Generator], Shape], second: Callable[[np.random.Generator], Shape]
) -> None:
    rng = np.random.default_rng(3)
    negative = 0
    for _ in range(12):
        (one, kind), (two, other) = first(rng), second(rng)
        two += (one.mean(axis=1) - two.mean(axis=1) + 0.5 * rng.normal(size=3))[:, None]
        p, q = ca.SX.sym("p", *one.shape), ca.SX.sym("q", *two.shape)
        found = float(ca.Function("distance", [p, q], [signed_distance(kind(p), other(q))])(one, two))
        assert found == pytest.approx(signed_by_hull(one, two), abs=1e-7)
        negative += found < 0.0
    assert (negative > 0) == (first is not segment or second is not segment)


@pytest.mark.parametrize("name", every_mechanism(MECHANISMS))
def test_every_component_is_the_distance_that_a_collision_library_finds(name: str) -> None:
    robot, rng = MECHANISMS[name](), np.random.default_rng(5)
    poses = robot.home + 0.03 * robot.pose_units() * rng.uniform(-1, 1, (40, len(robot.pose_names)))
    poses = poses[np.isfinite(robot.inverse(poses)).all(axis=1)][:2]
    pairs = rooms(robot).pairs
    found = components(robot, poses)
    assert np.allclose(robot.margin("clearance", poses), found.min(axis=1), rtol=0, atol=1e-12)
    for values, pose in zip(found, poses, strict=True):
        for value, (one, two, r, s) in zip(values, corners(robot, pairs, pose), strict=True):
            capsules = one.shape[1] == two.shape[1] == 2
            expected = signed_by_fcl(one, two, (r, s)) if capsules else signed_by_hull(one, two) - r - s
            assert value == pytest.approx(expected, abs=2e-6 * robot.geometry.size)


def test_rods_grown_until_they_touch_have_no_clearance_and_then_minus_their_depth() -> None:
    robot = Redundant3T1R()
    room = between(robot, "rod 1", "rod 4 b", robot.home)
    for grown, left in ((room / 2, 0.0), (room, -room)):
        thick = replace(robot.geometry, rod_radius=robot.geometry.rod_radius + grown)
        other = robot.with_geometry(thick)
        assert between(other, "rod 1", "rod 4 b", robot.home) == pytest.approx(left, abs=1e-14)


def compared(robot: Mechanism) -> set[frozenset[str]]:
    places = robot.margins["clearance"].places(robot)
    assert places is not None
    return {frozenset(place.split(" and ")) for place in places}


def test_heli4s_members_are_compared_unless_they_turn_on_one_another() -> None:
    """The list of joints is written here once more, by hand."""
    plates = {"lower plate": "12", "upper plate": "34"}
    rods = [f"rod {i} {side}" for i in "1234" for side in "ab"]
    moving = ["screw", *plates, *rods, *(f"arm {i}" for i in "1234")]
    every = {frozenset(pair) for pair in combinations(moving, 2)}
    every |= {frozenset((f"motor {i}", member)) for i in "1234" for member in moving}
    joined = {frozenset((f"arm {i}", other)) for i in "1234" for other in (f"motor {i}", f"rod {i} a", f"rod {i} b")}
    joined |= {frozenset((plate, f"rod {i} {s}")) for plate, limbs in plates.items() for i in limbs for s in "ab"}
    joined |= {frozenset(("screw", plate)) for plate in plates}
    assert compared(Heli4()) == every - joined


def test_the_rods_of_arms_3_and_4_are_compared_with_what_does_not_hold_them() -> None:
    pairs = compared(Redundant3T1R())
    for rod, own, other in (("a", "lower", "upper"), ("b", "upper", "lower")):
        for i in (3, 4):
            assert {f"rod {i} {rod}", f"platform's {other} bar"} in pairs
            assert {f"rod {i} {rod}", f"platform's {own} bar"} not in pairs
    assert {"rod 3 a", "rod 3 b"} in pairs
    assert {"rod 3 a", "rod 4 b"} in pairs


@pytest.mark.parametrize("kind", [Delta, Heli4, Par4, Redundant3T1R])
def test_two_rods_of_a_limb_that_are_nearer_than_they_are_thick_intersect(kind: type[Mechanism]) -> None:
    usual = kind().geometry
    radius = usual.rod_radius  # type: ignore[attr-defined]
    robot = kind(replace(usual, parallelogram_width=1.5 * radius))  # type: ignore[call-arg]
    assert robot.margin("clearance", robot.home) <= -0.5 * radius + 1e-12


def test_heli4s_plates_pass_each_other_in_a_whole_turn() -> None:
    robot = Heli4()
    poses = np.tile(robot.home, (200, 1))
    poses[:, 3] = np.linspace(-np.pi, np.pi, 200)
    assert (between_all(robot, "lower plate", "upper plate", poses) > 0.0).all()
    low = Heli4(replace(robot.geometry, plate_rise=0.01))
    assert (between_all(low, "lower plate", "upper plate", poses) < 0.0).any()


def between_all(robot: Mechanism, one: str, two: str, poses: np.ndarray) -> np.ndarray:
    return np.array([between(robot, one, two, pose) for pose in poses])


def test_turning_the_whole_robot_changes_no_clearance() -> None:
    robot, turn = Heli4(), 0.37
    turned = Heli4(replace(robot.geometry, azimuths=tuple(a + turn for a in robot.geometry.azimuths)))
    poses = robot.home + np.random.default_rng(1).uniform(-0.2, 0.2, (50, 4))
    c, s = np.cos(turn), np.sin(turn)
    moved = np.column_stack([c * poses[:, 0] - s * poses[:, 1], s * poses[:, 0] + c * poses[:, 1], poses[:, 2:]])
    assert np.allclose(robot.margin("clearance", poses), turned.margin("clearance", moved), rtol=0, atol=1e-12)


def test_a_mirrored_pose_of_the_redundant_robot_has_the_same_clearance() -> None:
    robot = Redundant3T1R()
    poses = np.random.default_rng(2).uniform([-0.2, -0.3, -0.3, -1.2], [0.2, 0.3, 0.3, 1.2], (50, 4))
    mirrored = poses * [1, -1, 1, -1]
    assert np.allclose(robot.margin("clearance", poses), robot.margin("clearance", mirrored), rtol=0, atol=1e-12)


def test_the_redundant_papers_guide_condition_follows_from_the_rails() -> None:
    """y_1 + d/2 <= y <= y_2 - d/2, plus the thickness of bar and rail, where the platform is as high as the rails."""
    robot = Redundant3T1R()
    g = robot.geometry
    thick = g.platform_thickness / 2 + g.rail_radius
    level = g.outer_rail_z - g.platform_height / 2  # of the tool, with B_1 as high as rails 1 and 2
    for y in (-0.3, -0.2, 0.1):
        room = between(robot, "platform's upper bar", "rail 1", np.array([0.0, y, level, np.pi / 2]))
        assert room == pytest.approx(y - (g.outer_rail_y + g.platform_length / 2) - thick, abs=1e-12)
        room = between(robot, "platform's upper bar", "rail 2", np.array([0.0, y, level, -np.pi / 2]))
        assert room == pytest.approx(-g.outer_rail_y - g.platform_length / 2 - y - thick, abs=1e-12)


def test_a_planar_platforms_corner_stays_on_its_side_of_a_rail() -> None:
    """Rail 1 runs along y = -0.5; the platform's lowest corner is rho below its centre."""
    robot = Planar3PRR()
    g, rho = robot.geometry, 0.15
    for y in (0.0, -0.1):
        room = between(robot, "platform", "rail 2", np.array([0.0, y, 0.0]))
        along = np.array([np.cos(g.rail_angles[1]), np.sin(g.rail_angles[1])])
        corner = rho * np.array([np.cos(np.pi / 6), np.sin(np.pi / 6)]) + [0.0, y]
        across = abs(np.cross(np.append(along, 0), np.append(corner - np.array(g.base_points[1]), 0))[2])
        assert room == pytest.approx(across - g.plate_thickness / 2 - g.rail_radius, abs=1e-12)


def test_a_peppermill_column_is_as_far_as_it_is_above_or_below() -> None:
    robot = Peppermill()
    g = robot.geometry
    pose = np.zeros(4)
    apart = 2 * g.half_distance + g.nut_spacing
    below = between(robot, "proximal link 2", "column 1", pose)
    assert below == pytest.approx(apart - g.link_radius - g.column_radius, abs=0.1)
    thick = robot.with_geometry(replace(g, column_radius=g.column_radius + 0.01))
    assert between(thick, "proximal link 2", "column 1", pose) == pytest.approx(below - 0.01, abs=1e-12)


def test_a_peppermill_nut_comes_nearer_to_the_other_by_both_pitches_a_turn() -> None:
    robot = Peppermill()
    g = robot.geometry
    for turns in (-1.0, 0.0, 0.5, 1.0):
        apart = g.nut_spacing - turns * (g.pitches[0] - g.pitches[1])
        room = between(robot, "nut 1", "nut 2", np.array([0.0, 0.0, 0.0, turns * 2 * np.pi]))
        assert room == pytest.approx(apart - g.nut_length - 2 * g.nut_radius, abs=1e-12)


def test_a_peppermill_carriage_meets_its_motor_where_its_range_ends() -> None:
    robot = Peppermill()
    (low, high), *_ = robot.ranges.limits(4)
    pose = np.array([0.07, -0.02, 0.0, 0.0])
    assert between(robot, "carriage 1", "motor 1L", pose) == pytest.approx(0.07 - low, abs=1e-12)
    assert between(robot, "carriage 1", "motor 1R", pose) == pytest.approx(high - 0.07, abs=1e-12)


def test_an_arm_of_a_planar_robot_passes_a_link_radius_above_another_motor() -> None:
    robot = Planar3RRR()
    g = robot.geometry
    angle = g.zero_angles[0] + robot.inverse(robot.home)[0]
    under = np.array(g.base_points[0]) + g.arm_lengths[0] / 2 * np.array([np.cos(angle), np.sin(angle)])
    moved = replace(g, base_points=(g.base_points[0], tuple(under), g.base_points[2]))
    other = Planar3RRR(moved, home=robot.home)
    assert between(other, "arm 1", "motor 2", robot.home) == pytest.approx(g.link_radius, abs=1e-12)


def test_the_floor_is_as_far_as_the_lowest_point() -> None:
    robot = Delta()
    lowest = robot.home[2] - robot.geometry.plate_thickness / 2
    for height, room in ((lowest - 0.004, 0.004), (lowest, 0.0), (lowest + 0.01, -0.01)):
        placed = robot.with_surroundings(Surroundings(floor=height))
        assert between(placed, "plate", "the floor", robot.home) == pytest.approx(room, abs=1e-14)
    assert str(placed.margin_place("clearance", robot.home)).endswith(" and the floor")
    found = lowest_of_base(robot)
    assert found is not None
    assert (found.member, found.height) == ("motor 1", -robot.geometry.motor_radius)


def test_a_box_may_be_kept_out_of_or_kept_in() -> None:
    robot = Delta()
    z = robot.home[2]
    top = z - robot.geometry.plate_thickness / 2 - 0.02
    beneath = Obstacle("conveyor", (-0.1, -0.1, top - 0.5), (0.1, 0.1, top))
    frame = Obstacle("frame", (-0.7, -0.7, z - 0.5), (0.7, 0.7, 0.5), inside=True)
    placed = robot.with_surroundings(Surroundings(obstacles=(beneath, frame)))
    assert between(placed, "plate", "conveyor", robot.home) == pytest.approx(0.02, abs=1e-14)
    assert between(placed, "plate", "frame", robot.home) == pytest.approx(
        0.5 - robot.geometry.plate_thickness / 2, abs=1e-14
    )
    raised = Obstacle("conveyor", (-0.1, -0.1, top - 0.5), (0.1, 0.1, top + 0.05))
    sunk = robot.with_surroundings(Surroundings(obstacles=(raised,)))
    assert between(sunk, "plate", "conveyor", robot.home) == pytest.approx(-0.03, abs=1e-14)


def test_a_payload_hangs_with_the_tool_and_tilts_with_it() -> None:
    hull = PayloadHull(radius=0.02, low=0.03, high=0.13)
    robot = GoughStewart(surroundings=Surroundings(payload_hull=hull))
    pose = robot.home + np.array([0.0, 0, 0, 0.15, 0, 0])
    top = pose[:3] + np.array([0.0, -np.sin(0.15), np.cos(0.15)]) * 0.11
    placed = robot.with_surroundings(Surroundings(floor=0.3, payload_hull=hull))
    assert between(placed, "payload", "the floor", pose) == pytest.approx(
        min(top[2], pose[2] + np.cos(0.15) * 0.05) - 0.02 - 0.3, abs=1e-12
    )
    assert payload_inside(robot) is None
    inside = robot.with_surroundings(Surroundings(payload_hull=PayloadHull(0.02, 0.0, 0.1)))
    found = payload_inside(inside)
    assert found is not None
    assert found.member == "platform"
    assert found.depth == pytest.approx(robot.geometry.plate_thickness / 2, abs=0.02)


def test_a_payload_among_the_bars_of_an_articulated_platform_is_refused() -> None:
    for kind, member in ((Par4, "bars"), (Heli4, "screw"), (Peppermill, "screws")):
        hull = PayloadHull(radius=0.01, low=-0.001, high=0.03)
        with pytest.raises(InvalidValue, match=rf"outside all members; at home it is .* inside the {member}"):
            require_room(kind(surroundings=Surroundings(payload_hull=hull)))


def test_a_flat_payload_is_as_wide_as_its_radius() -> None:
    hull = PayloadHull(radius=0.06, low=-0.05, high=-0.03)
    side = Obstacle("wall", (0.1, -1.0, -2.0), (0.2, 1.0, 1.0))
    robot = Delta(surroundings=Surroundings(obstacles=(side,), payload_hull=hull))
    assert between(robot, "payload", "wall", robot.home) == pytest.approx(0.1 - 0.06, abs=1e-12)


def test_a_member_that_joins_nothing_is_told() -> None:
    class Loose(Delta):
        def members(self, pose, joints, g):  # type: ignore[no-untyped-def]
            first, *rest = super().members(pose, joints, g)
            return [*rest, first._replace(joints=("nowhere",))]

    with pytest.raises(InvalidValue, match=r"Loose member 'arm 1', joints: found .*nowhere.*; expected a joint that"):
        Loose().margin("clearance", Loose().home)


IN_THE_PLATE = Surroundings(payload_hull=PayloadHull(0.03, -0.003, 0.003))


def boxed(name: str) -> Surroundings:
    return Surroundings(obstacles=(Obstacle(name, (0.0, 0.0, -2.0), (1.0, 1.0, -1.5)),))


@pytest.mark.parametrize(
    ("made", "words"),
    [
        (lambda: Obstacle("box", (0, 0, 0), (1, 1, 0)), "Obstacle 'box' high: .* expected above low"),
        (lambda: PayloadHull(0.0, 0.0, 1.0), "PayloadHull radius: found 0.0"),
        (lambda: PayloadHull(0.1, 1.0, 1.0), "PayloadHull high: found 1.0; expected above low"),
        (
            lambda: Delta().with_surroundings(boxed("rod 2 a")),
            "'rod 2 a': found rod 2 a; expected a name that is no member",
        ),
        (
            lambda: Peppermill(surroundings=boxed("payload")),
            "found payload; .* none of base, floor, payload, the floor",
        ),
        (lambda: require_room(Delta().with_surroundings(Surroundings(floor=0.3))), "floor: .* motor 1 reaches down to"),
        (
            lambda: require_room(Delta().with_surroundings(IN_THE_PLATE)),
            "high: .* outside all members; .* inside the plate",
        ),
        (lambda: Surroundings(floor=float("nan")), "Surroundings floor"),
        (lambda: Surroundings(obstacles=(Obstacle("a", (0, 0, 0), (1, 1, 1)),) * 2), "a different name for each"),
    ],
)
def test_bad_surroundings_are_told_with_their_field(made: Callable[[], object], words: str) -> None:
    with pytest.raises(InvalidValue, match=words):
        made()


def test_a_hull_is_judged_where_a_limb_cannot_reach_home() -> None:
    for kind, home in ((Delta, [0, 0, -3.0]), (Heli4, [0, 0, -3.0, 0]), (Peppermill, [0, 0, 5.0, 0])):
        robot = kind(home=home, surroundings=Surroundings(payload_hull=PayloadHull(0.02, -0.6, -0.5)))
        assert payload_inside(robot) is None
    assert payload_inside(Delta(home=[0, 0, -3.0], surroundings=IN_THE_PLATE)).member == "plate"


def test_heli4s_screw_joins_both_plates_whatever_their_heights() -> None:
    for change in (
        {"height_step": 0.2},
        {"height_step": -0.2},
        {"plate_rise": 0.2},
        {"plate_offset": -0.2},
        {"pitch": -0.1},
    ):
        robot = Heli4(replace(Heli4().geometry, **change))
        for turns in (-1.5, 0.0, 1.5):
            pose = robot.home + np.array([0, 0, 0, turns * 2 * np.pi])
            assert overlap(robot, "screw", "lower plate", pose) > 0.0
            assert overlap(robot, "screw", "upper plate", pose) > 0.0


def overlap(robot: Mechanism, one: str, two: str, pose: np.ndarray) -> float:
    """Of two members that may touch: how deep their shapes are in one another."""
    shapes = placed_shapes(robot, pose)
    first, second = ([s for s in shapes if s.member == name] for name in (one, two))
    return max(a.around + b.around - float(segment_distances(a.corners, b.corners)) for a in first for b in second)


def test_a_nut_leaves_its_screw_where_the_screws_turns_end() -> None:
    robot = Heli4()
    for turns in (1.6, -1.6):
        pose = robot.home + np.array([0, 0, 0, turns * 2 * np.pi])
        assert robot.margin("passive_joint", pose) == pytest.approx(-0.1 * 2 * np.pi, abs=1e-12)
        assert robot.margin_place("passive_joint", pose) == "nut on the screw"
