"""Poses at which a statement is false by more than rounding. Interval arithmetic shows it.

Plain evaluation only chooses the poses that are tried.
"""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca
import numpy as np

from design.certificates.scaled_rows import ScaledRows
from design.claims import Statement
from design.regions import Region
from kinematics import Array, ClaimSymbols, Value, enclose

_MOST = 1024  # poses that are tried together, the worst first


@dataclass(frozen=True, eq=False)
class Refutation(Value):
    """A pose (n,) of the region where the margin breaks the bound, or where a limb cannot reach."""

    pose: Array
    within_reach: bool


class Refuter:
    """Finds poses that refute one statement."""

    def __init__(self, statement: Statement) -> None:
        self.statement = statement
        robot, claim = statement.robot, ClaimSymbols.fresh()
        model = robot.model()
        reach = robot.reach(model.pose, model.g)
        shown = robot.margins[statement.margin].to_refute(robot, claim)
        self._limbs = reach.numel()
        self._scaled = ScaledRows(statement, claim, shown)
        self._rows = self._scaled.program(ca.vertcat(reach, shown.expressions))

    def refutation(self, region: Region, poses: Array) -> Refutation | None:
        """The worst of the poses (k, n) that are in the region and are shown to refute; None if there is none."""
        poses = poses[region.contains(poses, self.statement.robot.pose_names)]
        values = self.statement.value(poses)
        room = self.statement.bound.room(values)
        failing = np.flatnonzero(~(room >= 0.0))
        if not len(failing):
            return None
        order = np.argsort(np.nan_to_num(room[failing], nan=-np.inf), kind="stable")
        poses = poses[failing[order[:_MOST]]]
        at = np.hstack([poses, self._scaled.scaling(poses)])
        _, highest = enclose(self._rows, at, at)
        beyond = highest[:, : self._limbs].min(axis=1) < 0.0
        shown = np.flatnonzero(highest.min(axis=1) < 0.0)
        return Refutation(poses[shown[0]], not bool(beyond[shown[0]])) if len(shown) else None
