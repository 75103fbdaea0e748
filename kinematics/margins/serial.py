"""Margins of J_q: how far the limbs are from their serial singularities."""

from __future__ import annotations

import casadi as ca

from kinematics.arrays import Array
from kinematics.model import ClaimSymbols, Margin, Measure, Mechanism, ToShow, signed

_POSITIVE = 1e-250  # a number of at least this is surely above 0


def _normalised(robot: Mechanism) -> ca.SX:
    """(m,) |J_q,i| over its scale."""
    model = robot.model()
    return ca.fabs(model.j_q_at_pose / robot.scales(model.g)[0])


class WorstOfJq(Margin):
    """The worst |J_q,i| over its scale, in [0, 1]."""

    name = "J_q"
    words = "how far the worst limb is from a serial singularity: 0 on it, 1 at most"
    holds_on_paths = True
    of_jacobians = True

    def components(self, robot: Mechanism, measure: Measure) -> ca.SX:  # noqa: ARG002
        """One component for each limb."""
        return _normalised(robot)

    def places(self, robot: Mechanism) -> list[str]:
        """The limbs in order."""
        return [f"limb {i + 1}" for i in range(len(robot.joint_names))]

    def to_show(self, robot: Mechanism, claim: ClaimSymbols, inside: Array, positive: bool) -> ToShow:
        """Each entry with its sign, without the quotient; and that the scales are above 0."""
        if not positive:
            return super().to_show(robot, claim, inside, positive)
        model = robot.model()
        scale = robot.scales(model.g)[0]
        moduli = signed(robot, model.j_q_at_pose, inside)
        return ToShow(ca.vertcat(moduli - claim.bound * scale, scale - _POSITIVE), ca.SX(0, 0))


class DeterminantOfJq(Margin):
    """The product of all |J_q,i| over their scales, in [0, 1]."""

    name = "det_J_q"
    words = "how far all limbs together are from a serial singularity: 0 on it, 1 at most"
    of_jacobians = True
    singularity = "serial"

    def components(self, robot: Mechanism, measure: Measure) -> ca.SX:  # noqa: ARG002
        """One."""
        normalised, product = _normalised(robot), ca.SX(1)
        for i in range(normalised.shape[0]):
            product *= normalised[i]
        return product

    def to_show(self, robot: Mechanism, claim: ClaimSymbols, inside: Array, positive: bool) -> ToShow:
        """The product with its sign; and that the scales are above 0."""
        if not positive:
            return super().to_show(robot, claim, inside, positive)
        model = robot.model()
        scale, product = robot.scales(model.g)[0], ca.SX(1)
        for i in range(model.j_q_at_pose.numel()):
            product *= model.j_q_at_pose[i] / scale[i]
        row = signed(robot, product, inside) - claim.bound
        return ToShow(ca.vertcat(row, scale - _POSITIVE), ca.SX(0, 0))


J_Q, DET_J_Q = WorstOfJq(), DeterminantOfJq()
