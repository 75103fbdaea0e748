"""The record of all limits of the drives and the tool, and the list of their kinds."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict, dataclass, replace
from typing import Any, TypeVar

from kinematics import InvalidField, Mechanism
from trajectory.limits.acceleration import JOINT_ACCELERATION
from trajectory.limits.jerk import JOINT_JERK
from trajectory.limits.joint_ranges import JOINT_RANGES
from trajectory.limits.model import NO_SLACK, Along, Constraint, InstantLimit, Limit, LimitValues, MeanSquareLimit, Use
from trajectory.limits.rms_torque import RMS_TORQUE
from trajectory.limits.speed import JOINT_SPEED
from trajectory.limits.speed_torque_line import SPEED_TORQUE_LINE
from trajectory.limits.tool_caps import TOOL_ACCELERATION, TOOL_SPEED
from trajectory.limits.torque import PEAK_TORQUE
from trajectory.motions import Motion

PerJoint = float | tuple[float, ...]
Range = tuple[float, float]
Kind = TypeVar("Kind", bound=Constraint)

LIMITS: tuple[Limit, ...] = (
    JOINT_SPEED,
    JOINT_ACCELERATION,
    PEAK_TORQUE,
    TOOL_SPEED,
    TOOL_ACCELERATION,
    JOINT_JERK,
    JOINT_RANGES,
    SPEED_TORQUE_LINE,
    RMS_TORQUE,
)
"""Every limit, in the order of tables."""


@dataclass(frozen=True)
class Limits(LimitValues):
    """Limits of drives and tool; None is no limit. All but the position are the same in both directions. A joint limit
    is one number (or range) for all joints, or one for each joint. If drives couple the joints, as in the Peppermill,
    it holds at the actuators. The limits in `LIMITS` say what each field means.

    Attributes:
        speed: [rad/s or m/s].
        acceleration: [rad/s^2 or m/s^2].
        torque: [N m or N].
        jerk: [rad/s^3 or m/s^3].
        tool_speed: [m/s].
        tool_acceleration: [m/s^2].
        position: lowest and highest [rad or m].
        stall_torque, no_load_speed: both or neither [N m or N, rad/s or m/s].
        rms_torque: [N m or N].

    Raises:
        InvalidValue: a limit is not finite and positive, a range does not rise, or only one end of the line is given.
    """

    speed: PerJoint
    acceleration: PerJoint | None = None
    torque: PerJoint | None = None
    jerk: PerJoint | None = None
    tool_speed: float | None = None
    tool_acceleration: float | None = None
    position: Range | tuple[Range, ...] | None = None
    stall_torque: PerJoint | None = None
    no_load_speed: PerJoint | None = None
    rms_torque: PerJoint | None = None

    def __post_init__(self) -> None:
        for limit in LIMITS:
            values = [getattr(self, field.name) for field in limit.fields]
            for field, value in zip(limit.fields, values, strict=True):
                if value is not None or field.required:
                    object.__setattr__(self, field.name, field.checked(value))
                elif any(v is not None for v in values):
                    raise InvalidField("Limits", field.name, None, limit.both)

    def __iter__(self) -> Iterator[Limit]:
        """The limits that are set."""
        return (limit for limit in LIMITS if limit.is_set(self))

    def has(self, *kinds: type[Constraint]) -> bool:
        """Whether a limit with a constraint of one of these kinds is set."""
        return any(issubclass(limit.kind, kinds) for limit in self)

    def without(self, *kinds: type[Constraint]) -> Limits:
        """These limits without those that have a constraint of one of these kinds."""
        return self.less(*(limit for limit in self if issubclass(limit.kind, kinds)))

    def less(self, *others: Limit) -> Limits:
        """These limits without some."""
        nothing: dict[str, Any] = {field.name: None for limit in others for field in limit.fields}
        return replace(self, **nothing)

    def constraints(self, kind: type[Kind], along: Along) -> list[Kind]:
        """The constraints of one kind on the pace along a way."""
        found = [limit.constraint(along, self) for limit in self if issubclass(limit.kind, kind)]
        return [constraint for constraint in found if isinstance(constraint, kind)]

    def as_dict(self) -> dict[str, object]:
        """The limits that are set; a list if there is one for each joint."""
        return {k: _lists(v) for k, v in asdict(self).items() if v is not None}


def uses(robot: Mechanism, motion: Motion, limits: Limits, slack: Motion = NO_SLACK) -> dict[InstantLimit, Use]:
    """How much a motion uses of each limit that holds at every instant. A limit that is not set gives only the
    quantity.

    Args:
        robot: the robot that moves.
        motion: (..., m) samples.
        limits: limits of joints and tool.
        slack: bounds of the error of each sample; the result is then the largest possible use.
    """
    found = {limit: limit.use(robot, motion, limits, slack) for limit in LIMITS if isinstance(limit, InstantLimit)}
    return {limit: use for limit, use in found.items() if use is not None}


def mean_squares() -> tuple[MeanSquareLimit, ...]:
    """Every limit on a root mean square."""
    return tuple(limit for limit in LIMITS if isinstance(limit, MeanSquareLimit))


def _lists(value: Any) -> Any:
    return [_lists(v) for v in value] if isinstance(value, tuple) else value
