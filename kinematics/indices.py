"""Performance indices of any mechanism, built on the inverse Jacobian J_m of its actuators (q' = J_m t).

Where drives couple the joints, J_m and q here are the motors': identical limits exist only there.

FVI, v_w and f_w are expressions (39) and (40) of Shayya et al.; J_mw = J_m W^-1 is the homogeneous Jacobian, in which
a characteristic length turns rotations into lengths.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import combinations

import casadi as ca

from kinematics.errors import InvalidValue
from kinematics.linear import Minors, adjugate


@dataclass(frozen=True)
class FviBounds:
    """What the actuators give and what is wanted of the worst direction.

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
            if not (math.isfinite(value) and value > 0.0):
                raise InvalidValue(f"FviBounds {name}", value, "a finite number > 0")


def homogeneous(inverse_jacobian: ca.SX, rotations: tuple[int, ...], characteristic_length: float) -> ca.SX:
    """J_mw = J_m W^-1: the columns of the rotations divided by the characteristic length [m]."""
    result = ca.SX(inverse_jacobian)
    for column in rotations:
        result[:, column] = result[:, column] / characteristic_length
    return result


def isotropic_components(j_mw: ca.SX) -> tuple[ca.SX, ca.SX]:
    """Isotropic speed and force that each actuator alone would allow, for unit joint speed and effort.

    Their minima are v_w, the radius of the largest sphere in the polytope of velocities, and f_w, the same for forces
    with the minimum-norm joint efforts (40). The pseudo-inverse goes through adjugates, so a singular pose gives
    f_w = 0 and not NaN.

    Args:
        j_mw: (m, n) homogeneous inverse Jacobian, m >= n.

    Returns:
        speeds (m,), forces (m,).
    """
    m, n = j_mw.shape
    speeds = [1 / ca.norm_2(j_mw[i, :]) for i in range(m)]
    if m == n:
        columns, det = adjugate(j_mw)
    else:
        cofactors, det = adjugate(j_mw.T @ j_mw)
        columns = cofactors @ j_mw.T
    forces = [ca.fabs(det) / ca.norm_2(columns[:, i]) for i in range(m)]
    return ca.vertcat(*speeds), ca.vertcat(*forces)


def force_capability_components(j_mw: ca.SX) -> ca.SX:
    """Distances from the origin to the facets of the zonotope of forces J_mw^T tau, |tau_i| <= 1.

    A facet is parallel to n - 1 of the rows j_i of J_mw: its normal u is their generalised cross product, its distance
    sum_i |j_i . u| / |u|. The smallest is the radius of the largest ball of forces that some joint efforts within
    their limits give. Rows that depend on each other span no facet and give infinity.

    Args:
        j_mw: (m, n) homogeneous inverse Jacobian, m >= n.

    Returns:
        (k,) with k the number of ways to choose n - 1 of m rows.
    """
    m, n = j_mw.shape
    minors, distances = Minors(j_mw), []
    for rows in combinations(range(m), n - 1):
        columns = [tuple(c for c in range(n) if c != k) for k in range(n)]
        normal = ca.vertcat(*((-1) ** k * minors.minor(rows, columns[k]) for k in range(n)))
        size = ca.norm_2(normal)
        others = [i for i in range(m) if i not in rows]
        distance = ca.sum1(ca.fabs(j_mw[others, :] @ normal)) / size
        distances.append(ca.if_else(size <= 0, ca.inf, distance))
    return ca.vertcat(*distances)


def fvi_components(j_mw: ca.SX, bounds: FviBounds) -> ca.SX:
    """(2 m,) speeds over v_wl, then forces over f_wl; the FVI (39) is the smallest of them."""
    speeds, forces = isotropic_components(j_mw)
    return ca.vertcat(speeds * (bounds.joint_speed / bounds.speed), forces * (bounds.joint_effort / bounds.force))


def smallest(components: ca.SX) -> ca.SX:
    """Their minimum; the interpreter's FMIN passes NaN on."""
    result = components[0]
    for i in range(1, components.numel()):
        result = ca.fmin(result, components[i])
    return result


def sides(component: ca.SX) -> list[ca.SX]:
    """The numbers of which a component is the minimum; itself where it is none."""
    if component.op() == ca.OP_FMIN:
        return [*sides(component.dep(0)), *sides(component.dep(1))]
    return [component]
