"""A 6-UPS platform's numbers: joint centres, frames (8.6.1 of Khalil and Dombre), symmetric layouts (8.5.2.2); masses.

The masses and the joints' ranges are ours.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import ClassVar, Self

import numpy as np

from kinematics.arrays import Array
from kinematics.errors import InvalidField, InvalidGeometry, InvalidValue
from kinematics.machine import (
    LINEAR,
    TURN,
    DriveTrain,
    GeometryRecord,
    InertiaRecord,
    Pair,
    Points,
    RodRanges,
    frame,
    length,
    numbers_of,
)
from kinematics.robots.gough_stewart.architecture_singularity import why_singular

_DEG = math.pi / 180.0
_RIGID = 1e-9  # how far a frame's rotation may be from orthonormal


def symmetric_points(radius: float, half_angle: float, first: float) -> Points:
    """(6, 3) points on a circle: three pairs, 2 `half_angle` apart, at azimuths `first` + 120 deg k."""
    pairs = [first + TURN / 3 * k + side * half_angle for k in range(3) for side in (-1, 1)]
    return tuple((radius * math.cos(azimuth), radius * math.sin(azimuth), 0.0) for azimuth in pairs)


def _platform(radius: float, half_angle: float) -> Points:
    """Pairs midway between the base's, counted so that legs 2k and 2k + 1 share one."""
    points = symmetric_points(radius, half_angle, 60 * _DEG)
    return points[-1:] + points[:-1]


@dataclass(frozen=True)
class GoughStewartGeometry(GeometryRecord):
    """Joint centres A_i and B_i in the frames R_0 of the base and R_m of the platform.

    The defaults are this project's: the chapter gives no dimensions. R_0 and R_m may lie anywhere; `canonical` moves
    them to where the chapter puts them.

    Raises:
        InvalidGeometry: as for any geometry; or a frame is not a rigid transform, or the architecture is singular at
            every pose (the message says why).
    """

    base_points: tuple[tuple[float, ...], ...] = length(
        symmetric_points(0.5, 12 * _DEG, 0.0), minimum=None, doc="A_i in R_0"
    )
    platform_points: tuple[tuple[float, ...], ...] = length(_platform(0.3, 12 * _DEG), minimum=None, doc="B_i in R_m")
    Z: tuple[tuple[float, ...], ...] = frame(doc="Z, base frame R_0 in the reference frame R_f; [8.5]")
    E: tuple[tuple[float, ...], ...] = frame(doc="E, tool frame R_E in the platform's frame R_m; [8.5]")
    leg_radius: float = length(0.020, doc="of the legs' cylinders, outside")
    leg_wall: float = length(0.002, doc="of the legs' cylinders")
    plate_thickness: float = length(0.020, doc="of the platform")

    def __post_init__(self) -> None:
        super().__post_init__()
        for name in ("Z", "E"):
            matrix = np.array(getattr(self, name))
            rotation = matrix[:3, :3]
            rigid = np.allclose(rotation @ rotation.T, np.eye(3), rtol=0.0, atol=_RIGID) and np.linalg.det(rotation) > 0
            if not rigid or np.any(matrix[3] != (0.0, 0.0, 0.0, 1.0)):
                raise self.invalid(name, getattr(self, name), "a rotation and a translation above (0, 0, 0, 1)")
        reason = why_singular(np.array(self.base_points), np.array(self.platform_points))
        if reason is not None:
            raise SingularArchitecture(reason)

    @classmethod
    def ssm(
        cls,
        base_radius: float = 0.5,
        platform_radius: float = 0.3,
        base_half_angle: float = 12 * _DEG,
        platform_half_angle: float = 12 * _DEG,
    ) -> Self:
        """Simplified symmetric manipulator: base and platform are hexagons.

        Args:
            base_radius, platform_radius: of the circles through the joint centres [m].
            base_half_angle: half the angle between the legs of a base pair; the pairs are at 0, 120, 240 deg [rad].
            platform_half_angle: the same on the platform; its pairs are at 60, 180, 300 deg [rad].

        Raises:
            InvalidValue: a radius is not positive or a half angle is outside [0, 60 deg].
            InvalidGeometry: the hexagons are similar (the half angles add up to 60 deg): singular everywhere.
        """
        for name, radius in (("base_radius", base_radius), ("platform_radius", platform_radius)):
            if not 0.0 < radius < math.inf:
                raise InvalidValue(name, radius, "a finite radius > 0 m")
        for name, half in (("base_half_angle", base_half_angle), ("platform_half_angle", platform_half_angle)):
            if not 0.0 <= half <= TURN / 6:
                raise InvalidValue(name, half, "an angle from 0 to pi / 3 rad")
        return cls(symmetric_points(base_radius, base_half_angle, 0.0), _platform(platform_radius, platform_half_angle))

    @classmethod
    def tssm(cls, base_radius: float = 0.5, platform_radius: float = 0.3, base_half_angle: float = 12 * _DEG) -> Self:
        """Triangular simplified symmetric manipulator: hexagonal base, triangular platform; arguments as in `ssm`."""
        return cls.ssm(base_radius, platform_radius, base_half_angle, 0.0)

    @classmethod
    def mssm(cls, base_radius: float = 0.5, platform_radius: float = 0.3) -> Self:
        """Minimal simplified symmetric manipulator, an octahedron: two triangles; arguments as in `ssm`."""
        return cls.ssm(base_radius, platform_radius, 0.0, 0.0)

    def in_reference_frame(self) -> Array:
        """(6, 3) A_i in R_f; [8.6]."""
        return _moved(np.array(self.Z), np.array(self.base_points))

    def in_tool_frame(self) -> Array:
        """(6, 3) B_i in R_E: E^-1 maps them, where [8.7] prints E."""
        return _moved(_inverse(np.array(self.E)), np.array(self.platform_points))

    def canonical(self) -> Self:
        """The same robot with R_0 and R_m where 8.6.1 puts them: at A_1 and B_1, x to A_2 and B_2, A_6 and B_6 in xy.

        Twelve of the thirty-six coordinates are then zero, and Z and E hold twelve parameters in their place.

        Raises:
            InvalidGeometry: points 1, 2 and 6 of base or platform lie on one line and define no frame.
        """
        base, platform = np.array(self.base_points), np.array(self.platform_points)
        on_base, on_platform = self._frame_of(base, "base_points"), self._frame_of(platform, "platform_points")
        return self.with_values(
            base_points=_moved(_inverse(on_base), base),
            platform_points=_moved(_inverse(on_platform), platform),
            Z=np.array(self.Z) @ on_base,
            E=_inverse(on_platform) @ np.array(self.E),
        )

    def _frame_of(self, points: Array, name: str) -> Array:
        """(4, 4) frame on points 1, 2 and 6."""
        x, other = points[1] - points[0], points[5] - points[0]
        z = np.cross(x, other)
        if np.linalg.norm(z) <= _RIGID * np.ptp(points) ** 2:
            raise self.invalid(name, getattr(self, name), "points 1, 2 and 6 not on one line, for the chapter's frames")
        x, z = x / np.linalg.norm(x), z / np.linalg.norm(z)
        result = np.eye(4)
        result[:3] = np.column_stack([x, np.cross(z, x), z, points[0]])
        return result


@dataclass(frozen=True)
class GoughStewartInertia(InertiaRecord):
    """Electric cylinders of a laboratory hexapod: an assumption of this project, not a datasheet. SI units.

    Attributes:
        screw_lead: of each cylinder [m/turn].
        drive: inertia of motor and screw about the screw's axis.
        rod_length: the moving end of each leg, a thin uniform rod from B_i towards A_i; of length 0, a particle at B_i.
            The other end stays near A_i, and its turning is left out. None takes the least length of the legs.
        rod_joint: mass of the joint at its end.
        rod_mass: of the moving end without its joint; None takes that of a tube of `rod_length`.
        platform_joint: mass of the platform's part of each joint, at B_i.
        platform_mass: of the platform with its joints, in six equal particles at the B_i; None takes the plate, or the
            bars, and the joints. The payload is a particle at the tool point.
        drive_train: screw, bearings and servo loop of each cylinder give way by 0.02 um for each N.
    """

    dimensions: ClassVar[Mapping[str, str]] = {"screw_lead": "length_per_turn", "rod_length": "length"}
    screw_lead: float = 0.010
    drive: float = 1.2e-4
    rod_length: float | None = None
    rod_joint: float = 0.05
    rod_mass: float | None = None
    platform_joint: float = 0.3
    platform_mass: float | None = None
    drive_train: DriveTrain = field(default=replace(LINEAR, stiffness=5e7), kw_only=True)

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.screw_lead == 0.0:
            raise InvalidField("GoughStewartInertia", "screw_lead", self.screw_lead, "> 0 m/turn")


@dataclass(frozen=True)
class GoughStewartRanges(RodRanges):
    """Legs of two stages, joints that tilt up to 52 degrees: an assumption of this project, not a datasheet.

    Attributes:
        rest: the tool point [m] where, with the platform not turned, each leg is along the axes of its two joints; None
            takes the robot's home.
    """

    dimensions: ClassVar[Mapping[str, str]] = {**RodRanges.dimensions, "rest": "length"}
    joints: Pair | tuple[Pair, ...] = (0.4, 1.0)
    passive: Pair = (0.9, 0.9)
    rest: tuple[float, float, float] | None = None

    def check(self, count: int) -> None:
        """As for `RodRanges`; and `rest` is a point."""
        super().check(count)
        if self.rest is None:
            return
        rest = numbers_of(self.rest)
        if rest is None or rest.shape != (3,) or not np.isfinite(rest).all():
            raise InvalidField("GoughStewartRanges", "rest", self.rest, "three finite coordinates [m]")


class SingularArchitecture(InvalidGeometry):
    """The six legs are dependent at every pose."""

    def __init__(self, reason: str) -> None:
        self.reason = reason
        super().__init__(
            "GoughStewart", "base_points and platform_points", f"an architecture singular at every pose: {reason}",
            "legs that are independent at some pose",
        )  # fmt: skip


def _moved(transform: Array, points: Array) -> Array:
    result: Array = points @ transform[:3, :3].T + transform[:3, 3]
    return result


def _inverse(transform: Array) -> Array:
    result = np.eye(4)
    result[:3, :3] = transform[:3, :3].T
    result[:3, 3] = -transform[:3, :3].T @ transform[:3, 3]
    return result
