"""Many polynomials at once: their products, and their real roots, exact enough to close a loop to rounding."""

from __future__ import annotations

import numba
import numpy as np

from kinematics.evaluation import over_spans

_EPS = float(np.finfo(float).eps)


def product(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """(k, a + 1) and (k or 1, b + 1) coefficients -> (k, a + b + 1), row by row."""
    result = np.zeros((len(first), first.shape[1] + second.shape[1] - 1))
    for i in range(second.shape[1]):
        result[:, i : i + first.shape[1]] += first * second[:, i : i + 1]
    return result


def real_roots(coefficients: np.ndarray, most: int | None = None) -> np.ndarray:
    """Real roots, by the interlacing of a polynomial's roots with those of its derivatives.

    Between two neighbouring stationary points a polynomial is monotonic, so a sign change there holds exactly one
    root, and bisection guards every Newton step: no simple root is lost and none is invented. A stationary point whose
    value is within the rounding of its own evaluation is a double root, given once.

    Args:
        coefficients: (..., d + 1), highest power first; leading zeros lower the degree.
        most: how many of the smallest roots to find; all of them by default.

    Returns:
        (..., most or d) in rising order, NaN after the last root; all NaN where a coefficient is not finite.
    """
    lead, degree = coefficients.shape[:-1], coefficients.shape[-1] - 1
    flat = np.ascontiguousarray(coefficients, dtype=float).reshape(-1, degree + 1)
    out = np.full((flat.shape[0], degree if most is None else min(most, degree)), np.nan)
    over_spans(flat.shape[0], lambda span: _all_roots(flat[span], out[span]))
    return out.reshape(*lead, out.shape[1])


@numba.njit(cache=True, nogil=True, error_model="numpy")
def _all_roots(coefficients, out):  # type: ignore[no-untyped-def]
    degree = coefficients.shape[1] - 1
    derivatives = np.zeros((degree + 1, degree + 1))  # row d: the derivative of degree d
    edges, values, found = np.empty(degree + 2), np.empty(degree + 2), np.empty(degree + 1)
    for k in range(coefficients.shape[0]):
        if not np.all(np.isfinite(coefficients[k])):
            continue
        derivatives[degree] = coefficients[k]
        for d in range(degree, 0, -1):
            for i in range(d):
                derivatives[d - 1, i] = derivatives[d, i] * (d - i)
        size = 0
        for d in range(1, degree + 1):
            most = d if d < degree else out.shape[1]
            curvature = derivatives[max(d - 2, 0), : max(d - 1, 1)]
            size = _roots_between(derivatives[d, : d + 1], curvature, size, most, edges, values, found)
        out[k, :size] = found[:size]


@numba.njit(cache=True, nogil=True, error_model="numpy")
def _roots_between(c, curvature, size, most, edges, values, found):  # type: ignore[no-untyped-def]
    """Replace the `size` rising stationary points of c in `found` by at most `most` real roots of c; their number."""
    degree = c.shape[0] - 1
    lead = 0
    while lead < degree and c[lead] == 0.0:
        lead += 1
    if lead == degree:
        return 0
    if lead == degree - 1:
        found[0] = -c[degree] / c[lead]
        return min(1, most)
    bound = 0.0  # Cauchy's bound on the size of a root
    for i in range(lead + 1, degree + 1):
        bound = max(bound, abs(c[i]))
    bound = 1.0 + bound / abs(c[lead])
    last = size + 1
    edges[0], edges[last] = -bound, bound
    values[last] = c[lead]  # only the signs matter far out
    values[0] = c[lead] if (degree - lead) % 2 == 0 else -c[lead]
    for i in range(1, last):
        edges[i] = found[i - 1]
        values[i] = _horner(c, edges[i])
    count = 0
    for i in range(last):
        if count == most:
            break
        low, high, f_low, f_high = edges[i], edges[i + 1], values[i], values[i + 1]
        if f_low * f_high < 0.0:
            start = _start(curvature, low, high, f_low, f_high, i == 0, i + 1 == last)
            found[count] = _bracketed(c, start, low, high, f_low)
            count += 1
        elif i + 1 < last and f_low != 0.0 and _touches(c, high, f_high, values[i + 2]):
            found[count] = high
            count += 1
    return count


@numba.njit(cache=True, nogil=True, error_model="numpy")
def _touches(c, x, value, after):  # type: ignore[no-untyped-def]
    """Whether the stationary point x, with no change of sign before it, is a double root: zero but for rounding."""
    if value == 0.0:
        return True
    if value * after < 0.0:
        return False
    size = 0.0
    for i in range(c.shape[0]):
        size = size * abs(x) + abs(c[i])
    return abs(value) <= 4.0 * _EPS * size


@numba.njit(cache=True, nogil=True, error_model="numpy")
def _start(curvature, low, high, f_low, f_high, first, last):  # type: ignore[no-untyped-def]
    """Where Newton's method starts: on the parabola at the only stationary point, or the cubic through two."""
    if first and last:
        return 0.5 * (low + high)
    if first:
        return high - np.sqrt(2.0 * abs(f_high / _horner(curvature, high)))
    if last:
        return low + np.sqrt(2.0 * abs(f_low / _horner(curvature, low)))
    share = f_low / (f_low - f_high)  # 3 t^2 - 2 t^3 = share, nearly
    if share > 0.5:
        share = 1.0 - share
        return high - (high - low) * np.sqrt(share / 3.0) * (1.0 + 0.45 * share)
    return low + (high - low) * np.sqrt(share / 3.0) * (1.0 + 0.45 * share)


@numba.njit(cache=True, nogil=True, error_model="numpy")
def _horner(c, x):  # type: ignore[no-untyped-def]
    value = c[0]
    for i in range(1, c.shape[0]):
        value = value * x + c[i]
    return value


@numba.njit(cache=True, nogil=True, error_model="numpy")
def _bracketed(c, start, low, high, f_low):  # type: ignore[no-untyped-def]
    """Newton's method kept inside a shrinking bracket, until the value is within the rounding of its evaluation."""
    x = start if low < start < high else 0.5 * (low + high)
    for _ in range(200):
        value, slope, size = c[0], 0.0, abs(c[0])
        for i in range(1, c.shape[0]):
            slope = slope * x + value
            value = value * x + c[i]
            size = size * abs(x) + abs(c[i])
        if value * f_low > 0.0:
            low = x
        else:
            high = x
        following = x - value / slope
        inside = low <= following <= high
        if abs(value) <= _EPS * size or abs(following - x) <= _EPS * abs(x):
            return following if inside else x
        if not inside or following == x:
            following = 0.5 * (low + high)
        if high - low <= 2.0 * _EPS * abs(x):
            return following
        x = following
    return x
