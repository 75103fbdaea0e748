"""Heli4's masses: arms with their drives, rods, two plates, tool and payload."""

from __future__ import annotations

from dataclasses import dataclass
from types import SimpleNamespace
from typing import TYPE_CHECKING

import casadi as ca

from kinematics.machine import AXES, TURN, Bodies, Particle, Rotor
from kinematics.robots.heli4.geometry import UPPER
from kinematics.robots.shared import ArmInertia, arms_and_rods

if TYPE_CHECKING:
    from kinematics.robots.heli4.heli4 import Heli4


@dataclass(frozen=True)
class Heli4Inertia(ArmInertia):
    """The masses of the arms and the plates.

    Attributes:
        plate_masses: masses of the lower plate (limbs 1 and 2) and of the upper plate.
        tool: inertia of the tool about e_z; the payload is a point on the lower plate.
    """

    plate_masses: tuple[float, float] = (0.55, 0.55)
    tool: float = 6e-4


def bodies(robot: Heli4, pose: ca.SX, joints: ca.SX, g: SimpleNamespace, payload: float | ca.SX) -> Bodies:
    """Arms with their drives, rods, plates, payload and tool."""
    i, plates = robot.inertia, ("lower plate", "upper plate")
    found = arms_and_rods(robot, pose, joints, g, i.rod_mass, [plates[int(k)] for k in UPPER])
    above = pose[:3] + g.pitch / TURN * pose[3] * ca.DM([0, 0, 1])
    lower = Particle(plates[0], i.plate_masses[0] + payload, pose[:3])
    found.particles.extend([lower, Particle(plates[1], i.plate_masses[1], above)])
    found.rotors.append(Rotor(i.tool, pose[3], AXES[2]))
    return found
