"""Bounds in the word of their margin, for tests over all margins."""

from __future__ import annotations

from typing import Any

from kinematics import Mechanism


def bound_of(robot: Mechanism, margin: str, value: float) -> dict[str, Any]:
    """As an argument of `certify`."""
    return {robot.margins[margin].word: value}


def eased(robot: Mechanism, margin: str, worst: float, share: float) -> dict[str, Any]:
    """A share of a worst value above 0, or one over the share if smaller is better."""
    return bound_of(robot, margin, worst * (share if robot.margins[margin].sense > 0 else 1.0 / share))


def trivial(robot: Mechanism, margin: str, far: float) -> dict[str, Any]:
    """What holds wherever the margin has a value: at least -far, or at most far."""
    return bound_of(robot, margin, -robot.margins[margin].sense * far)
