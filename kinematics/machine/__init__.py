"""The data of a machine: its geometry, masses, drive train and joint ranges."""

from kinematics.machine.beams import Beam, Section
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
from kinematics.machine.member_masses import arm_mass, mass_points, member_mass, rod_mass
from kinematics.machine.members import (
    Member,
    Plate,
    Tube,
    bar,
    platform,
    shared_joints,
)
from kinematics.machine.statics import Cut, LimbStatics, rod_cut
from kinematics.machine.structure import Structure
from kinematics.machine.surroundings import Obstacle, PayloadHull, Surroundings

__all__ = [
    "AXES",
    "LINEAR",
    "MATERIALS",
    "ORIGIN",
    "REST",
    "ROTARY",
    "TURN",
    "UNIFORM",
    "Beam",
    "Bodies",
    "Connection",
    "Coupling",
    "Cut",
    "DriveTrain",
    "FieldKind",
    "GeometryRecord",
    "InertiaRecord",
    "JointRanges",
    "LimbStatics",
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
    "Section",
    "Structure",
    "Surroundings",
    "Tree",
    "TreeJoint",
    "Tube",
    "angle",
    "arm_mass",
    "bar",
    "frame",
    "kind_of",
    "length",
    "mass_points",
    "member_mass",
    "numbers_of",
    "platform",
    "ratio",
    "rod_cut",
    "rod_mass",
    "screw_pitch",
    "shared_joints",
    "universal",
]
