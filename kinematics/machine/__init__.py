"""The data of a machine: its geometry, masses, drive train and joint ranges."""

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
from kinematics.machine.links import (
    AXES,
    ORIGIN,
    Connection,
    Coupling,
    Link,
    Reference,
    Tree,
    TreeJoint,
    universal,
)

__all__ = [
    "AXES",
    "ORIGIN",
    "REST",
    "TURN",
    "UNIFORM",
    "Bodies",
    "Connection",
    "Coupling",
    "DriveTrain",
    "GeometryRecord",
    "InertiaRecord",
    "JointRanges",
    "Link",
    "Pair",
    "Particle",
    "PassiveJoint",
    "Points",
    "Reference",
    "Rod",
    "RodRanges",
    "Rotor",
    "Tree",
    "TreeJoint",
    "angle",
    "frame",
    "length",
    "numbers_of",
    "ratio",
    "screw_pitch",
    "universal",
]
