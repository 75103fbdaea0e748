"""The angle of a point without a library call, so that a loop over it becomes vector code.

The angle between the nearer axis and the point has a tangent t <= 1. It is halved twice: tan(v / 2) = t / (1 + sqrt(1 +
t^2)). The Taylor series to t^23 of what is left errs by less than 1e-18 relative to it. The whole is good to four units
in the last place of 1; the tests compare with arbitrary precision.
"""

from __future__ import annotations

import numba
import numpy as np

_A = [(-1.0) ** k / (2 * k + 1) for k in range(12)]
_A1, _A2, _A3, _A4, _A5, _A6, _A7, _A8, _A9, _A10, _A11 = _A[1:]


@numba.njit(inline="always")
def angle(y: float, x: float) -> float:
    """atan2(y, x) for finite numbers, not both 0 and y not -0."""
    p, q = abs(x), abs(y)
    t = min(p, q) / max(p, q)
    t /= 1.0 + np.sqrt(1.0 + t * t)
    t /= 1.0 + np.sqrt(1.0 + t * t)
    z = t * t
    tail = _A6 + z * (_A7 + z * (_A8 + z * (_A9 + z * (_A10 + z * _A11))))
    series = t + t * z * (_A1 + z * (_A2 + z * (_A3 + z * (_A4 + z * (_A5 + z * tail)))))
    near = 4.0 * series
    right = near if q <= p else 0.5 * np.pi - near
    upper = right if x >= 0.0 else np.pi - right
    result: float = upper if y >= 0.0 else -upper
    return result
