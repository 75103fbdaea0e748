"""Accuracy: how far the tool is off, to first order, where actuators and rods are off by as much as they may be.

With e the errors of the actuators, |e_i| <= one encoder step and half of the backlash, and d the errors of the rods'
lengths, |d_i| <= the joints' play, the platform is off by the twist t with

    J_x t = J_q C^-1 e + s d,

s_i the length of the translational part of row i of J_x: a shift of the platform by 1 m along a rod changes the row as
much as 1 m more of rod. A row that is linear in the pose has no rod. So t = G u with |u_k| <= 1, and the largest error
is that of one of the corners u = +-1. With more joints than freedoms t is the error of the best fit to all encoders,
`BestFit`: J_m t = e in the sense of least squares.
"""

from __future__ import annotations

from typing import ClassVar, NamedTuple

import casadi as ca

from kinematics.arrays import Array
from kinematics.mathematics import adjugate
from kinematics.model import ClaimSymbols, Margin, Measure, Mechanism, ToShow

_TINY = 1e-60  # under a root, so that it has a derivative where a corner moves nothing
_REGULAR = 1e-6  # what det (A S), about 1 in the middle of a box, must exceed


class ErrorModel(NamedTuple):
    """A t = B u, |u_k| <= 1: exactly with as many joints as freedoms, else by least squares.

    Attributes:
        matrix, errors: A (m, n) and B (m, k) in the model's symbols `pose` and `geometry`.
    """

    matrix: ca.SX
    errors: ca.SX

    @classmethod
    def of(cls, robot: Mechanism) -> ErrorModel:
        """That of a robot. The errors of a limb's actuator and of its rod are one, unless drives couple the joints."""
        model, steps = robot.model(), ca.DM(robot.inertia.drive_train.position_errors(len(robot.joint_names)))
        j_q, play = model.j_q_at_pose, robot.structure.joint_play
        rods = play * _rods(robot) if play else ca.SX.zeros(j_q.numel())
        coupled = not model.drives.is_eye()
        if j_q.numel() == len(robot.pose_names):
            matrix, factors = robot.cleared_j_x()
            if coupled:
                errors = ca.horzcat(ca.diag(j_q) @ _inverse(model.drives) @ ca.diag(steps), ca.diag(rods))
            else:
                errors = ca.diag((ca.fabs(j_q) if play else j_q) * steps + rods)
            return cls(matrix, _nonzero(ca.diag(factors) @ errors))
        if coupled:
            errors = ca.horzcat(ca.diag(steps), model.drives @ ca.diag(rods / j_q))
        else:
            errors = ca.diag(steps + (rods / ca.fabs(j_q) if play else 0))
        return cls(model.actuator_jacobian, _nonzero(errors))

    def columns(self, scaling: ca.SX | None = None) -> tuple[ca.SX, ca.SX]:
        """G (n, k) times the second result, a determinant; of A S in place of A with a scaling S (n, n)."""
        matrix = self.matrix if scaling is None else self.matrix @ scaling
        if matrix.shape[0] == matrix.shape[1]:
            cofactors, det = adjugate(matrix)
            columns = cofactors @ self.errors
        else:
            cofactors, det = adjugate(matrix.T @ matrix, symmetric=True)
            columns = cofactors @ (matrix.T @ self.errors)
        return (columns if scaling is None else scaling @ columns), det


class _Accuracy(Margin):
    """The largest error of some coordinates of the twist."""

    sense = -1
    lowest = 0.0
    records = ("inertia", "structure")
    angles: ClassVar[bool]

    def mirrored(self, robot: Mechanism) -> bool:
        """The Jacobians decide it if all actuators have the same error."""
        errors = robot.inertia.drive_train.position_errors(len(robot.joint_names))
        return bool((errors == errors[0]).all())

    def components(self, robot: Mechanism, measure: Measure) -> ca.SX:  # noqa: ARG002
        """One for each pair of opposite corners; one for a single coordinate."""
        columns, det = ErrorModel.of(robot).columns()
        squares, moduli = self._sizes(robot, columns)
        return ca.vertcat(ca.sqrt(squares + _TINY), moduli) / ca.fabs(det)

    def worst(self, robot: Mechanism, measure: Measure) -> ca.SX:  # noqa: ARG002
        """With one root and one division."""
        columns, det = ErrorModel.of(robot).columns()
        squares, moduli = self._sizes(robot, columns)
        largest = moduli if moduli.numel() else ca.sqrt(ca.mmax(squares))
        return largest / ca.fabs(det)

    def to_show(self, robot: Mechanism, claim: ClaimSymbols, inside: Array, positive: bool) -> ToShow:
        """Of a corner with G u = S adj(A S) B u / det(A S): c^2 det(A S)^2 - |S adj(A S) B u|^2 >= 0, any S.

        S makes A S nearly the identity in the middle of a box, and det(A S) > 0 is shown. A single coordinate needs no
        corners: c det(A S) is at least the sum of the moduli.
        """
        if not positive:
            return super().to_show(robot, claim, inside, positive)
        model, n = ErrorModel.of(robot), len(robot.pose_names)
        scaling = ca.SX.sym("scaling", n, n)
        columns, det = model.columns(scaling)
        squares, moduli = self._sizes(robot, columns)
        rows = ca.vertcat((claim.bound * det) ** 2 - squares, claim.bound * det - moduli, det - _REGULAR)
        return ToShow(rows, scaling, model.matrix)

    def _sizes(self, robot: Mechanism, columns: ca.SX) -> tuple[ca.SX, ca.SX]:
        """Squared sizes at the corners, and the sum of the moduli of a single coordinate; one of both is empty."""
        rows = [i for i in range(columns.shape[0]) if (i in robot.rotations) == self.angles]
        chosen = columns[rows, :]
        if len(rows) == 1:
            return ca.SX(0, 1), ca.sum2(ca.fabs(chosen))
        return ca.vertcat(*(ca.sumsqr(corner) for corner in _corners(chosen))), ca.SX(0, 1)


class PositionAccuracy(_Accuracy):
    """The largest distance of the tool point from where it should be [m]."""

    name = "position_accuracy"
    unit = "m"
    words = "largest position error of the tool from encoders, backlash and joint play"
    angles = False


class AngleAccuracy(_Accuracy):
    """The largest angle by which the tool is turned away from where it should be [rad]."""

    name = "angle_accuracy"
    unit = "rad"
    words = "largest angle error of the tool from encoders, backlash and joint play"
    angles = True


def _rods(robot: Mechanism) -> ca.SX:
    """(m,) s_i, 0 for a row that has no rod."""
    j_x, pose = robot.model().j_x_at_pose, robot.model().pose
    along = [i for i in range(len(robot.pose_names)) if i not in robot.rotations]
    sizes = [ca.norm_2(j_x[i, along]) if ca.jacobian(j_x[i, :], pose).nnz() else ca.SX(0) for i in range(j_x.shape[0])]
    return ca.vertcat(*sizes)


def _inverse(matrix: ca.SX) -> ca.SX:
    cofactors, det = adjugate(matrix)
    return cofactors / det


def _nonzero(columns: ca.SX) -> ca.SX:
    """Without the columns of zeros; one of them stays where all are."""
    kept = [k for k in range(columns.shape[1]) if not columns[:, k].is_zero()]
    return columns[:, kept or [0]]


def _corners(columns: ca.SX) -> list[ca.SX]:
    """Sums of the columns (n, k) with all signs but the first's: 2^(k - 1) vectors, one of each opposite two."""
    sums = [columns[:, 0]]
    for k in range(1, columns.shape[1]):
        sums = [total + sign * columns[:, k] for total in sums for sign in (1, -1)]
    return sums


POSITION_ACCURACY, ANGLE_ACCURACY = PositionAccuracy(), AngleAccuracy()
