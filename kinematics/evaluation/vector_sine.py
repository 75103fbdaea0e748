"""Sine and cosine without a library call, so that a loop over them becomes vector code.

The angle is reduced by the nearest multiple of pi/2, which is taken off in three parts; |r| <= pi/4 is left, where the
Taylor series to r^17 err by less than 1e-18. Good to two units in the last place for |x| <= LIMIT; the tests
compare with mpmath.
"""

from __future__ import annotations

import math

import numba
import numpy as np

LIMIT = 1e5  # rad; up to here the multiple times each part is exact

# pi/2 = _PARTS[0] + _PARTS[1] + _PARTS[2] to 1e-30; the first two end in zeros, 33 bits and 35 are left.
_P0 = 1.5707963267341256
_P1 = 6.077100506303966e-11
_P2 = 2.0222662487959506e-21
_TURN = 2.0 / math.pi
_S = [(-1.0) ** k / math.factorial(2 * k + 1) for k in range(9)]
_C = [(-1.0) ** k / math.factorial(2 * k) for k in range(9)]
_S1, _S2, _S3, _S4, _S5, _S6, _S7, _S8 = _S[1:]
_C2, _C3, _C4, _C5, _C6, _C7, _C8 = _C[2:]


@numba.njit(inline="always")
def sine(x: float, quarters: float) -> float:
    """sin(x + quarters pi / 2) for |x| <= LIMIT; `quarters` is 0 or 1."""
    n = np.floor(x * _TURN + 0.5)
    r = ((x - n * _P0) - n * _P1) - n * _P2
    t = r * r
    s = r + r * t * (_S1 + t * (_S2 + t * (_S3 + t * (_S4 + t * (_S5 + t * (_S6 + t * (_S7 + t * _S8)))))))
    c = 1.0 + t * (-0.5 + t * (_C2 + t * (_C3 + t * (_C4 + t * (_C5 + t * (_C6 + t * (_C7 + t * _C8)))))))
    quarter = (n + quarters) * 0.25
    quarter -= np.floor(quarter)
    value = s if quarter == 0.0 or quarter == 0.5 else c
    result: float = value if quarter < 0.5 else -value
    return result
