"""The data of a machine: its geometry, masses, drive train and joint ranges."""

from kinematics.machine.bodies import UNIFORM, Bodies, InertiaRecord, Particle, Rod, Rotor
from kinematics.machine.drive_train import REST, DriveTrain
from kinematics.machine.geometry_fields import TURN, FieldKind, Points, angle, frame, length, ratio, screw_pitch
from kinematics.machine.geometry_record import GeometryRecord, kind_of, numbers_of
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
    "FieldKind",
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
    "kind_of",
    "length",
    "numbers_of",
    "ratio",
    "screw_pitch",
    "universal",
]
