"""The definition of a mechanism: its data, its closure and its closed forms. `Mechanism` derives the rest.

A new mechanism is one file with these hooks, and its name in `MECHANISMS`; docs/new_mechanism.md explains them.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any, ClassVar

import casadi as ca

from kinematics.arrays import Array
from kinematics.machine import (
    Bodies,
    GeometryRecord,
    InertiaRecord,
    JointRanges,
    LimbStatics,
    Member,
    PassiveJoint,
    Reference,
    Tree,
)
from kinematics.mathematics import rotation_symbolic
from kinematics.model.abstract_margin import Margin
from kinematics.model.indices import FviBounds

if TYPE_CHECKING:
    from kinematics.model.working_mode import Mode


class Definition(ABC):
    """The hooks of a mechanism; `g` holds the geometry's fields by name, as numbers or symbols."""

    Geometry: ClassVar[type[GeometryRecord]]
    Inertia: ClassVar[type[InertiaRecord]]
    Ranges: ClassVar[type[JointRanges]] = JointRanges  # a frozen dataclass of joint limits, with defaults
    pose_names: ClassVar[tuple[str, ...]]
    joint_names: ClassVar[tuple[str, ...]]
    joint_units: ClassVar[tuple[str, ...]]  # rad or m
    rotations: ClassVar[tuple[int, ...]]  # which pose coordinates are angles
    counts_turns: ClassVar[bool] = False  # whether an angle a turn on is another pose, as on a screw
    fvi_bounds: ClassVar[FviBounds]
    mirrors: ClassVar[tuple[tuple[str, ...], ...]] = ()  # coordinates whose signs change together: a mirror image
    tool_member: ClassVar[str] = "platform"  # the member that carries the tool
    margins: ClassVar[Mapping[str, Margin]]  # by name: `by_name(*STANDARD, ...)`, and what the mechanism adds

    @classmethod
    def lacking(cls) -> tuple[str, ...]:
        """The hooks without a default that the class does not define."""
        data = (name for name in Definition.__annotations__ if not hasattr(cls, name))
        return tuple(sorted({*cls.__abstractmethods__, *data}))

    @staticmethod
    @abstractmethod
    def closure(pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> ca.SX:
        """(m,) loop closure, one row for each limb."""

    @staticmethod
    @abstractmethod
    def default_home(geometry: Any) -> tuple[float, ...]:
        """(n,) a pose near the middle of the workspace, for a geometry of any size."""

    @staticmethod
    @abstractmethod
    def inverse_closed_form(pose: ca.SX, g: SimpleNamespace, mode: Mode) -> ca.SX:
        """(m,) joints of a working mode, NaN where a limb cannot reach."""

    @classmethod
    def usual_branches(cls, home: Array, geometry: Any) -> tuple[int, ...]:  # noqa: ARG003
        """(m,) the branch of each limb's inverse, +1 or -1, that is usual around a home (n,)."""
        return (1,) * len(cls.joint_names)

    @staticmethod
    @abstractmethod
    def reach(pose: ca.SX, g: SimpleNamespace) -> ca.SX:
        """(m,) distance of each limb from the end of its reach [m]; negative where it cannot reach."""

    @classmethod
    def limb_roots(cls, pose: ca.SX, g: SimpleNamespace) -> ca.SX:
        """Numbers that are NaN where a limb cannot reach, such as the roots of the inverse model."""
        return ca.sqrt(cls.reach(pose, g))

    @staticmethod
    @abstractmethod
    def scales(g: SimpleNamespace) -> tuple[ca.SX, ca.SX]:
        """Divisors that bring J_q's diagonal (m,) and det J_x into [-1, 1].

        With m > n, sqrt(det J_x^T J_x) replaces the determinant.
        """

    @abstractmethod
    def bodies(self, pose: ca.SX, joints: ca.SX, g: SimpleNamespace, payload: float | ca.SX) -> Bodies:
        """The masses that move; `payload` [kg] is at the tool."""

    @staticmethod
    @abstractmethod
    def skeleton(pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> dict[str, ca.SX]:
        """Named polylines (3, k) that draw the mechanism: base, arms, rods, platform."""

    def link_tree(
        self,
        pose: ca.SX,  # noqa: ARG002
        joints: ca.SX,  # noqa: ARG002
        g: SimpleNamespace,  # noqa: ARG002
        reference: Reference,  # noqa: ARG002
    ) -> Tree | None:
        """The links and their joints, for simulators; None if they follow from the bodies.

        They follow if each link is moved by one driven joint, or by the pose alone: x, y, z slide it, and theta, or
        yaw, pitch and roll, turn it about the tool point.
        """
        return None

    def passive_joints(self, pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> list[PassiveJoint]:  # noqa: ARG002
        """The joints at the rods' ends. If there are any, `Ranges` limits them and `PASSIVE_JOINT` is a margin."""
        return []

    @abstractmethod
    def members(self, pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> list[Member]:
        """Bodies whose masses follow from their sections. Those that share no joint must not touch: `clearance`."""

    def statics(self, pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> list[LimbStatics]:
        """What each limb transmits to the platform, and how it gives way: `stiffness`. By default only drives do."""
        phi = self.closure(pose, joints, g)
        j_q, by_twist = ca.diag(ca.jacobian(phi, joints)), self.closure_by_twist(pose, joints, g)
        efforts = ca.SX.eye(joints.numel())
        return [LimbStatics(-(by_twist[i, :] / j_q[i]).T, ca.SX(1, 1), efforts[:, i]) for i in range(joints.numel())]

    @classmethod
    def beyond_twist(cls, pose: ca.SX, g: SimpleNamespace, limb: int | None, point: ca.SX) -> ca.SX:  # noqa: ARG003
        """(3, f - n) how a point that the pose carries moves with the freedoms of `statics` that follow the twist.

        `limb`, from 0, is one that holds the point's body; None if no limb does.
        """
        return ca.SX(3, 0)

    @staticmethod
    def turns_left(pose: ca.SX, g: SimpleNamespace) -> dict[str, ca.SX]:  # noqa: ARG004
        """By name, how far each passive joint that is not at a rod's end may still turn [rad]: `passive_joint`."""
        return {}

    def base_members(self, pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> list[Member]:  # noqa: ARG002
        """Bodies in the way whose masses follow from no section: the base, rails, slides, motors.

        Those of the base share the joint "base".
        """
        return []

    def all_members(self, pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> list[Member]:
        """`members` and `base_members`."""
        return [*self.members(pose, joints, g), *self.base_members(pose, joints, g)]

    @classmethod
    def drives(cls, g: SimpleNamespace) -> ca.SX:  # noqa: ARG003
        """(m, m) constant C with actuators = C joints; the identity unless the drives couple joints."""
        return ca.SX.eye(len(cls.joint_names))

    @staticmethod
    def joint_cosines_and_sines(
        pose: ca.SX,  # noqa: ARG004
        g: SimpleNamespace,  # noqa: ARG004
        mode: Mode,  # noqa: ARG004
    ) -> tuple[ca.SX, ca.SX] | None:
        """(m,) cosines and (m,) sines of the joints at a pose, where the joints are revolute."""
        return None

    @staticmethod
    def j_q_closed_form(
        pose: ca.SX,  # noqa: ARG004
        g: SimpleNamespace,  # noqa: ARG004
        mode: Mode,  # noqa: ARG004
    ) -> ca.SX | None:
        """(m,) the diagonal of J_q at a pose, where it is simpler than what the closure's derivative gives there."""
        return None

    @classmethod
    def tool_frame(cls, pose: ca.SX) -> tuple[ca.SX, ca.SX]:
        """The tool point (3,) and the axes of the tool (3, 3), but for a turn about its own z axis."""
        names = cls.pose_names
        point = ca.vertcat(*(pose[names.index(name)] if name in names else 0 for name in ("x", "y", "z")))
        if "roll" not in names:
            return point, ca.SX.eye(3)
        return point, rotation_symbolic(pose[[names.index(name) for name in ("roll", "pitch", "yaw")]])

    @staticmethod
    def pose_rate_map(pose: ca.SX) -> ca.SX:
        """(n, n) pose rates from the twist; the identity unless the pose holds Euler angles."""
        return ca.SX.eye(pose.shape[0])

    @classmethod
    def closure_by_twist(cls, pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> ca.SX:
        """(m, n) derivative of the closure by the twist. Override it if the pose has Euler angles."""
        return ca.jacobian(cls.closure(pose, joints, g), pose) @ cls.pose_rate_map(pose)

    @property
    def actuator_names(self) -> tuple[str, ...]:
        """The names of the actuators (C joints); the joints' names unless drives couple joints."""
        return self.joint_names

    @property
    def actuator_units(self) -> tuple[str, ...]:
        """Rad or m."""
        return self.joint_units

    @property
    @abstractmethod
    def characteristic_length(self) -> float:
        """The length that makes a rotation a length [m]."""

    @abstractmethod
    def assembly_modes(self, joints: Array) -> Array:
        """(m,) -> (k, n), every real pose with these joints."""

    @abstractmethod
    def working_forward(self, joints: Array) -> Array:
        """(..., m) joints -> (..., n) pose in the assembly mode of home; a NaN row where no pose has these joints."""

    @staticmethod
    def moved(pose: Array, twist: Array) -> Array:
        """(k, n) poses after small displacements (k, n). With Euler angles this is not a sum."""
        result: Array = pose + twist
        return result
