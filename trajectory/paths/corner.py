"""The shapes of which a rounded path is made: a corner, and the change of an angle.

In a corner of arc length l the tangent turns by alpha, from one leg towards the other, by phi = alpha S5(u), u = s / l,
S5 the quintic smoothstep: the curvature and its derivative vanish at both ends, so the path is G3. From the corner's
start it goes l C along the first leg and l S across it, C and S the integrals of cos(phi) and sin(phi) over [0, u].
As S5(1 - u) = 1 - S5(u), a corner is its own mirror image and takes the same blend b off both legs:
l S(1) = b sin(alpha).
A straight leg is a corner with alpha = 0. Angles change by S7, the septic smoothstep.
"""

from __future__ import annotations

from functools import cache
from typing import TypeVar

import casadi as ca
import numpy as np

from kinematics import Array, BlockProgram, bulk, derivatives_along, evaluate

Number = TypeVar("Number", Array, ca.SX)
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(24)  # exact to rounding: the integrands are entire functions
_NODES, _WEIGHTS = (_NODES + 1) / 2, _WEIGHTS / 2


# The largest moduli on [0, 1] of the first four derivatives of S5, and of the fourth and fifth of S7.
QUINTIC_MOST = (1.875, 5.7736, 60.0, 360.0)
SEPTIC_MOST = {4: 840.0, 5: 10080.0}


def quintic(u: Number) -> Number:
    """S5, (...,) in [0, 1] -> (...,)."""
    result: Number = u**3 * (10 + u * (-15 + 6 * u))
    return result


def septic(w: Number) -> Number:
    """S7, (...,) in [0, 1] -> (...,)."""
    result: Number = w**4 * (35 + w * (-84 + w * (70 - 20 * w)))
    return result


@cache
def _turned_program() -> BlockProgram:
    """u and alpha -> C and S (2,)."""
    u, alpha = ca.SX.sym("u"), ca.SX.sym("alpha")
    angles = alpha * quintic(u * ca.SX(_NODES))
    sums = [ca.dot(_WEIGHTS, of(angles)) for of in (ca.cos, ca.sin)]
    return bulk(ca.Function("turned", [u, alpha], [u * ca.vertcat(*sums)]))


def turned(u: Array, alpha: Array) -> tuple[Array, Array]:
    """Integrals C and S of cos and sin of alpha S5 over [0, u], (...,) each, by Gauss-Legendre quadrature."""
    bent = alpha != 0.0
    c, s = np.array(u), np.zeros_like(u)  # as on a straight leg
    if bent.any():
        (found,) = evaluate(_turned_program(), u[bent][:, None], alpha[bent][:, None])
        c[bent], s[bent] = found.T
    return c, s


def corner_length(alpha: float, blend: float) -> float:
    """Arc length l [m] of a corner that turns by alpha in [0, pi) [rad] and takes `blend` [m] off both legs."""
    if alpha == 0.0:
        return 2 * blend
    return blend * float(np.sin(alpha) / turned(np.array([1.0]), np.array([alpha]))[1][0])


@cache
def tangent_program() -> BlockProgram:
    """u, its rate 1 / l and alpha -> cos and sin of phi (2,), and their first three derivatives by s."""
    state, rate, alpha = ca.SX.sym("state"), ca.SX.sym("rate"), ca.SX.sym("alpha")
    angle = alpha * quintic(state)
    derivatives = derivatives_along(ca.vertcat(ca.cos(angle), ca.sin(angle)), state, [rate, *[ca.SX(1, 1)] * 2])
    return bulk(ca.Function("tangent", [state, rate, alpha], derivatives))


@cache
def septic_program() -> BlockProgram:
    """w and its rate by s -> S7 and its first four derivatives by s, (1,) each."""
    state, rate = ca.SX.sym("state"), ca.SX.sym("rate")
    derivatives = derivatives_along(septic(state), state, [rate, *[ca.SX(1, 1)] * 3])
    return bulk(ca.Function("septic", [state, rate], derivatives))
