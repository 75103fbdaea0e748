"""Set-points of a cycle: the values that the drives get in each period."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from importlib.metadata import version
from typing import Any

import numpy as np

from kinematics import (
    Array,
    InvalidField,
    InvalidShape,
    InvalidValue,
    Mechanism,
    Value,
    actuator_motion,
    from_actuators,
)
from trajectory.cycles import Cycle, Piece, periods_of
from trajectory.limits import Limits
from trajectory.motions import Motion, motion_of
from trajectory.paths import places
from trajectory.setpoints.interpolation import PARTS, between_setpoints

CONVENTIONS = (
    "one row a period; the last row of a cycle is the first of the next one",
    "where the law has no jerk limit, acceleration and torque step between rows, from and to rest too",
)
ASSUMPTIONS = (
    "the default inertia and the reference limits are an assumed drive set, not a manufacturer's datasheet",
    "rigid bodies; `inertia` states the friction, and by rod_middle how a rod's mass is spread: 0 is half at each end",
    "a mass in `inertia` without a number, null, is that of the members",
    "q'' and the torque are right-hand limits where s'' jumps",
)
_CONSISTENT = 1e-9  # of the loop closure [rad, or over the robot's size]


@dataclass(frozen=True, eq=False)
class Setpoints(Value):
    """One row for each period, in SI units. The last row closes the cycle.

    Attributes:
        time: (k,) [s].
        pose: (k, n).
        joints, speed, acceleration: (k, m) the joints and their time derivatives.
        torque: (k, m) of the drives.
        pose_names: (n,) the tool point's coordinates first.
        joint_names: (m,).
        joint_units: (m,) rad or m.
        header: plain data by name: how the set-points were made, and for which robot and limits.
    """

    time: Array
    pose: Array
    joints: Array
    speed: Array
    acceleration: Array
    torque: Array
    pose_names: tuple[str, ...]
    joint_names: tuple[str, ...]
    joint_units: tuple[str, ...]
    header: Mapping[str, Any]

    def __post_init__(self) -> None:
        rows = self.time.shape[0]
        groups = dict.fromkeys(("joints", "speed", "acceleration", "torque"), self.joint_names)
        for name, columns in {"pose": self.pose_names, **groups}.items():
            if getattr(self, name).shape != (rows, len(columns)):
                raise InvalidShape(f"Setpoints {name}", columns, getattr(self, name).shape)
        if len(self.joint_units) != len(self.joint_names) or not set(self.joint_units) <= {"rad", "m"}:
            raise InvalidField("Setpoints", "joint_units", self.joint_units, "rad or m, one a joint")

    @property
    def columns(self) -> tuple[str, ...]:
        """Names of the columns of `table`."""
        groups = ("", "_speed", "_acceleration", "_torque")
        return ("t", *self.pose_names, *(f"{name}{group}" for group in groups for name in self.joint_names))

    @property
    def units(self) -> tuple[str, ...]:
        """Units of the columns of `table`."""
        of_tool = places(self.pose_names)
        of_pose = ["m"] * of_tool + ["rad"] * (len(self.pose_names) - of_tool)
        effort = ["N m" if unit == "rad" else "N" for unit in self.joint_units]
        rates = (f"{unit}{per}" for per in ("", "/s", "/s^2") for unit in self.joint_units)
        return ("s", *of_pose, *rates, *effort)

    def table(self) -> Array:
        """(k, 1 + n + 4 m) all columns side by side."""
        parts = (self.time[:, None], self.pose, self.joints, self.speed, self.acceleration, self.torque)
        return np.concatenate(parts, axis=1)

    @classmethod
    def of_table(
        cls,
        table: Array,
        pose_names: Sequence[str],
        joint_names: Sequence[str],
        joint_units: Sequence[str],
        header: Mapping[str, Any],
    ) -> Setpoints:
        """From the columns side by side (k, 1 + n + 4 m)."""
        edges = 1 + len(pose_names) + len(joint_names) * np.arange(4)
        time, pose, joints, speed, acceleration, torque = np.split(table, [1, *edges], axis=1)
        names = (tuple(pose_names), tuple(joint_names), tuple(joint_units))
        return cls(time[:, 0], pose, joints, speed, acceleration, torque, *names, dict(header))

    def require_finite(self) -> None:
        """Check that every number is finite.

        Raises:
            InvalidValue: it names the set-point and its column.
        """
        table = self.table()
        if not np.isfinite(table).all():
            row, column = (int(k) for k in np.argwhere(~np.isfinite(table))[0])
            raise InvalidValue(f"set-point {row}, {self.columns[column]}", table[row, column], "a finite number")

    def require_consistent(self, robot: Mechanism) -> None:
        """Check that these set-points are for this robot: its mechanism and geometry, and joints that fit the poses.

        Raises:
            InvalidValue: the mechanism or the geometry is another one, or the loop closure is not zero; it names row
                and limb.
        """
        found = (self.header.get("mechanism"), self.header.get("geometry hash"))
        expected = (type(robot).__name__, robot.geometry.digest)
        if found != expected:
            raise InvalidValue("mechanism and geometry of the set-points", found, str(expected))
        residual = np.abs(robot.closure_gap(self.pose, from_actuators(robot, self.joints)))
        if not residual.max() <= _CONSISTENT:
            row, limb = (int(k) for k in np.unravel_index(int(residual.argmax()), residual.shape))
            what = f"loop closure of set-point {row}, limb {limb + 1} [rad, or over the robot's size]"
            raise InvalidValue(
                what, float(residual[row, limb]), f"at most {_CONSISTENT}, so that the joints fit the pose"
            )


def cycle_setpoints(cycle: Cycle, period: float, joint_units: Sequence[str]) -> Setpoints:
    """Stretch a cycle to whole periods, verify it again and sample it.

    Each piece gets a whole number of periods of its own, so that pick and place are set-points at rest.

    Args:
        cycle: timed and verified.
        period: of the drives' bus [s].
        joint_units: rad or m for each joint.

    Raises:
        InvalidValue: the period or the units are impossible.
        LimitsExceeded: the stretched cycle fails its verification.
    """
    whole = cycle.stretched_to(period)
    counts = [periods_of(piece.duration, period) for piece in whole.pieces]
    parts = []
    for piece, count in zip(whole.pieces, counts, strict=True):
        motion = _sampled(whole, piece, count, last=piece is whole.pieces[-1])
        parts.append(np.concatenate([motion.tool.pose, *motion.joints[:3], motion.torque], axis=1))
    time = np.round(np.arange(sum(counts) + 1) * period, 12)
    table = np.concatenate([time[:, None], np.concatenate(parts)], axis=1)
    header = _header(cycle, whole, period, counts)
    setpoints = Setpoints.of_table(table, cycle.robot.pose_names, cycle.robot.actuator_names, joint_units, header)
    header["between set-points"] = _between(whole, counts, setpoints)
    return replace(setpoints, header=header)


def _sampled(cycle: Cycle, piece: Piece, count: int, last: bool) -> Motion:
    """Motion of a piece at its periods; its end is the next piece's start unless it is the last one."""
    times = np.linspace(0.0, piece.duration, count + 1)[: count + 1 if last else count]
    return motion_of(cycle.robot, piece.motion.at(times), piece.payload)


def _between(cycle: Cycle, counts: Sequence[int], setpoints: Setpoints) -> dict[str, dict[str, float]]:
    """The errors of each interpolation of a drive between the set-points."""
    parts = []
    for piece, count in zip(cycle.pieces, counts, strict=True):
        times = np.linspace(0.0, piece.duration, count * PARTS + 1)
        rows = np.arange(count)[:, None] * PARTS + np.arange(PARTS + 1)
        parts.append([v[rows] for v in actuator_motion(cycle.robot, *piece.motion.at(times))[:3]])
    exact = [np.concatenate(v) for v in zip(*parts, strict=True)]
    given = (setpoints.time, setpoints.joints, setpoints.speed, setpoints.acceleration)
    return between_setpoints(given, exact, setpoints.joint_units, cycle.limits)


def robot_header(robot: Mechanism, limits: Limits) -> dict[str, Any]:
    """The header's data about the robot: plain data, with lists for tuples, so that it is equal when read back."""
    header: dict[str, Any] = {
        "units of this header": "SI and radians unless a name says so",
        "made by": f"linkwright {version('linkwright')}",
        "mechanism": type(robot).__name__,
        "coordinates": (type(robot).__doc__ or "").splitlines()[0],
        "geometry": _spelled(robot.geometry.as_dict()),
        "geometry hash": robot.geometry.digest,
        "inertia": _spelled(asdict(robot.inertia)),
        "joint ranges": _spelled(asdict(robot.ranges)),
    }
    header |= {f"limit {name}": value for name, value in limits.as_dict().items()}
    return header | {"conventions": list(CONVENTIONS), "assumptions": list(ASSUMPTIONS)}


def _spelled(value: Any) -> Any:
    """Plain data with words for infinite numbers, which JSON does not have: such a joint has no range."""
    if isinstance(value, dict):
        return {key: _spelled(entry) for key, entry in value.items()}
    if isinstance(value, list | tuple):
        return [_spelled(entry) for entry in value]
    return str(value) if isinstance(value, float) and math.isinf(value) else value


def _header(before: Cycle, after: Cycle, period: float, counts: Sequence[int]) -> dict[str, Any]:
    header = robot_header(before.robot, before.limits) | {
        "laws": [piece.motion.name for piece in before.pieces],
        "period [s]": float(period),
        "periods": list(counts),
        "cycle time before stretching [s]": before.duration,
        "cycle time after stretching [s]": after.duration,
        "payloads [kg]": [float(piece.payload) for piece in before.pieces],
        "limits not kept by this law": list(before.not_kept),
    }
    header |= {f"path {name}": value for name, value in before.path.as_dict().items()}
    header["proved margins"] = before.certificate.margins
    for k, piece in enumerate(after.pieces):
        found = piece.timed.verification
        header[f"peak over limit, piece {k + 1}, after stretching"] = dict(found.peak_over_limit)
        header[f"rms torque, piece {k + 1}, after stretching"] = found.rms_torque.tolist()
    return header
