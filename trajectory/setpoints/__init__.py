"""Set-points of a cycle: the values that the drives get in each period."""

from trajectory.setpoints.setpoint_file import read_setpoints, setpoints_text, write_setpoints
from trajectory.setpoints.setpoints import Setpoints, cycle_setpoints, robot_header

__all__ = [
    "Setpoints",
    "cycle_setpoints",
    "read_setpoints",
    "robot_header",
    "setpoints_text",
    "write_setpoints",
]
