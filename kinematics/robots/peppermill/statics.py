"""How the Peppermill's limbs bear a load, and give way.

With locked drives limb i is a chain of two parallel revolute joints, which transmit all but the moment about their
axis a_i and a force across the distal link in the limb's plane: two forces and two moments at the nut. The nut turns
freely on its screw, and rises as it turns. So the platform and its two nuts have eight freedoms: the twist; two tilts,
which the nuts share; and each nut's own turn about e_z.
"""

from __future__ import annotations

from types import SimpleNamespace
from typing import TYPE_CHECKING

import casadi as ca

from kinematics.machine import TURN, Cut, LimbStatics
from kinematics.robots.shared import beam

if TYPE_CHECKING:
    from kinematics.robots.peppermill.peppermill import Peppermill

_FREEDOMS = 8  # x, y, z, theta, omega_x, omega_y, turn of nut 1, turn of nut 2
_E_Z = ca.DM([0, 0, 1])


def statics(robot: Peppermill, pose: ca.SX, joints: ca.SX, g: SimpleNamespace) -> list[LimbStatics]:
    """The hook `statics`: each limb transmits, at its nut, the distal link's tension, the force along a_i, the moment
    about the distal link, and that about the normal of both.
    """
    _, carriages, elbows, nuts = robot.points_apart(pose, joints, g)
    members = {member.name: member for member in robot.members(pose, joints, g)}
    found = []
    for i in range(2):
        drive_axis = ca.DM.eye(3)[:, i]
        near, far = g.proximal_lengths[i], g.distal_lengths[i]
        distal = beam(members[f"distal link {i + 1}"], (nuts[:, i] - elbows[:, i]) / far, far, robot.structure)
        proximal = beam(
            members[f"proximal link {i + 1}"], (elbows[:, i] - carriages[:, i]) / near, near, robot.structure
        )
        force = ca.horzcat(distal.along, drive_axis, ca.SX(3, 2))
        moment = ca.horzcat(ca.SX(3, 2), distal.along, ca.cross(drive_axis, distal.along))
        at_elbow = distal.moment_at_root(force, moment)
        root = proximal.moment_at_root(force, at_elbow)
        joints_give = ca.diag(ca.vertcat(2 / robot.structure.joint_stiffness, 0, 0, 0))
        compliance = distal.compliance(force, moment) + proximal.compliance(force, at_elbow) + joints_give
        efforts = ca.SX(4, 4)
        efforts[[i, 2 + i], :] = -ca.vertcat(drive_axis.T @ force, drive_axis.T @ root)
        cuts = (
            Cut(f"proximal link {i + 1}", proximal.along, force, root),
            Cut(f"proximal link {i + 1}", proximal.along, force, at_elbow),
            Cut(f"distal link {i + 1}", distal.along, force, at_elbow),
            Cut(f"distal link {i + 1}", distal.along, force, moment),
        )
        found.append(LimbStatics(-_on_freedoms(force, moment, nuts[:, i], i, pose, g), compliance, efforts, cuts))
    return found


def _on_freedoms(force: ca.SX, moment: ca.SX, nut: ca.SX, limb: int, pose: ca.SX, g: SimpleNamespace) -> ca.SX:
    """(8, k) of loads on a nut (3, k): the nut rises with the screw's turn less its own."""
    lead, about_tool = g.pitches[limb] / TURN, moment + ca.skew(nut - pose[:3]) @ force
    up, turn = _E_Z.T @ force, _E_Z.T @ moment
    own_turn = turn - lead * up
    other = ca.SX(1, force.shape[1])
    turns = (own_turn, other) if limb == 0 else (other, own_turn)
    return ca.vertcat(force, lead * up, about_tool[:2, :], *turns)
