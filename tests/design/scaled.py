"""The same robot, region and wanted speed in another size."""

from __future__ import annotations

import math
from dataclasses import fields, replace
from typing import Any

import numpy as np

from design import Box
from kinematics import FviBounds, Mechanism, kind_of

_LENGTHS = ("length", "length_per_turn")


def scaled(robot: Mechanism, factor: float) -> Mechanism:
    """All lengths times a factor, those of joint ranges and of drives' errors too; angles stay."""
    changes: dict[str, Any] = {}
    for f in fields(robot.geometry):
        value = np.array(getattr(robot.geometry, f.name), dtype=float)
        if kind_of(f).dimension in _LENGTHS:
            value = value * factor
        elif kind_of(f).dimension == "frame":
            value[:3, 3] *= factor
        changes[f.name] = _nested(value)
    ranges, inertia = robot.ranges, robot.inertia
    if "m" in robot.joint_units:
        grown = [factor if unit == "m" else 1.0 for unit in robot.joint_units]
        pairs = zip(ranges.limits(len(grown)).tolist(), grown, strict=True)
        ranges = replace(ranges, joints=tuple((low * by, high * by) for (low, high), by in pairs))
    if set(robot.joint_units) == {"m"}:
        train = inertia.drive_train
        errors = {name: factor * np.array(getattr(train, name)) for name in ("encoder_resolution", "backlash")}
        inertia = replace(inertia, drive_train=replace(train, **errors))
    return type(robot)(replace(robot.geometry, **changes), inertia, ranges)


def scaled_box(robot: Mechanism, box: Box, factor: float) -> Box:
    """Its lengths times a factor."""
    angles = {robot.pose_names[i] for i in robot.rotations}
    return Box(**{n: (v if n in angles else (v[0] * factor, v[1] * factor)) for n, v in box.intervals.items()})


def scaled_bounds(robot: Mechanism, factor: float) -> FviBounds:
    """So that the FVI stays: a revolute drive gives a larger robot more speed and less force."""
    bounds = robot.fvi_bounds
    if set(robot.actuator_units) == {"rad"}:
        return replace(bounds, speed=bounds.speed * factor, force=bounds.force / factor)
    return bounds


def scale_of(robot: Mechanism, margin: str, factor: float) -> float:
    """What a margin is multiplied by.

    NaN where its joints have different units, where joints rest in a home that does not scale with the robot, and where
    masses or the drives' stiffness count.
    """
    angles = list(robot.rotations)
    lengths = np.delete(np.array(robot.home, dtype=float), angles)
    if margin == "passive_joint" and not np.allclose(
        np.delete(np.array(scaled(robot, factor).home, dtype=float), angles), factor * lengths
    ):
        joints = robot.passive_joints(robot.model().pose, robot.model().joints, robot.model().g)
        return 1.0 if all(joint.swivels for joint in joints) else math.nan
    if margin == "joint_travel":
        units = set(robot.joint_units)
        return math.nan if len(units) > 1 else factor if units == {"m"} else 1.0
    if margin in ("v_w", "f_w", "force_capability") and set(robot.actuator_units) == {"rad"}:
        return factor if margin == "v_w" else 1.0 / factor
    if {"inertia", "load"} & set(robot.margins[margin].records) and "accuracy" not in margin:
        return math.nan  # neither masses nor drives scale with the robot
    return factor if robot.margins[margin].unit == "m" else 1.0


def around_home(robot: Mechanism, half: float = 0.02) -> Box:
    """A box about the home of a robot of the usual size, which a joint at rest there is not in the middle of."""
    home = np.array(robot.home, dtype=float) + 0.001 * np.arange(1, len(robot.pose_names) + 1)
    return Box(**{n: (float(v) - half, float(v) + half) for n, v in zip(robot.pose_names, home, strict=True)})


def _nested(value: np.ndarray) -> Any:
    return tuple(map(_nested, value)) if value.ndim else float(value)
