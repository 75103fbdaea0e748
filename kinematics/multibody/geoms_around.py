"""A robot's surroundings as shapes of an MJCF document: floor, boxes, and the payload on the tool's body.

They are drawn and measured: they weigh nothing, and nothing collides with them.
"""

from __future__ import annotations

from xml.etree import ElementTree as Xml

import numpy as np

from kinematics.arrays import Array
from kinematics.errors import InvalidValue
from kinematics.machine import Member, Obstacle, Reference, Tube
from kinematics.model import Mechanism
from kinematics.multibody.geoms import WEIGHTLESS, every_digit
from kinematics.multibody.payload import PAYLOAD, payload_shape

_LIGHT = "0.6 0.6 0.6 0.3"
_THICK = 0.01  # of a frame's smallest side: how thick its walls are drawn
_ROUND = 16  # steps of half a turn around a flat payload's rim


def add_floor_and_boxes(robot: Mechanism, world: Xml.Element) -> None:
    """Add floor and boxes to the world. A box that the robot stays inside becomes six walls around it."""
    around = robot.surroundings
    if around.floor is not None:
        place = {"pos": every_digit(np.array([0.0, 0.0, around.floor])), "size": "0 0 1"}
        _add(world, "the floor", type="plane", **place)
    for box in around.obstacles:
        boxes = _walls(box) if box.inside else [np.array([box.low, box.high])]
        for k, (low, high) in enumerate(boxes, start=1):
            name = f"{box.name}, {k}" if box.inside else box.name
            _add(world, name, type="box", pos=every_digit((low + high) / 2), size=every_digit((high - low) / 2))


def add_payload(
    robot: Mechanism, members: list[Member], bodies: dict[str, Xml.Element], asset: Xml.Element, reference: Reference
) -> None:
    """Add the payload's hull to the body of the tool's member; arguments as of `add_geoms`.

    Raises:
        InvalidValue: the tool's member has no body.
    """
    shape = payload_shape(robot, robot.model())
    holder = next((member for member in members if member.name == robot.tool_member), None)
    if shape is None:
        return
    if holder is None or (holder.link or holder.name) not in bodies:
        expected = f"a member with a body of its own: one of {', '.join(m.name for m in members if m.name in bodies)}"
        raise InvalidValue(f"{type(robot).__name__} tool_member", robot.tool_member, expected)
    body = bodies[holder.link or holder.name]
    corners, around = np.array(reference(shape.corners)).T, float(reference(shape.around))
    if isinstance(shape, Tube):
        _add(body, PAYLOAD, type="capsule", fromto=every_digit(corners), size=every_digit(around))
    else:
        Xml.SubElement(asset, "mesh", name=PAYLOAD, vertex=every_digit(_rounded(corners, around)))
        _add(body, PAYLOAD, type="mesh", mesh=PAYLOAD)


def _add(body: Xml.Element, name: str, **attributes: str) -> None:
    Xml.SubElement(body, "geom", WEIGHTLESS, name=name, rgba=_LIGHT, **attributes)


def _walls(box: Obstacle) -> list[Array]:
    """(2, 3) low and high corners of six walls around a box."""
    ends = np.array([box.low, box.high])
    thick = _THICK * float((ends[1] - ends[0]).min())
    outside = ends + thick * np.array([[-1.0], [1.0]])
    walls = []
    for axis in range(3):
        for side in (0, 1):
            wall = outside.copy()
            wall[1 - side, axis] = ends[side, axis]
            walls.append(wall)
    return walls


def _rounded(corners: Array, around: float) -> Array:
    """(k, 3) points on the rim of a plate: half circles around each corner, towards the corner and its neighbours."""
    centre = corners.mean(axis=0)
    spokes = (corners - centre) / np.linalg.norm(corners - centre, axis=1, keepdims=True)
    normal = np.cross(spokes[0], spokes[1])
    normal /= np.linalg.norm(normal)
    between = spokes + np.roll(spokes, 1, axis=0)
    between /= np.linalg.norm(between, axis=1, keepdims=True)
    ways = np.stack([between, spokes, np.roll(between, -1, axis=0)], axis=1)
    angles = np.linspace(-np.pi / 2, np.pi / 2, _ROUND + 1)[:, None, None, None]
    points = corners[:, None] + around * (np.cos(angles) * ways + np.sin(angles) * normal)
    return np.asarray(points.reshape(-1, 3))
