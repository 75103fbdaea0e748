"""The machine's masses, drives, joint ranges and surroundings. An omitted key takes the mechanism's own value."""

from typing import Annotated, Any

from pydantic import Field, ValidationInfo, field_validator, model_validator

from kinematics import Load
from studies.study_file.keys import Key
from studies.study_file.table import Name, NotNegative, Positive, StudyTable, gathered, table_of
from studies.study_file.units import Dimension

Numbers = float | tuple[float, ...]
Ranges = dict[str, Numbers | tuple[tuple[float, float], ...]]
"""Values by the fields of the mechanism's `Ranges` [m or rad]."""


class DriveTrainTable(StudyTable):
    """Of each actuator, as in `kinematics.DriveTrain`; None takes the mechanism's own value."""

    gear_ratio: Annotated[
        Numbers | None, Key("a number > 0, or one a joint (rad of the motor for one rad, or one m, of the joint)")
    ] = None
    """The gear ratio: turns of the motor for one turn of the joint."""
    motor_inertia: Annotated[Numbers | None, Key("a number >= 0, or one a joint (kg m^2)")] = None
    """The inertia of the rotor, on its own side of the gear."""
    coulomb: Annotated[Numbers | None, Key("a number >= 0, or one a joint (N m, or N)")] = None
    """The dry friction at the joint."""
    viscous: Annotated[Numbers | None, Key("a number >= 0, or one a joint (N m s/rad, or N s/m)")] = None
    """The friction at the joint for each unit of speed. The law `toppra` does not allow it."""
    stiffness: Annotated[Numbers | None, Key("a number > 0, or one a joint (N m/rad, or N/m)")] = None
    """How hard gear and servo loop resist at the joint."""
    encoder_resolution: Annotated[Numbers | None, Key("a number >= 0, or one a joint (rad or m)")] = None
    """One step of the encoder, at the actuator. The motor may be off by so much to either side."""
    backlash: Annotated[Numbers | None, Key("a number >= 0, or one a joint (rad or m)")] = None
    """How far the actuator moves freely, from one flank to the other."""


class MaterialTable(StudyTable):
    """A material of the study's own, along a tube or bar."""

    density: Annotated[Positive, Key("a density > 0 (kg/m^3)")]
    """The density."""
    modulus: Annotated[Positive, Key("a modulus > 0 (Pa)")]
    """Young's modulus along the axis."""
    shear_modulus: Annotated[Positive, Key("a modulus > 0 (Pa)")]
    """The modulus for torsion about the axis."""
    strength: Annotated[Positive, Key("a stress > 0 (Pa)")]
    """The largest stress that the material bears for many cycles."""


class StructureTable(StudyTable):
    """What the members are made of, and how the joints between them give way."""

    materials: dict[str, str] = Field(default_factory=dict)
    """The name of the material of each kind of member."""
    joint_stiffness: Annotated[Positive | None, Key("a stiffness > 0 (N/m)")] = None
    """The stiffness of each joint at a rod's end, along the rod. None takes joints that do not give way."""
    joint_play: Annotated[NotNegative, Key("a length >= 0", Dimension.LENGTH)] = 0.0
    """How far each joint at a rod's end lets the rod slip along itself, from one end to the other."""

    @model_validator(mode="before")
    @classmethod
    def _gather_materials(cls, data: Any) -> Any:
        return gathered(cls, data, "materials")


class LoadTable(StudyTable):
    """The load that `natural_frequency` and `strength` are for. A cycle states its own payloads."""

    payload: Annotated[NotNegative, Key("a mass >= 0 (kg)")] = Load().payload
    """The mass at the tool point."""
    acceleration: Annotated[NotNegative, Key("an acceleration >= 0 (m/s^2)")] = Load().acceleration
    """The acceleration of the tool point, in the worst direction."""


class InertiaTable(StudyTable):
    """The masses that move, and the drives."""

    masses: dict[str, Numbers] = Field(default_factory=dict)
    """The fields of the mechanism's `Inertia` [SI]."""
    drive_train: Annotated[DriveTrainTable, table_of(DriveTrainTable)] = DriveTrainTable()
    """The gear, motor, friction and stiffness of each actuator."""

    @model_validator(mode="before")
    @classmethod
    def _gather_masses(cls, data: Any) -> Any:
        return gathered(cls, data, "masses")


_PLACE = tuple[float, float, float]


class ObstacleTable(StudyTable):
    """A box along the axes of the base."""

    name: Annotated[Name, Key("a name, different from those of the other obstacles")]
    """What messages call it, such as "conveyor"."""
    low: Annotated[_PLACE, Key("three coordinates x, y, z", Dimension.LENGTH, place=True)]
    """The corner with the lowest coordinates [m]."""
    high: Annotated[_PLACE, Key("three coordinates x, y, z, each above that of low", Dimension.LENGTH, place=True)]
    """The opposite corner [m]."""
    inside: Annotated[bool, Key("true or false")] = False
    """Whether the robot must stay inside the box, as in a frame. Otherwise it must stay outside."""

    @field_validator("high")
    @classmethod
    def _has_size(cls, high: _PLACE, info: ValidationInfo) -> _PLACE:
        low = info.data.get("low")
        if low is not None and not all(a < b for a, b in zip(low, high, strict=True)):
            raise ValueError("no size")
        return high


class PayloadHullTable(StudyTable):
    """A round body that the tool holds, along its z axis."""

    radius: Annotated[Positive, Key("a length > 0", Dimension.LENGTH)]
    """Its radius [m]."""
    low: Annotated[float, Key("a finite number", Dimension.LENGTH, place=True)]
    """Where it starts, from the tool point along the tool's z axis [m]."""
    high: Annotated[float, Key("a number above low", Dimension.LENGTH, place=True)]
    """Where it ends [m]."""

    @field_validator("high")
    @classmethod
    def _has_height(cls, high: float, info: ValidationInfo) -> float:
        if high <= info.data.get("low", high - 1.0):
            raise ValueError("no height")
        return high


class SurroundingsTable(StudyTable):
    """What the margin `clearance` looks at besides the robot itself."""

    floor: Annotated[float | None, Key("a height below the base", Dimension.LENGTH, place=True)] = None
    """The height that everything that moves stays above [m]. None for no floor."""
    obstacle: Annotated[tuple[ObstacleTable, ...], table_of(ObstacleTable, rows=True)] = ()
    """Boxes, such as a conveyor or a frame."""
    payload_hull: Annotated[PayloadHullTable | None, table_of(PayloadHullTable)] = None
    """The room that the payload takes. None for a payload without size."""
