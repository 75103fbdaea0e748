"""Mechanisms as loop closures, and everything that is derived from them."""

from __future__ import annotations

from kinematics.arguments import finite, positive, whole
from kinematics.arrays import Array, Value, checked
from kinematics.coordinates import LENGTHS, is_length
from kinematics.dynamics import (
    JointMotion,
    actuator_motion,
    derivatives_along,
    friction,
    from_actuators,
    inverse_dynamics,
    joint_motion,
    to_actuators,
    torques,
)
from kinematics.errors import (
    InvalidField,
    InvalidGeometry,
    InvalidShape,
    InvalidValue,
    LinkwrightError,
    UnreachablePose,
    plain,
)
from kinematics.evaluation import (
    CORES,
    BlockProgram,
    BoxProgram,
    Op,
    Program,
    bulk,
    enclose,
    evaluate,
    over_spans,
    run_through,
)
from kinematics.machine import (
    UNIFORM,
    DriveTrain,
    FieldKind,
    GeometryRecord,
    InertiaRecord,
    JointRanges,
    Obstacle,
    PayloadHull,
    Surroundings,
    kind_of,
)
from kinematics.margins import CLEARANCE, PASSIVE_JOINT, STANDARD, hull_depth, lowest_of_base
from kinematics.mathematics import bisected
from kinematics.mobility import ARCHITECTURES, Architecture, JointGraph, loop_mobility, mobility_of_identical_chains
from kinematics.model import (
    ClaimSymbols,
    FviBounds,
    Margin,
    Measure,
    Mechanism,
    Model,
    ToShow,
    by_name,
    continued,
    sides,
)
from kinematics.multibody import mjcf
from kinematics.printed_bounds import rounded_down, rounded_up
from kinematics.robots import MECHANISMS, Delta, Hexa
from kinematics.robots.gough_stewart import GoughStewart, LostPaths, SelfMotion, SingularArchitecture
from kinematics.robots.heli4 import Heli4
from kinematics.robots.par4 import Par4
from kinematics.robots.peppermill import Peppermill
from kinematics.robots.planar import Planar3PRR, Planar3RPR, Planar3RRR
from kinematics.robots.redundant_3t1r import Redundant3T1R

__all__ = [
    "ARCHITECTURES",
    "CLEARANCE",
    "CORES",
    "LENGTHS",
    "MECHANISMS",
    "PASSIVE_JOINT",
    "STANDARD",
    "UNIFORM",
    "Architecture",
    "Array",
    "BlockProgram",
    "BoxProgram",
    "ClaimSymbols",
    "Delta",
    "DriveTrain",
    "FieldKind",
    "FviBounds",
    "GeometryRecord",
    "GoughStewart",
    "Heli4",
    "Hexa",
    "InertiaRecord",
    "InvalidField",
    "InvalidGeometry",
    "InvalidShape",
    "InvalidValue",
    "JointGraph",
    "JointMotion",
    "JointRanges",
    "LinkwrightError",
    "LostPaths",
    "Margin",
    "Measure",
    "Mechanism",
    "Model",
    "Obstacle",
    "Op",
    "Par4",
    "PayloadHull",
    "Peppermill",
    "Planar3PRR",
    "Planar3RPR",
    "Planar3RRR",
    "Program",
    "Redundant3T1R",
    "SelfMotion",
    "SingularArchitecture",
    "Surroundings",
    "ToShow",
    "UnreachablePose",
    "Value",
    "actuator_motion",
    "bisected",
    "bulk",
    "by_name",
    "checked",
    "continued",
    "derivatives_along",
    "enclose",
    "evaluate",
    "finite",
    "friction",
    "from_actuators",
    "hull_depth",
    "inverse_dynamics",
    "is_length",
    "joint_motion",
    "kind_of",
    "loop_mobility",
    "lowest_of_base",
    "mjcf",
    "mobility_of_identical_chains",
    "over_spans",
    "plain",
    "positive",
    "rounded_down",
    "rounded_up",
    "run_through",
    "sides",
    "to_actuators",
    "torques",
    "whole",
]
