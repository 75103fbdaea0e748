"""Passive joints: the distance of the joints at the rods' ends from the ends of their ranges."""

from __future__ import annotations

from collections.abc import Callable

import casadi as ca

from kinematics.arrays import Array
from kinematics.machine import Pair, PassiveJoint, RodRanges
from kinematics.model import ClaimSymbols, Margin, Measure, Mechanism, ToShow


class PassiveJoints(Margin):
    """Distance of each joint at a rod's end from its limit in `ranges.passive`, and of others from theirs [rad]."""

    name = "passive_joint"
    unit = "rad"
    words = "distance to the nearest end of a passive joint's range"
    holds_on_paths = True

    def components(self, robot: Mechanism, measure: Measure) -> ca.SX:  # noqa: ARG002
        """One or two components for each joint."""
        return ca.vertcat(_rows(robot, lambda joint, limits: joint.room(limits)), *_turns_left(robot).values())

    def places(self, robot: Mechanism) -> list[str]:
        """The joints in order."""
        assert isinstance(robot.ranges, RodRanges)
        model = robot.model()
        at_rods = [
            f"passive joint {i + 1}, at the {('drive', 'platform')[joint.end]}"
            for i, joint in enumerate(robot.passive_joints(model.pose, model.joints, model.g))
            for _ in joint.room(robot.ranges.passive)
        ]
        return at_rods + list(_turns_left(robot))

    def to_refute(self, robot: Mechanism, claim: ClaimSymbols) -> ToShow:
        """By `PassiveJoint.within`: sines and cosines in place of the arctangent."""
        rows = _rows(robot, lambda joint, limits: joint.within(limits, claim.bound))
        return ToShow(ca.vertcat(rows, *(left - claim.bound for left in _turns_left(robot).values())), ca.SX(0, 0))

    def to_show(self, robot: Mechanism, claim: ClaimSymbols, inside: Array, positive: bool) -> ToShow:  # noqa: ARG002
        """The same, which hold if and only if the margin reaches the bound."""
        return self.to_refute(robot, claim)


def _rows(robot: Mechanism, rows: Callable[[PassiveJoint, Pair], list[ca.SX]]) -> ca.SX:
    """Expressions of every passive joint and the limits, in the symbols `pose` and `geometry`."""
    assert isinstance(robot.ranges, RodRanges)
    model, limits = robot.model(), robot.ranges.passive
    joints = robot.passive_joints(model.pose, model.joints, model.g)
    return model.at_pose(ca.vertcat(*(row for joint in joints for row in rows(joint, limits))))


def _turns_left(robot: Mechanism) -> dict[str, ca.SX]:
    model = robot.model()
    return robot.turns_left(model.pose, model.g)


PASSIVE_JOINT = PassiveJoints()
