"""What a study's robot must not touch besides itself, and whether the robot fits there at home."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kinematics import Obstacle, PayloadHull, Surroundings, hull_depth, lowest_of_base
from studies.errors import KeyPath, StudyError, spelled

if TYPE_CHECKING:
    from kinematics import Mechanism
    from studies.study_file import Study, TomlFile


def surroundings_of(study: Study) -> Surroundings:
    """The floor, the obstacles and the payload's hull of the study."""
    table = study.surroundings
    hull = None if table.payload_hull is None else PayloadHull(**table.payload_hull.model_dump())
    return Surroundings(table.floor, tuple(Obstacle(**row.model_dump()) for row in table.obstacle), hull)


def require_room(robot: Mechanism, file: TomlFile) -> None:
    """Check that the base is above the floor, and that the payload is not inside what carries it.

    Raises:
        StudyError: at the key of the floor or of the hull.
    """
    floor, base = robot.surroundings.floor, lowest_of_base(robot)
    if floor is not None and base is not None and base.height < floor:
        key = _spelled(file, ("surroundings", "floor"))
        expected = f"a height below the base: {base.member} reaches down to {base.height:.6g} m"
        raise StudyError([file.fault(key, spelled(file.value(key)), expected)])
    depth = hull_depth(robot)
    if depth > 0.0:
        key = _spelled(file, ("surroundings", "payload_hull", "high"))
        expected = f"a hull beside the {robot.tool_member}, which carries it; at home it is {depth:.6g} m inside"
        raise StudyError([file.fault(key, spelled(file.value(key)), expected)])


def _spelled(file: TomlFile, path: KeyPath) -> KeyPath:
    in_mm = (*path[:-1], f"{path[-1]}_mm")
    return in_mm if in_mm in file.lines else path
