"""The path is the curve that it claims to be: checked against other quadratures and finite differences."""

from __future__ import annotations

import math

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad

from kinematics import InvalidValue
from trajectory import AdeptCycle, Reversed

HERE = AdeptCycle(pick=(0.0, 0.0, 0.0))


def quintic(u: float) -> float:
    return 10 * u**3 - 15 * u**4 + 6 * u**5


def exact_position(path: AdeptCycle, s: float) -> tuple[float, float]:
    """Across and up by 30-digit quadrature of the tangent, from the definition alone."""
    with mpmath.workdps(30):
        share = mpmath.quad(lambda u: mpmath.sin(mpmath.pi / 2 * quintic(u)), [0, 1])
        corner = mpmath.mpf(path.blend) / share
        first = mpmath.mpf(path.lift) - mpmath.mpf(path.blend)
        second = first + corner + mpmath.mpf(path.span) - 2 * mpmath.mpf(path.blend)
        inside = [k for k in (first, first + corner, second, second + corner) if 0 < k < s]
        places = [mpmath.mpf(0), *inside, mpmath.mpf(s)]

        def angle(at: mpmath.mpf) -> mpmath.mpf:
            held = [min(max((at - start) / corner, 0), 1) for start in (first, second)]
            return mpmath.pi / 2 * sum(quintic(u) for u in held)

        across = mpmath.quad(lambda at: mpmath.sin(angle(at)), places)
        up = mpmath.quad(lambda at: mpmath.cos(angle(at)), places)
        return float(across), float(up)


@pytest.mark.parametrize("fraction", [0.0001, 0.02, 0.07, 0.11, 0.4, 0.89, 0.93, 0.9995, 1.0])
def test_positions_agree_with_quadrature_in_30_digits(fraction: float) -> None:
    s = fraction * HERE.length
    (pose,) = HERE.evaluate(np.array(s), 0)
    assert np.abs(pose[[0, 2]] - exact_position(HERE, s)).max() < 2e-16


def test_arc_length_is_the_integral_of_the_speed_of_the_positions() -> None:
    share = quad(lambda u: math.sin(math.pi / 2 * quintic(u)), 0.0, 1.0, epsabs=1e-15)[0]
    corner = HERE.knots[2] - HERE.knots[1]
    assert corner == pytest.approx(HERE.blend / share, rel=1e-15)
    s = np.linspace(0.0, HERE.length, 20001)
    chords = np.linalg.norm(np.diff(HERE.evaluate(s, 0)[0][:, :3], axis=0), axis=-1).sum()
    assert chords == pytest.approx(HERE.length, rel=1e-7)
    assert chords <= HERE.length


def test_a_corner_takes_the_blend_along_both_legs() -> None:
    (poses,) = HERE.evaluate(np.array(HERE.knots), 0)
    across, up = poses[:, 0], poses[:, 2]
    b, lift, span = HERE.blend, HERE.lift, HERE.span
    assert across == pytest.approx([0, 0, b, span - b, span, span], abs=1e-15)
    assert up == pytest.approx([0, lift - b, lift, lift, lift - b, 0], abs=1e-15)


def test_the_tangent_has_unit_length_everywhere() -> None:
    s = np.linspace(0.0, HERE.length, 5001)
    assert np.abs(np.linalg.norm(HERE.evaluate(s, 1)[1][:, :3], axis=-1) - 1).max() < 4e-16


@pytest.mark.parametrize("order", [1, 2, 3])
def test_each_derivative_is_the_finite_difference_of_the_one_below(order: int) -> None:
    rng = np.random.default_rng(7)
    h = 1e-6
    s = rng.uniform(h, HERE.length - h, 2000)
    derivatives = HERE.evaluate(s, 3)
    difference = (HERE.evaluate(s + h, 3)[order - 1] - HERE.evaluate(s - h, 3)[order - 1]) / (2 * h)
    assert np.abs(difference - derivatives[order]).max() < 1e-6 * (1 + np.abs(derivatives[order]).max())


def test_curvature_and_its_slope_are_continuous_across_the_knots() -> None:
    """G3: the third derivative of the position changes across a knot by no more than its slope allows."""
    corner = HERE.knots[2] - HERE.knots[1]
    steepest = math.pi / 2 * 60 / corner**3 + 2e5 * HERE.turn  # of S5''' and of the slower turn
    for h in (1e-6, 1e-7):
        for knot in HERE.knots[1:-1]:
            below, above = HERE.evaluate(np.array([knot - h, knot + h]), 3)[3]
            assert np.abs(above - below).max() <= 2 * h * steepest


def test_the_path_is_its_own_mirror_image() -> None:
    s = np.linspace(0.0, HERE.length, 997)
    there, back = HERE.evaluate(s, 0)[0], HERE.evaluate(HERE.length - s, 0)[0]
    assert np.abs(there[:, 0] - (HERE.span - back[:, 0])).max() < 2e-16
    assert np.abs(there[:, 2] - back[:, 2]).max() < 2e-16
    assert np.abs(there[:, 3] - (HERE.turn - back[:, 3])).max() < 1e-13


def test_the_turn_starts_and_ends_at_rest_to_its_third_derivative() -> None:
    _, *derivatives = HERE.evaluate(np.array([0.0, HERE.length]), 3)
    for k, d in enumerate(derivatives):
        assert np.abs(d[:, 3]).max() * HERE.length ** (k + 1) < 1e-11


def test_the_reversed_path_goes_back_the_same_way() -> None:
    back = Reversed(HERE)
    s = np.linspace(0.0, HERE.length, 101)
    for k, (there, again) in enumerate(zip(HERE.evaluate(s), back.evaluate(HERE.length - s), strict=True)):
        scale = np.abs(there).max()
        assert np.abs(there - (-1) ** k * again).max() <= 1e-12 * scale
    assert back.as_dict() == {**HERE.as_dict(), "reversed": True}
    assert HERE.reversed() == back


def test_heading_and_start_angle_place_the_span() -> None:
    path = AdeptCycle.centred((0.1, -0.2, -0.7), span=0.3, heading=0.5, start_angle=0.25)
    start, end = path.evaluate(np.array([0.0, path.length]), 0)[0]
    assert (start + end)[:3] / 2 == pytest.approx([0.1, -0.2, -0.7], abs=1e-15)
    assert (end - start)[:2] == pytest.approx([0.3 * math.cos(0.5), 0.3 * math.sin(0.5)], abs=1e-15)
    assert (start[3], end[3]) == pytest.approx((0.25, 0.25 + math.pi), abs=1e-14)


@settings(derandomize=True, deadline=None, max_examples=50)
@given(
    lift=st.floats(1e-3, 0.2),
    span=st.floats(1e-2, 1.0),
    share=st.floats(0.01, 1.0),
    heading=st.floats(-math.pi, math.pi),
)
def test_any_valid_cycle_ends_at_the_place_and_keeps_within_its_height(
    lift: float, span: float, share: float, heading: float
) -> None:
    path = AdeptCycle(lift, span, share * min(lift, span / 2), heading=heading)
    s = np.linspace(0.0, path.length, 301)
    pose, first = path.evaluate(s, 1)
    away = pose[-1, :3] - path.pick
    assert away == pytest.approx([span * math.cos(heading), span * math.sin(heading), 0.0], abs=1e-14)
    assert np.abs(np.linalg.norm(first[:, :3], axis=-1) - 1).max() < 1e-15
    assert pose[:, 2].max() <= path.pick[2] + lift + 1e-15
    assert 2 * lift + span - 4 * path.blend < path.length <= 2 * lift + span


@pytest.mark.parametrize(("size", "span"), [("25/305/25", 0.305), ("25/300/25", 0.3), ("25/700/25", 0.7)])
def test_a_standard_size_is_as_long_as_its_legs_and_corners(size: str, span: float) -> None:
    """Each corner replaces two blends b by its arc b / I, I the mean of the sine of the tangent's angle."""
    path = AdeptCycle.of_size(size, blend=0.02)
    with mpmath.workdps(30):
        mean = float(mpmath.quad(lambda u: mpmath.sin(mpmath.pi / 2 * quintic(u)), [0, 1]))
    assert path.length == pytest.approx(0.05 + span - 4 * 0.02 + 2 * 0.02 / mean, rel=1e-15)


def test_another_size_is_refused() -> None:
    with pytest.raises(InvalidValue, match="25/305/25"):
        AdeptCycle.of_size("30/305/30")


def test_pick_and_place_may_lie_at_any_heights_each_with_its_own_lift() -> None:
    pick, place = (0.05, -0.1, -0.8), (-0.15, 0.1, -0.76)
    path = AdeptCycle.between(pick, place, lift=0.06, place_lift=0.03, blend=0.02, turn=1.0)
    assert path.place == pytest.approx(place, abs=1e-15)
    s = np.linspace(0.0, path.length, 4001)
    pose, first = path.evaluate(s, 1)
    assert (*pose[0, :3], *pose[-1, :3]) == pytest.approx((*pick, *place), abs=1e-15)
    assert np.abs(np.linalg.norm(first[:, :3], axis=1) - 1).max() < 1e-15
    straight_up, straight_down = s <= path.knots[1], s >= path.knots[4]
    assert pose[straight_up, 2].max() == pytest.approx(pick[2] + 0.06 - 0.02, abs=1e-4)
    assert pose[straight_down, 2].max() == pytest.approx(place[2] + 0.03 - 0.02, abs=1e-4)
    for legs in (straight_up, straight_down):
        assert np.ptp(pose[legs, :2], axis=0).max() == 0.0
    assert pose[:, 2].max() < max(pick[2] + 0.06, place[2] + 0.03)


def test_tilt_and_turn_share_the_smooth_change_along_the_path() -> None:
    names = ("x", "y", "z", "roll", "pitch", "yaw")
    path = AdeptCycle(turn=0.3, start_angle=0.1, tilt=(0.2, -0.1), pose_names=names)
    share = np.linspace(0.0, 1.0, 101)
    (pose,) = path.evaluate(share * path.length, 0)
    smooth = 35 * share**4 - 84 * share**5 + 70 * share**6 - 20 * share**7
    assert np.abs(pose[:, 3:] - (np.array([0, 0, 0.1]) + smooth[:, None] * [0.2, -0.1, 0.3])).max() < 1e-14


@pytest.mark.parametrize(
    ("fields", "wrong"),
    [
        ({"pose_names": ("x", "y", "theta")}, "pose_names"),
        ({"pose_names": ("x", "y", "z")}, "turn"),
        ({"tilt": (0.1, 0.0)}, "tilt"),
        ({"tilt": (0.1,)}, "tilt"),
        ({"place_lift": 0.02}, "blend"),
        ({"place_lift": -0.02}, "place_lift"),
        ({"rise": math.nan}, "rise"),
    ],
)
def test_what_does_not_go_with_the_pose_or_the_corners_is_named(fields: dict, wrong: str) -> None:
    with pytest.raises(InvalidValue) as caught:
        AdeptCycle(**fields)
    assert wrong in caught.value.what


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("blend", 0.0),
        ("blend", 0.0251),
        ("blend", -1.0),
        ("blend", math.nan),
        ("span", 0.049),
        ("span", math.inf),
        ("lift", math.nan),
        ("turn", math.inf),
        ("pick", (0.0, 0.0)),
        ("pick", (0.0, math.nan, 0.0)),
        ("heading", math.nan),
    ],
)
def test_an_impossible_field_is_named(field: str, value: object) -> None:
    with pytest.raises(InvalidValue) as caught:
        AdeptCycle(**{field: value})
    assert ("blend" if (field, value) == ("span", 0.049) else field) in caught.value.what


@pytest.mark.parametrize("s", [-1e-6, HERE.length + 1e-6, math.nan])
def test_an_arc_length_outside_the_path_is_refused(s: float) -> None:
    with pytest.raises(InvalidValue, match="arc length"):
        HERE.evaluate(np.array([0.1, s]))


def test_an_order_beyond_the_fourth_is_refused() -> None:
    with pytest.raises(InvalidValue, match="order"):
        HERE.evaluate(np.array(0.1), 5)
