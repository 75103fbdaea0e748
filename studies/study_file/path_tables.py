"""The path of a study's tool: a pick-and-place cycle, or a path through waypoints."""

from collections.abc import Mapping
from typing import Annotated, Any

from pydantic import Field, ValidationInfo, field_validator, model_validator

from kinematics import InvalidValue
from studies.study_file.keys import Key
from studies.study_file.table import Name, Positive, StudyTable, gathered, one_of, table_of
from studies.study_file.units import Dimension
from trajectory import STANDARD_SIZES, AdeptCycle

LENGTH, ANGLE = Dimension.LENGTH, Dimension.ANGLE
_NOT_OF_THE_PATH = ("size", "place", "payload", "payload_back")


class CycleTable(StudyTable):
    """The pick-and-place cycle: up by `lift`, across by `span`, down by `place_lift`, and back [m, rad, kg].

    A `size` replaces lift, span and place lift. A `place` replaces `span`, `heading` and `rise`.
    """

    pick: Annotated[tuple[float, float, float], Key("three lengths x, y, z", LENGTH, place=True)]
    """Where the cycle starts."""
    size: Annotated[Annotated[str, one_of(STANDARD_SIZES)] | None, Key("one of", choices=tuple(STANDARD_SIZES))] = None
    """Lift, span and place lift at once [mm]. The corners are not part of it: give a blend too."""
    place: Annotated[
        tuple[float, float, float] | None,
        Key("three lengths x, y, z, not straight above or below the pick; not with a size", LENGTH, place=True),
    ] = None
    """The pose where the half cycle ends. It replaces span, heading and rise."""
    lift: Annotated[Positive | None, Field(validate_default=True), Key("a length > 0; or a size instead", LENGTH)] = (
        None
    )
    """The height of the vertical leg above the pick."""
    span: Annotated[
        Positive | None, Field(validate_default=True), Key("a length > 0; or a size or a place instead", LENGTH)
    ] = None
    """The horizontal distance from pick to place."""
    place_lift: Annotated[Positive | None, Key("a length > 0; not with a size", LENGTH)] = None
    """The height of the vertical leg above the place. None takes the lift."""
    rise: Annotated[float, Key("a length; not with a place", LENGTH, place=True)] = 0.0
    """The height of the place above the pick. Below the pick it is negative."""
    heading: Annotated[float, Key("an angle; not with a place", ANGLE)] = 0.0
    """The direction of the span: its angle about z, from x."""
    blend: Annotated[
        Positive, Key("a length > 0, at most the lift and at most half the span; also needed with a size", LENGTH)
    ]
    """The length that a rounded corner takes off each of its legs."""
    turn: Annotated[float, Key("an angle", ANGLE)] = 0.0
    """The change of theta, or yaw, from pick to place."""
    start_angle: Annotated[float, Key("an angle", ANGLE)] = 0.0
    """Theta, or yaw, at the pick."""
    tilt: Annotated[tuple[float, float], Key("two angles, roll and pitch at the place", ANGLE)] = (0.0, 0.0)
    """Roll and pitch at the place; both are 0 at the pick. Only for a pose with roll and pitch."""
    payload: Annotated[float, Field(ge=0), Key("a mass >= 0 (kg); payload_back may give another for the way back")]
    """The mass at the tool."""
    payload_back: Annotated[float | None, Field(ge=0), Key("a mass >= 0 (kg)")] = None
    """The mass at the tool on the way back. None takes the same."""

    @field_validator("lift", "span", "place", "place_lift")
    @classmethod
    def _once(cls, value: Any, info: ValidationInfo) -> Any:
        given = [info.data.get("size")] + ([info.data.get("place")] if info.field_name == "span" else [])
        stated = [v for v in (value, *given) if v is not None]
        if len(stated) > 1 or (not stated and info.field_name in ("lift", "span")):
            raise ValueError("given twice, or not at all")
        if info.field_name == "place" and value is not None and value[:2] == info.data.get("pick", ())[:2]:
            raise ValueError("straight above or below the pick")
        return value

    @field_validator("rise", "heading")
    @classmethod
    def _not_with_place(cls, value: float, info: ValidationInfo) -> float:
        if value != 0.0 and info.data.get("place") is not None:
            raise ValueError("the place gives it")
        return value

    @field_validator("blend")
    @classmethod
    def _blend_fits(cls, blend: float, info: ValidationInfo) -> float:
        if not {"size", "place", "lift", "span", "place_lift", "rise", "heading", "pick"} <= info.data.keys():
            return blend  # the fault of lift or span is already reported
        try:
            adept_cycle({**info.data, "blend": blend})
        except InvalidValue as error:
            raise ValueError(str(error)) from error
        return blend


def adept_cycle(cycle: Mapping[str, Any], **others: Any) -> AdeptCycle:
    """The path of the way there, from the fields of a `CycleTable`.

    Raises:
        InvalidValue: the corners do not fit, or the pose has no such angles.
    """
    given = {k: v for k, v in cycle.items() if v is not None and k not in _NOT_OF_THE_PATH} | others
    if cycle["place"] is not None:
        return AdeptCycle.between(
            **{k: v for k, v in given.items() if k not in ("heading", "rise")}, place=cycle["place"]
        )
    return AdeptCycle(**given) if cycle["size"] is None else AdeptCycle.of_size(cycle["size"], **given)


class WaypointTable(StudyTable):
    """A pose, and the blend of its corner. An angle that is left out follows from the waypoints before and after."""

    coordinates: dict[str, float]
    """The pose [m or rad]."""
    blend: Annotated[float, Field(ge=0), Key("a length >= 0", LENGTH)] = 0.0
    """The length that the corner takes off each leg. At 0 the tool stops there, unless the path goes straight on."""

    @model_validator(mode="before")
    @classmethod
    def _gather_coordinates(cls, data: Any) -> Any:
        return gathered(cls, data)


class WaypointPathTable(StudyTable):
    """A path through waypoints, from a CSV file beside the study or from the study itself."""

    file: Annotated[Name | None, Key("the name of a CSV file; or waypoints instead")] = None
    """The CSV file, beside the study."""
    waypoint: Annotated[tuple[WaypointTable, ...], table_of(WaypointTable, rows=True)] = ()
    """The waypoints in order. With a file, they come from the file."""
    payload: Annotated[float, Field(ge=0), Key("a mass >= 0 (kg)")]
    """The mass at the tool, both ways."""
