"""The study file: one question, asked in `study.toml`, as a frozen model in SI and radians."""

import hashlib
import json
from typing import Annotated, Any, Literal

from pydantic import (
    AfterValidator,
    BaseModel,
    ConfigDict,
    Field,
    ValidationInfo,
    field_validator,
    model_validator,
)

from studies.units import Dimension, Key, Table

LENGTH, ANGLE = Dimension.LENGTH, Dimension.ANGLE


def _rising(pair: tuple[float, float]) -> tuple[float, float]:
    if pair[0] >= pair[1]:
        raise ValueError("low must be below high")
    return pair


Positive = Annotated[float, Field(gt=0)]
Interval = Annotated[tuple[float, float], AfterValidator(_rising)]
Coordinate = float | Interval
GeometryValue = float | tuple[float, ...] | tuple[tuple[float, ...], ...]
PerJoint = Positive | Annotated[tuple[Positive, ...], Field(min_length=1)]
Name = Annotated[str, Field(min_length=1)]


class _Model(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid", strict=True, allow_inf_nan=False)


def table_of(model: type[BaseModel], rows: bool = False) -> Table:
    """The keys that `model` takes from a file: its fields annotated with a Key or a Table."""
    keys = {
        name: node
        for name, field in model.model_fields.items()
        for node in field.metadata
        if isinstance(node, Key | Table)
    }
    return Table(keys, rows)


REGION_KINDS = ("box", "cylinder")
KIND = Key("one of", choices=REGION_KINDS)


class _Region(_Model):
    coordinates: dict[str, Coordinate]
    """By the pose's names: (low, high), or a number that fixes the coordinate [m or rad]."""

    @model_validator(mode="before")
    @classmethod
    def _gather_coordinates(cls, data: Any) -> Any:
        """The file gives the coordinates beside `kind` and `radius`."""
        if not isinstance(data, dict) or "coordinates" in data:
            return data
        own = {name: value for name, value in data.items() if name in cls.model_fields}
        return own | {"coordinates": {name: data[name] for name in data if name not in own}}


class BoxRegion(_Region):
    """Every pose coordinate in its interval."""

    kind: Annotated[Literal["box"], KIND]


class CylinderRegion(_Region):
    """x and y within `radius` [m] of the z axis; `coordinates` has the others."""

    kind: Annotated[Literal["cylinder"], KIND]
    radius: Annotated[Positive, Key("a length > 0", LENGTH)]


class Fvi(_Model):
    """What the force-velocity index (39) is taken from: what the joints give, what is wanted."""

    joint_speed: Annotated[Positive, Key("a speed > 0", Dimension.JOINT_SPEED)]
    """rad/s, or m/s on a rail."""
    joint_effort: Annotated[Positive, Key("an effort > 0 (N m, or N on a rail)")]
    speed: Annotated[Positive, Key("a speed > 0 (m/s)")]
    """Wanted worst isotropic speed [m/s]."""
    force: Annotated[Positive, Key("a force > 0 (N)")]
    """Wanted worst isotropic force [N]."""
    characteristic_length: Annotated[Positive | None, Key("a length > 0", LENGTH)] = None
    """m; None for the mechanism's own."""


class Sum(_Model):
    """The geometry's `fields`, added, are `at_most` [m]; a tuple counts entry by entry."""

    fields: Annotated[Annotated[tuple[Name, ...], Field(min_length=1)], Key("a list out of")]
    at_most: Annotated[Positive, Key("a length > 0", LENGTH)]


class Optimise(_Model):
    """What the synthesis may change: `variables` by geometry field, (low, high), one for each entry of a tuple."""

    seed: Annotated[int, Field(ge=0, lt=2**32), Key("a whole number from 0 to 2^32 - 1")] = 0
    starts: Annotated[int, Field(ge=1, le=10_000), Key("a whole number from 1 to 10000")] = 3
    variables: Annotated[dict[str, Interval | tuple[Interval, ...]], Field(min_length=1), Table({})]
    sums: Annotated[tuple[Sum, ...], table_of(Sum, rows=True)] = ()


class Requirement(_Model):
    """`margin` is `at_least` this at every pose of the region."""

    margin: Annotated[str, Key("one of")]
    at_least: Annotated[float, Key("a finite number")]


class Cycle(_Model):
    """The pick-and-place cycle: up by `lift`, across by `span`, down, and back [m, rad, kg]."""

    lift: Annotated[Positive, Key("a length > 0", LENGTH)]
    span: Annotated[Positive, Key("a length > 0", LENGTH)]
    blend: Annotated[Positive, Key("a length > 0, at most the lift and at most half the span", LENGTH)]
    turn: Annotated[float, Key("an angle", ANGLE)]
    pick: Annotated[tuple[float, float, float], Key("three lengths x, y, z", LENGTH)]
    """Where the cycle starts."""
    heading: Annotated[float, Key("an angle", ANGLE)] = 0.0
    """Direction of the span about z, from x."""
    payload: Annotated[float, Field(ge=0), Key("a mass >= 0 (kg)")]
    payload_back: Annotated[float | None, Field(ge=0), Key("a mass >= 0 (kg)")] = None
    """On the way back; None for the same."""

    @field_validator("blend")
    @classmethod
    def _blend_fits(cls, blend: float, info: ValidationInfo) -> float:
        lift, span = info.data.get("lift", blend), info.data.get("span", 2 * blend)
        if blend > lift or 2 * blend > span:
            raise ValueError("the blends overlap")
        return blend


class Limits(_Model):
    """What each joint can do: a number for all joints, or one a joint; None is no limit."""

    speed: Annotated[PerJoint, Key("a speed > 0, or one a joint", Dimension.JOINT_SPEED)]
    acceleration: Annotated[PerJoint | None, Key("a number > 0, or one a joint (rad/s^2, or m/s^2)")] = None
    torque: Annotated[PerJoint | None, Key("a number > 0, or one a joint (N m, or N)")] = None
    jerk: Annotated[PerJoint | None, Key("a number > 0, or one a joint (rad/s^3, or m/s^3)")] = None
    tool_speed: Annotated[Positive | None, Key("a speed > 0 (m/s)")] = None
    tool_acceleration: Annotated[Positive | None, Key("an acceleration > 0 (m/s^2)")] = None
    position: Annotated[
        Interval | Annotated[tuple[Interval, ...], Field(min_length=1)] | None,
        Key("low < high, or one such pair a joint (rad, or m)"),
    ] = None
    stall_torque: Annotated[PerJoint | None, Key("a number > 0, or one a joint (N m, or N)")] = None
    no_load_speed: Annotated[
        PerJoint | None,
        Field(validate_default=True),
        Key("a speed > 0, or one a joint, if and only if there is a stall_torque", Dimension.JOINT_SPEED),
    ] = None
    """Both or neither: the ends of the speed-torque line."""
    rms_torque: Annotated[PerJoint | None, Key("a number > 0, or one a joint (N m, or N)")] = None
    """Of each way by itself, and so of the cycle."""

    @field_validator("no_load_speed")
    @classmethod
    def _whole_line(cls, speed: PerJoint | None, info: ValidationInfo) -> PerJoint | None:
        if "stall_torque" in info.data and (info.data["stall_torque"] is None) != (speed is None):
            raise ValueError("half of a line")
        return speed


LAWS = ("jerk", "toppra")


class Approach(_Model):
    """What the joints may do on the jerk-limited move from home to the cycle's start."""

    speed: Annotated[PerJoint, Key("a speed > 0, or one a joint", Dimension.JOINT_SPEED)]
    acceleration: Annotated[PerJoint, Key("a number > 0, or one a joint (rad/s^2, or m/s^2)")]
    jerk: Annotated[PerJoint, Key("a number > 0, or one a joint (rad/s^3, or m/s^3)")]


class Trajectory(_Model):
    """How the cycle is timed, and how its set-points are sampled."""

    law: Annotated[Literal["jerk", "toppra"], Key("one of", choices=LAWS)] = "jerk"
    """toppra keeps no jerk limit."""
    grid: Annotated[int, Field(ge=1000, le=1_000_000), Key("a whole number from 1000 to 1000000")] = 2000
    """Points along the path."""
    period: Annotated[Positive, Key("a time > 0 (s)")] = 0.001
    """Of the set-points [s]."""
    cycle: Annotated[Cycle, table_of(Cycle)]
    limits: Annotated[Limits, table_of(Limits)]
    approach: Annotated[Approach | None, table_of(Approach)] = None
    """None leaves the approach out."""


class Study(_Model):
    """A whole study; `studies.load.load_study` reads one and checks it against its mechanism."""

    name: str
    """The folder's name."""
    title: Annotated[Name, Key("a title")]
    mechanism: Annotated[str, Key("one of")]
    geometry: Annotated[dict[str, GeometryValue], Table({})] = {}
    """What differs from the prototype's geometry [m, rad, m per turn]."""
    region: Annotated[Annotated[BoxRegion | CylinderRegion, Field(discriminator="kind")], Table({})]
    fvi: Annotated[Fvi | None, table_of(Fvi)] = None
    """None takes the mechanism's defaults."""
    optimise: Annotated[Optimise | None, table_of(Optimise)] = None
    dense_sample: Annotated[int, Field(ge=10_000, le=100_000_000), Key("a whole number from 10000 to 100000000")] = (
        1_000_000
    )
    """About how many poses of the region the worst cases are searched on, before the descents."""
    requirement: Annotated[tuple[Requirement, ...], table_of(Requirement, rows=True)] = ()
    trajectory: Annotated[Trajectory | None, table_of(Trajectory)] = None

    @property
    def digest(self) -> str:
        """sha256 (hex) of all that the file says, in SI to 12 digits; its folder's name is left out."""
        canonical = json.dumps(_rounded(self.model_dump(exclude={"name"})), sort_keys=True)
        return hashlib.sha256(canonical.encode()).hexdigest()


def _rounded(value: Any) -> Any:
    """Twelve digits forgive what converting a unit rounds off."""
    match value:
        case float():
            return float(f"{value:.12g}") + 0.0  # no negative zero
        case dict():
            return {key: _rounded(entry) for key, entry in value.items()}
        case list() | tuple():
            return [_rounded(entry) for entry in value]
        case _:
            return value
