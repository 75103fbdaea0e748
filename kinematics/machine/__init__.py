"""The data of a machine: its geometry, masses, drive train and joint ranges."""

from kinematics.machine.bodies import UNIFORM, Bodies, InertiaRecord, Particle, Rod, Rotor
from kinematics.machine.drive_train import LINEAR, REST, ROTARY, DriveTrain
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
from kinematics.machine.load import Load
from kinematics.machine.materials import MATERIALS, Material
from kinematics.machine.members import (
    Member,
    Plate,
    Tube,
    bar,
    platform,
    require_walls,
    shared_joints,
    unjoined,
)
from kinematics.machine.structure import Structure

__all__ = [
    "AXES",
    "LINEAR",
    "MATERIALS",
    "ORIGIN",
    "REST",
    "ROTARY",
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
    "Load",
    "Material",
    "Member",
    "Pair",
    "Particle",
    "PassiveJoint",
    "Plate",
    "Points",
    "Reference",
    "Rod",
    "RodRanges",
    "Rotor",
    "Structure",
    "Tree",
    "TreeJoint",
    "Tube",
    "angle",
    "bar",
    "frame",
    "kind_of",
    "length",
    "numbers_of",
    "platform",
    "ratio",
    "require_walls",
    "screw_pitch",
    "shared_joints",
    "universal",
    "unjoined",
]
