"""Where a margin is worst: a dense grid, then descents between its points.

A grid alone gives too good a worst value, so descents start at its worst poses and end with a step far below that of
the grid. The answer is still that of a sample: the true worst value is at least as bad.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from design.budget import Budget
from design.regions import Region, unit_grid
from design.sampling.sweep import sweep
from kinematics import Array, FviBounds, Mechanism, Value, whole

DENSE = 1_000_000  # poses of a dense grid; the optimisation uses far fewer poses


@dataclass(frozen=True, eq=False)
class WorstPoses(Value):
    """Locally worst values of a margin over a region, the worst first.

    Attributes:
        values: (k,) the margin; where a limb cannot reach and it has no value, -inf, or inf if smaller is better.
        poses: (k, n).
        sampled: the number of grid poses that were evaluated.
        complete: whether these were all poses of the grid; false if the time ended before.
        typical: mean modulus of the margin over a few poses of the region, for its scale; NaN if it has no value there.
    """

    values: Array
    poses: Array
    sampled: int
    complete: bool
    typical: float

    @property
    def value(self) -> float:
        """The worst value of all."""
        return float(self.values[0])

    @property
    def pose(self) -> Array:
        """(n,) the pose with the worst value."""
        result: Array = self.poses[0]
        return result


def dense_counts(dimension: int, about: int) -> tuple[int, ...]:
    """Equal counts for a grid of roughly `about` poses. They are odd, so that the middle is on the grid."""
    each = max(3, round(about ** (1.0 / max(1, dimension))))
    return (each + 1 - each % 2,) * dimension


def worst_poses(
    robot: Mechanism,
    region: Region,
    margin: str,
    *,
    bounds: FviBounds | None = None,
    characteristic_length: float | None = None,
    about: int = DENSE,
    descents: int = 64,
    seconds: float = math.inf,
) -> WorstPoses:
    """Locally worst values of a margin, from a grid of about that many poses and descents between them.

    Args:
        robot: the mechanism with its geometry.
        region: the poses to search.
        margin: one of `robot.margins`.
        bounds, characteristic_length: as in `Mechanism.margin`.
        about: approximate number of grid poses.
        descents: the number of worst grid poses that a descent starts from.
        seconds: after so much time no more grid poses are evaluated; see `WorstPoses.complete`.

    Raises:
        InvalidRegion, InvalidValue: the region or the margin does not fit the robot, or a number is impossible.
    """
    names, budget = robot.pose_names, Budget(seconds)
    region.check(names)
    about, descents = whole("about", about, 1), whole("descents", descents, 1)
    counts, sense = dense_counts(region.dimension, about), robot.margin_named(margin).sense
    few = robot.margin(margin, region.spread(names), bounds, characteristic_length)

    def value(unit: Array) -> Array:
        found = sense * robot.margin(margin, region.from_unit(unit, names), bounds, characteristic_length)
        return np.where(np.isnan(found), -np.inf, found)

    if region.dimension == 0:
        pose = region.from_unit(np.empty((1, 0)), names)
        found = value(np.empty((1, 0)))
        return WorstPoses(sense * found, pose, 1, True, _typical(few))
    grid = sweep(value, budget.during(unit_grid(counts)), keep=4 * descents)
    unit, values = descend(value, grid.at, 1.0 / (np.array(counts) - 1.0))
    order = np.argsort(values, kind="stable")
    unit, values = unit[order], values[order]
    poses = region.from_unit(unit, names)
    extent = region.extent(names)
    distinct = _distinct(poses, np.where(extent > 0.0, extent, 1.0))
    complete = grid.poses == math.prod(counts)
    return WorstPoses(sense * values[distinct], poses[distinct], grid.poses, complete, _typical(few))


def _typical(values: Array) -> float:
    finite = np.abs(values[np.isfinite(values)])
    return float(finite.mean()) if len(finite) else math.nan


def descend(value, unit: Array, step: Array, rounds: int = 40) -> tuple[Array, Array]:  # type: ignore[no-untyped-def]
    """Compass search from all points at once inside the unit cube.

    A point without a better neighbour halves its step.
    """
    k = unit.shape[1]
    moves = np.concatenate([np.eye(k), -np.eye(k)])
    scale = np.ones(len(unit))
    best = value(unit)
    for _ in range(rounds):
        trial = np.clip(unit[:, None, :] + scale[:, None, None] * (moves * step)[None], 0.0, 1.0)
        values = value(trial)
        choice = values.argmin(axis=1)
        rows = np.arange(len(unit))
        better = values[rows, choice] < best
        unit = np.where(better[:, None], trial[rows, choice], unit)
        best = np.where(better, values[rows, choice], best)
        scale = np.where(better, scale, scale / 2.0)
    return unit, best


def _distinct(poses: Array, extent: Array) -> list[int]:
    """Indices of poses that are further than a hundredth of the region from every earlier one."""
    left, kept = np.arange(len(poses)), []
    while len(left):
        first = left[0]
        kept.append(int(first))
        left = left[np.abs((poses[left] - poses[first]) / extent).max(axis=1) > 0.01]
    return kept
