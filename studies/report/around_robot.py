"""Floor, boxes and payload in the picture of a robot, as far as they are near it."""

from __future__ import annotations

from itertools import product
from typing import Any, NamedTuple

import numpy as np
from matplotlib.patches import Patch
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

from kinematics import Array, Mechanism, Obstacle, placed_payload
from studies.report.solids import faces

_NEAR = 0.3  # of the longest side of the robot's box: how far around it the surroundings are drawn
_ASIDE = 0.1  # the same, of the floor's edges
_FLOOR, _BOXES, _FRAME, _PAYLOAD = "#8a8a8a", ("#edae49", "#6a4c93", "#8a5a44"), "#5b8db8", "#3c7a3f"
_LIGHT = {_FRAME: 0.06, _PAYLOAD: 0.45}  # how opaque a colour is
_USUAL = 0.2


class Part(NamedTuple):
    """Something around a robot: its name for people, its colour, and its faces (4, 3) near the robot."""

    name: str
    colour: str
    polygons: list[Array]

    @property
    def handle(self) -> Patch:
        """What a legend shows."""
        name = self.name if self.polygons else f"{self.name} (too far away to be drawn)"
        return Patch(facecolor=self.colour, alpha=_LIGHT.get(self.colour, _USUAL) + 0.2, label=name)


def parts_around(robot: Mechanism, pose: Array, low: Array, high: Array) -> list[Part]:
    """The robot's surroundings near a box from `low` to `high`, (3,) each, at a pose (n,)."""
    around, size = robot.surroundings, float((high - low).max())
    near, under = (np.array([low - far, high + far]) for far in (_NEAR * size, _ASIDE * size))
    parts = []
    if around.floor is not None:
        level = np.array([[*under[0, :2], around.floor], [*under[1, :2], around.floor]])
        parts.append(Part(f"floor at z = {around.floor:g} m", _FLOOR, _sides(level, near, [(2, 0)])))
    for k, box in enumerate(around.obstacles):
        name = f"{box.name} (the robot stays inside)" if box.inside else box.name
        parts.append(Part(name, _FRAME if box.inside else _BOXES[k % len(_BOXES)], _of_box(box, near)))
    payload = placed_payload(robot, pose)
    if payload is not None and np.isfinite(payload.corners).all():
        parts.append(Part(payload.member, _PAYLOAD, faces(payload)))
    return parts


def draw_parts(axes: Any, parts: list[Part]) -> None:
    """Draw the parts on axes in 3-D, so that the robot is seen through them."""
    for part in parts:
        if part.polygons:
            opaque = _LIGHT.get(part.colour, _USUAL)
            edges = "none" if part.colour == _PAYLOAD else (part.colour, 0.5)
            axes.add_collection3d(
                Poly3DCollection(part.polygons, facecolors=part.colour, edgecolors=edges, linewidths=0.5, alpha=opaque)
            )


def _of_box(box: Obstacle, near: Array) -> list[Array]:
    """The faces of a box that are near; of a box to stay out of, all faces of its near part."""
    ends, every = np.array([box.low, box.high]), list(product(range(3), (0, 1)))
    if box.inside:
        return _sides(ends, near, every)
    clipped = np.clip(ends, *near)
    return _sides(clipped, near, every) if (clipped[0] < clipped[1]).all() else []


def _sides(ends: Array, near: Array, wanted: list[tuple[int, int]]) -> list[Array]:
    """(4, 3) each: the near part of the wanted sides (axis, end) of a box (2, 3)."""
    found = []
    for axis, end in wanted:
        one, two = (k for k in range(3) if k != axis)
        clipped = np.clip(ends, *near)
        seen = near[0, axis] <= ends[end, axis] <= near[1, axis]
        if seen and clipped[0, one] < clipped[1, one] and clipped[0, two] < clipped[1, two]:
            side = np.empty((4, 3))
            side[:, axis] = ends[end, axis]
            side[:, one], side[:, two] = clipped[[0, 1, 1, 0], one], clipped[[0, 0, 1, 1], two]
            found.append(side)
    return found
