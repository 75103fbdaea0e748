"""Par4's links for simulators: arms on the base; a crank for the bars, and halves that keep their orientation on it."""

from __future__ import annotations

from types import SimpleNamespace
from typing import TYPE_CHECKING

import casadi as ca

from kinematics.machine import AXES, ORIGIN, Coupling, Link, Reference, Tree, TreeJoint

if TYPE_CHECKING:
    from kinematics.robots.par4.par4 import Par4


def links(robot: Par4, pose: ca.SX, joints: ca.SX, g: SimpleNamespace, reference: Reference) -> Tree:  # noqa: ARG001
    """The hook `link_tree`: bars and halves follow the tool, by the gear and the parallelogram."""
    limbs, psi = robot.limbs(g), pose[3] / g.amplification
    axes, half = limbs.axes(), robot.half_bar(psi, g)
    arms = tuple(
        Link(f"arm {i + 1}", None, (TreeJoint(name, "hinge", axes[:, i], limbs.actuators[:, i], joints[i]),))
        for i, name in enumerate(robot.joint_names)
    )
    slides = tuple(TreeJoint("xyz"[k], "slide", AXES[k], ORIGIN, pose[k]) for k in range(3))
    platform = (
        Link("bars", None, slides),  # their mass sits at the tool point
        Link("tool", "bars", (TreeJoint("theta", "hinge", AXES[2], pose[:3], pose[3]),)),
        Link("crank", "bars", (TreeJoint("psi", "hinge", AXES[2], pose[:3], psi),)),
        Link("half 1", "crank", (TreeJoint("half1", "hinge", AXES[2], pose[:3] - half, -psi),)),
        Link("half 2", "crank", (TreeJoint("half2", "hinge", AXES[2], pose[:3] + half, -psi),)),
    )
    rates = {"psi": 1 / g.amplification, "half1": -1 / g.amplification, "half2": -1 / g.amplification}
    return Tree(arms + platform, tuple(Coupling(name, "theta", rate) for name, rate in rates.items()))
