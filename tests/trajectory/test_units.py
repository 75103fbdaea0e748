"""Millimetres, degrees and turns a minute become the double that is nearest to the exact product."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest

from trajectory.units import in_si


def machin() -> Fraction:
    """Pi to eighty digits: 16 arctan(1/5) - 4 arctan(1/239)."""

    def arctan_of_inverse(n: int) -> Fraction:
        return sum((Fraction((-1) ** k, (2 * k + 1) * n ** (2 * k + 1)) for k in range(60)), Fraction(0))

    return 16 * arctan_of_inverse(5) - 4 * arctan_of_inverse(239)


FACTORS = {"mm": Fraction(1, 1000), "deg": machin() / 180, "rpm": machin() / 30}


@pytest.mark.parametrize("suffix", FACTORS)
def test_every_decimal_is_converted_to_the_nearest_double(suffix: str) -> None:
    rng = np.random.default_rng(3)
    for digits, places in zip(rng.integers(-(10**9), 10**9, 2000).tolist(), rng.integers(0, 9, 2000), strict=True):
        exact = Fraction(digits, 10 ** int(places))
        written = f"{digits / 10 ** int(places)!r}"
        nearest = float(exact * FACTORS[suffix])
        assert in_si(written, suffix) == in_si(float(written), suffix) == nearest


def test_what_people_write() -> None:
    assert in_si("41.3", "mm") == 0.0413
    assert 41.3 * 1e-3 != 0.0413  # what a product of doubles makes of it
    assert (in_si(180, "deg"), in_si(-90, "deg"), in_si(60, "rpm")) == (math.pi, -math.pi / 2, 2 * math.pi)
    assert in_si("1e-3", "") == 0.001
    assert math.isinf(in_si("-inf", "mm"))
    with pytest.raises(ValueError, match="could not convert"):
        in_si("1..2", "mm")
