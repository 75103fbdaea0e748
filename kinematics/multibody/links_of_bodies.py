"""The links of a mechanism and their joints, derived from the points of its bodies.

A link is moved by one driven joint, or by coordinates of the pose. Its joints have the same names. A check makes sure
that they move each point of the link as the bodies do.
"""

from __future__ import annotations

import casadi as ca
import numpy as np

from kinematics.arrays import Array
from kinematics.coordinates import LENGTHS, is_length
from kinematics.errors import InvalidValue
from kinematics.machine import AXES, ORIGIN, Bodies, Link, Tree, TreeJoint
from kinematics.model import Mechanism, Model

_SAME = 1e-9  # of the largest velocity of a point: what rounding may change
_TRIES, _FAR = 4, 0.2  # poses at which a tree is checked; how far they are off [rad, or of the robot's size]
_ORDER = ("x", "y", "z", "theta", "yaw", "pitch", "roll")  # of the pose's coordinates, outermost first


def links_of_bodies(robot: Mechanism, model: Model, bodies: Bodies) -> Tree:
    """The tree whose links are those of the bodies.

    Raises:
        InvalidValue: it names a link that is moved in another way, or a joint that moves no link.
    """
    points = _points_by_link(bodies)
    names = (*robot.joint_names, *robot.pose_names)
    moved = {link: _movers(model, names, points[link]) for link in points}
    driven = {link: by for link, by in moved.items() if set(by) <= set(robot.joint_names)}
    carried = {link: by for link, by in moved.items() if link not in driven}
    links = [*_driven_links(robot, model, driven, points), *_carried_links(robot, model, carried)]
    held = {joint.name for link in links for joint in link.joints}
    for name in names:
        if name not in held:
            raise _unclear(robot, f"no link that {name} moves")
    tree = Tree(tuple(links))
    _check(robot, model, tree, points)
    return tree


def _points_by_link(bodies: Bodies) -> dict[str, list[ca.SX]]:
    points: dict[str, list[ca.SX]] = {}
    for particle in bodies.particles:
        points.setdefault(particle.link, []).append(particle.point)
    for rod in bodies.rods:
        for link, end in zip(rod.links, (rod.start, rod.end), strict=True):
            points.setdefault(link, []).append(end)
    return points


def _movers(model: Model, names: tuple[str, ...], points: list[ca.SX]) -> tuple[str, ...]:
    """The joints and coordinates that some point of a link depends on."""
    depends = ca.which_depends(ca.vertcat(*points), ca.vertcat(model.joints, model.pose), 1, False)
    return tuple(name for name, moves in zip(names, depends, strict=True) if moves)


def _driven_links(
    robot: Mechanism, model: Model, moved: dict[str, tuple[str, ...]], points: dict[str, list[ca.SX]]
) -> list[Link]:
    """Each on the base; what the same joint moves is fixed to the first."""
    links: list[Link] = []
    first: dict[str, str] = {}
    for link, by in moved.items():
        if len(by) > 1:
            raise _unclear(robot, f"{link}, which {' and '.join(by)} move")
        if not by:
            links.append(Link(link, None, ()))
        elif by[0] in first:
            links.append(Link(link, first[by[0]], ()))
        else:
            k = robot.joint_names.index(by[0])
            links.append(Link(link, None, (_driven_joint(robot, model, k, points[link]),)))
            first[by[0]] = link
    return links


def _driven_joint(robot: Mechanism, model: Model, k: int, points: list[ca.SX]) -> TreeJoint:
    """From the first point that moves: a slide along its velocity, or a hinge about the centre of its circle."""
    name, coordinate = robot.joint_names[k], model.joints[k]
    point = next(p for p in points if ca.depends_on(p, coordinate))
    velocity = ca.jacobian(point, coordinate)
    if robot.joint_units[k] == "m":
        return TreeJoint(name, "slide", velocity, ORIGIN, coordinate)
    to_centre = ca.jacobian(velocity, coordinate)
    axis = ca.cross(velocity, to_centre)  # on a circle to_centre = c - p, and velocity = axis x (p - c)
    return TreeJoint(name, "hinge", axis / ca.norm_2(axis), point + to_centre, coordinate)


def _carried_links(robot: Mechanism, model: Model, moved: dict[str, tuple[str, ...]]) -> list[Link]:
    """One on the other, each with the coordinates that the one before it lacks; the last has those that are left."""
    links: list[Link] = []
    have: set[str] = set()
    ordered = sorted(moved, key=lambda link: len(moved[link]))
    for link in ordered:
        by = set(moved[link])
        if not have <= by or not by <= set(robot.pose_names):
            raise _unclear(robot, f"{link}, which {', '.join(moved[link])} move")
        left = set(robot.pose_names) - have if link == ordered[-1] else by - have
        joints = tuple(_carried_joint(robot, model, name) for name in _ORDER if name in left)
        links.append(Link(link, links[-1].name if links else None, joints))
        have |= by
    return links


def _carried_joint(robot: Mechanism, model: Model, name: str) -> TreeJoint:
    """x, y, z slide, theta and yaw turn about z, pitch and roll about the axes that these have turned."""
    pose = dict(zip(robot.pose_names, ca.vertsplit(model.pose), strict=True))
    if is_length(name):
        return TreeJoint(name, "slide", AXES["xyz".index(name)], ORIGIN, pose[name])
    anchor = ca.vertcat(*(pose.get(c, ca.SX(0)) for c in LENGTHS))
    axis = AXES[2]
    if name in ("pitch", "roll"):
        axis = ca.vertcat(-ca.sin(pose["yaw"]), ca.cos(pose["yaw"]), 0)
    if name == "roll":
        level = ca.vertcat(ca.cos(pose["yaw"]), ca.sin(pose["yaw"]), 0)
        axis = ca.cos(pose["pitch"]) * level - ca.sin(pose["pitch"]) * AXES[2]
    return TreeJoint(name, "hinge", axis, anchor, pose[name])


def _check(robot: Mechanism, model: Model, tree: Tree, points: dict[str, list[ca.SX]]) -> None:
    """Check, about home, that the joints between a link and the base move its points as the bodies say.

    Raises:
        InvalidValue: naming the link.
    """
    parents = {link.name: link for link in tree.links}
    free = ca.vertcat(model.joints, model.pose)
    names = (*robot.joint_names, *robot.pose_names)
    wanted, given = [], []
    for link in tree.links:
        chain: list[TreeJoint] = []
        at: str | None = link.name
        while at is not None:
            chain, at = [*chain, *parents[at].joints], parents[at].parent
        columns = {joint.name: joint for joint in chain}
        point = points[link.name]
        wanted.append(ca.jacobian(ca.vertcat(*point), free))
        given.append(ca.horzcat(*(ca.vertcat(*(_velocity(columns.get(name), p) for p in point)) for name in names)))
    ends = np.cumsum([0, *(w.shape[0] for w in wanted)])
    function = ca.Function("check", [free, model.geometry], [ca.vertcat(*wanted), ca.vertcat(*given)])
    for state in _states(robot):
        says, moves = (np.array(v) for v in function(state, ca.DM(robot.geometry.vector())))
        off = np.abs(says - moves) > _SAME * np.abs(says).max()
        for k, link in enumerate(tree.links):
            if off[ends[k] : ends[k + 1]].any():
                raise _unclear(robot, f"{link.name}, which moves in another way")


def _velocity(joint: TreeJoint | None, point: ca.SX) -> ca.SX:
    """(3,) of a point for a unit speed of a joint between its link and the base; none of any other joint."""
    if joint is None:
        return ca.SX(3, 1)
    return joint.axis if joint.kind == "slide" else ca.cross(joint.axis, point - joint.anchor)


def _states(robot: Mechanism) -> list[Array]:
    """(m + n,) joints and poses about home; they need not belong together, as each point depends on one kind."""
    rng = np.random.default_rng(0)
    about = np.concatenate([robot.inverse(robot.home), robot.home])
    lengths = [unit == "m" for unit in robot.joint_units] + [is_length(name) for name in robot.pose_names]
    steps = _FAR * np.where(lengths, robot.geometry.size, 1.0)
    return [about + rng.uniform(-1.0, 1.0, about.size) * steps for _ in range(_TRIES)]


def _unclear(robot: Mechanism, found: str) -> InvalidValue:
    expected = "links that one joint or the pose alone moves; or the hook `link_tree`, which describes how they move"
    return InvalidValue(f"links of {type(robot).__name__} for simulators", found, expected)
