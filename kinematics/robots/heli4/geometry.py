"""Heli4's geometry: table 1 of the paper, with the prototype's numbers as defaults."""

from __future__ import annotations

import math
from dataclasses import dataclass

from kinematics.machine import angle, length, ratio, screw_pitch
from kinematics.robots.shared import HalvesGeometry

UPPER = (0.0, 0.0, 1.0, 1.0)  # 1 for the limbs that hold the plate on the screw: (7), (8)
_DEG = math.pi / 180.0


@dataclass(frozen=True)
class Heli4Geometry(HalvesGeometry):
    """Table 1 of the paper, in metres and radians.

    Raises:
        InvalidGeometry: as for any geometry; or both limbs of a plate have the same azimuth.
    """

    base_radius: float = length(0.350, doc="R, of the actuators' axes")
    platform_radius: float = length(0.041, doc="r, of the plates")
    arm_length: float = length(0.351, doc="L, actuator to rod")
    rod_length: float = length(0.800, doc="l, rod")
    height_step: float = length(0.0, minimum=None, doc="H, actuators 3 and 4 above 1 and 2")
    plate_offset: float = length(0.041, minimum=None, doc="h, plates above the tool point")
    pitch: float = screw_pitch(0.050, doc="p, of the screw")
    azimuths: tuple[float, ...] = angle((0.0, 180 * _DEG, 90 * _DEG, 270 * _DEG), doc="alpha, of the limbs")
    parallelogram_width: float = length(0.06, doc="d, between the two rods of a limb; not in the paper")
    arm_radius: float = length(0.025, doc="of the arms' tubes, outside; not in the paper")
    arm_wall: float = length(0.002, doc="of the arms' tubes; not in the paper")
    rod_radius: float = length(0.006, doc="of the rods' tubes, outside; not in the paper")
    rod_wall: float = length(0.0015, doc="of the rods' tubes; not in the paper")
    plate_thickness: float = length(0.012, doc="of both plates; not in the paper")
    plate_rise: float = length(0.050, doc="of the upper plate's middle bar above its rods' ends; not in the paper")
    screw_radius: float = length(0.006, doc="of the screw, which is the tool's shaft too; not in the paper")
    screw_turns: float = ratio(1.5, doc="turns of the tool to either side that the screw is long enough for; ours")
    motor_radius: float = length(0.040, doc="of the motors; not in the paper")
    motor_length: float = length(
        0.080, doc="of the motors along their axes, without their round ends; not in the paper"
    )
