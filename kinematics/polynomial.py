"""Real roots of many polynomials at once, exact enough to close a loop to rounding."""

from __future__ import annotations

import numba
import numpy as np


def real_roots(coefficients: np.ndarray) -> np.ndarray:
    """All real roots, by the interlacing of a polynomial's roots with those of its derivatives.

    Between two neighbouring stationary points a polynomial is monotonic, so a sign change there holds exactly one
    root, and bisection guards every Newton step: no root is lost and none is invented. A double root is found when
    rounding leaves a sign change or an exact zero.

    Args:
        coefficients: (..., d + 1), highest power first.

    Returns:
        (..., d) in rising order, NaN after the last root; all NaN where a coefficient is NaN.
    """
    lead, degree = coefficients.shape[:-1], coefficients.shape[-1] - 1
    flat = np.ascontiguousarray(coefficients, dtype=float).reshape(-1, degree + 1)
    return _all_roots(flat).reshape(*lead, degree)


@numba.njit(cache=True, nogil=True, error_model="numpy")
def _all_roots(coefficients):  # type: ignore[no-untyped-def]
    count, degree = coefficients.shape[0], coefficients.shape[1] - 1
    out = np.full((count, degree), np.nan)
    derivatives = np.zeros((degree + 1, degree + 1))
    for k in range(count):
        if not np.all(np.isfinite(coefficients[k])):
            continue
        derivatives[degree] = coefficients[k]
        for d in range(degree, 0, -1):
            for i in range(d):
                derivatives[d - 1, i] = derivatives[d, i] * (d - i)
        stationary = np.zeros(0)
        for d in range(1, degree + 1):
            stationary = _roots_between(derivatives[d, : d + 1], stationary)
        out[k, : stationary.shape[0]] = stationary
    return out


@numba.njit(cache=True, nogil=True, error_model="numpy")
def _roots_between(c, stationary):  # type: ignore[no-untyped-def]
    """Real roots of c, given the rising stationary points of c."""
    degree = c.shape[0] - 1
    lead = 0
    while lead < degree and c[lead] == 0.0:
        lead += 1
    if c[lead] == 0.0 or lead == degree:
        return np.empty(0)
    bound = 1.0  # Cauchy's bound on the size of a root
    for i in range(lead + 1, degree + 1):
        bound = max(bound, 1.0 + abs(c[i] / c[lead]))
    edges = np.empty(stationary.shape[0] + 2)
    edges[0], edges[-1] = -bound, bound
    edges[1:-1] = stationary
    found = np.empty(degree)
    size = 0
    for i in range(edges.shape[0] - 1):
        low, high = edges[i], edges[i + 1]
        f_low, f_high = _horner(c, low), _horner(c, high)
        if f_low == 0.0 and i > 0:
            continue
        if f_high == 0.0 and size < degree:
            found[size] = high
            size += 1
        elif f_low * f_high < 0.0 and size < degree:
            found[size] = _bracketed(c, low, high, f_low)
            size += 1
    return found[:size].copy()


@numba.njit(cache=True, nogil=True, error_model="numpy")
def _horner(c, x):  # type: ignore[no-untyped-def]
    value = c[0]
    for i in range(1, c.shape[0]):
        value = value * x + c[i]
    return value


@numba.njit(cache=True, nogil=True, error_model="numpy")
def _bracketed(c, low, high, f_low):  # type: ignore[no-untyped-def]
    """Newton's method kept inside a shrinking bracket."""
    x = 0.5 * (low + high)
    for _ in range(200):
        value, slope = c[0], 0.0
        for i in range(1, c.shape[0]):
            slope = slope * x + value
            value = value * x + c[i]
        if value == 0.0:
            return x
        if value * f_low > 0.0:
            low = x
        else:
            high = x
        step = value / slope
        following = x - step
        if not (low < following < high):
            following = 0.5 * (low + high)
        if following == x or high - low <= 4e-16 * abs(x):
            return following
        x = following
    return x
