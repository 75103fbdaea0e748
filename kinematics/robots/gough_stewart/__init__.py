"""The Gough-Stewart platform, and what every platform on six legs shares."""

from kinematics.robots.gough_stewart.assembly_modes import LostPaths
from kinematics.robots.gough_stewart.forward import apart, matched_pose
from kinematics.robots.gough_stewart.geometry import GoughStewartGeometry, SingularArchitecture, symmetric_points
from kinematics.robots.gough_stewart.gough_stewart import GoughStewart
from kinematics.robots.gough_stewart.self_motion import SelfMotion
from kinematics.robots.gough_stewart.six_legs import SixLegs

__all__ = [
    "GoughStewart",
    "GoughStewartGeometry",
    "LostPaths",
    "SelfMotion",
    "SingularArchitecture",
    "SixLegs",
    "apart",
    "matched_pose",
    "symmetric_points",
]
