"""Heli4's links for simulators: arms on the base, and plates that cannot turn because of the rods."""

from __future__ import annotations

from types import SimpleNamespace
from typing import TYPE_CHECKING

import casadi as ca

from kinematics.machine import AXES, ORIGIN, TURN, Coupling, Link, Reference, Tree, TreeJoint

if TYPE_CHECKING:
    from kinematics.robots.heli4.heli4 import Heli4


def links(robot: Heli4, pose: ca.SX, joints: ca.SX, g: SimpleNamespace, reference: Reference) -> Tree:  # noqa: ARG001
    """The hook `link_tree`: the upper plate rides as a nut on the tool's screw."""
    limbs = robot.limbs(g)
    arms = tuple(
        Link(f"arm {i + 1}", None, (TreeJoint(name, "hinge", axis, limbs.actuators[:, i], joints[i]),))
        for i, name in enumerate(robot.joint_names)
        for axis in [ca.cross(limbs.zero[:, i], limbs.quarter[:, i])]
    )
    lead = g.pitch / TURN
    slides = tuple(TreeJoint("xyz"[k], "slide", AXES[k], ORIGIN, pose[k]) for k in range(3))
    plates = (
        Link("lower plate", None, slides),
        Link("tool", "lower plate", (TreeJoint("theta", "hinge", AXES[2], pose[:3], pose[3]),)),
        Link("upper plate", "lower plate", (TreeJoint("nut", "slide", AXES[2], ORIGIN, lead * pose[3]),)),
    )
    return Tree(arms + plates, (Coupling("nut", "theta", lead),))
