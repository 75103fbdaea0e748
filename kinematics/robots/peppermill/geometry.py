"""The Peppermill's numbers: a geometry, masses and joint ranges that are ours, as its paper gives none."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from kinematics.machine import ROTARY, DriveTrain, GeometryRecord, InertiaRecord, Pair, RodRanges, length, screw_pitch

# Share of the larger pitch. Rounding of a nut's height [m] changes theta by 2 pi / |p_1 - p_2| times as much [rad]. At
# this difference of pitches theta is known to about 1e-8 rad; at 1e-11 only to 1e-3.
_SAME_PITCH = 1e-6


@dataclass(frozen=True)
class PeppermillGeometry(GeometryRecord):
    """The paper gives no dimensions. These are for a box of 0.4 x 0.4 x 0.1 m about the origin, with a turn either way.

    Raises:
        InvalidGeometry: as for any geometry; or the two pitches are equal to a millionth, the architecture singularity
            of (48).
    """

    proximal_lengths: tuple[float, ...] = length((0.20, 0.20), doc="r_i, drive axis to elbow")
    distal_lengths: tuple[float, ...] = length((0.50, 0.50), doc="l_i, elbow to platform")
    half_distance: float = length(0.50, doc="b_0, origin to either drive axis")
    pitches: tuple[float, ...] = screw_pitch((0.10, -0.10), doc="p_i, of the platform's screws")
    link_radius: float = length(0.020, doc="of both limbs' links, outside")
    link_wall: float = length(0.002, doc="of both limbs' links")
    nut_spacing: float = length(0.30, doc="between the nuts at theta = 0; not in the paper, whose nuts coincide there")
    screw_radius: float = length(0.010, doc="of the platform's screws")
    column_radius: float = length(0.020, doc="of the drive columns; not in the paper")
    nut_radius: float = length(0.020, doc="of the nuts; not in the paper")
    nut_length: float = length(0.030, doc="of the nuts along the screws, without their round ends; not in the paper")
    carriage_radius: float = length(0.030, doc="of the carriages around their columns; not in the paper")
    carriage_length: float = length(
        0.060, doc="of the carriages along their columns, without their round ends; not in the paper"
    )
    motor_radius: float = length(0.030, doc="of the motors at both ends of each column; not in the paper")
    motor_length: float = length(
        0.100, doc="of the motors along their axes, without their round ends; not in the paper"
    )
    drive_pitch: float = screw_pitch(0.10, doc="p_c, of the drives' screws")

    def __post_init__(self) -> None:
        super().__post_init__()
        first, second = self.pitches
        if abs(first - second) <= _SAME_PITCH * max(abs(first), abs(second)):
            reason = "with equal pitches det A of (48) is zero at every pose (an architecture singularity)"
            raise self.invalid("pitches", self.pitches, f"two different pitches: {reason}")
        if self.drive_pitch < 0.0:
            raise self.invalid("drive_pitch", self.drive_pitch, "a pitch > 0 m/turn, as in (A.2)")


@dataclass(frozen=True)
class PeppermillInertia(InertiaRecord):
    """A light machine with 750 W servos: an assumption of this project, not a datasheet. SI units.

    Attributes:
        motor: inertia of each motor with its nut, about its axis.
        carriage_mass, carriage: mass of the part that slides along a drive axis, and its inertia about that axis.
        proximal_hub, proximal_joint: masses at a third of a proximal link, where it is joined to its carriage, and at
            its elbow.
        proximal_mass, proximal_centre, proximal_factor: a proximal link's mass, its centre of mass c as a fraction of
            r_i, and its inertia about the drive axis over m c^2; None takes those of tube, hub and joint.
        distal_joint: mass of the joint at each end of a distal link.
        distal_mass: mass of a distal link with its joints; None takes that of tube and joints.
        nut_mass: mass of each nut of the platform's screws.
        platform_mass, tool: mass of the platform with screws and tool, and its inertia about e_z; the payload is a
            point at C.
        drive_train: the servo loop of each motor gives way by 5e-4 rad for each N m.
    """

    motor: float = 3.0e-4
    carriage_mass: float = 1.5
    carriage: float = 1.0e-3
    proximal_hub: float = 0.353
    proximal_joint: float = 0.018
    proximal_mass: float | None = None
    proximal_centre: float | None = None
    proximal_factor: float | None = None
    distal_joint: float = 0.04
    distal_mass: float | None = None
    nut_mass: float = 0.2
    platform_mass: float = 0.8
    tool: float = 6.0e-4
    drive_train: DriveTrain = field(default=replace(ROTARY, stiffness=2e3), kw_only=True)


@dataclass(frozen=True)
class PeppermillRanges(RodRanges):
    """Slides of 0.6 m and arms that turn 3 rad: an assumption of this project, as the paper gives no limits.

    `passive` limits the angles of the elbows from a right angle, and of the distal links' ends from upright.
    """

    joints: Pair | tuple[Pair, ...] = ((-0.3, 0.3), (-0.3, 0.3), (-1.2, 1.8), (0.4, 3.4))
    passive: Pair = (1.2, 1.2)
