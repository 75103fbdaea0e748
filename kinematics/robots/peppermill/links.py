"""Peppermill's links for simulators: a carriage and a proximal link for each limb; the platform with its two nuts."""

from __future__ import annotations

from types import SimpleNamespace
from typing import TYPE_CHECKING

import casadi as ca

from kinematics.machine import AXES, ORIGIN, TURN, Coupling, Link, Reference, Tree, TreeJoint

if TYPE_CHECKING:
    from kinematics.robots.peppermill.peppermill import Peppermill


def links(robot: Peppermill, pose: ca.SX, joints: ca.SX, g: SimpleNamespace, reference: Reference) -> Tree:  # noqa: ARG001
    """The hook `link_tree`: rods as bodies turn about the drives' axes, and keep the platform's x and y."""
    carriages = robot.points(pose, joints, g)[1]
    chain, couplings, planes = [], [], []
    for i in range(2):
        slide = TreeJoint(f"d{i + 1}", "slide", AXES[i], ORIGIN, joints[i])
        turn = TreeJoint(f"theta{i + 1}", "hinge", AXES[i], carriages[:, i], joints[2 + i])
        chain += [
            Link(f"carriage {i + 1}", None, (slide,)),
            Link(f"proximal link {i + 1}", f"carriage {i + 1}", (turn,)),
        ]
        planes.append(Coupling("xy"[i], f"d{i + 1}", ca.SX(1)))
    slides = tuple(TreeJoint("xyz"[k], "slide", AXES[k], ORIGIN, pose[k]) for k in range(3))
    chain.append(Link("platform", None, slides))
    chain.append(Link("tool", "platform", (TreeJoint("theta", "hinge", AXES[2], pose[:3], pose[3]),)))
    for i in range(2):
        lead = g.pitches[i] / TURN
        nut = TreeJoint(f"nut{i + 1}", "slide", AXES[2], ORIGIN, lead * pose[3])
        chain.append(Link(f"nut {i + 1}", "platform", (nut,)))
        couplings.append(Coupling(f"nut{i + 1}", "theta", lead))
    return Tree(tuple(chain), tuple(couplings), hinges=(AXES[0], AXES[1]), planes=tuple(planes))
