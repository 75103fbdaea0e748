"""Builds the robot, region, synthesis, path and limits that a study describes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from design import Bounds, Box, Cylinder, Problem, Region, Requirement, SumLimit
from kinematics import (
    Array,
    FviBounds,
    GeometryRecord,
    InvalidField,
    InvalidValue,
    Mechanism,
    UnreachablePose,
    to_actuators,
)
from studies.building.hardware import inertia_of, load_of, ranges_of, structure_of
from studies.building.inside_region import leaving
from studies.building.surroundings import surroundings_of
from studies.errors import HomeOutOfReach, StudyError
from studies.study_file import (
    ApproachTable,
    CylinderTable,
    DriveTable,
    LimitsTable,
    Study,
    TomlFile,
    TrajectoryTable,
    adept_cycle,
    refused_field,
    travelled,
)
from trajectory import Limits, Path, PoseBounds, RoundedPath, Setpoints, TimingLaw, law_named, places
from trajectory.drive_files import Drive, drive_files

OBJECTIVE = "fvi"
FRAME_FILE = "frame_reaction.csv"  # what the machine exerts on its frame, beside the set-points


def robot_of(study: Study, geometry: GeometryRecord | None = None) -> Mechanism:
    """The robot with the study's masses, ranges and surroundings; `geometry` replaces the study's own geometry."""
    kind = study.mechanism_class
    joints = None if study.home is None else study.home.joints
    return kind(
        geometry or kind.Geometry(**study.geometry),
        inertia_of(study),
        ranges_of(study),
        home=_home_pose(study, kind.pose_names),
        home_joints=joints,
        structure=structure_of(study),
        load=load_of(study),
        surroundings=surroundings_of(study),
    )


def _home_pose(study: Study, pose_names: Sequence[str]) -> list[float]:
    """(n,) the coordinates that the study gives; the others are in the middle of the region."""
    given = {} if study.home is None else study.home.coordinates
    middle = region_of(study).intervals
    return [given.get(name, sum(middle[name]) / 2) for name in pose_names]


def home_of(robot: Mechanism) -> Array:
    """(n,) the pose that the robot works around.

    Raises:
        HomeOutOfReach: a limb cannot reach it.
    """
    home = np.asarray(robot.home, dtype=float)
    try:
        robot.require_reachable(home)
    except UnreachablePose as error:
        raise HomeOutOfReach(tuple(home.tolist()), error) from error
    return home


def region_of(study: Study) -> Region:
    """The workspace."""
    if isinstance(study.region, CylinderTable):
        return Cylinder(study.region.radius, **study.region.coordinates)
    return Box(**study.region.coordinates)


def fvi_bounds_of(study: Study) -> FviBounds:
    """The bounds that the FVI compares: the study's, or the mechanism's own."""
    if study.fvi is None:
        return study.mechanism_class.fvi_bounds
    f = study.fvi
    return FviBounds(f.joint_speed, f.joint_effort, f.speed, f.force)


def problem_of(study: Study) -> Problem:
    """The synthesis that the study asks for. Without a table `[optimise]` it has no variables."""
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
        requirements=tuple(Requirement(r.margin, r.at_least, r.at_most) for r in study.requirement),
        sums=tuple(sums),
        fvi_bounds=fvi_bounds_of(study),
        characteristic_length=own_length or robot.characteristic_length,
    )


def path_of(asked: TrajectoryTable, pose_names: tuple[str, ...]) -> Path:
    """The path of the way there, for poses with these coordinates.

    Raises:
        InvalidPath: a waypoint does not fit.
    """
    if asked.cycle is not None:
        return adept_cycle(asked.cycle.model_dump(), pose_names=pose_names)
    assert asked.path is not None
    waypoints = asked.path.waypoint
    poses = tuple(tuple(w.coordinates.get(name) for name in pose_names) for w in waypoints)
    return RoundedPath(pose_names, poses, tuple(w.blend for w in waypoints[1:-1]))


def require_cycle_inside(study: Study, file: TomlFile) -> None:
    """Prove that the cycle's path stays inside the region, where the geometry is verified.

    Raises:
        StudyError: the path leaves the region; the message has a pose outside.
    """
    if study.trajectory is None:
        return
    names = study.mechanism_class.pose_names
    path = path_of(study.trajectory, names)
    if (found := leaving(region_of(study), path, names)) is not None:
        pose = ", ".join(f"{v:.4g}" for v in found.pose)
        key = travelled(file)
        expected = f"a {key[-1]} inside the region, {region_of(study)}"
        raise StudyError([file.fault(key, f"the pose ({pose}) on the path", expected)])


def drive_of(drive: DriveTable) -> Drive:
    """Names and encoders of the axes."""
    return Drive(drive.axes, drive.increments, drive.encoder_gear)


def drive_file_names(study: Study, file: TomlFile, asked_for: Sequence[str] | None) -> list[str]:
    """The names of the drive files and of the file beside them.

    A trial at rest along the path finds early what a format cannot express.

    Args:
        asked_for: formats of the command line, which replace the study's own.

    Raises:
        StudyError: a format cannot express what the study asks for.
    """
    asked = study.trajectory
    if asked is None:
        return []
    stems = ("cycle", "approach") if asked.approach else ("cycle",)
    try:
        robot, drive = robot_of(study), drive_of(asked.drive)
        at_rest = _along(robot, path_of(asked, robot.pose_names), asked.period)
        names = [name for stem in stems for name in drive_files(stem, at_rest, asked.files, drive)]
        return [*names, FRAME_FILE]
    except InvalidValue as error:
        by = f"for --format {' --format '.join(asked_for)}" if asked_for else ""
        key = ("trajectory",) if asked_for else ("trajectory", "files")
        found = f"{error.what} {error.found} {by}".strip()
        at_its_key = refused_field(file, error, by) if isinstance(error, InvalidField) else None
        raise StudyError([at_its_key or file.fault(key, found, error.expected)]) from error


def _along(robot: Mechanism, path: Path, period: float) -> Setpoints:
    """Set-points along the path with zero speed. Where a limb cannot reach, they are zero; other checks report that."""
    (poses,) = path.evaluate(np.linspace(0.0, path.length, 101), 0)
    joints = np.nan_to_num(to_actuators(robot, robot.inverse(poses)))
    table = np.hstack([np.arange(101)[:, None] * period, poses, joints, np.zeros((101, 3 * joints.shape[1]))])
    header = {"period [s]": period, "periods": [100]}
    return Setpoints.of_table(table, robot.pose_names, robot.actuator_names, robot.actuator_units, header)


def limits_of(limits: LimitsTable) -> Limits:
    """The limits of the cycle."""
    return Limits(**limits.model_dump())


def timing_of(study: Study) -> tuple[TimingLaw, tuple[str, ...]]:
    """The study's timing law, and the names of limits that this law ignores even if the study sets them."""
    asked = study.trajectory
    assert asked is not None
    law = law_named(asked.law)
    return law.timing(asked.grid, pose_bounds_of(study)), law.leaves_out


def pose_bounds_of(study: Study) -> PoseBounds:
    """The study's region as bounds of the pose, for the free law."""
    region = region_of(study)
    low, high = zip(*(region.intervals[name] for name in study.mechanism_class.pose_names), strict=True)
    count = places(study.mechanism_class.pose_names)
    return PoseBounds(low, high, count, region.radius if isinstance(region, Cylinder) else math.inf)


def approach_limits(asked: ApproachTable, drives: Limits, joints: int) -> Limits:
    """The approach's own limits, lowered to the drives' limits, and the other drive limits that a move keeps."""
    own = Limits(asked.speed, asked.acceleration, jerk=asked.jerk)
    merged: dict[str, Any] = {}
    for name in ("speed", "acceleration", "jerk"):
        given = [limit for limits in (own, drives) if (limit := limits.of_joints(name, joints)) is not None]
        merged[name] = tuple(np.min(given, axis=0).tolist())
    return replace(drives.less(*(limit for limit in drives if limit.not_for_moves)), **merged)
