"""Motion and torque of the joints and of the actuators."""

from kinematics.dynamics.actuators import from_actuators, to_actuators
from kinematics.dynamics.chain_rule import JointMotion, actuator_motion, derivatives_along, joint_motion
from kinematics.dynamics.drive_torque import (
    GRAVITY,
    friction,
    inverse_dynamics,
    moving_bodies,
    require_payload,
    torques,
)
from kinematics.dynamics.frame_reaction import FrameReaction, frame_reaction

__all__ = [
    "GRAVITY",
    "FrameReaction",
    "JointMotion",
    "actuator_motion",
    "derivatives_along",
    "frame_reaction",
    "friction",
    "from_actuators",
    "inverse_dynamics",
    "joint_motion",
    "moving_bodies",
    "require_payload",
    "to_actuators",
    "torques",
]
