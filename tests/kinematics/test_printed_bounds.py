"""A bound that is shown is one that was proved, and close to it."""

from __future__ import annotations

import math

from hypothesis import given
from hypothesis import strategies as st

from kinematics.printed_bounds import rounded_down, rounded_up

numbers = st.floats(1e-12, 1e12) | st.floats(-1e12, -1e-12)


@given(numbers, st.integers(2, 9))
def test_it_is_off_by_less_than_one_in_the_last_digit_and_to_the_safe_side(value: float, digits: int) -> None:
    low, high = float(rounded_down(value, digits)), float(rounded_up(value, digits))
    assert low <= value <= high
    unit = 10.0 ** (math.floor(math.log10(abs(value))) - digits + 1)
    assert max(value - low, high - value) < 1.001 * unit


def test_a_bound_that_was_asked_for_is_shown_as_it_was_written() -> None:
    assert [rounded_down(v, 7) for v in (0.3, 0.1, -2.5, 1e-6, 0.0)] == ["0.3", "0.1", "-2.5", "1e-06", "0"]
    assert (rounded_down(1.1905571, 4), rounded_up(1.1905571, 4)) == ("1.19", "1.191")
