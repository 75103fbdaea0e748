"""Names that no obstacle may have, as messages would no longer tell two things apart."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING

import casadi as ca

from kinematics.errors import InvalidField
from kinematics.machine import Surroundings

if TYPE_CHECKING:
    from kinematics.model.mechanism import Mechanism

_RESERVED = ("base", "floor", "payload", "the floor")


@lru_cache(maxsize=64)
def taken_names(kind: type[Mechanism]) -> frozenset[str]:
    """The names of a mechanism's members and of the parts of its base, and the reserved ones."""
    pose, joints = ca.SX.sym("pose", len(kind.pose_names)), ca.SX.sym("joints", len(kind.joint_names))
    members = kind().all_members(pose, joints, kind.Geometry.symbols()[1])
    return frozenset([*_RESERVED, *(member.name for member in members)])


def free_name(kind: type[Mechanism]) -> str:
    """What a name must be, in words."""
    return f"a name that is no member of {kind.__name__}, and none of {', '.join(_RESERVED)}"


def require_free_names(kind: type[Mechanism], surroundings: Surroundings) -> None:
    """Check that no obstacle has the name of something else.

    Raises:
        InvalidValue: it names the obstacle.
    """
    if not surroundings.obstacles:
        return
    taken = taken_names(kind)
    for obstacle in surroundings.obstacles:
        if obstacle.name in taken:
            name = f"obstacles, name of {obstacle.name!r}"
            raise InvalidField("Surroundings", name, obstacle.name, free_name(kind))
