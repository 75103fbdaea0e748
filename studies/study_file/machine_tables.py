"""The machine's masses, drives and joint ranges. A key that is left out takes the mechanism's own value."""

from typing import Annotated, Any

from pydantic import Field, model_validator

from studies.study_file.keys import Key
from studies.study_file.table import StudyTable, gathered, table_of

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
