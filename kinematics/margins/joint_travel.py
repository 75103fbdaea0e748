"""Joint travel: the distance of the driven joints from the ends of their ranges."""

from __future__ import annotations

import math

import casadi as ca
import numpy as np

from kinematics.model import Margin, Measure, Mechanism


class JointTravel(Margin):
    """Distance of each driven joint from each end of its range, in the joint's unit; infinite without ranges."""

    name = "joint_travel"
    unit = "rad or m"
    words = "distance to the nearest end of a driven joint's range"
    holds_on_paths = True

    def components(self, robot: Mechanism, measure: Measure) -> ca.SX:  # noqa: ARG002
        """Components for the lower ends, then for the upper ends; only for joints with a range."""
        joints, limits = robot.model().inverse, robot.ranges.limits(len(robot.joint_names))
        rooms = [joints[i] - low for i, (low, _) in enumerate(limits) if np.isfinite(low)]
        rooms += [high - joints[i] for i, (_, high) in enumerate(limits) if np.isfinite(high)]
        return ca.vertcat(*rooms) if rooms else ca.SX(math.inf)

    def places(self, robot: Mechanism) -> list[str] | None:
        """The end of the range, and the joint's name."""
        limits, names = robot.ranges.limits(len(robot.joint_names)), robot.joint_names
        sides = zip(("lower", "upper"), limits.T, strict=True)
        return [
            f"the {word} end of {names[i]}" for word, side in sides for i in np.flatnonzero(np.isfinite(side))
        ] or None


JOINT_TRAVEL = JointTravel()
