"""The redundant 3T-1R robot's numbers: its paper's optimised geometry, and joint ranges that are ours."""

from __future__ import annotations

from dataclasses import dataclass

from kinematics.machine import GeometryRecord, Pair, RodRanges, length

LIMBS = 6
PARALLELOGRAMS = (2, 3)  # the limbs of two rods, from 0
_LEAST_SPREAD = 1e-4  # of rails, over the arms' length: the forward model loses as many digits as this has zeros


@dataclass(frozen=True)
class Redundant3T1RGeometry(GeometryRecord):
    """The optimised parameters of section V.D, in metres.

    Raises:
        InvalidGeometry: as for any geometry; or |y_1| or |z_1 - a/2| is below 1e-4 L_1, or |y_3| below 1e-4 L_3. If y_1
            or y_3 is 0, rails coincide. If z_1 = a/2, all arms are level at z = 0, and nothing holds the platform's
            height there. The forward model divides by these numbers, and its error is about 3e-15 m times the arms'
            length over them.
    """

    outer_arm_length: float = length(1.25, doc="L1, arms 1, 2, 5 and 6")
    middle_arm_length: float = length(1.0926, doc="L3, arms 3 and 4")
    outer_rail_y: float = length(-0.375, minimum=None, doc="y1, of rails 1 and 5; rails 2 and 6 are at -y1")
    middle_rail_y: float = length(-0.4602, minimum=None, doc="y3, of rail 3; rail 4 is at -y3")
    outer_rail_z: float = length(0.3, minimum=None, doc="z1, of rails 1 and 2; rails 5 and 6 are at -z1")
    platform_length: float = length(0.1126, doc="d, between B1 and B3 seen from above")
    platform_height: float = length(0.2, doc="a, from B5 up to B1")
    parallelogram_width: float = length(0.1, doc="between the two rods of arms 3 and 4; not in the paper")
    rod_radius: float = length(0.010, doc="of the rods' tubes, outside; not in the paper")
    rod_wall: float = length(0.002, doc="of the rods' tubes; not in the paper")
    rail_radius: float = length(0.010, doc="of the rails; not in the paper")
    slide_radius: float = length(0.020, doc="of the slides around their rails; not in the paper")
    slide_length: float = length(0.080, doc="of the slides along x, without their round ends; not in the paper")
    platform_thickness: float = length(0.020, doc="of the platform's bars; not in the paper")

    def __post_init__(self) -> None:
        super().__post_init__()
        outer, middle = _LEAST_SPREAD * self.outer_arm_length, _LEAST_SPREAD * self.middle_arm_length
        for name, least in (("outer_rail_y", outer), ("middle_rail_y", middle)):
            if abs(getattr(self, name)) < least:
                raise self.invalid(
                    name, getattr(self, name), f"{least:g} m or more from 0, so that no two rails coincide"
                )
        if abs(self.outer_rail_z - self.platform_height / 2) < outer:
            why = f"{outer:g} m or more from platform_height / 2, as otherwise nothing holds the height at z = 0"
            raise self.invalid("outer_rail_z", self.outer_rail_z, why)


@dataclass(frozen=True)
class Redundant3T1RRanges(RodRanges):
    """Rails of 3 m, and forks that lean up to 46 degrees: an assumption of this project, the paper gives no limits."""

    joints: Pair | tuple[Pair, ...] = (-2.0, 1.0)
    passive: Pair = (0.8, 0.8)
