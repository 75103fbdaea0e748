"""Lowest values, mean and counts of a value over more poses than memory can hold: the poses come in chunks."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from kinematics import Array, Value


@dataclass(frozen=True, eq=False)
class Sweep(Value):
    """Figures of a value over all poses. A pose whose value is NaN counts only as lost.

    Attributes:
        poses: the number of poses.
        lost: the number of poses without a value.
        values: (k,) the lowest values, in rising order; of equal values the first ones.
        at: (k, n) their poses.
        mean, deviation: arithmetic mean and standard deviation (divided by the number k of values, not k - 1); NaN if
            no pose has a value.
        below: (b,) the number of values below each level.
    """

    poses: int
    lost: int
    values: Array
    at: Array
    mean: float
    deviation: float
    below: Array


def sweep(
    value: Callable[[Array], Array], chunks: Iterable[Array], *, keep: int = 1, levels: Sequence[float] = ()
) -> Sweep:
    """Evaluate chunk by chunk and reduce.

    Args:
        value: (k, n) poses -> (k,) values, such as `robot.fvi`.
        chunks: arrays (k, n), such as `region.walk(names, counts)` yields.
        keep: the number of lowest values that are kept.
        levels: bounds below which values are counted.
    """
    poses = used = 0
    lowest, at = np.empty(0), None
    below, mean, spread = np.zeros(len(levels), dtype=np.int64), 0.0, 0.0
    for chunk in chunks:
        values = np.asarray(value(chunk))
        poses += len(values)
        good = ~np.isnan(values)
        if not good.all():
            chunk, values = chunk[good], values[good]
        if not len(values):
            continue
        candidates = np.flatnonzero(values < lowest[-1]) if len(lowest) == keep else np.arange(len(values))
        if len(candidates):
            lowest = np.concatenate([lowest, values[candidates]])
            at = chunk[candidates] if at is None else np.concatenate([at, chunk[candidates]])
            order = np.argsort(lowest, kind="stable")[:keep]
            lowest, at = lowest[order], at[order]
        below += np.array([np.count_nonzero(values < level) for level in levels], dtype=np.int64)
        used, mean, spread = _joined((used, mean, spread), values)
    deviation = float(np.sqrt(spread / used)) if used else np.nan
    at = np.empty((0, 0)) if at is None else at
    return Sweep(poses, poses - used, lowest, at, mean if used else np.nan, deviation, below)


def _joined(before: tuple[int, float, float], values: Array) -> tuple[int, float, float]:
    """Count, mean and sum of squared deviations after more values, by the update of Chan, Golub and LeVeque."""
    count, mean, spread = before
    with np.errstate(invalid="ignore"):  # an infinite value makes the deviation NaN, which is right
        more = float(values.mean())
        step, total = more - mean, count + len(values)
        spread += float(((values - more) ** 2).sum()) + step**2 * (count * len(values) / total)
    return total, mean + step * (len(values) / total), spread
