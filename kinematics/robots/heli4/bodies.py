"""Heli4's masses: arms with their drives, rods, two plates, tool and payload."""

from __future__ import annotations

from dataclasses import dataclass
from types import MappingProxyType, SimpleNamespace
from typing import TYPE_CHECKING

import casadi as ca

from kinematics.machine import AXES, TURN, Bodies, Particle, Rotor, member_mass
from kinematics.robots.heli4.geometry import UPPER
from kinematics.robots.shared import ArmInertia, arms_and_rods

if TYPE_CHECKING:
    from kinematics.robots.heli4.heli4 import Heli4


@dataclass(frozen=True)
class Heli4Inertia(ArmInertia):
    """The masses of the arms and the plates.

    Attributes:
        plate_fittings: what the lower plate (limbs 1 and 2) and the upper plate carry: bearings, nut, tool, joints.
        plate_masses: masses of both plates, the lower one with screw and tool; None takes those of bars, screw and
            fittings.
        tool: inertia of tool and screw about e_z, given for both; the payload is a point at the tool point.
    """

    _shapes = MappingProxyType({"plate_masses": (2,)})
    plate_fittings: tuple[float, float] = (0.347, 0.4585)
    plate_masses: tuple[float, float] | None = None
    tool: float = 6e-4


def bodies(robot: Heli4, pose: ca.SX, joints: ca.SX, g: SimpleNamespace, payload: float | ca.SX) -> Bodies:
    """Arms with their drives, rods, plates, screw, payload and tool."""
    i, plates = robot.inertia, ("lower plate", "upper plate")
    found = arms_and_rods(robot, pose, joints, g, [plates[int(k)] for k in UPPER], g.parallelogram_width)
    at_rest = {member.name: member for member in robot.members(ca.SX(4, 1), joints, g)}
    own = [member_mass(at_rest[name], robot.structure.of(at_rest[name]).density) for name in (*plates, "screw")]
    masses = i.plate_masses or [i.plate_fittings[0] + own[0] + own[2], i.plate_fittings[1] + own[1]]
    above = pose[:3] + g.pitch / TURN * pose[3] * ca.DM([0, 0, 1])
    lower = Particle(plates[0], masses[0] + payload, pose[:3])
    found.particles.extend([lower, Particle(plates[1], masses[1], above)])
    found.rotors.append(Rotor(i.tool, pose[3], AXES[2]))
    return found
