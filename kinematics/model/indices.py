"""Performance indices of any mechanism, built on the inverse Jacobian J_m of its actuators (q' = J_m t).

Where drives couple the joints, J_m and q here are the motors': identical limits exist only there.

FVI, v_w and f_w are expressions (39) and (40) of Shayya et al.; J_mw = J_m W^-1 is the homogeneous Jacobian, in which
a characteristic length turns rotations into lengths.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import reduce

import casadi as ca

from kinematics.arguments import positive
from kinematics.errors import InvalidField
from kinematics.mathematics import adjugate

_LEAST, _MOST = 1e-50, 1e50  # of a bound of the FVI: squares of products of two must stay numbers


@dataclass(frozen=True)
class FviBounds:
    """What the actuators give, and what is wanted in the worst direction.

    Attributes:
        joint_speed: q'_max of every actuator [rad/s or m/s].
        joint_effort: tau_max of every actuator [N m or N].
        speed: v_wl, the wanted lower bound of the worst isotropic speed [m/s].
        force: f_wl, the wanted lower bound of the worst isotropic force [N].
    """

    joint_speed: float
    joint_effort: float
    speed: float
    force: float

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            number = positive(f"FviBounds {name}", value)
            if not _LEAST <= number <= _MOST:
                raise InvalidField("FviBounds", name, number, f"a number from {_LEAST:g} to {_MOST:g}")
            object.__setattr__(self, name, number)


def homogeneous(inverse_jacobian: ca.SX, rotations: tuple[int, ...], characteristic_length: float) -> ca.SX:
    """J_mw = J_m W^-1: the columns of the rotations divided by the characteristic length [m]."""
    result = ca.SX(inverse_jacobian)
    for column in rotations:
        result[:, column] = result[:, column] / characteristic_length
    return result


def _squares(j_mw: ca.SX) -> tuple[list[ca.SX], list[ca.SX], ca.SX]:
    """|j_i|^2 of the rows (m,), |det p_i|^2 of the pseudo-inverse's columns (m,), and det.

    The pseudo-inverse goes through adjugates, so that no pose divides by zero.
    """
    m, n = j_mw.shape
    if m == n:
        columns, det = adjugate(j_mw)
    else:
        cofactors, det = adjugate(j_mw.T @ j_mw, symmetric=True)
        columns = cofactors @ j_mw.T
    return [ca.sumsqr(j_mw[i, :]) for i in range(m)], [ca.sumsqr(columns[:, i]) for i in range(m)], det


def isotropic_components(j_mw: ca.SX) -> tuple[ca.SX, ca.SX]:
    """Isotropic speed and force that each actuator alone would allow, for unit joint speed and effort.

    Their minima are v_w, the radius of the largest sphere in the polytope of velocities, and f_w, the same for forces
    with the minimum-norm joint efforts (40). A singular pose of a square j_mw gives f_w = 0 and not NaN.

    Args:
        j_mw: (m, n) homogeneous inverse Jacobian, m >= n.

    Returns:
        speeds (m,), forces (m,).
    """
    rows, columns, det = _squares(j_mw)
    return ca.vertcat(*(1 / ca.sqrt(r) for r in rows)), ca.vertcat(*(ca.fabs(det) / ca.sqrt(c) for c in columns))


def isotropic(j_mw: ca.SX) -> tuple[ca.SX, ca.SX]:
    """v_w and f_w, the minima of `isotropic_components`, with one root and one division each."""
    rows, columns, det = _squares(j_mw)
    return 1 / ca.sqrt(reduce(ca.fmax, rows)), ca.fabs(det) / ca.sqrt(reduce(ca.fmax, columns))


def fvi_components(j_mw: ca.SX, bounds: FviBounds) -> ca.SX:
    """(2 m,) speeds over v_wl, then forces over f_wl; the FVI (39) is the smallest of them."""
    speeds, forces = isotropic_components(j_mw)
    return ca.vertcat(speeds * (bounds.joint_speed / bounds.speed), forces * (bounds.joint_effort / bounds.force))


def fvi(j_mw: ca.SX, bounds: FviBounds) -> ca.SX:
    """(39): the smallest of `fvi_components`."""
    speed, force = isotropic(j_mw)
    return ca.fmin(speed * (bounds.joint_speed / bounds.speed), force * (bounds.joint_effort / bounds.force))


def smallest(components: ca.SX) -> ca.SX:
    """Their minimum, inf if there are none; the interpreter's FMIN passes NaN on."""
    return reduce(ca.fmin, [components[i] for i in range(components.numel())] or [ca.SX(math.inf)])


def largest(components: ca.SX) -> ca.SX:
    """Their maximum; the interpreter's FMAX passes NaN on."""
    return reduce(ca.fmax, [components[i] for i in range(components.numel())])


def sides(component: ca.SX, of: int = ca.OP_FMIN) -> list[ca.SX]:
    """The numbers of which a component is the minimum, or the maximum for `OP_FMAX`; itself where it is none."""
    if component.op() == of:
        return [*sides(component.dep(0), of), *sides(component.dep(1), of)]
    return [component]
