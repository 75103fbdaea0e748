"""Delta (Clavel; Khalil and Dombre 2002, 8.5.3): rotary arms and pairs of rods translate a plate."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from types import SimpleNamespace

import casadi as ca
import numpy as np

from kinematics.arrays import Array
from kinematics.evaluation import evaluate
from kinematics.machine import Bodies, GeometryRecord, Member, Particle, angle, length, member_mass, platform
from kinematics.margins import INTERNAL_STIFFNESS, PASSIVE_JOINT, STANDARD
from kinematics.mathematics import determinant, not_below_zero
from kinematics.model import Build, FviBounds, Model, by_name
from kinematics.robots.shared import (
    INTERNAL_DETERMINANT,
    ArmInertia,
    ArmRanges,
    Limbs,
    PairedArms,
    arms_and_rods,
    central_limbs,
    columns,
    height_in_reach,
    limb_members,
    means_and_differences,
    motors,
    pairs_held,
    radial_directions,
    studs,
)

_DEG = math.pi / 180.0
_SAME = 1e-6  # of a rod: rounding parts the two poses of a double root by no more
_CLOSED = 1e-9  # of the robot's size: a pose that misses its rods by more is none


@dataclass(frozen=True)
class DeltaGeometry(GeometryRecord):
    """A pick-and-place robot of usual size: an assumption of this project, as the chapter gives no dimensions.

    Raises:
        InvalidGeometry: as for any geometry; or two azimuths are equal.
    """

    base_radius: float = length(0.200, doc="R, of the actuators' axes")
    platform_radius: float = length(0.045, doc="r, of the plate")
    arm_length: float = length(0.350, doc="L, actuator to rod")
    rod_length: float = length(0.800, doc="l, rod")
    azimuths: tuple[float, ...] = angle((0.0, 120 * _DEG, 240 * _DEG), doc="alpha, of the limbs")
    parallelogram_width: float = length(0.06, doc="between the two rods of a limb")
    arm_radius: float = length(0.025, doc="of the arms' tubes, outside")
    arm_wall: float = length(0.002, doc="of the arms' tubes")
    rod_radius: float = length(0.006, doc="of the rods' tubes, outside")
    rod_wall: float = length(0.0015, doc="of the rods' tubes")
    plate_thickness: float = length(0.012, doc="of the plate")
    motor_radius: float = length(0.040, doc="of the motors")
    motor_length: float = length(0.080, doc="of the motors along their axes, without their round ends")

    def __post_init__(self) -> None:
        super().__post_init__()
        if abs(_triangle(np.array(self.azimuths))) < 1e-9:
            raise self.invalid("azimuths", self.azimuths, "three different directions")


@dataclass(frozen=True)
class DeltaInertia(ArmInertia):
    """The masses of the arms and the plate.

    Attributes:
        plate_fittings: what the plate carries, such as the rods' joints; the payload is a point on it.
        plate_mass: mass of the plate; None takes that of the plate with its fittings.
    """

    plate_fittings: float = 0.206
    plate_mass: float | None = None


class Delta(PairedArms):
    """Pose [x, y, z] of the plate's centre, joints q1..q3 measured from e_z outward. Elbows are usually out."""

    Geometry = DeltaGeometry
    Inertia = DeltaInertia
    Ranges = ArmRanges
    geometry: DeltaGeometry
    inertia: DeltaInertia
    pose_names = ("x", "y", "z")
    joint_names = ("q1", "q2", "q3")
    joint_units = ("rad",) * 3
    rotations = ()
    fvi_bounds = FviBounds(joint_speed=20.0, joint_effort=127.0, speed=2.5, force=100.0)
    tool_member = "plate"
    margins = by_name(*STANDARD, INTERNAL_DETERMINANT, INTERNAL_STIFFNESS, PASSIVE_JOINT)
    rod_velocities = ("x", "y", "z", "omega_x", "omega_y", "omega_z")
    row_combinations = means_and_differences(3)
    column_combinations = np.eye(6)

    @property
    def characteristic_length(self) -> float:
        """1 m, without effect, as the plate does not rotate."""
        return 1.0

    @staticmethod
    def default_home(geometry: DeltaGeometry) -> tuple[float, ...]:
        """A pose on the axis below the drives, in the middle of the reach."""
        g = geometry
        return 0.0, 0.0, -height_in_reach(g.base_radius, g.platform_radius, g.arm_length, g.rod_length)

    @staticmethod
    def limbs(g: SimpleNamespace) -> Limbs:
        """Arms in vertical planes through e_z."""
        return central_limbs(g)

    @staticmethod
    def platform_points(pose: ca.SX, g: SimpleNamespace) -> ca.SX:
        """Each pair of rods by the line midway."""
        result: ca.SX = columns(pose, 3) + g.platform_radius * radial_directions(g.azimuths)[0]
        return result

    @staticmethod
    def scales(g: SimpleNamespace) -> tuple[ca.SX, ca.SX]:
        """L l for each J_q,i; l^3 for det J_x."""
        return ca.repmat(g.arm_length * g.rod_length, 3, 1), g.rod_length**3

    # The rods, one by one.

    @staticmethod
    def carried(pose: ca.SX, displacement: ca.SX, limb: int, g: SimpleNamespace) -> tuple[ca.SX, ca.SX]:  # noqa: ARG004
        """The plate moves freely."""
        return displacement[:3], displacement[3:]

    def internal_determinant_symbolic(self) -> ca.SX:
        """det of the three `parallelogram_normals`: det J_int over d^3 l^3."""
        return determinant(self.parallelogram_normals())

    def bodies(self, pose: ca.SX, joints: ca.SX, g: SimpleNamespace, payload: float | ca.SX) -> Bodies:
        """Arms, rods, plate and payload."""
        bodies = arms_and_rods(self, pose, joints, g, ["plate"] * 3, g.parallelogram_width)
        plate, given = self.members(ca.SX(3, 1), joints, g)[-1], self.inertia.plate_mass
        own = self.inertia.plate_fittings + member_mass(plate, self.structure.of(plate).density)
        bodies.particles.append(Particle("plate", (own if given is None else given) + payload, pose))
        return bodies

    def members(self, pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> list[Member]:
        """Arms, both rods of each limb, and the plate, whose corners are the rods' ends."""
        corners = studs(self.platform_points(pose, g), self.limbs(g).axes(), g.parallelogram_width)
        own, half = self.geometry, self.geometry.parallelogram_width / 2
        flat = [
            u * complex(own.platform_radius, side * half)
            for u in np.exp(1j * np.array(own.azimuths))
            for side in (-1, 1)
        ]
        shapes = platform(corners, np.column_stack([np.real(flat), np.imag(flat)]), g.plate_thickness)
        limbs = limb_members(type(self), pose, joints, g, g.parallelogram_width)
        return [*limbs, Member("plate", tuple(pairs_held(0, 1, 2)), "plate", shapes)]

    def base_members(self, pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> list[Member]:  # noqa: ARG002
        """The motors."""
        return motors(self.limbs(g), g)

    @classmethod
    def skeleton(cls, pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> dict[str, ca.SX]:
        """Base, arms, rod pairs by their midlines, plate."""
        return cls.limb_lines(pose, joints, g) | {"platform": cls.platform_points(pose, g)[:, [0, 1, 2, 0]]}

    # The forward model: three spheres of radius l, of 2nd degree (8.6.4.1).

    def _both(self, joints: Array) -> Array:
        """(..., 3) -> (2, ..., 3), the plate on either side of the elbows' plane; NaN where there is none."""
        both: Array = np.stack(evaluate(self.program(_spheres), joints))
        with np.errstate(invalid="ignore"):  # with the three centres all but on one line, rounding is all that is left
            closed = (np.abs(self.closure_gap(both, np.stack([joints, joints]))) <= _CLOSED).all(axis=-1)
        return np.where(closed[..., None], both, np.nan)

    @cached_property
    def _side(self) -> int:
        """Which of `_both` home is."""
        away = np.linalg.norm(self._both(self.inverse(self.home)) - self.home, axis=-1)
        if np.isfinite(away).all():
            return int(away.argmin())
        return 0 if _triangle(np.array(self.geometry.azimuths)) > 0.0 else 1  # below, the limbs counted either way

    def working_forward(self, joints: Array) -> Array:
        """(..., 3) -> (..., 3): on the side of the plane of the rods' upper ends (moved inward by r) where home is."""
        result: Array = self._both(self._joints(joints))[self._side]
        return result

    def assembly_modes(self, joints: Array) -> Array:
        """(3,) -> (k, 3), every real pose with these joints: none, two, or one if both are equal. That of home's mode
        is first.

        If the spheres' centres are on one line there is none, as no pose is isolated then.
        """
        joints = self._one(joints)
        both = self._both(joints)[[self._side, 1 - self._side]]
        both = both[np.isfinite(both).all(axis=-1)]
        meet = len(both) and np.abs(both[0] - both[1]).max() <= _SAME * self.geometry.rod_length
        result: Array = both[:1] if meet else both
        return result


def _spheres(robot: Delta, model: Model) -> Build:
    """The two points that are a rod from each elbow, all moved inward by r."""
    centres = robot.limbs(model.g).elbows(model.joints) - robot.platform_points(ca.SX(3, 1), model.g)
    second, third = centres[:, 1] - centres[:, 0], centres[:, 2] - centres[:, 0]
    normal = ca.cross(second, third)
    square = ca.sumsqr(normal)
    foot = ca.cross(ca.sumsqr(second) * third - ca.sumsqr(third) * second, normal) / (2 * square)
    rod = model.g.rod_length**2
    height = ca.sqrt(not_below_zero(rod - ca.sumsqr(foot), rod) / square) * normal
    return [model.joints], [centres[:, 0] + foot - height, centres[:, 0] + foot + height]


def _triangle(azimuths: Array) -> float:
    """Twice the signed area of the triangle on the unit circle, positive counter-clockwise."""
    x, y = np.cos(azimuths), np.sin(azimuths)
    return float((x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]))
