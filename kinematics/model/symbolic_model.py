"""The symbolic model of a mechanism: everything that follows from its loop closure by differentiation."""

from __future__ import annotations

from functools import cached_property, lru_cache
from typing import TYPE_CHECKING

import casadi as ca

from kinematics.evaluation import Op, Program, run_through

if TYPE_CHECKING:
    from kinematics.model.mechanism import Mechanism
    from kinematics.model.working_mode import Mode


class Model:
    """Expressions in the symbols `pose` (n,), `joints` (m,) and `geometry` (k,); `g` names the geometry's fields.

    The closure phi(pose, joints; geometry) = 0 has one row for each limb. Its sign is such that J_q = d phi / d joints
    and J_x = -d phi / d twist are those of the paper; then J_q q' = J_x t. The constant matrix `drives` C maps joints
    to actuators.

    The working mode decides which joints belong to a pose (`inverse`, `at_pose`). The closure does not depend on it.

    Raises:
        TypeError: a limb's closure depends on another limb's joint, or there is not one row for each joint.
    """

    def __init__(self, mechanism: type[Mechanism], mode: Mode) -> None:
        self._mechanism, self.mode = mechanism, mode
        self.pose = ca.SX.sym("pose", len(mechanism.pose_names))
        self.joints = ca.SX.sym("joints", len(mechanism.joint_names))
        self.geometry, self.g = mechanism.Geometry.symbols()
        self.closure = mechanism.closure(self.pose, self.joints, self.g)
        self.inverse = mechanism.inverse_closed_form(self.pose, self.g, mode)
        self.drives = mechanism.drives(self.g)
        j_q = ca.jacobian(self.closure, self.joints)
        if self.closure.shape[0] != self.joints.shape[0] or not j_q.sparsity().is_diag():
            raise TypeError(f"{mechanism.__name__}: each limb needs one row of the closure, with its own joint only")
        self.j_q = ca.diag(j_q)
        self.j_x = -mechanism.closure_by_twist(self.pose, self.joints, self.g)

    @cached_property
    def inverse_function(self) -> ca.Function:
        """(n,) pose and (k,) geometry -> (m,) joints, for one pose."""
        return ca.Function("inverse", [self.pose, self.geometry], [self.inverse])

    @cached_property
    def j_q_at_pose(self) -> ca.SX:
        """(m,) the diagonal of J_q in the working mode."""
        known = self._mechanism.j_q_closed_form(self.pose, self.g, self.mode)
        return self.at_pose(self.j_q) if known is None else known

    @cached_property
    def j_x_at_pose(self) -> ca.SX:
        """(m, n) J_x in the working mode."""
        return self.at_pose(self.j_x)

    @cached_property
    def inverse_jacobian(self) -> ca.SX:
        """(m, n) J_m = J_q^-1 J_x in the working mode."""
        return ca.diag(1 / self.j_q_at_pose) @ self.j_x_at_pose

    @cached_property
    def actuator_jacobian(self) -> ca.SX:
        """(m, n) C J_m: the actuators' rates from the twist, in the working mode."""
        return self.drives @ self.inverse_jacobian

    def at_pose(self, expression: ca.SX) -> ca.SX:
        """The expression with the joints replaced by the inverse model.

        Sines and cosines of a revolute joint become the algebraic expressions that the inverse model knows: faster,
        and far tighter in interval arithmetic.
        """
        known = self._mechanism.joint_cosines_and_sines(self.pose, self.g, self.mode)
        table = {}
        if known is not None:
            for i in range(self.joints.shape[0]):
                table[self.joints[i].element_hash()] = (known[0][i], known[1][i])

        def lookup(place: int, a: ca.SX) -> ca.SX:
            entry = table.get(a.element_hash()) if isinstance(a, ca.SX) else None
            return entry[place] if entry else (ca.cos, ca.sin)[place](a)

        own = [self.pose, self.joints, self.geometry]
        names = {s.element_hash() for vector in own for s in ca.symvar(vector)}
        symbols = [*own, *(s for s in ca.symvar(expression) if s.element_hash() not in names)]
        inner = Program.of(ca.Function("expression", symbols, [ca.densify(expression)]))
        operations = {Op.COS: lambda a, _: lookup(0, a), Op.SIN: lambda a, _: lookup(1, a)}
        numbers = run_through(inner, [s[i] for s in symbols for i in range(s.shape[0])], operations)
        rows, columns = expression.shape
        result = ca.sparsify(ca.reshape(ca.vertcat(*numbers), columns, rows).T)
        return ca.substitute(result, self.joints, self.inverse)


@lru_cache(maxsize=64)
def model_of(mechanism: type[Mechanism], mode: Mode) -> Model:
    """The model of a mechanism in a working mode, shared by all robots that have both."""
    return Model(mechanism, mode)
