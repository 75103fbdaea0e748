"""A time law is an exact function of time."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from kinematics import InvalidShape, InvalidValue
from trajectory import TimeLaw


@pytest.fixture
def bang_bang() -> TimeLaw:
    """Half a metre at 8 m/s^2 up and down: peak 2 m/s, half a second."""
    s = np.linspace(0.0, 0.5, 101)
    return TimeLaw.constant_acceleration("bang-bang", s, np.sqrt(2 * 8 * np.minimum(s, 0.5 - s)))


@pytest.fixture
def smooth() -> TimeLaw:
    """s''' of +1, -1, -1, +1 for a second each: s'' is continuous and zero at both ends."""
    position, speed = [0, 1 / 6, 1, 11 / 6, 2], [0, 0.5, 1, 0.5, 0]
    return TimeLaw("smooth", np.arange(5.0), position, speed, [0, 1, 0, -1], [1, -1, -1, 1], np.zeros(4))


@pytest.fixture
def bent() -> TimeLaw:
    """s'' a parabola up and another one down, a second each: s''' is linear in both."""
    return TimeLaw("bent", np.arange(3.0), [0, 1 / 3, 2 / 3], [0, 2 / 3, 0], [0, 0], [4, -4], [-8, 8])


def test_bang_bang_has_its_closed_form(bang_bang: TimeLaw) -> None:
    assert bang_bang.duration == pytest.approx(2 * math.sqrt(0.5 / 8), rel=1e-12)
    t = np.linspace(0.0, bang_bang.duration, 1001)
    expected = np.where(t < 0.25, 4 * t**2, 0.5 - 4 * (0.5 - t) ** 2)
    assert np.abs(bang_bang.at(t).position - expected).max() < 1e-14
    assert np.abs(np.abs(bang_bang.at(t).acceleration) - 8).max() < 1e-10


@pytest.mark.parametrize("name", ["bang_bang", "smooth", "bent"])
def test_each_derivative_is_that_of_the_one_before(name: str, request: pytest.FixtureRequest) -> None:
    law: TimeLaw = request.getfixturevalue(name)
    rng = np.random.default_rng(3)
    t = rng.uniform(0.01, law.duration - 0.01, 400)
    t = t[np.abs(t[:, None] - law.times).min(axis=1) > 1e-5 * law.duration]
    h = 1e-6
    there, before, after = law.at(t), law.at(t - h), law.at(t + h)
    for value, last, following in zip(there[1:], before, after, strict=False):
        assert np.abs((following - last) / (2 * h) - value).max() < 1e-8


def test_the_squared_speed_is_linear_in_arc_length_between_gridpoints(bang_bang: TimeLaw) -> None:
    _, along = bang_bang.within(np.linspace(0, 1, 7))
    x = along.speed**2
    fraction = (along.position - along.position[:, :1]) / np.ptp(along.position, axis=1)[:, None]
    assert np.abs(x - (x[:, :1] + fraction * (x[:, -1:] - x[:, :1]))).max() < 1e-12


def test_within_gives_both_limits_at_a_knot(bang_bang: TimeLaw) -> None:
    times, along = bang_bang.within(np.array([0.0, 1.0]))
    assert times[1:, 0] == pytest.approx(times[:-1, 1], abs=1e-15)
    assert along.acceleration[49, 1] == pytest.approx(8)
    assert along.acceleration[50, 0] == pytest.approx(-8)


def test_a_knot_takes_the_right_hand_limit_and_the_end_the_left_hand_one(bang_bang: TimeLaw) -> None:
    assert bang_bang.at(bang_bang.times[50]).acceleration == pytest.approx(-8)
    assert bang_bang.at(bang_bang.duration).acceleration == pytest.approx(-8)


@pytest.mark.parametrize("name", ["bang_bang", "smooth", "bent"])
def test_stretching_divides_each_derivative_by_its_power_of_the_factor(
    name: str, request: pytest.FixtureRequest
) -> None:
    law: TimeLaw = request.getfixturevalue(name)
    t = np.linspace(0.0, law.duration, 57)
    slow = law.stretched(1.7).at(np.minimum(1.7 * t, 1.7 * law.duration))
    for k, (a, b) in enumerate(zip(law.at(t), slow, strict=True)):
        inner = slice(1, -1) if k < 2 else np.abs(t[:, None] - law.times).min(axis=1) > 1e-9
        assert a[inner] == pytest.approx(b[inner] * 1.7**k, abs=1e-12)


def test_arrays_of_a_law_are_read_only_copies(smooth: TimeLaw) -> None:
    with pytest.raises(ValueError, match="read-only"):
        smooth.speed[0] = 1.0


@pytest.mark.parametrize("t", [-0.1, 4.1, math.nan])
def test_a_time_outside_the_law_is_refused(smooth: TimeLaw, t: float) -> None:
    with pytest.raises(InvalidValue, match="time"):
        smooth.at(np.array([1.0, t]))


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("times", [0, 1, 1, 3, 4]),
        ("times", [1, 2, 3, 4, 5]),
        ("position", [0, 1 / 6, 1, 11 / 6, math.nan]),
        ("position", [0, 1 / 6, 1.001, 11 / 6, 2]),
        ("speed", [0, 0.5, 1, 0.5, 1e-3]),
        ("speed", [0, 0.5, 1, 0.5, -1e-3]),
        ("acceleration", [0, 1, 0, math.inf]),
    ],
)
def test_a_law_that_is_not_finite_or_does_not_join_is_refused(smooth: TimeLaw, field: str, value: list[float]) -> None:
    arrays = {name: getattr(smooth, name) for name in ("times", "position", "speed", "acceleration", "jerk", "snap")}
    with pytest.raises(InvalidValue, match=f"TimeLaw {field}"):
        TimeLaw("bad", **{**arrays, field: value})


def test_arrays_of_other_lengths_are_refused(smooth: TimeLaw) -> None:
    with pytest.raises(InvalidShape, match="jerk"):
        replace(smooth, jerk=smooth.jerk[:-1])


def test_an_interval_at_rest_is_refused() -> None:
    with pytest.raises(InvalidValue, match="rest all through"):
        TimeLaw.constant_acceleration("stuck", np.arange(4.0), np.array([0.0, 1.0, 0.0, 0.0]))


@pytest.mark.parametrize("factor", [0.0, -1.0, math.nan, math.inf])
def test_an_impossible_stretch_is_refused(smooth: TimeLaw, factor: float) -> None:
    with pytest.raises(InvalidValue, match="factor"):
        smooth.stretched(factor)
