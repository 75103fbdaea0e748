"""From what a study says to the objects that compute."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from design import Bounds, Box, Cylinder, Region, Requirement, SumLimit
from design.nlp import Problem
from kinematics import FviBounds, Mechanism
from studies import schema
from studies.errors import StudyError
from studies.mechanisms import mechanism_class
from studies.schema import CylinderRegion, Study
from studies.toml_file import read_toml
from trajectory import AdeptCycle, Limits
from trajectory.cycle import Timing

OBJECTIVE = "fvi"


def robot_of(study: Study) -> Mechanism:
    """The study's mechanism: the prototype with the study's own geometry on top."""
    kind = mechanism_class(study.mechanism)
    return kind(kind.Geometry(**study.geometry))


def region_of(study: Study) -> Region:
    """The workspace."""
    if isinstance(study.region, CylinderRegion):
        return Cylinder(study.region.radius, **study.region.coordinates)
    return Box(**study.region.coordinates)


def fvi_bounds_of(study: Study) -> FviBounds:
    """What the FVI is measured against: the study's, or the mechanism's own."""
    if study.fvi is None:
        return mechanism_class(study.mechanism).fvi_bounds
    f = study.fvi
    return FviBounds(f.joint_speed, f.joint_effort, f.speed, f.force)


def problem_of(study: Study) -> Problem:
    """The synthesis that the study asks for; without an `[optimise]` table, one with nothing to vary."""
    robot = robot_of(study)
    own_length = study.fvi.characteristic_length if study.fvi else None
    variables: list[Bounds] = []
    sums: list[SumLimit] = []
    if study.optimise is not None:
        for name, intervals in study.optimise.variables.items():
            pairs = [intervals] if isinstance(intervals[0], float | int) else intervals
            variables += [Bounds(name, item, low, high) for item, (low, high) in enumerate(pairs)]
        sums = [SumLimit(s.fields, s.at_most) for s in study.optimise.sums]
    return Problem(
        robot=robot,
        objective=OBJECTIVE,
        variables=tuple(variables),
        requirements=tuple(Requirement(r.margin, r.at_least) for r in study.requirement),
        sums=tuple(sums),
        fvi_bounds=fvi_bounds_of(study),
        characteristic_length=own_length or robot.characteristic_length,
    )


def cycle_of(cycle: schema.Cycle) -> AdeptCycle:
    """The path there."""
    return AdeptCycle(cycle.lift, cycle.span, cycle.blend, cycle.turn, cycle.pick, cycle.heading)


def require_cycle_inside(study: Study, file: Path) -> None:
    """Check that the cycle stays where the geometry is verified.

    Raises:
        StudyError: it leaves the region, with the pose at which it does.
    """
    if study.trajectory is None:
        return
    path = cycle_of(study.trajectory.cycle)
    (poses,) = path.evaluate(np.linspace(0.0, path.length, 501), 0)
    names = mechanism_class(study.mechanism).pose_names
    inside = region_of(study).contains(poses, names, slack=1e-9)
    if not inside.all():
        pose = ", ".join(f"{v:.4g}" for v in poses[int(np.argmin(inside))])
        expected = f"a cycle inside the region, {region_of(study)}"
        problem = read_toml(file).problem(("trajectory", "cycle"), f"the pose ({pose}) on it", expected)
        raise StudyError([problem])


def limits_of(limits: schema.Limits) -> Limits:
    """The limits of the cycle."""
    return Limits(**limits.model_dump())


def timing_of(asked: schema.Trajectory) -> tuple[Timing, tuple[str, ...]]:
    """The study's timing law, and the limits that it is run without although the study may set them.

    Only jerk: it makes a motion smooth, while what else a law cannot keep rates the drives, and is refused.
    """
    if asked.law == "toppra":
        from trajectory.toppra_law import time_optimal

        return partial(time_optimal, intervals=asked.grid), ("jerk",)
    from trajectory.jerk_law import jerk_limited

    return jerk_limited, ()


def approach_limits(asked: schema.Approach, drives: Limits, joints: int) -> Limits:
    """The approach's own limits, nowhere above the drives', and the drives' torque."""
    own = Limits(asked.speed, asked.acceleration, jerk=asked.jerk)
    merged: dict[str, Any] = {"torque": drives.torque}
    for name in ("speed", "acceleration", "jerk"):
        given = [limit for limits in (own, drives) if (limit := limits.of_joints(name, joints)) is not None]
        merged[name] = tuple(np.min(given, axis=0).tolist())
    return Limits(**merged)
