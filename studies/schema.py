"""The study file: one question, asked in `study.toml`, as a frozen model in SI and radians."""

import hashlib
import json
from collections.abc import Mapping
from typing import Annotated, Any, Literal, get_args

from pydantic import (
    AfterValidator,
    BaseModel,
    ConfigDict,
    Field,
    ValidationInfo,
    field_validator,
    model_validator,
)

from kinematics import InvalidValue
from studies.units import Dimension, Key, Table
from trajectory.adept import STANDARD_SIZES, AdeptCycle

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


def _gathered(model: type[BaseModel], data: Any) -> Any:
    """A file gives the coordinates beside the model's own keys."""
    if not isinstance(data, dict) or "coordinates" in data:
        return data
    own = {name: value for name, value in data.items() if name in model.model_fields}
    return own | {"coordinates": {name: data[name] for name in data if name not in own}}


REGION_KINDS = ("box", "cylinder")
KIND = Key("one of", choices=REGION_KINDS)


class _Region(_Model):
    coordinates: dict[str, Coordinate]
    """By the pose's names: (low, high), or a number that fixes the coordinate [m or rad]."""

    @model_validator(mode="before")
    @classmethod
    def _gather_coordinates(cls, data: Any) -> Any:
        return _gathered(cls, data)


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


class Certify(_Model):
    """What is proved of every pose: each required margin at its bound, the objective and any other at its best."""

    margins: Annotated[tuple[Name, ...] | None, Key("a list out of")] = None
    """None for all that are required, and the objective."""
    tolerance: Annotated[Positive, Field(lt=1), Key("a number above 0 and below 1")] = 0.01
    """By how much a best bound may stay below the lowest value found, relative to that value."""
    most_boxes: Annotated[int, Field(ge=4, le=10**9), Key("a whole number from 4 to 1000000000")] = 4_000_000
    """After so many a claim stays undecided."""


class Cycle(_Model):
    """The pick-and-place cycle: up by `lift`, across by `span`, down by `place_lift`, and back [m, rad, kg].

    A `size` stands for the three, a `place` for `span`, `heading` and `rise`.
    """

    pick: Annotated[tuple[float, float, float], Key("three lengths x, y, z", LENGTH)]
    """Where the cycle starts."""
    size: Annotated[str | None, Key("one of", choices=tuple(STANDARD_SIZES))] = None
    place: Annotated[
        tuple[float, float, float] | None, Key("three lengths x, y, z, not above the pick; no size beside it", LENGTH)
    ] = None
    """Where the half cycle ends."""
    lift: Annotated[
        Positive | None, Field(validate_default=True), Key("a length > 0, or a size instead of it", LENGTH)
    ] = None
    span: Annotated[
        Positive | None, Field(validate_default=True), Key("a length > 0, or a size or a place instead of it", LENGTH)
    ] = None
    place_lift: Annotated[Positive | None, Key("a length > 0; no size beside it", LENGTH)] = None
    """None for the lift."""
    rise: Annotated[float, Key("a length, how much higher the place is; no place beside it", LENGTH)] = 0.0
    heading: Annotated[float, Key("an angle; no place beside it", ANGLE)] = 0.0
    """Direction of the span about z, from x."""
    blend: Annotated[Positive, Key("a length > 0, at most the lift and at most half the span", LENGTH)]
    turn: Annotated[float, Key("an angle", ANGLE)] = 0.0
    start_angle: Annotated[float, Key("an angle", ANGLE)] = 0.0
    tilt: Annotated[tuple[float, float], Key("two angles, roll and pitch at the place", ANGLE)] = (0.0, 0.0)
    payload: Annotated[float, Field(ge=0), Key("a mass >= 0 (kg)")]
    payload_back: Annotated[float | None, Field(ge=0), Key("a mass >= 0 (kg)")] = None
    """On the way back; None for the same."""

    @field_validator("size")
    @classmethod
    def _size_known(cls, size: str | None) -> str | None:
        if size is not None and size not in STANDARD_SIZES:
            raise ValueError("no standard size")
        return size

    @field_validator("lift", "span", "place", "place_lift")
    @classmethod
    def _once(cls, value: Any, info: ValidationInfo) -> Any:
        given = [info.data.get("size")] + ([info.data.get("place")] if info.field_name == "span" else [])
        stated = [v for v in (value, *given) if v is not None]
        if len(stated) > 1 or (not stated and info.field_name in ("lift", "span")):
            raise ValueError("given twice, or not at all")
        if info.field_name == "place" and value is not None and value[:2] == info.data.get("pick", ())[:2]:
            raise ValueError("above the pick")
        return value

    @field_validator("rise", "heading")
    @classmethod
    def _not_with_place(cls, value: float, info: ValidationInfo) -> float:
        if value != 0.0 and info.data.get("place") is not None:
            raise ValueError("the place says it")
        return value

    @field_validator("blend")
    @classmethod
    def _blend_fits(cls, blend: float, info: ValidationInfo) -> float:
        if not {"size", "place", "lift", "span", "place_lift", "rise", "heading", "pick"} <= info.data.keys():
            return blend  # what is wrong with those is told already
        try:
            adept_cycle({**info.data, "blend": blend})
        except InvalidValue as error:
            raise ValueError(str(error)) from error
        return blend


def adept_cycle(cycle: Mapping[str, Any], **others: Any) -> AdeptCycle:
    """The path there, from the fields of a `Cycle`.

    Raises:
        InvalidValue: the corners do not fit, or the pose has no such angles.
    """
    given = {k: v for k, v in cycle.items() if v is not None and k not in ("size", "place", "payload")} | others
    if cycle["place"] is not None:
        return AdeptCycle.between(
            **{k: v for k, v in given.items() if k not in ("heading", "rise")}, place=cycle["place"]
        )
    return AdeptCycle(**given) if cycle["size"] is None else AdeptCycle.of_size(cycle["size"], **given)


class Waypoint(_Model):
    """A pose, and the blend of the corner there; an angle that is left out is left to its neighbours."""

    coordinates: dict[str, float]
    """By the pose's names [m or rad]."""
    blend: Annotated[float, Field(ge=0), Key("a length >= 0", LENGTH)] = 0.0

    @model_validator(mode="before")
    @classmethod
    def _gather_coordinates(cls, data: Any) -> Any:
        return _gathered(cls, data)


class WaypointPath(_Model):
    """A path through waypoints, from a CSV file beside the study or from the study itself."""

    file: Annotated[Name | None, Key("the name of a CSV file, or waypoints instead of it")] = None
    waypoint: Annotated[tuple[Waypoint, ...], table_of(Waypoint, rows=True)] = ()
    """In order; those of the file where one is given."""
    payload: Annotated[float, Field(ge=0), Key("a mass >= 0 (kg)")]


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


File = Literal["csv", "ros2", "cia402", "zaber", "xps", "pmac"]
FILES = get_args(File)
Increments = Annotated[int, Field(gt=0)]
LAWS = ("jerk", "toppra")


class Approach(_Model):
    """What the joints may do on the jerk-limited move from home to the cycle's start."""

    speed: Annotated[PerJoint, Key("a speed > 0, or one a joint", Dimension.JOINT_SPEED)]
    acceleration: Annotated[PerJoint, Key("a number > 0, or one a joint (rad/s^2, or m/s^2)")]
    jerk: Annotated[PerJoint, Key("a number > 0, or one a joint (rad/s^3, or m/s^3)")]


class Drive(_Model):
    """What the drive files need of the machine; a value for all axes, or one an axis."""

    axes: Annotated[Annotated[tuple[Name, ...], Field(min_length=1)] | None, Key("a list of names, one a joint")] = None
    increments: Annotated[
        Increments | Annotated[tuple[Increments, ...], Field(min_length=1)] | None,
        Key("a whole number > 0, or one a joint (encoder increments in a turn of the motor, or in a metre on a rail)"),
    ] = None
    gear: Annotated[
        float | Annotated[tuple[float, ...], Field(min_length=1)],
        Key("a number other than 0, or one a joint (turns of the motor for one of the joint)"),
    ] = 1.0


class Trajectory(_Model):
    """How the cycle is timed, and how its set-points are sampled."""

    law: Annotated[Literal["jerk", "toppra"], Key("one of", choices=LAWS)] = "jerk"
    """toppra keeps no jerk limit."""
    grid: Annotated[int, Field(ge=1000, le=1_000_000), Key("a whole number from 1000 to 1000000")] = 2000
    """Points along the path."""
    period: Annotated[Positive, Key("a time > 0 (s)")] = 0.001
    """Of the set-points [s]."""
    cycle: Annotated[Cycle | None, table_of(Cycle)] = None
    path: Annotated[WaypointPath | None, Field(validate_default=True), table_of(WaypointPath)] = None
    """One of the two: what is travelled."""
    limits: Annotated[Limits, table_of(Limits)]
    approach: Annotated[Approach | None, table_of(Approach)] = None
    """None leaves the approach out."""
    files: Annotated[Annotated[tuple[File, ...], Field(min_length=1)], Key("a list out of", choices=FILES)] = ("csv",)
    """Formats of the set-points' files."""
    drive: Annotated[Drive, table_of(Drive)] = Drive()

    @field_validator("path")
    @classmethod
    def _one_of_two(cls, path: WaypointPath | None, info: ValidationInfo) -> WaypointPath | None:
        if "cycle" in info.data and (path is None) == (info.data["cycle"] is None):
            raise ValueError("either a cycle or a path")
        return path

    @property
    def payload(self) -> float:
        """Mass at the tool [kg]."""
        asked = self.cycle or self.path
        assert asked is not None
        return asked.payload

    @property
    def payload_back(self) -> float | None:
        """Mass on the way back [kg]; None for the same."""
        return self.cycle.payload_back if self.cycle else None


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
    certify: Annotated[Certify, table_of(Certify)] = Certify()
    trajectory: Annotated[Trajectory | None, table_of(Trajectory)] = None

    @property
    def digest(self) -> str:
        """sha256 (hex) of all that the file says, in SI to 12 digits; its folder's name is left out."""
        canonical = json.dumps(_rounded(self.model_dump(exclude={"name"}, exclude_defaults=True)), sort_keys=True)
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
