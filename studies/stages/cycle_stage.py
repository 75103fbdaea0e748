"""A study's cycle on a robot: approach, timing, verification, set-points, and the requirements on its path."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import Any

import numpy as np

from design import Region
from kinematics import Bound, InvalidField, LinkwrightError, Mechanism, to_actuators
from studies.building import approach_limits, home_of, leaving, limits_of, path_of, region_of, timing_of
from studies.errors import ApproachFailed, Failed, RequirementFailed
from studies.study_file import Study
from trajectory import (
    Cycle,
    FramePeak,
    Limits,
    MemberPeak,
    Move,
    Path,
    Setpoints,
    cycle_setpoints,
    frame_peaks,
    lower_bound,
    member_peaks,
    there_and_back,
)

_MOST_SETPOINTS = 1_000_000


@dataclass(frozen=True)
class Timing:
    """A cycle, its set-points, and the move to its start.

    Attributes:
        cycle: the way there and the way back, timed and verified.
        setpoints: the cycle's set-points, stretched to whole periods and verified again.
        approach: the move from home; None if the study asks for none.
        frame: the force and the moment that the machine exerts on its frame, by name.
        members: the largest loads of each member, and its smallest safety factor.
        lower_bound: time that every motion on this path needs for the way there, even without a jerk limit [s].
        seconds: wall-clock time of timing and verification.
    """

    cycle: Cycle
    setpoints: Setpoints
    approach: Move | None
    frame: dict[str, FramePeak]
    members: tuple[MemberPeak, ...]
    lower_bound: float
    seconds: float

    @property
    def half_cycle(self) -> float:
        """The way there, before the stretch to whole periods [s]."""
        return self.cycle.half

    @property
    def half_cycle_name(self) -> str:
        """The name of `half_cycle` among the figures; "closed_cycle" if the way there is closed, with no way back."""
        return "half_cycle" if self.cycle.back else "closed_cycle"

    def figures(self) -> dict[str, Any]:
        """The figures that the timing claims, as plain data."""
        there = [piece.timed for piece in self.cycle.there]
        return {
            "law": there[0].motion.name,
            self.half_cycle_name: self.half_cycle,
            "lower_bound": self.lower_bound,
            "cycle_on_the_bus": float(self.setpoints.time[-1]),
            "repair_factor": max(timed.factor for timed in there),
            "peak_over_limit": {
                name: max(piece.timed.verification.peak_over_limit[name] for piece in self.cycle.pieces)
                for name in there[0].verification.peak_over_limit
            },
            "worst_rms_over_peak_torque": max(float(timed.verification.rms_over_peak.max()) for timed in there),
            **({"limits_not_kept": list(self.cycle.not_kept)} if self.cycle.not_kept else {}),
        }

    def loads(self) -> dict[str, Any]:
        """What the machine bears and what its frame feels, as plain data; no claim of the optimum."""
        frame = {name: peak.as_dict() for name, peak in self.frame.items()}
        members = [member.as_dict() for member in self.members]
        return {"frame_reaction": frame, "members": members, "would_break": [member.member for member in self.broken]}

    @property
    def weakest(self) -> MemberPeak | None:
        """The member nearest its limit; None if no member's strength is known."""
        return min(self.members, key=lambda member: member.safety, default=None)

    @property
    def broken(self) -> list[MemberPeak]:
        """The members that the cycle would break, the nearest to its limit first."""
        return sorted((member for member in self.members if member.breaks), key=lambda member: member.safety)

    def weakness(self) -> str:
        """What to say of the members that the cycle would break; empty if there are none."""
        if not (broken := self.broken):
            return ""
        worst, more = broken[0], len(broken) - 1
        others = f"; {more} more member{'s' if more > 1 else ''} would break too" if more else ""
        return (
            f"this cycle would break {worst.member} by {worst.fails_by}: its safety factor falls to "
            f"{worst.safety:.3g}, below 1, at {worst.safety_at:.4g} s{others}; a requirement on the margin strength "
            "would refuse such a cycle"
        )


def time_cycle(study: Study, robot: Mechanism) -> Timing:
    """Time, verify and sample the study's cycle on a robot.

    Raises:
        RequirementFailed: the cycle leaves the study's region.
        LinkwrightError: any error of the timing law or the verification.
    """
    asked = study.trajectory
    assert asked is not None
    started = time.perf_counter()
    path, limits, payload = path_of(asked, robot.pose_names), limits_of(asked.limits), asked.payload
    _require_few(_least_duration(robot, path, limits), asked.period)  # before an hour-long path is proved
    approach = _approach(study, robot, path, limits)
    timing, cannot_keep = timing_of(study)
    cycle = there_and_back(robot, path, limits, payload, timing, asked.payload_back, cannot_keep)
    _require_inside(region_of(study), cycle)
    seconds = time.perf_counter() - started
    _require_few(sum(piece.duration for piece in cycle.pieces), asked.period)
    points = cycle_setpoints(cycle, asked.period, robot.actuator_units)
    bound = sum(lower_bound(robot, piece.path, limits, payload) for piece in cycle.there)
    return Timing(cycle, points, approach, frame_peaks(cycle), member_peaks(cycle), bound, seconds)


def _approach(study: Study, robot: Mechanism, path: Path, limits: Limits) -> Move | None:
    """The move from home to the path's start; None if none is asked. It is planned first, as the path takes longer.

    Raises:
        ApproachFailed: there is no such move, and why.
        HomeOutOfReach: a limb cannot reach home.
        UnreachablePose: a limb cannot reach the path's start.
    """
    from trajectory import plan_move

    asked = study.trajectory
    assert asked is not None
    if asked.approach is None:
        return None
    (start,) = path.evaluate(np.array(0.0), 0)
    robot.require_reachable(start)
    home = home_of(robot)
    gentle = approach_limits(asked.approach, limits, len(robot.joint_names))
    try:
        return plan_move(robot, home, start, gentle, asked.payload, asked.period, robot.actuator_units)
    except LinkwrightError as error:
        raise ApproachFailed(tuple(home.tolist()), tuple(start.tolist()), error) from error


def _least_duration(robot: Mechanism, path: Path, limits: Limits) -> float:
    """Lower bound of the time of the way there [s], from the joints' speed limits and a few poses."""
    (poses,) = path.evaluate(np.linspace(0.0, path.length, 101), 0)
    joints = to_actuators(robot, robot.inverse(poses))
    speed = limits.of_joints("speed", joints.shape[1])
    return 0.0 if speed is None else float((np.nansum(np.abs(np.diff(joints, axis=0)), axis=0) / speed).max())


def _require_few(duration: float, period: float) -> None:
    """Check that a cycle has no more set-points than a drive and the memory can hold.

    Raises:
        InvalidValue: the period is too short.
    """
    if not duration <= _MOST_SETPOINTS * period:
        expected = f"one that cuts {duration:.3g} s into at most {_MOST_SETPOINTS:,} set-points"
        raise InvalidField("Trajectory", "period", period, expected)


def _require_inside(region: Region, cycle: Cycle) -> None:
    out = [found for way in cycle.ways if (found := leaving(region, way, cycle.robot.pose_names))]
    if out:
        room = "distance inside the region's boundary on the cycle [m or rad]"
        raise RequirementFailed([Failed(room, Bound(0.0), found.room, tuple(found.pose.tolist())) for found in out])
