"""Everything that is derived from a mechanism's definition, for arrays of poses."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Sequence
from dataclasses import asdict
from typing import Any, Self

import casadi as ca
import numpy as np

from kinematics.arrays import Array, checked, together
from kinematics.errors import InvalidShape, InvalidValue, UnreachablePose
from kinematics.evaluation import BlockProgram, evaluate
from kinematics.machine import GeometryRecord, InertiaRecord, JointRanges, Load, Structure, Surroundings
from kinematics.model import expressions
from kinematics.model.abstract_margin import Margin, Measure
from kinematics.model.continuation import forward_near
from kinematics.model.definition import Definition
from kinematics.model.indices import FviBounds, homogeneous
from kinematics.model.obstacle_names import require_free_names
from kinematics.model.programs import Write, program_of
from kinematics.model.symbolic_model import Model, model_of
from kinematics.model.working_mode import Mode, mode_at

_RECORDS = ("geometry", "inertia", "ranges", "structure", "load", "surroundings")
_SLICE = 8192  # poses whose matrices are in memory at once


class Mechanism(Definition):
    """A parallel mechanism with n freedoms and m actuated joints, one for each limb.

    Every public method takes poses (..., n) or joints (..., m) with any leading shape.
    """

    ranges: JointRanges
    home: Array
    mode: Mode

    def __init__(
        self,
        geometry: GeometryRecord | None = None,
        inertia: InertiaRecord | None = None,
        ranges: JointRanges | None = None,
        home: Sequence[float] | Array | None = None,
        home_joints: Sequence[float] | Array | None = None,
        *,
        structure: Structure | None = None,
        load: Load | None = None,
        surroundings: Surroundings | None = None,
    ) -> None:
        """A robot; each part has a default.

        Args:
            geometry, inertia, ranges: records of the mechanism's own kinds.
            home: (n,) the pose that the robot works around. It decides the working mode. By default it is near the
                middle of the workspace.
            home_joints: (m,) joints near those at home. They choose a branch of each limb's inverse, such as elbow in.
                By default the usual branches are used.
            structure: the materials of the members, and how the joints between them give way.
            load: what `natural_frequency` and `strength` are for.
            surroundings: what it must not touch besides itself; by default nothing.

        Raises:
            InvalidValue, InvalidShape, InvalidGeometry: the message names the part.
        """
        self.geometry = geometry if geometry is not None else self.Geometry()
        if not isinstance(self.geometry, self.Geometry):
            raise InvalidValue(f"{type(self).__name__} geometry", geometry, f"a {self.Geometry.__name__}")
        self.inertia = inertia if inertia is not None else self.Inertia()
        if not isinstance(self.inertia, self.Inertia):
            raise InvalidValue(f"{type(self).__name__} inertia", inertia, f"a {self.Inertia.__name__}")
        self.inertia.check(len(self.joint_names))
        self.ranges = ranges if ranges is not None else self.Ranges()
        if not isinstance(self.ranges, self.Ranges):
            raise InvalidValue(f"{type(self).__name__} ranges", ranges, f"a {self.Ranges.__name__}")
        self.ranges.check(len(self.joint_names))
        self.structure = structure if structure is not None else Structure()
        if not isinstance(self.structure, Structure):
            raise InvalidValue(f"{type(self).__name__} structure", structure, "a Structure")
        self.load = load if load is not None else Load()
        if not isinstance(self.load, Load):
            raise InvalidValue(f"{type(self).__name__} load", load, "a Load")
        self.surroundings = surroundings if surroundings is not None else Surroundings()
        if not isinstance(self.surroundings, Surroundings):
            raise InvalidValue(f"{type(self).__name__} surroundings", surroundings, "a Surroundings")
        require_free_names(type(self), self.surroundings)
        joints = _vector(home_joints, "home_joints", self.joint_names)
        self._given = _vector(home, "home", self.pose_names), joints
        self.home = np.array(self._given[0] or self.default_home(self.geometry), dtype=float) + 0.0  # no -0
        self.home.setflags(write=False)
        self.mode = mode_at(self, np.array(joints) if joints else None)
        records = tuple(getattr(self, name) for name in _RECORDS)
        self._identity = (type(self), *records, tuple(self.home.tolist()), self.mode)
        self._hash = hash(self._identity)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Mechanism) and self._identity == other._identity

    def __hash__(self) -> int:
        return self._hash

    def conditions(self, records: Sequence[str] = ()) -> dict[str, Any]:
        """The plain data that a margin depends on besides the geometry: joint ranges, mode, and its `records`."""
        return {name: asdict(getattr(self, name)) for name in ("ranges", *records)} | {"mode": self.mode}

    def conditions_digest(self, records: Sequence[str] = ()) -> str:
        """SHA-256 of `conditions`. A proof states it, so that it is known which robot it is for."""
        return hashlib.sha256(json.dumps(self.conditions(records), sort_keys=True).encode()).hexdigest()

    @classmethod
    def member_kinds(cls) -> list[str]:
        """The materials' fields of `Structure` that the prototype's members name, in their order."""
        pose, joints = ca.SX.sym("pose", len(cls.pose_names)), ca.SX.sym("joints", len(cls.joint_names))
        members = cls().members(pose, joints, cls.Geometry.symbols()[1])
        return list(dict.fromkeys(member.material for member in members))

    def with_inertia(self, inertia: InertiaRecord) -> Self:
        """The same robot with other masses and drives."""
        return self._with(inertia=inertia)

    def with_geometry(self, geometry: GeometryRecord) -> Self:
        """The same robot with another geometry; a given home is kept."""
        return self._with(geometry=geometry)

    def with_structure(self, structure: Structure) -> Self:
        """The same robot of other materials."""
        return self._with(structure=structure)

    def with_load(self, load: Load) -> Self:
        """The same robot with another load."""
        return self._with(load=load)

    def with_surroundings(self, surroundings: Surroundings) -> Self:
        """The same robot in another place, or with another payload's hull.

        Whether it fits there is not checked here: see `kinematics.require_room`.

        Raises:
            InvalidValue: an obstacle has the name of a member.
        """
        return self._with(surroundings=surroundings)

    def _with(self, **changed: Any) -> Self:
        home, home_joints = self._given
        records = {name: getattr(self, name) for name in _RECORDS} | changed
        return type(self)(**records, home=home, home_joints=home_joints)

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self.geometry})"

    def model(self) -> Model:
        """The symbolic model, shared by all robots of this class and working mode."""
        return model_of(type(self), self.mode)

    def cleared_j_x(self) -> tuple[ca.SX, ca.SX]:
        """K (m, n) and k (m,) > 0 with J_x = diag(1 / k) K in the working mode; K without the divisors of its rows."""
        model = self.model()
        return model.j_x_at_pose, ca.SX.ones(model.j_x_at_pose.shape[0])

    def inverse(self, pose: Array) -> Array:
        """(..., n) -> (..., m) joints of the working mode; a NaN row where a limb cannot reach."""
        return self._evaluate(expressions.inverse, pose)[0]

    def forward(self, joints: Array, near: Array | None = None) -> Array:
        """(..., m) -> (..., n) the pose with these joints; a NaN row where there is none.

        Args:
            joints: (..., m) joints of the working mode [m or rad].
            near: (n,) or (..., n) known poses, each in the wanted assembly mode. From there the joints, or else the
                pose, move on a straight line without a singularity. By default the assembly mode is that of `home`.
        """
        if near is None:
            return self.working_forward(joints)
        return forward_near(self, self._joints(joints), self._poses(near))

    def closure_residual(self, pose: Array, joints: Array) -> Array:
        """(..., n), (..., m) -> (..., m) the loop closure; zero when they belong together."""
        pose, joints = self._poses(pose), self._joints(joints)
        return evaluate(self.program(expressions.closure), *together(pose, joints))[0]

    def closure_gap(self, pose: Array, joints: Array) -> Array:
        """(..., n), (..., m) -> (..., m) the least displacement of the platform that would close each limb.

        It is in radians, or in lengths over the robot's size.
        """
        return evaluate(self.program(expressions.closure_gap), *together(self._poses(pose), self._joints(joints)))[0]

    def pose_units(self) -> Array:
        """(n,) units of pose differences: the robot's size for a length [m], 1 for an angle."""
        units = np.full(len(self.pose_names), self.geometry.size)
        units[list(self.rotations)] = 1.0
        return units

    def apart(self, first: Array, second: Array) -> Array:
        """(..., n), (..., n) -> (...,) the largest difference of poses: an angle, or a length over the robot's size."""
        gap = self._poses(first) - self._poses(second)
        turns = list(self.rotations)
        if not self.counts_turns:
            gap[..., turns] = 2 * np.sin(gap[..., turns] / 2)
        largest: Array = np.abs(gap / self.pose_units()).max(axis=-1)
        return largest

    def jacobians(self, pose: Array, joints: Array | None = None) -> tuple[Array, Array]:
        """J_q (..., m, m) and J_x (..., m, n), with J_q q' = J_x t; of the working mode, or at `joints` (..., m)."""
        if joints is None:
            diagonal, j_x = self._evaluate(expressions.jacobians, pose)
        else:
            both = together(self._poses(pose), self._joints(joints))
            diagonal, j_x = evaluate(self.program(expressions.jacobians_of_joints), *both, blank=True)
        j_q = np.zeros((*diagonal.shape, diagonal.shape[-1]))
        j_q[..., range(diagonal.shape[-1]), range(diagonal.shape[-1])] = diagonal
        j_q[np.isnan(diagonal).any(axis=-1)] = np.nan
        return j_q, j_x

    def inverse_jacobian(self, pose: Array) -> Array:
        """(..., m, n) J_m = J_q^-1 J_x, so that q' = J_m t; of the joints, see `actuator_jacobian`."""
        return self._evaluate(expressions.inverse_jacobian, pose)[0]

    def actuator_jacobian(self, pose: Array) -> Array:
        """(..., m, n) C J_m: the rates of the actuators, which carry the limits, from the twist."""
        return self._evaluate(expressions.actuator_jacobian, pose)[0]

    def pose_rates(self, pose: Array) -> Array:
        """(..., n, n) the matrix from twist to pose rates; the identity unless the pose has Euler angles."""
        return evaluate(self.program(expressions.pose_rates), self._poses(pose), blank=True)[0]

    def isotropic(self, pose: Array, characteristic_length: float | None = None) -> tuple[Array, Array]:
        """v_w (...,) and f_w (...,): worst speed and force for unit actuator speed and effort; Shayya et al. (40)."""
        speed, force = self._evaluate(expressions.isotropic, pose, self._length(characteristic_length))
        return speed[..., 0], force[..., 0]

    def force_capability(self, pose: Array, characteristic_length: float | None = None) -> Array:
        """(...,) largest force in every direction for unit actuator effort, over all shares of the efforts.

        With m = n it is f_w. With m > n it is larger, as f_w uses only efforts of least norm.
        """
        return self.margin("force_capability", pose, characteristic_length=characteristic_length)

    def fvi(self, pose: Array, bounds: FviBounds | None = None, characteristic_length: float | None = None) -> Array:
        """(...,) min(v_w / v_wl, f_w / f_wl); Shayya et al. (39). NaN where the pose is out of reach."""
        return self.margin("fvi", pose, bounds, characteristic_length)

    def condition_number(self, pose: Array, characteristic_length: float | None = None) -> Array:
        """(...,) 2-norm condition number of J_mw at the actuators; inf on a singularity, NaN out of reach."""
        length = self._length(characteristic_length)
        pose = self._poses(pose)
        flat = pose.reshape(-1, pose.shape[-1])
        result = np.empty(len(flat))
        for first in range(0, len(flat), _SLICE):
            part = slice(first, first + _SLICE)
            (j_mw,) = self._evaluate(expressions.homogeneous, flat[part], length)
            good = np.isfinite(j_mw).all(axis=(-2, -1))
            result[part] = np.where(np.isnan(j_mw).any(axis=(-2, -1)), np.nan, np.inf)
            result[part][good] = np.linalg.cond(j_mw[good])
        return result.reshape(pose.shape[:-1])

    def margin(
        self, name: str, pose: Array, bounds: FviBounds | None = None, characteristic_length: float | None = None
    ) -> Array:
        """(...,) a named margin: the worst of its components at each pose. Its `sense` says whether larger is better.

        Every mechanism has the margins `kinematics.STANDARD`; `margins` holds these and the mechanism's other ones. NaN
        where the pose is out of reach, except for reach itself.

        Raises:
            InvalidValue: the mechanism has no such margin.
        """
        if self.margin_named(name).beyond_reach:
            program = self.program(expressions.margin_everywhere, name)
        else:
            program = self.margin_program(name, bounds, characteristic_length)
        return evaluate(program, self._poses(pose), blank=True)[0][..., 0]

    def margin_place(
        self, name: str, pose: Array, bounds: FviBounds | None = None, characteristic_length: float | None = None
    ) -> str | None:
        """Where a margin is worst at one pose (n,), in words, such as "limb 1" or "rod 1 and rod 3".

        None if its components have no place of their own, or if the pose is out of reach.
        """
        places = self.margin_named(name).places(self)
        if places is None:
            return None
        measure = Measure(bounds or self.fvi_bounds, self._length(characteristic_length))
        found = evaluate(self.program(expressions.margin_components, name, measure), self._poses(pose))[0].ravel()
        values = self.margins[name].sense * found
        return None if np.isnan(values).all() else places[int(np.nanargmin(values))]

    def margin_named(self, name: str) -> Margin:
        """One of `margins`.

        Raises:
            InvalidValue: the mechanism has no such margin.
        """
        if name not in self.margins:
            raise InvalidValue(f"{type(self).__name__} margin", name, f"one of {', '.join(self.margins)}")
        return self.margins[name]

    def margin_program(
        self, name: str, bounds: FviBounds | None = None, characteristic_length: float | None = None
    ) -> BlockProgram:
        """The program of a margin: from a pose to the margin, and to a number that is NaN out of reach."""
        measure = Measure(bounds or self.fvi_bounds, self._length(characteristic_length))
        return self.program(expressions.within_reach, expressions.margin, name, measure)

    def margin_components(self, name: str, bounds: FviBounds, characteristic_length: float) -> ca.SX:
        """A margin's components in the model's symbols `pose` and `geometry`. Each must keep the bound.

        Raises:
            InvalidValue: the mechanism has no such margin.
        """
        return self.margin_named(name).components(self, Measure(bounds, characteristic_length))

    def polylines(self, pose: Array) -> dict[str, Array]:
        """Named polylines (k, 3) of the mechanism at one pose (n,), for drawing."""
        lines, model = self._evaluate(expressions.skeleton, pose), self.model()
        return dict(zip(self.skeleton(model.pose, model.joints, model.g), (p.T for p in lines), strict=True))

    def singularities(self, pose: Array, tolerance: float = 1e-6) -> dict[str, Array]:
        """For each kind of singularity, whether the poses have it, (...,); False where a limb cannot reach.

        The kinds are `serial` (J_q; the paper's under-mobility), `parallel` (J_x; over-mobility) and, if single rods
        hold the platform's orientation, `internal` (J_int). A pose has a kind if the normalised margin is at most
        the tolerance.
        """
        kinds = {m.singularity: name for name, m in self.margins.items() if m.singularity}
        return {kind: self.margin(name, pose) <= tolerance for kind, name in kinds.items()}

    def require_reachable(self, pose: Array) -> None:
        """Check every pose.

        Raises:
            UnreachablePose: it names the worst pose, its limb (counted from 1) and margin [m].
        """
        pose = self._poses(pose)
        margins = self._reach(pose)
        margins = np.where(np.isnan(margins), -np.inf, margins).reshape(-1, margins.shape[-1])
        if margins.size and margins.min() < 0.0:
            row, limb = np.unravel_index(int(margins.argmin()), margins.shape)
            worst = pose.reshape(-1, pose.shape[-1])[row]
            raise UnreachablePose(worst, int(limb) + 1, float(margins[row, limb]))

    # Helpers.

    def homogeneous_jacobian(self, characteristic_length: float) -> ca.SX:
        """(m, n) J_mw of the actuators, in the model's symbols `pose` and `geometry`."""
        return homogeneous(self.model().actuator_jacobian, self.rotations, characteristic_length)

    def _reach(self, pose: Array) -> Array:
        """(..., limbs) each limb's reach [m]."""
        return evaluate(self.program(expressions.reach), self._poses(pose), blank=True)[0]

    def _length(self, given: float | None) -> float:
        length = self.characteristic_length if given is None else float(given)
        if not np.isfinite(length) or length <= 0.0:
            raise InvalidValue("characteristic_length", given, "a finite length > 0 m")
        return length

    def _evaluate(self, write: Callable[..., list[ca.SX]], pose: Array, *given: Any) -> list[Array]:
        """The outputs of `write(robot, model, *given)` at each pose; all NaN where a limb cannot reach.

        They are also NaN where the pose is not finite or an output has no value.
        """
        program = self.program(expressions.within_reach, write, *given)
        return evaluate(program, self._poses(pose), blank=True)[:-1]

    def program(self, write: Write, *given: Any) -> BlockProgram:
        """As `program_of`."""
        return program_of(self, write, *given)

    def _poses(self, pose: Array) -> Array:
        return checked(pose, "pose", self.pose_names)

    def _joints(self, joints: Array) -> Array:
        return checked(joints, "joints", self.joint_names)

    def _one(self, joints: Array) -> Array:
        """(m,), for `assembly_modes`."""
        joints = self._joints(joints)
        if joints.ndim != 1:
            raise InvalidShape("joints of assembly_modes, one at a time", self.joint_names, joints.shape)
        return joints


def _vector(given: Sequence[float] | Array | None, what: str, names: tuple[str, ...]) -> list[float] | None:
    """The given numbers as a list, after a check that there is a finite one for each name."""
    if given is None:
        return None
    array = checked(np.asarray(given), what, names)
    if array.shape != (len(names),) or not np.isfinite(array).all():
        raise InvalidValue(what, f"{given!r:.80}", f"{len(names)} finite numbers: {', '.join(names)}")
    return list(array.tolist())
