"""Which convention of counting gives Table I of Shayya et al. to its printed digits.

The paper does not say how it counted. Tried: a grid of each step from the middle, its last column on or below the limit
of y; the area of the nodes that pass (each has the area of its cell), of the cells whose four corners pass, and of the
polygon through the outermost nodes that pass; mean and deviation over the nodes that pass.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from kinematics import Array, Redundant3T1R

NINE = tuple(np.deg2rad([-90.0, -60.0, -45.0, -30.0, 0.0, 30.0, 45.0, 60.0, 90.0]).tolist())
CASES = {"theta = 0": (0.0,), "nine angles": NINE}
PRINTED = {"theta = 0": (0.79, 1.21, 0.08), "nine angles": (0.69, 1.14, 0.07)}
HIGHEST = 0.80  # [m] above all of the region
STEPS = (0.001, 0.002, 0.0025, 0.004, 0.005, 0.008, 0.010, 0.0125, 0.020, 0.025, 0.050)
RULES = ("nodes", "whole cells", "polygon of nodes")
AXES = ("multiples of the step", "spread to the limit")


@dataclass(frozen=True)
class Counted:
    """What one convention gives for one case: area [m^2], mean and deviation of the FVI."""

    step: float
    axis: str
    rule: str
    case: str
    figures: tuple[float, float, float]

    @property
    def matches(self) -> bool:
        """All three printed numbers, rounded to their two decimals."""
        return all(round(a, 2) == b for a, b in zip(self.figures, PRINTED[self.case], strict=True))


def limit_of_y(robot: Redundant3T1R) -> float:
    """|y| <= |y_1| - d/2, by which the paper keeps the platform off the rails [m]."""
    return abs(robot.geometry.outer_rail_y) - robot.geometry.platform_length / 2


def conventions(robot: Redundant3T1R, steps: tuple[float, ...] = STEPS) -> Iterator[Counted]:
    """Every step [m], axis, rule and case."""
    limit = limit_of_y(robot)
    for step in steps:
        for axis in AXES:
            count = int(limit / step + 1e-9)
            y = step * np.arange(count + 1) if axis == AXES[0] else np.linspace(0.0, limit, count + 2)
            z = step * np.arange(round(HIGHEST / step) + 1)
            for case, angles in CASES.items():
                fvi = lowest_fvi(robot, y, z, angles)
                for rule in RULES:
                    yield Counted(step, axis, rule, case, _figures(fvi, y, z, rule))


def lowest_fvi(robot: Redundant3T1R, y: Array, z: Array, angles: tuple[float, ...]) -> Array:
    """(y, z) the lowest FVI at these angles, 0 where one is out of reach."""
    pose = np.zeros((len(y), len(z), len(angles), 4))
    pose[..., 1], pose[..., 2], pose[..., 3] = y[:, None, None], z[None, :, None], angles
    return np.nan_to_num(robot.fvi(pose)).min(axis=-1)


def _figures(fvi: Array, y: Array, z: Array, rule: str) -> tuple[float, float, float]:
    """Of the whole plane, which four times the quarter makes."""
    passes = fvi >= 1.0
    cell = (y[1] - y[0]) * (z[1] - z[0])
    if rule == "nodes":
        share = np.outer(np.where(y > 0.0, 1.0, 0.5), np.where(z > 0.0, 1.0, 0.5))  # an axis counts once
        area = cell * float((share * passes).sum())
    elif rule == "whole cells":
        area = cell * int((passes[1:, 1:] & passes[1:, :-1] & passes[:-1, 1:] & passes[:-1, :-1]).sum())
    else:
        area = float(np.trapezoid(np.where(passes, z, 0.0).max(axis=1), y))
    return 4.0 * area, float(fvi[passes].mean()), float(fvi[passes].std())
