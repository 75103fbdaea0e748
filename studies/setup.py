"""From what a study says to the objects that compute."""

from __future__ import annotations

from design import Bounds, Box, Cylinder, Region, Requirement, SumLimit
from design.nlp import Problem
from kinematics import FviBounds, Mechanism
from studies import schema
from studies.mechanisms import mechanism_class
from studies.schema import CylinderRegion, Study
from trajectory import AdeptCycle, Limits

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


def limits_of(limits: schema.Limits | schema.Approach) -> Limits:
    """The limits of the cycle or of the approach."""
    return Limits(**limits.model_dump())
