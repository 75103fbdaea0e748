"""The four mechanisms as trees of links: joints drive one side, the pose carries the other.

Joints and pose coordinates keep their names. Plates whose orientation parallelograms keep, only slide.
"""

from __future__ import annotations

from collections.abc import Callable

import casadi as ca

from kinematics.errors import InvalidValue
from kinematics.machine import TURN
from kinematics.model import Mechanism, Model
from kinematics.multibody.links import AXES, ORIGIN, Connection, Coupling, Link, Reference, Tree, TreeJoint, universal
from kinematics.robots.gough_stewart import GoughStewart
from kinematics.robots.heli4 import Heli4
from kinematics.robots.peppermill import Peppermill
from kinematics.robots.redundant_3t1r import Redundant3T1R


def link_tree(robot: Mechanism, reference: Reference) -> Tree:
    """The mechanism as a tree, in its model's symbols; angles of rods and legs count from the reference.

    Raises:
        InvalidValue: a mechanism that has none.
    """
    if type(robot) not in _TREES:
        known = ", ".join(kind.__name__ for kind in _TREES)
        raise InvalidValue("mechanism with a model for simulators", type(robot).__name__, f"one of {known}")
    return _TREES[type(robot)](robot.model(), reference)


def _translation(pose: ca.SX) -> tuple[TreeJoint, ...]:
    return tuple(TreeJoint("xyz"[k], "slide", AXES[k], ORIGIN, pose[k]) for k in range(3))


def _heli4(model: Model, _: Reference) -> Tree:
    pose, g = model.pose, model.g
    limbs = Heli4.limbs(g)
    arms = tuple(
        Link(f"arm {i + 1}", None, (TreeJoint(name, "hinge", axis, limbs.actuators[:, i], model.joints[i]),))
        for i, name in enumerate(Heli4.joint_names)
        for axis in [ca.cross(limbs.zero[:, i], limbs.quarter[:, i])]
    )
    lead = g.pitch / TURN
    plates = (
        Link("lower plate", None, _translation(pose)),
        Link("tool", "lower plate", (TreeJoint("theta", "hinge", AXES[2], pose[:3], pose[3]),)),
        Link("upper plate", "lower plate", (TreeJoint("nut", "slide", AXES[2], ORIGIN, lead * pose[3]),)),
    )
    return Tree(arms + plates, (Coupling("nut", "theta", lead),))


def _redundant(model: Model, _: Reference) -> Tree:
    pose, names = model.pose, Redundant3T1R.joint_names
    slides = tuple(
        Link(f"slide {i + 1}", None, (TreeJoint(name, "slide", AXES[0], ORIGIN, model.joints[i]),))
        for i, name in enumerate(names)
    )
    turn = TreeJoint("theta", "hinge", AXES[2], pose[:3], pose[3])
    return Tree((*slides, Link("platform", None, (*_translation(pose), turn))))


def _peppermill(model: Model, _: Reference) -> Tree:
    pose, joints, g = model.pose, model.joints, model.g
    carriages = Peppermill.points(pose, joints, g)[1]
    links, couplings, planes = [], [], []
    for i in range(2):
        slide = TreeJoint(f"d{i + 1}", "slide", AXES[i], ORIGIN, joints[i])
        turn = TreeJoint(f"theta{i + 1}", "hinge", AXES[i], carriages[:, i], joints[2 + i])
        links += [Link(f"carriage {i + 1}", None, (slide,)), Link(f"proximal {i + 1}", f"carriage {i + 1}", (turn,))]
        planes.append(Coupling("xy"[i], f"d{i + 1}", ca.SX(1)))
    links.append(Link("platform", None, _translation(pose)))
    links.append(Link("tool", "platform", (TreeJoint("theta", "hinge", AXES[2], pose[:3], pose[3]),)))
    for i in range(2):
        lead = g.pitches[i] / TURN
        nut = TreeJoint(f"nut{i + 1}", "slide", AXES[2], ORIGIN, lead * pose[3])
        links.append(Link(f"nut {i + 1}", "platform", (nut,)))
        couplings.append(Coupling(f"nut{i + 1}", "theta", lead))
    return Tree(tuple(links), tuple(couplings), hinges=(AXES[0], AXES[1]), planes=tuple(planes))


def _gough_stewart(model: Model, reference: Reference) -> Tree:
    pose, base = model.pose, GoughStewart.base_points(model.g)
    ends = base + GoughStewart.legs(pose, model.g)
    links, connections = [], []
    for i, name in enumerate(GoughStewart.joint_names):
        along = (ends[:, i] - base[:, i]) / ca.norm_2(ends[:, i] - base[:, i])
        slide = TreeJoint(name, "slide", along, ORIGIN, model.joints[i])
        links.append(Link(f"leg {i + 1}", None, (*universal(f"leg {i + 1}", base[:, i], along, reference), slide)))
        connections.append(Connection((f"leg {i + 1}", "platform"), ends[:, i]))
    turned = GoughStewart.rotation(pose)
    level = ca.vertcat(-ca.sin(pose[5]), ca.cos(pose[5]), 0)
    axes = zip(("yaw", "pitch", "roll"), (AXES[2], level, turned[:, 0]), (5, 4, 3), strict=True)
    turns = tuple(TreeJoint(name, "hinge", axis, pose[:3], pose[k]) for name, axis, k in axes)
    links.append(Link("platform", None, (*_translation(pose), *turns)))
    return Tree(tuple(links), connections=tuple(connections))


_TREES: dict[type[Mechanism], Callable[[Model, Reference], Tree]] = {
    Heli4: _heli4,
    Redundant3T1R: _redundant,
    Peppermill: _peppermill,
    GoughStewart: _gough_stewart,
}
