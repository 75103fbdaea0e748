"""Motion and torque of the joints and of the actuators; stiffness and mass at the tool."""

from kinematics.dynamics.actuators import from_actuators, to_actuators
from kinematics.dynamics.buckling_and_yield import LARGEST, Size, Slack, WorstDirection, demands, safety_factors
from kinematics.dynamics.chain_rule import JointMotion, actuator_motion, derivatives_along, joint_motion
from kinematics.dynamics.drive_torque import (
    GRAVITY,
    friction,
    inverse_dynamics,
    moving_bodies,
    require_payload,
    torques,
)
from kinematics.dynamics.forces_of_members import MemberForces, member_forces
from kinematics.dynamics.loads_from_rest import LoadsFromRest, loads_from_rest
from kinematics.dynamics.member_loads import LoadCase, MemberLoad, case_at_rest, case_in_motion
from kinematics.dynamics.reaction_on_frame import FrameReaction, frame_reaction
from kinematics.dynamics.stiffness import (
    Transmission,
    mass_matrix,
    mass_matrix_symbolic,
    platform_stiffness,
    stiffness_symbolic,
    tool_stiffness,
    transmission,
    transmission_at_pose,
)

__all__ = [
    "GRAVITY",
    "LARGEST",
    "FrameReaction",
    "JointMotion",
    "LoadCase",
    "LoadsFromRest",
    "MemberForces",
    "MemberLoad",
    "Size",
    "Slack",
    "Transmission",
    "WorstDirection",
    "actuator_motion",
    "case_at_rest",
    "case_in_motion",
    "demands",
    "derivatives_along",
    "frame_reaction",
    "friction",
    "from_actuators",
    "inverse_dynamics",
    "joint_motion",
    "loads_from_rest",
    "mass_matrix",
    "mass_matrix_symbolic",
    "member_forces",
    "moving_bodies",
    "platform_stiffness",
    "require_payload",
    "safety_factors",
    "stiffness_parts",
    "stiffness_symbolic",
    "sum_of",
    "to_actuators",
    "tool_stiffness",
    "torques",
    "transmission",
    "transmission_at_pose",
]
