"""The Gough-Stewart platform's links for simulators: each leg turns on a universal joint and slides along itself."""

from __future__ import annotations

from types import SimpleNamespace
from typing import TYPE_CHECKING

import casadi as ca

from kinematics.machine import AXES, ORIGIN, Connection, Link, Reference, Tree, TreeJoint, universal
from kinematics.mathematics import rotation_symbolic

if TYPE_CHECKING:
    from kinematics.robots.gough_stewart.gough_stewart import GoughStewart


def links(robot: GoughStewart, pose: ca.SX, joints: ca.SX, g: SimpleNamespace, reference: Reference) -> Tree:
    """The hook `link_tree`: the legs' angles count from the reference."""
    base = robot.base_points(g)
    ends = base + robot.legs(pose, g)
    chain, connections = [], []
    for i, name in enumerate(robot.joint_names):
        along = (ends[:, i] - base[:, i]) / ca.norm_2(ends[:, i] - base[:, i])
        slide = TreeJoint(name, "slide", along, ORIGIN, joints[i])
        chain.append(Link(f"leg {i + 1}", None, (*universal(f"leg {i + 1}", base[:, i], along, reference), slide)))
        connections.append(Connection((f"leg {i + 1}", "platform"), ends[:, i]))
    turned = rotation_symbolic(pose[3:])
    level = ca.vertcat(-ca.sin(pose[5]), ca.cos(pose[5]), 0)
    axes = zip(("yaw", "pitch", "roll"), (AXES[2], level, turned[:, 0]), (5, 4, 3), strict=True)
    slides = (TreeJoint("xyz"[k], "slide", AXES[k], ORIGIN, pose[k]) for k in range(3))
    turns = (TreeJoint(name, "hinge", axis, pose[:3], pose[k]) for name, axis, k in axes)
    chain.append(Link("platform", None, (*slides, *turns)))
    return Tree(tuple(chain), connections=tuple(connections))
