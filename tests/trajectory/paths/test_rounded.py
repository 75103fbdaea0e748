"""A path through points is the curve that it claims to be, for any corners and any pose."""

from __future__ import annotations

import itertools
import math
from itertools import pairwise

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from kinematics import InvalidValue
from trajectory import InvalidPath, Reversed, RoundedPath, pieces

NAMES = ("x", "y", "z", "theta")
POSES = (
    (0.0, 0.0, 0.0, 0.2),
    (0.0, 0.0, 0.1, None),
    (0.3, 0.1, 0.15, 1.0),
    (0.35, -0.2, 0.1, None),
    (0.35, -0.2, -0.02, -0.7),
)
BLENDS = (0.04, 0.1, 0.06)
BENT = RoundedPath(NAMES, POSES, BLENDS)
SQUARE = RoundedPath(("x", "y", "theta"), ((0, 0, 0), (0.1, 0, 1), (0.1, 0.1, 0.5), (0, 0, 0)), (0.0, 0.0))


def smooth5(u: mpmath.mpf) -> mpmath.mpf:
    return u**3 * (10 - 15 * u + 6 * u**2)


def place_in_30_digits(path: RoundedPath, s: float) -> list[float]:
    """By quadrature of the tangent from one corner to the next, from the definition alone."""
    with mpmath.workdps(30):
        points = [mpmath.matrix([mpmath.mpf(v) for v in pose[:3]]) for pose in path.poses]
        steps = [b - a for a, b in pairwise(points)]
        units = [step / mpmath.norm(step) for step in steps]
        blends = [mpmath.mpf(0), *map(mpmath.mpf, path.blends), mpmath.mpf(0)]
        here, left = points[0], mpmath.mpf(s)
        for k, unit in enumerate(units):
            straight = min(mpmath.norm(steps[k]) - blends[k] - blends[k + 1], left)
            here, left = here + straight * unit, left - straight
            if left <= 0 or k + 1 == len(units):
                break
            cosine = (unit.T * units[k + 1])[0]
            alpha = mpmath.acos(cosine)
            across = (units[k + 1] - cosine * unit) / mpmath.sin(alpha)
            whole = mpmath.quad(lambda u, a=alpha: mpmath.sin(a * smooth5(u)), [0, 1])
            length = blends[k + 1] * mpmath.sin(alpha) / whole
            u = min(left / length, mpmath.mpf(1))
            parts = [mpmath.quad(lambda v, f=f, a=alpha: f(a * smooth5(v)), [0, u]) for f in (mpmath.cos, mpmath.sin)]
            here, left = here + length * (parts[0] * unit + parts[1] * across), left - u * length
        return [float(v) for v in here]


@pytest.mark.parametrize("fraction", [0.0, 0.03, 0.11, 0.15, 0.32, 0.5, 0.66, 0.8, 0.93, 1.0])
def test_places_agree_with_quadrature_in_30_digits(fraction: float) -> None:
    s = fraction * BENT.length
    assert np.abs(BENT.evaluate(np.array(s), 0)[0][:3] - place_in_30_digits(BENT, s)).max() < 1e-15


def test_s_is_the_arc_length_and_the_tangent_has_unit_length() -> None:
    s = np.linspace(0.0, BENT.length, 20001)
    pose, first = BENT.evaluate(s, 1)
    assert np.abs(np.linalg.norm(first[:, :3], axis=1) - 1).max() < 1e-15
    chords = np.linalg.norm(np.diff(pose[:, :3], axis=0), axis=1).sum()
    assert chords == pytest.approx(BENT.length, rel=1e-7)
    assert chords <= BENT.length


@pytest.mark.parametrize("order", [1, 2, 3, 4])
def test_each_derivative_is_the_finite_difference_of_the_one_below(order: int) -> None:
    h = 1e-6
    s = np.random.default_rng(3).uniform(0.0, BENT.length, 2000)
    s = s[np.abs(s[:, None] - BENT.knots).min(axis=1) > 2 * h]
    derivatives = BENT.evaluate(s, 4)
    difference = (BENT.evaluate(s + h, 4)[order - 1] - BENT.evaluate(s - h, 4)[order - 1]) / (2 * h)
    assert np.abs(difference - derivatives[order]).max() < 1e-6 * np.abs(derivatives[order]).max()


@pytest.mark.parametrize("order", [4, 5])
def test_the_steepest_bounds_hold_on_each_piece_and_are_not_far_off(order: int) -> None:
    for start, stop in itertools.pairwise(BENT.knots):
        h = 1e-5 * (stop - start)
        s = np.linspace(start + 2 * h, stop - 2 * h, 2001)
        if order == 4:
            found = np.abs(BENT.evaluate(s, 4)[4])
        else:
            found = np.abs(BENT.evaluate(s + h, 4)[4] - BENT.evaluate(s - h, 4)[4]) / (2 * h)
        bounds = BENT.steepest(s, order)
        assert (found <= bounds * (1.0 + 1e-5) + 1e-6).all()
        assert (found[:, :3].max() >= 0.1 * bounds[:, :3].max()) or bounds[:, :3].max() == 0.0


def test_curvature_and_its_slope_are_continuous_where_the_pieces_meet() -> None:
    """G3: across a knot each derivative changes by no more than the next one allows."""
    steepest = [np.abs(d).max() for d in BENT.evaluate(np.linspace(0.0, BENT.length, 20001), 4)]
    for h in (1e-6, 1e-7):
        for knot in BENT.knots[1:-1]:
            for order, (below, above) in enumerate(BENT.evaluate(np.array([knot - h, knot + h]), 3)):
                assert np.abs(above - below).max() <= 2.1 * h * steepest[order + 1]


def test_a_corner_takes_its_blend_off_both_legs() -> None:
    ends = [(BENT.poses[k], b) for k, b in enumerate(BENT.blends, start=1)]
    (poses,) = BENT.evaluate(np.array(BENT.knots), 0)
    for corner, blend in ends:
        away = np.linalg.norm(poses[:, :3] - np.array(corner[:3], dtype=float), axis=1)
        assert np.sum(np.abs(away - blend) < 1e-14) == 2


def test_angles_are_exact_where_given_and_stay_between_them() -> None:
    s = np.linspace(0.0, BENT.length, 5001)
    theta = BENT.evaluate(s, 0)[0][:, 3]
    middle = [k for k in BENT.knots if abs(float(BENT.evaluate(np.array(k), 0)[0][3]) - 1.0) < 1e-14]
    assert len(middle) == 1
    before = s <= middle[0]
    assert (np.diff(theta[before]) >= 0).all()
    assert (np.diff(theta[~before]) <= 0).all()
    assert (theta[0], theta[-1]) == pytest.approx((0.2, -0.7), abs=1e-15)


def test_the_middle_of_a_corner_is_its_nearest_point_to_the_waypoint() -> None:
    s = np.linspace(0.0, BENT.length, 20_001)
    (poses,) = BENT.evaluate(s, 0)
    nearest = s[np.linalg.norm(poses[:, :3] - np.array(POSES[2][:3]), axis=1).argmin()]
    assert np.abs(np.array(BENT.knots) - nearest).min() <= s[1]


def test_a_corner_without_turn_is_a_straight_line() -> None:
    path = RoundedPath(NAMES, ((0, 0, 0, 0), (0.1, 0, 0, None), (0.3, 0, 0, 1)), (0.05,))
    s = np.linspace(0.0, 0.3, 301)
    assert path.length == pytest.approx(0.3, rel=1e-15)
    assert np.abs(path.evaluate(s, 0)[0][:, 0] - s).max() < 1e-16
    assert pieces(path) == (path,)


def test_it_is_split_at_corners_without_a_blend_and_the_parts_meet() -> None:
    parts = pieces(SQUARE)
    assert [part.length for part in parts] == pytest.approx([0.1, 0.1, 0.1 * math.sqrt(2)], rel=1e-15)
    wanted = [(1, 0), (0, 1), (-math.sqrt(0.5), -math.sqrt(0.5))]
    for k, (part, tangent) in enumerate(zip(parts, wanted, strict=True)):
        pose, first = part.evaluate(np.linspace(0.0, part.length, 11), 1)
        assert pose[[0, -1]] == pytest.approx(np.array(SQUARE.poses[k : k + 2], dtype=float), abs=1e-14)
        assert np.abs(first[:, :2] - tangent).max() < 1e-15
        assert pieces(part) == (part,)
    back = pieces(Reversed(SQUARE))
    for there, again in zip(parts, reversed(back), strict=True):
        s = np.linspace(0.0, there.length, 7)
        assert np.abs(there.evaluate(s, 1)[1] + again.evaluate(there.length - s, 1)[1]).max() < 1e-12


def test_a_reversal_is_a_stop() -> None:
    path = RoundedPath(NAMES, ((0, 0, 0, 0), (0, 0, 0.1, 1), (0, 0, 0, 0)), (0.0,))
    up, down = pieces(path)
    assert np.array_equal(up.evaluate(np.array(0.1), 1)[1][:3], [0, 0, 1])
    assert np.array_equal(down.evaluate(np.array(0.0), 1)[1][:3], [0, 0, -1])


@settings(derandomize=True, deadline=None, max_examples=40)
@given(seed=st.integers(0, 2**32 - 1), count=st.integers(3, 7), share=st.floats(0.05, 1.0))
def test_any_path_stays_within_the_bounds_that_enclose_it(seed: int, count: int, share: float) -> None:
    """Pose and rate at random places lie within those of random intervals between the knots, reversed too."""
    rng = np.random.default_rng(seed)
    points = rng.uniform(-1.0, 1.0, (count, 6))
    legs = np.linalg.norm(np.diff(points[:, :3], axis=0), axis=1)
    blends = share * np.minimum(legs[1:], legs[:-1]) / 2
    names = ("x", "y", "z", "roll", "pitch", "yaw")
    path = RoundedPath(names, tuple(map(tuple, points.tolist())), tuple(blends.tolist()))
    for way in (path, Reversed(path)):
        edges = np.unique(np.concatenate([way.knots, rng.uniform(0.0, way.length, 30)]))
        box = way.enclose(edges[:-1], edges[1:])
        s = edges[:-1, None] + np.diff(edges)[:, None] * rng.uniform(0.0, 1.0, 20)
        pose, first = way.evaluate(s, 1)
        assert ((pose >= box.low[:, None]) & (pose <= box.high[:, None])).all()
        assert ((first >= box.first_low[:, None]) & (first <= box.first_high[:, None])).all()
        assert (box.high - box.low)[:, :3].max() < 2.0 * np.diff(edges).max() + 1e-9


@pytest.mark.parametrize(
    ("poses", "blends", "pose", "field"),
    [
        (((0, 0, 0, 1), (0, 0, 0, 1)), (), 2, "place"),
        (((1, 0, 0, 0), (1, 0, 1e-14, 1e-14)), (), 2, "place"),
        (((0, 0, 0, 0), (0, 0, 1, None), (0, 0, 1, 1)), (0,), 3, "place"),
        (((0, 0, 0, 0), (0, 0, 1, 0), (0, 0, 1, 1)), (0.1,), 2, "blend"),
        (((0, 0, 0, None), (0, 0, 1, 1)), (), 1, "theta"),
        (((0, 0, 0, 0), (0, None, 1, 1), (1, 1, 1, 1)), (0.1,), 2, "y"),
        (((0, 0, 0, 0), (0, 0, math.nan, 1)), (), 2, "z"),
        (((0, 0, 0, 0), (0, 0, 1, 1), (1, 0, 1, 1)), (-0.1,), 2, "blend"),
        (((0, 0, 0, 0), (0, 0, 1, 1), (1, 0, 1, 1)), (1.1,), 2, "blend"),
        (((0, 0, 0, 0), (0, 0, 1, 1), (1, 0, 1, 1), (1, 0, 0, 1)), (0.4, 0.7), 3, "blend"),
        (((0, 0, 0, 0), (0, 0, 1, 1), (0, 0, 0, 1)), (0.1,), 2, "blend"),
    ],
)
def test_a_pose_that_does_not_fit_is_named(poses: tuple, blends: tuple, pose: int, field: str) -> None:
    with pytest.raises(InvalidPath) as caught:
        RoundedPath(NAMES, poses, blends)
    assert (caught.value.pose, caught.value.field) == (pose, field)


@pytest.mark.parametrize(("poses", "blends"), [(((0, 0, 0, 0),), ()), (((0, 0, 0), (0, 0, 1)), ()), (POSES, (0.01,))])
def test_numbers_of_poses_coordinates_and_blends_that_do_not_fit_are_refused(poses: tuple, blends: tuple) -> None:
    with pytest.raises(InvalidValue, match="of a path"):
        RoundedPath(NAMES, poses, blends)
