"""The components of a requirement that a nonlinear program needs.

A margin such as the clearance has hundreds of components, of which few come near the bound. The program gets these; all
others are looked at in its answer, and it is solved again with those that break the bound there. So the answer keeps
every component.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import casadi as ca
import numpy as np

from kinematics import Array, FviBounds, Mechanism, Model, evaluate

if TYPE_CHECKING:
    from design.synthesis.nlp import Problem

_FEW = 24  # a margin with no more components keeps all
_FIRST = 8  # of more components, so many at first


class NearComponents:
    """The components of each requirement's margin that are kept, over the poses (p, n)."""

    def __init__(self, problem: Problem, poses: Array, start: Array) -> None:
        """Of small margins all, of others those with the least room at the start (k,)."""
        self._problem, self._poses = problem, poses
        self.kept: dict[str, list[int]] = {}
        for name, room in self._room(start).items():
            count = len(room) if len(room) <= _FEW else _FIRST
            self.kept[name] = sorted(np.argsort(room, kind="stable")[:count].tolist())

    def grown(self, values: Array) -> bool:
        """Add the components that break their bound at the values (k,) of the variables; whether there were any."""
        before = sum(map(len, self.kept.values()))
        for name, room in self._room(values).items():
            broken = np.flatnonzero(room < 0.0).tolist()
            self.kept[name] = sorted({*self.kept[name], *broken})
        return sum(map(len, self.kept.values())) > before

    def _room(self, values: Array) -> dict[str, Array]:
        """By margin, (c,) the least distance of each component from the bound; inf where it has no value."""
        problem = self._problem
        robot = problem.robot_with(values)
        found: dict[str, Array] = {}
        for r in problem.requirements:
            measured = problem.fvi_bounds, problem.characteristic_length
            (parts,) = evaluate(robot.program(_components, r.margin, *measured), self._poses)
            room = r.bound.sense * (parts.reshape(len(self._poses), -1) - r.bound.value)
            least = np.where(np.isnan(room), np.inf, room).min(axis=0)
            found[r.margin] = np.minimum(least, found.get(r.margin, np.inf))
        return found


def _components(
    robot: Mechanism, model: Model, name: str, bounds: FviBounds, length: float
) -> tuple[list[ca.SX], list[ca.SX]]:
    return [model.pose], [robot.margin_components(name, bounds, length)]
