"""At a double root, rounding can make the number under a square root negative. This corrects it to 0."""

from __future__ import annotations

import casadi as ca

_ROUNDING = 1e-13  # relative: what is so little below 0 is 0


def not_below_zero(value: ca.SX, size: ca.SX) -> ca.SX:
    """The value, but 0 where it is below 0 by no more than rounding; `size` (> 0) is that of its terms."""
    return ca.if_else(value >= -_ROUNDING * size, ca.fmax(value, 0), value)
