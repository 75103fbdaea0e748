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
)
from kinematics.machine.structure import Structure
from kinematics.machine.surroundings import Obstacle, PayloadHull, Surroundings

__all__ = [
    "AXES",
    "MATERIALS",
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
    "Load",
    "Material",
    "Member",
    "Obstacle",
    "Pair",
    "Particle",
    "PassiveJoint",
    "PayloadHull",
    "Plate",
    "Points",
    "Reference",
    "Rod",
    "RodRanges",
    "Rotor",
    "Structure",
    "Surroundings",
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
]
