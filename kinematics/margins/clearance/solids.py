"""The solids that a robot's clearance is about: shapes of its members, of its base, and of its surroundings."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from itertools import combinations
from typing import NamedTuple

import casadi as ca
import numpy as np

from kinematics.errors import InvalidValue
from kinematics.machine import Member, Obstacle, PayloadHull, Plate
from kinematics.mathematics import Convex, signed_distance
from kinematics.model import Mechanism, Model

_BASE = "base"  # the joint of all that does not move
_HULL = "payload"
_ROUNDING = 1e-12  # of the robot's size


class Solid(NamedTuple):
    """All points within `radius` of `core`, at a pose."""

    member: Member
    core: Convex
    radius: ca.SX

    @property
    def length(self) -> ca.SX:
        """Of its first edge [m]."""
        return ca.norm_2(self.core.corners[:, 1] - self.core.corners[:, 0])

    @property
    def moves(self) -> bool:
        """Whether it is no part of the base."""
        return _BASE not in self.member.joints


class Pair(NamedTuple):
    """Two solids that must not touch."""

    one: Solid
    two: Solid

    @property
    def place(self) -> str:
        """The names of both members."""
        return f"{self.one.member.name} and {self.two.member.name}"

    @property
    def distance(self) -> ca.SX:
        """Between their surfaces [m]; minus the depth if they intersect."""
        return signed_distance(self.one.core, self.two.core) - self.thick

    @property
    def thick(self) -> ca.SX:
        """The sum of the radii [m]."""
        return self.one.radius + self.two.radius


class Walled(NamedTuple):
    """A solid that must stay on one side of walls: side * (coordinate - at) >= 0 for each (coordinate, at, side)."""

    solid: Solid
    name: str
    walls: tuple[tuple[int, float, float], ...]

    @property
    def place(self) -> str:
        """The names of the member and of the walls."""
        return f"{self.solid.member.name} and {self.name}"

    @property
    def distances(self) -> ca.SX:
        """(k,) of each corner from each wall [m]; minus the depth of those beyond it."""
        corners = self.solid.core.corners
        return ca.vertcat(*(side * (corners[i, :].T - at) for i, at, side in self.walls)) - self.solid.radius


class Rooms(NamedTuple):
    """Pairs, what is beside walls, and the distances of both in this order, (k,); infinite without any."""

    pairs: tuple[Pair, ...]
    walled: tuple[Walled, ...]
    distances: ca.SX


def rooms(robot: Mechanism) -> Rooms:
    """Everything that must not touch, at a pose.

    Raises:
        InvalidValue: a member joins nothing, or no member is the mechanism's `tool_member`.
    """
    return _rooms(robot, robot.model())


@lru_cache(maxsize=16)
def _rooms(robot: Mechanism, model: Model) -> Rooms:
    around = robot.surroundings
    members = robot.all_members(model.pose, model.joints, model.g)
    _require_joined(robot, members)
    if around.payload_hull is not None:
        hull = _hull_member(robot, around.payload_hull)
        held = {member.name for member in _carriers(robot)}
        members = [m._replace(joints=(*m.joints, *hull.joints)) if m.name in held else m for m in members] + [hull]
    solids = _solids(robot, members)
    boxes = [
        Solid(Member(box.name, (_BASE,), "", ()), Convex.box(box.low, box.high), ca.SX(0))
        for box in around.obstacles
        if not box.inside
    ]
    pairs = tuple(
        Pair(one, two)
        for one, two in combinations([*solids, *boxes], 2)
        if not set(one.member.joints) & set(two.member.joints)
    )
    moving = [solid for solid in solids if solid.moves]
    walled = tuple(Walled(solid, name, walls) for name, walls in _walls(robot) for solid in moving)
    found = [pair.distance for pair in pairs] + [ca.mmin(room.distances) for room in walled]
    return Rooms(pairs, walled, ca.vertcat(*found) if found else ca.SX(ca.inf))


class Lowest(NamedTuple):
    """The lowest point of the base: the member that it belongs to, and its height [m]."""

    member: str
    height: float


def lowest_of_base(robot: Mechanism) -> Lowest | None:
    """The lowest point of what belongs to the base, at home; None if the mechanism names no such member."""
    model = robot.model()
    solids = [
        solid for solid in _solids(robot, robot.base_members(model.pose, model.joints, model.g)) if not solid.moves
    ]
    if not solids:
        return None
    heights = _at_home(robot, [ca.mmin(solid.core.corners[2, :]) - solid.radius for solid in solids])
    lowest = int(np.argmin(heights))
    return Lowest(solids[lowest].member.name, float(heights[lowest]))


class Inside(NamedTuple):
    """A member that the payload's hull is inside, and how deep [m]."""

    member: str
    depth: float


def payload_inside(robot: Mechanism) -> Inside | None:
    """The member that the payload's hull is deepest inside at home; None if it is outside all members.

    Raises:
        InvalidValue: no member is the mechanism's `tool_member`.
    """
    hull, model = robot.surroundings.payload_hull, robot.model()
    if hull is None:
        return None
    _carriers(robot)  # there must be one
    members = robot.all_members(model.pose, model.joints, model.g)
    *solids, of_hull = _solids(robot, [*members, _hull_member(robot, hull)])
    depths = -_at_home(robot, [Pair(of_hull, one).distance for one in solids])
    depths = np.where(np.isfinite(depths), depths, -np.inf)  # a limb that cannot reach home has no place
    deepest = int(np.argmax(depths))
    if depths[deepest] <= _ROUNDING * robot.geometry.size:
        return None
    return Inside(solids[deepest].member.name, float(depths[deepest]))


def _at_home(robot: Mechanism, expressions: Sequence[ca.SX]) -> np.ndarray:
    model = robot.model()
    function = ca.Function("at_home", [model.pose, model.geometry], [ca.vertcat(*expressions)])
    return np.array(function(robot.home, robot.geometry.vector()))[:, 0]


def _solids(robot: Mechanism, members: Sequence[Member]) -> list[Solid]:
    """All shapes of the members, their points from one evaluation, so that equal terms are one node."""
    shapes = [(member, shape) for member in members for shape in member.shapes]
    if not shapes:
        return []
    at_pose = ca.cse(robot.model().at_pose(ca.horzcat(*(shape.corners for _, shape in shapes))))
    ends = np.cumsum([0, *(shape.corners.shape[1] for _, shape in shapes)]).tolist()
    placed = ca.horzsplit(at_pose, ends)
    return [
        Solid(member, Convex.polygon(corners) if isinstance(shape, Plate) else Convex(corners), shape.around)
        for (member, shape), corners in zip(shapes, placed, strict=True)
    ]


def _hull_member(robot: Mechanism, hull: PayloadHull) -> Member:
    """The payload as a capsule, or as a plate if it is flat."""
    shape = hull.shape(*robot.tool_frame(robot.model().pose))
    return Member(_HULL, (_HULL,), "", (shape,))


def _carriers(robot: Mechanism) -> list[Member]:
    """The member that carries the tool, and others of the same link."""
    model = robot.model()
    members = robot.members(model.pose, model.joints, model.g)
    links = {member.name: member.link or member.name for member in members}
    if robot.tool_member not in links:
        raise InvalidValue(f"{type(robot).__name__} tool_member", robot.tool_member, f"one of {', '.join(links)}")
    return [member for member in members if links[member.name] == links[robot.tool_member]]


def _walls(robot: Mechanism) -> list[tuple[str, tuple[tuple[int, float, float], ...]]]:
    """The name and the walls of the floor, and of each box that the robot must stay inside."""
    around = robot.surroundings
    found = [] if around.floor is None else [("the floor", ((2, around.floor, 1.0),))]
    return found + [(box.name, _faces(box)) for box in around.obstacles if box.inside]


def _faces(box: Obstacle) -> tuple[tuple[int, float, float], ...]:
    lower = [(i, at, 1.0) for i, at in enumerate(box.low)]
    upper = [(i, at, -1.0) for i, at in enumerate(box.high)]
    return (*lower, *upper)


def _require_joined(robot: Mechanism, members: Sequence[Member]) -> None:
    for member in members:
        others = {joint for other in members if other is not member for joint in other.joints} | {_BASE}
        if not set(member.joints) & others:
            what = f"{type(robot).__name__} member {member.name!r}, joints"
            raise InvalidValue(what, member.joints, 'a joint that another member has too, or "base"')
