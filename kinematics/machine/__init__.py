"""What a machine is made of, as data: its geometry, masses, drive train and joint ranges."""

from kinematics.machine.bodies import UNIFORM, Bodies, InertiaRecord, Particle, Rod, Rotor
from kinematics.machine.drive_train import REST, DriveTrain
from kinematics.machine.geometry import (
    TURN,
    GeometryRecord,
    Points,
    angle,
    frame,
    length,
    numbers_of,
    ratio,
    screw_pitch,
)
from kinematics.machine.joint_ranges import JointRanges, Pair, PassiveJoint, RodRanges

__all__ = [
    "REST",
    "TURN",
    "UNIFORM",
    "Bodies",
    "DriveTrain",
    "GeometryRecord",
    "InertiaRecord",
    "JointRanges",
    "Pair",
    "Particle",
    "PassiveJoint",
    "Points",
    "Rod",
    "RodRanges",
    "Rotor",
    "angle",
    "frame",
    "length",
    "numbers_of",
    "ratio",
    "screw_pitch",
]
