"""What a study did not ask about: the figures of the bodies, for its own geometry and for the result."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from design import WorstPoses, worst_poses
from kinematics import Mechanism, swept_box
from studies.stages.loads_over_region import loads_over
from studies.stages.pipeline import Outcome
from studies.stages.timed_stage import Progress, stage

SAMPLE = 10_000  # poses of the search for each of these figures
_SAME = 1e-3  # a figure that changes by a smaller share is neither better nor worse


@dataclass(frozen=True)
class Change:
    """A figure of the study's own geometry and of the result, the worst over the region.

    Attributes:
        name, unit: of the figure.
        before, after: its values.
        sense: 1 if larger is better, -1 if smaller is.
    """

    name: str
    unit: str
    before: float
    after: float
    sense: int

    @property
    def worse(self) -> bool:
        """Whether the result is worse by more than a thousandth."""
        loss = self.sense * (self.before - self.after)
        return bool(loss > _SAME * abs(self.before))

    def __str__(self) -> str:
        share = abs(self.after - self.before) / abs(self.before) if self.before else math.inf
        unit = f" {self.unit}" if self.unit else ""
        return f"{self.name} is worse by {100 * share:.1f} %: {self.before:.4g} before, {self.after:.4g}{unit} now"


def with_unasked(outcome: Outcome, progress: Progress) -> Outcome:
    """The outcome with the margins of its bodies that the study did not ask about, and the loads of its members."""
    names = [n for n, margin in outcome.robot.margins.items() if margin.records and n not in outcome.worst]
    own = outcome.problem.robot
    with stage("figures of the bodies", progress):
        after = {name: _worst(outcome, outcome.robot, name) for name in names}
        before = None
        if outcome.prototype is not None:
            before = {name: _worst(outcome, own, name) for name in names}
        loads = loads_over(outcome.robot, outcome.region)
    return replace(outcome, unasked=after, unasked_before=before, loads=loads)


def became_worse(outcome: Outcome) -> list[Change]:
    """What the result does worse than the study's own geometry, of all that the study did not ask about."""
    if outcome.unasked_before is None:
        return []
    own, margins = outcome.problem.robot, outcome.robot.margins
    found = [
        Change(name, margins[name].unit, outcome.unasked_before[name].value, after.value, margins[name].sense)
        for name, after in outcome.unasked.items()
    ]
    if outcome.timing is not None and outcome.prototype_timing is not None:
        before, now = (timing.half_cycle for timing in (outcome.prototype_timing, outcome.timing))
        found.append(Change("cycle time, one way", "s", before, now, -1))
    before, now = (_size(outcome, robot) for robot in (own, outcome.robot))
    found.append(Change("size, the longest side of the box that the members sweep", "m", before, now, -1))
    return [change for change in found if change.worse]


def _worst(outcome: Outcome, robot: Mechanism, margin: str) -> WorstPoses:
    problem, about = outcome.problem, min(outcome.study.dense_sample, SAMPLE)
    length = problem.characteristic_length
    return worst_poses(
        robot, outcome.region, margin, bounds=problem.fvi_bounds, characteristic_length=length, about=about
    )


def _size(outcome: Outcome, robot: Mechanism) -> float:
    low, high = swept_box(robot, outcome.region.spread(robot.pose_names))
    return float((high - low).max())
