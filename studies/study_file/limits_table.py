"""The table `[trajectory.limits]`. Its keys and their words are those of the fields of all limits."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields
from typing import TYPE_CHECKING, Annotated, Any

from pydantic import Field, ValidationInfo, create_model, field_validator

from studies.study_file.keys import Key
from studies.study_file.table import Interval, PerJoint, Positive, StudyTable
from studies.study_file.units import Dimension
from trajectory import LIMITS, SPEED_UNIT, JointField, Limit, LimitField, Limits, RangeField, ToolField

_HOLDS: dict[type[LimitField], Any] = {
    JointField: PerJoint,
    ToolField: Positive,
    RangeField: Interval | Annotated[tuple[Interval, ...], Field(min_length=1)],
}


def _holds(field: LimitField) -> tuple[Any, Any]:
    """The type and the default of a key, as pydantic takes them."""
    dimension = Dimension.JOINT_SPEED if field.unit == SPEED_UNIT else Dimension.NONE
    key = Key(field.expected, dimension, place=isinstance(field, RangeField))
    kind = _HOLDS[type(field)]
    default: Any = ... if field.required else None
    asked = Field(default, description=field.words, validate_default=not field.required)
    return Annotated[kind if field.required else kind | None, key], asked


def _whole(limit: Limit) -> Callable[..., Any]:
    """A check that the fields of a limit are set together."""
    first, *others = (field.name for field in limit.fields)

    def check(cls: type, value: Any, info: ValidationInfo) -> Any:  # noqa: ARG001
        if first in info.data and (info.data[first] is None) != (value is None):
            raise ValueError("a field of the limit is missing")
        return value

    return field_validator(*others)(check)


if TYPE_CHECKING:

    class LimitsTable(StudyTable):
        """The fields are those of `Limits`."""

        def __getattr__(self, name: str) -> Any: ...
else:
    _DECLARED = {field.name: field for limit in LIMITS for field in limit.fields}
    LimitsTable = create_model(
        "LimitsTable",
        __base__=StudyTable,
        __module__=__name__,
        __doc__="The limits of each joint: a number for all joints, or one for each joint; None is no limit.",
        __validators__={f"whole_{limit.fields[0].name}": _whole(limit) for limit in LIMITS if len(limit.fields) > 1},
        **{field.name: _holds(_DECLARED[field.name]) for field in fields(Limits)},
    )
