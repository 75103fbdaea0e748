"""A mechanism's tree of links with its masses, about a reference pose."""

from __future__ import annotations

from typing import NamedTuple

import casadi as ca
import numpy as np

from kinematics.arrays import Array, checked
from kinematics.dynamics import derivatives_along, moving_bodies, require_payload
from kinematics.errors import InvalidValue
from kinematics.evaluation import evaluate
from kinematics.machine import Bodies, Connection, Link, Particle, Reference, Tree, TreeJoint, universal
from kinematics.model import Build, Mechanism, Model
from kinematics.multibody.links_of_bodies import links_of_bodies


class OpenTree(NamedTuple):
    """What the loops are cut into.

    Attributes:
        tree: links, those of rods included where rods are bodies, and what closes the loops.
        bodies: the masses.
        reference: an expression's value at the pose that angles of rods and legs count from.
        rods_are_bodies: else their masses sit at their ends, and a constant length stands for each.
    """

    tree: Tree
    bodies: Bodies
    reference: Reference
    rods_are_bodies: bool

    def particles(self) -> list[Particle]:
        """Every particle on its link, its mass a number."""
        if self.rods_are_bodies:
            rods = range(len(self.bodies.rods))
            own = [*self.bodies.particles, *(p for k in rods for p in self.bodies.rod_particles(k))]
        else:
            own = self.bodies.all_particles()
        return [p._replace(mass=float(self.reference(ca.SX(p.mass)))) for p in own]


def open_tree(robot: Mechanism, pose: Array, payload: float) -> OpenTree:
    """The mechanism cut open; rods are bodies where some of their mass is at the middle.

    Args:
        robot: one whose links follow from its bodies, or that has the hook `link_tree`.
        pose: (n,) the reference.
        payload: mass at the tool [kg].

    Raises:
        InvalidValue: its links do not follow from its bodies, more than one pose, or a payload that is no mass.
        UnreachablePose: a limb cannot reach the pose.
    """
    pose, model = checked(pose, "pose", robot.pose_names), robot.model()
    if pose.ndim != 1:
        raise InvalidValue("reference pose", f"an array of shape {pose.shape}", "one pose")
    require_payload(payload)
    robot.require_reachable(pose)
    numbers = [ca.DM(v) for v in (pose, robot.inverse(pose), robot.geometry.vector())]

    def reference(expression: ca.SX) -> ca.DM:
        return ca.Function("at", [model.pose, model.joints, model.geometry], [expression])(*numbers)

    bodies = moving_bodies(robot, model, payload)
    tree = robot.link_tree(model.pose, model.joints, model.g, reference) or links_of_bodies(robot, model, bodies)
    if all(rod.split for rod in bodies.rods):
        return OpenTree(tree._replace(couplings=tree.couplings + tree.planes), bodies, reference, False)
    links, connections = _rod_links(bodies, tree, reference)
    whole = tree._replace(links=tree.links + links, connections=tree.connections + connections)
    return OpenTree(whole, bodies, reference, True)


def _rod_links(bodies: Bodies, tree: Tree, reference: Reference) -> tuple[tuple[Link, ...], tuple[Connection, ...]]:
    """Each rod as a link of its own: hung on its first link, which sees its angles, and connected to the second."""
    links, connections = [], []
    for k, rod in enumerate(bodies.rods):
        name, span = f"rod {k + 1}", _turn(tree, rod.links[0], reference).T @ (rod.end - rod.start)
        if tree.hinges:
            axis, before = tree.hinges[k], reference(span)
            angle = ca.atan2(ca.dot(ca.cross(before, span), axis), ca.dot(before, span))
            joints: tuple[TreeJoint, ...] = (TreeJoint(name, "hinge", axis, rod.start, angle),)
        else:
            joints = universal(name, rod.start, span, reference)
        links.append(Link(name, rod.links[0], joints))
        connections.append(Connection((name, rod.links[1]), rod.end))
    return tuple(links), tuple(connections)


def _turn(tree: Tree, link: str | None, reference: Reference) -> ca.SX:
    """(3, 3) by what rotation a link is turned from the reference."""
    if link is None:
        return ca.SX.eye(3)
    joints, parent = next((some.joints, some.parent) for some in tree.links if some.name == link)
    turn = _turn(tree, parent, reference)
    for joint in joints:
        if joint.kind == "hinge":
            axis, angle = ca.skew(reference(joint.axis)), joint.coordinate - reference(joint.coordinate)
            turn = turn @ (ca.SX.eye(3) + ca.sin(angle) * axis + (1 - ca.cos(angle)) * (axis @ axis))
    return turn


def tree_motion(
    robot: Mechanism, reference: Array, pose: Array, velocity: Array, acceleration: Array
) -> dict[str, tuple[Array, Array, Array]]:
    """Each of the tree's joints by name: its coordinate and time derivatives, (...,) each [rad or m].

    Args:
        robot, reference: as for `open_tree`.
        pose, velocity, acceleration: (..., n) the motion.
    """
    program = robot.program(_tree_motion, tuple(np.asarray(reference).tolist()))
    found = evaluate(program, *np.broadcast_arrays(pose, velocity, acceleration))
    names = [joint.name for joint in _tree_joints(robot, reference)]
    return {name: (found[0][..., k], found[1][..., k], found[2][..., k]) for k, name in enumerate(names)}


def _tree_joints(robot: Mechanism, reference: Array) -> list[TreeJoint]:
    return [joint for link in open_tree(robot, reference, 0.0).tree.links for joint in link.joints]


def _tree_motion(robot: Mechanism, model: Model, reference: tuple[float, ...]) -> Build:
    rates = [ca.SX.sym(name, model.pose.shape[0]) for name in ("velocity", "acceleration")]
    coordinates = ca.vertcat(*(joint.coordinate for joint in _tree_joints(robot, np.array(reference))))
    return [model.pose, *rates], derivatives_along(model.at_pose(coordinates), model.pose, rates)
