"""Motion and torque of the joints and of the actuators; stiffness and mass at the tool."""

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
    "JointMotion",
    "Transmission",
    "actuator_motion",
    "derivatives_along",
    "friction",
    "from_actuators",
    "inverse_dynamics",
    "joint_motion",
    "mass_matrix",
    "mass_matrix_symbolic",
    "moving_bodies",
    "platform_stiffness",
    "require_payload",
    "stiffness_symbolic",
    "to_actuators",
    "tool_stiffness",
    "torques",
    "transmission",
    "transmission_at_pose",
]
