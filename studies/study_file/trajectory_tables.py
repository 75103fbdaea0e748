"""The table `[trajectory]`: limits, timing law, approach, and the files for the drives."""

from typing import Annotated

from pydantic import Field, ValidationInfo, field_validator

from studies.study_file.keys import Key
from studies.study_file.limits_table import LimitsTable
from studies.study_file.path_tables import CycleTable, WaypointPathTable
from studies.study_file.table import Name, PerJoint, Positive, StudyTable, one_of, table_of
from studies.study_file.units import Dimension
from trajectory import LAWS
from trajectory.drive_files import FORMATS

Increments = Annotated[int, Field(gt=0)]


class ApproachTable(StudyTable):
    """The limits of the joints on the jerk-limited move from home to the cycle's start."""

    speed: Annotated[PerJoint, Key("a speed > 0, or one a joint", Dimension.JOINT_SPEED)]
    """The largest speed of the joints."""
    acceleration: Annotated[PerJoint, Key("a number > 0, or one a joint (rad/s^2, or m/s^2)")]
    """The largest acceleration of the joints."""
    jerk: Annotated[PerJoint, Key("a number > 0, or one a joint (rad/s^3, or m/s^3)")]
    """The largest jerk of the joints."""


class DriveTable(StudyTable):
    """The data of the machine that drive files need: a value for all axes, or one for each axis."""

    axes: Annotated[Annotated[tuple[Name, ...], Field(min_length=1)] | None, Key("a list of names, one a joint")] = None
    """The names of the axes. None takes the names of each format."""
    increments: Annotated[
        Increments | Annotated[tuple[Increments, ...], Field(min_length=1)] | None,
        Key("a whole number > 0, or one a joint (for one turn of the encoder, or one metre on a rail)"),
    ] = None
    """The number of increments of the encoder. The format `cia402` needs it."""
    encoder_gear: Annotated[
        float | Annotated[tuple[float, ...], Field(min_length=1)],
        Key("a number other than 0, or one a joint (turns of the encoder for one turn of the joint)"),
    ] = 1.0
    """The gear ratio between joint and encoder. It is negative if the encoder counts the other way."""


class TrajectoryTable(StudyTable):
    """How the cycle is timed, and how its set-points are sampled."""

    law: Annotated[str, one_of(LAWS), Key("one of", choices=tuple(LAWS))] = "jerk"
    """The timing law. `toppra` keeps no jerk limit. `free` also finds the path."""
    grid: Annotated[int, Field(ge=1000, le=1_000_000), Key("a whole number from 1000 to 1000000")] = 2000
    """The number of points along the path at the start. The law `toppra` adds more if needed."""
    period: Annotated[Positive, Field(le=1.0), Key("a time > 0, at most 1 (s)")] = 0.001
    """The time between two set-points [s]."""
    cycle: Annotated[CycleTable | None, table_of(CycleTable)] = None
    """The cycle to time. Give either a cycle or a path."""
    path: Annotated[WaypointPathTable | None, Field(validate_default=True), table_of(WaypointPathTable)] = None
    """The path to time. Give either a cycle or a path."""
    limits: Annotated[LimitsTable, table_of(LimitsTable)]
    """The limits of the drives and the tool."""
    approach: Annotated[ApproachTable | None, table_of(ApproachTable)] = None
    """The move from home to the start. None leaves it out."""
    files: Annotated[
        Annotated[tuple[Annotated[str, one_of(FORMATS)], ...], Field(min_length=1)],
        Key("a list out of", choices=tuple(FORMATS)),
    ] = ("csv",)
    """The formats of the set-points' files."""
    drive: Annotated[DriveTable, table_of(DriveTable)] = DriveTable()
    """The data of the machine that drive files need."""

    @field_validator("path")
    @classmethod
    def _one_of_two(cls, path: WaypointPathTable | None, info: ValidationInfo) -> WaypointPathTable | None:
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
        """Mass at the tool on the way back [kg]; None for the same mass."""
        return self.cycle.payload_back if self.cycle else None
