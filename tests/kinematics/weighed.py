"""Masses as of machines that were built and weighed, so that tests can compute with them by hand."""

from kinematics import GoughStewart, Heli4, Peppermill, Redundant3T1R

HELI4 = Heli4.Inertia(
    arm_mass=0.9, arm_centre=0.40, arm_factor=1.25, rod_mass=0.26, rod_middle=0.0, plate_masses=(0.55, 0.55)
)
PEPPERMILL = Peppermill.Inertia(
    proximal_mass=0.5, proximal_centre=0.40, proximal_factor=1.25, distal_mass=0.4, rod_middle=0.0
)
REDUNDANT = Redundant3T1R.Inertia(rod_mass=0.9, rod_middle=0.0, platform_mass=3.0, platform_inertia=0.015)
GOUGH_STEWART = GoughStewart.Inertia(rod_mass=0.8, rod_joint=0.0, rod_length=0.0, platform_mass=12.0)
