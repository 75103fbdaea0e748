"""The largest loads of the members over the region, where the robot starts from rest with the study's load."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from design import Region
from kinematics import Array, Mechanism, loads_from_rest

_SAMPLE = 3000  # poses, about


@dataclass(frozen=True)
class RegionLoad:
    """What a member bears at most, each in its own worst pose and direction; SI units.

    Attributes:
        member: its name.
        tension, compression: the largest force along it.
        bending, torsion: the largest moments across it and about it.
        joint_force: the largest force in a joint of it.
    """

    member: str
    tension: float
    compression: float
    bending: float
    torsion: float
    joint_force: float

    def as_dict(self) -> dict[str, Any]:
        """Plain data."""
        return asdict(self)


def loads_over(robot: Mechanism, region: Region) -> tuple[RegionLoad, ...]:
    """Of each member with a section whose load is known, on a grid of the region; empty without any."""
    loads = loads_from_rest(robot, _grid(region, robot))
    largest = np.stack([np.nanmax(part, axis=0) for part in loads[1:]], axis=-1) if loads.names else np.empty((0, 5))
    return tuple(RegionLoad(name, *row) for name, row in zip(loads.names, largest.tolist(), strict=True))


def _grid(region: Region, robot: Mechanism) -> Array:
    """(k, n) poses, those of the region's edges too."""
    each = max(3, round(_SAMPLE ** (1 / max(1, region.dimension))))
    axes = np.meshgrid(*[np.linspace(0.0, 1.0, each)] * region.dimension, indexing="ij")
    unit = np.stack(axes, axis=-1) if axes else np.empty((1, 0))
    return region.from_unit(unit.reshape(-1, region.dimension), robot.pose_names)
