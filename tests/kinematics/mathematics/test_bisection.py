"""Bisection finds where a condition stops to hold, of many intervals at once."""

from __future__ import annotations

import numpy as np
import pytest

from kinematics import bisected


def test_the_ends_enclose_each_root_and_are_neighbouring_doubles() -> None:
    roots = np.random.default_rng(1).uniform(0.0, 10.0, (3, 50))
    low, high = bisected(lambda x: x * x < roots * roots, np.zeros_like(roots), np.full_like(roots, 10.0))
    assert (low * low < roots * roots).all()
    assert (high * high >= roots * roots).all()
    assert np.array_equal(np.nextafter(low, np.inf), high)


@pytest.mark.parametrize("tolerance", [0.1, 1e-6])
def test_no_more_is_asked_than_the_tolerance_needs_and_the_ends_never(tolerance: float) -> None:
    asked: list[float] = []

    def holds(x: np.ndarray) -> bool:
        asked.append(float(x))
        return bool(x < 0.3)

    low, high = bisected(holds, 0.0, 1.0, tolerance)
    assert low < 0.3 <= high <= low + tolerance
    assert len(asked) == int(np.ceil(np.log2(1.0 / tolerance)))
    assert not {0.0, 1.0} & set(asked)
