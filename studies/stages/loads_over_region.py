"""The largest loads of the members over the region, where the robot starts from rest with the study's load."""

from __future__ import annotations

import numpy as np

from design import Region
from kinematics import LoadsFromRest, Mechanism, loads_from_rest

_SAMPLE = 3000  # poses, about


def loads_over(robot: Mechanism, region: Region) -> LoadsFromRest:
    """The largest of each load of each member, (k,), on a grid of the region."""
    each = max(3, round(_SAMPLE ** (1 / max(1, region.dimension))))
    loads = loads_from_rest(robot, region.grid(robot.pose_names, (each,) * region.dimension))
    return LoadsFromRest(loads.names, *(np.nanmax(part, axis=0) for part in loads[1:]))
